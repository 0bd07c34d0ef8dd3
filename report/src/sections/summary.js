import { usualError } from '../numerics/expected_error.js';
import { inShort, inWords, tile } from '../parts/tiles.js';
import { duration, percentDown, quantity } from '../text/units.js';
import * as say from '../text/sentences.js';

/** The smaller of what is known over the candidates and over the whole workspace: with few candidates the best of them
 * may be far from the best there is. @param {any} certificate */
function nearness({ candidates, workspace }) {
  const title = 'of the best plan';
  if (!candidates) return tile('no bound', 'for this criterion', 'how near the best plan is unknown');
  if (!workspace || !say.isSettled(workspace) || workspace.efficiency >= candidates.efficiency)
    return tile(`≥ ${percentDown(candidates.efficiency)}`, title, 'proved over the candidates');
  return workspace.proved
    ? tile(`≥ ${percentDown(workspace.efficiency, 1)}`, title, 'proved over the whole workspace')
    : tile(say.searchedShare(workspace), title, 'over the whole workspace, by a search');
}

/** @param {import('../pose_list.js').PoseList} list */
function tiles(list) {
  const { plan } = list.report;
  const kept = plan.parameters.filter((p) => p.identifiable);
  const nuisance = kept.filter((p) => p.role === 'nuisance').length;
  const known = kept.filter((p) => p.role === 'interest');
  const gained = known.filter((p) => p.worth_identifying).length;
  return [
    tile(String(say.newPoses(plan).length), 'poses', 'to measure'),
    tile(
      String(kept.length - nuisance),
      'parameters',
      nuisance > 0 ? `and ${nuisance} estimated along with them` : 'identified',
    ),
    plan.expected_error
      ? tile(
          quantity(usualError(plan.expected_error), 'm', 3),
          'position error',
          `expected after calibration, ${quantity(plan.expected_error.by_noise, 'm', 3)} from noise alone`,
        )
      : tile(`${gained} of ${known.length}`, 'parameters gain', 'known better than their tolerance afterwards'),
    nearness(plan.certificate),
    onDrawnRobots(plan.robust),
    jobTime(list.report.route),
  ];
}

/** A plan for the tolerances. @param {any} robust of plan.json */
const onDrawnRobots = (robust) =>
  robust && robust.efficiency.length > 0
    ? tile(percentDown(robust.value), `on ${robust.draws} drawn robots`, `of the best plan for each, ${robust.measure}`)
    : null;

/** Percent of full speed at which exported programs move unless --speed asks for another. */
const PROGRAM_SPEED = 10;

/** How long the robot is taken, by the route. @param {any} route */
function jobTime(route) {
  if (!route || route.motions.length === 0) return null;
  const { travel, changes, settle, reading = 0 } = route.seconds;
  const parts = [
    `${duration(travel)} moving (about ${duration((travel * 100) / PROGRAM_SPEED)} at the ${PROGRAM_SPEED} % of exported programs)`,
    settle > 0 && `${duration(settle)} settling`,
    reading > 0 && `${duration(reading)} reading`,
    changes > 0 && `${duration(changes)} changes`,
  ].filter(Boolean);
  return tile(duration(travel + changes + settle + reading), 'for the whole route', parts.join(', '));
}

/** Figures and warnings: the picture comes next, words after it. @param {import('../pose_list.js').PoseList} list */
export const summarySection = (list) => inShort(tiles(list), say.warnings(list.report));

/** What the figures mean. @param {import('../pose_list.js').PoseList} list */
export function wordsSection(list) {
  const { report } = list;
  const { plan } = report;
  return inWords([
    say.what(plan),
    say.accuracy(plan),
    say.worth(plan),
    say.instruments(plan),
    `${say.proof(plan)} ${say.proofMeaning(plan)}`.trim(),
    say.searched(plan),
    say.loss(plan),
    say.clearance(plan, report.route),
    say.dropped(plan),
  ]);
}
