import { h } from '../dom.js';
import { percentDown, quantity } from '../text/units.js';
import * as say from '../text/sentences.js';

/** @param {string} value @param {string} title @param {string} hint */
const tile = (value, title, hint) =>
  h('div', { class: 'tile' }, h('b', {}, value), h('span', {}, title), h('small', {}, hint));

/** @param {import('../pose_list.js').PoseList} list */
function tiles(list) {
  const { plan } = list.report;
  const kept = plan.parameters.filter((p) => p.identifiable);
  const nuisance = kept.filter((p) => p.role === 'nuisance').length;
  const { candidates } = plan.certificate;
  const known = kept.filter((p) => p.role === 'interest');
  const gained = known.filter((p) => p.worth_identifying).length;
  return h(
    'div',
    { class: 'tiles' },
    tile(String(say.newPoses(plan).length), 'poses', 'to measure'),
    tile(
      String(kept.length - nuisance),
      'parameters',
      nuisance > 0 ? `and ${nuisance} estimated along with them` : 'identified',
    ),
    plan.accuracy.rho0 !== null
      ? tile(quantity(plan.accuracy.rho0, 'm', 3), 'position error', 'expected after calibration, 1σ')
      : tile(`${gained} of ${known.length}`, 'parameters gain', 'known better than their tolerance afterwards'),
    candidates
      ? tile(`≥ ${percentDown(candidates.efficiency)}`, 'of the best plan', 'proved over the candidates')
      : tile('no bound', 'for this criterion', 'how near the best plan is unknown'),
  );
}

/** @param {import('../pose_list.js').PoseList} list */
export function summarySection(list) {
  const { report } = list;
  const { plan } = report;
  const warnings = say.warnings(report);
  const sentences = [
    say.what(plan),
    say.accuracy(plan),
    say.worth(plan),
    `${say.proof(plan)} ${say.proofMeaning(plan)}`.trim(),
    say.searched(plan),
    say.loss(plan),
    say.clearance(plan, report.route),
    say.dropped(plan),
  ].filter(Boolean);
  return h(
    'section',
    { id: 'summary', 'aria-labelledby': 'summary-title' },
    h('h2', { id: 'summary-title' }, 'In short'),
    tiles(list),
    warnings.length > 0
      ? h(
          'div',
          { class: 'warnings', role: 'note' },
          h('h3', {}, 'Please note'),
          h(
            'ul',
            {},
            warnings.map((w) => h('li', {}, w)),
          ),
        )
      : null,
    h(
      'ul',
      { class: 'sentences' },
      sentences.map((s) => h('li', {}, s)),
    ),
  );
}
