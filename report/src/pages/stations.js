import { headingOf } from '../page.js';
import { h, section, table } from '../dom.js';
import { inShort, tile } from '../parts/tiles.js';
import { commonFacts, repeatSection } from '../parts/repeat.js';
import { usualError } from '../numerics/expected_error.js';
import { counts, hasRatios, isLookedAt, sigmaRatio } from '../numerics/stations.js';
import { stationMap } from '../plots/station_map.js';
import { shell, shellFile } from '../sections/reproduce.js';
import { number, percent, plural, quantity } from '../text/units.js';

const namesOf = (rank) => Object.keys(rank.stations).join(', ');
const placeOf = (rank) =>
  Object.values(rank.stations)
    .map(({ position }) => position.map((v) => number(1e3 * v, 6)).join(', '))
    .join('; ');

/** @param {any} s */
function tiles(s) {
  const [best] = s.ranking;
  const planned = s.ranking.filter((r) => !r.why_not);
  const { looked, all } = counts(s.ranking);
  const ratio = planned.filter((r) => r.sigma_ratio !== null).map((r) => r.sigma_ratio);
  return [
    tile(namesOf(best), Object.keys(best.stations).length > 1 ? 'best places' : 'best place', `at ${placeOf(best)} mm`),
    looked < all
      ? tile(`${looked} of ${all}`, 'looked at', `${planned.length} give a plan; the search was ended early`)
      : tile(
          String(planned.length),
          'choices give a plan',
          planned.length < s.ranking.length
            ? `${s.ranking.length - planned.length} do not`
            : `${planned.filter((r) => r.in_full).length} planned in full`,
        ),
    best.expected_error !== null
      ? tile(quantity(usualError(best.expected_error), 'm', 3), 'position error', 'predicted from the best place')
      : null,
    ratio.length > 1
      ? tile(`${number(Math.max(...ratio), 4)} ×`, 'σ from the worst', `of the ${ratio.length} planned ${best.in_full ? 'in full' : 'quickly'}, against the best`)
      : null,
    tile(percent(best.feasible_share), 'feasible', 'of the configurations drawn, from the best place'),
  ];
}

/** @param {any} s */
function rankingSection(s) {
  const planned = s.ranking.filter((r) => !r.why_not);
  const withError = planned.some((r) => r.expected_error !== null);
  const header = [
    '#',
    'station',
    'place x, y, z, mm',
    'planned',
    '#parameters',
    `#${s.criterion}`,
    '#σ against the best planned alike',
    '#feasible',
    ...(withError ? ['#position error'] : []),
    'most rejected by',
  ];
  const rows = planned.map((r, k) => [
    String(k + 1),
    namesOf(r),
    placeOf(r),
    r.in_full ? 'in full' : 'quickly',
    String(r.parameters),
    number(r.phi, 5),
    hasRatios(s) ? `${number(sigmaRatio(s.ranking, r), 4)} ×` : '–',
    percent(r.feasible_share),
    ...(withError ? [r.expected_error ? quantity(usualError(r.expected_error), 'm') : '–'] : []),
    r.main_rejection,
  ]);
  const refused = s.ranking.filter((r) => r.why_not && isLookedAt(r));
  const open = s.ranking.filter((r) => !isLookedAt(r));
  return section(
    'ranking',
    'Ranking',
    `Criterion ${s.criterion} as it is maximised, larger is better; compare only places that were planned alike.`,
    table(header, rows, 'Ranking'),
    refused.length > 0
      ? h(
          'ul',
          { class: 'sentences' },
          refused.map((r) => h('li', {}, `${namesOf(r)} allows no plan: ${r.why_not}`)),
        )
      : null,
    open.length > 0
      ? h('p', {}, `Not scored, because the search ended before: ${open.map(namesOf).join('; ')}.`)
      : null,
  );
}

/** The best choice as a problem file has it. @param {any} s */
function entrySection(s) {
  const lines = Object.entries(s.ranking[0].stations).map(
    ([name, { position, rpy }]) => `    ${name}: {position: [${position.join(', ')}], rpy: [${rpy.join(', ')}]}`,
  );
  return section(
    'entry',
    'Into the problem file',
    'The best choice, in m and rad, under measurement: device:',
    h('pre', { tabindex: '0' }, ['  stations:', ...lines].join('\n')),
  );
}

/** @param {any} s stations.json @param {any} report @returns {import('../page.js').Page} */
export function stationsPage(s, report) {
  return {
    kind: `Places for the instrument, from ${s.problem.file}`,
    heading: headingOf(report.title, s.variant),
    title: `Stations: ${report.title}`,
    sections: [
      ['In short', inShort(tiles(s))],
      [
        'Map',
        section(
          'map',
          'Map of the places',
          `${plural(s.ranking.length, 'choice')} of ${Object.keys(s.ranking[0].stations).length > 1 ? 'places' : 'a place'}, each scored by its best plan.`,
          stationMap(s),
        ),
      ],
      ['Ranking', rankingSection(s)],
      ['Problem file', entrySection(s)],
      [
        'Repeat',
        repeatSection(
          [...commonFacts(s, report), ['criterion', s.criterion]],
          [
            `posewright stations ${shellFile(s.problem.file)} --variant ${shell(s.variant)} --criterion ${shell(s.criterion)} --choose ${Object.keys(s.ranking[0].stations).length} --seed ${shell(s.seed)} --json > stations.json`,
          ],
          'Options that are not in the result (--poses, --candidates, --restarts, --full) have to be given again.',
        ),
      ],
    ],
  };
}
