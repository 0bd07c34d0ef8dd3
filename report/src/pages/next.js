import { headingOf } from '../page.js';
import { h, section, table } from '../dom.js';
import { inShort, tile } from '../parts/tiles.js';
import { commonFacts, repeatSection } from '../parts/repeat.js';
import { nextPlot } from '../plots/next.js';
import { shell, shellFile } from '../sections/reproduce.js';
import { choicesOf } from '../text/choices.js';
import { fixed, plural, quantity, shownUnit } from '../text/units.js';

const verdicts = { not_determined: 'go on', go_on: 'go on', reached: 'stop', flat: 'stop' };
const becauses = {
  not_determined: 'not all parameters are told yet',
  go_on: 'more poses still help',
  reached: 'the required accuracy is reached',
  flat: 'more poses hardly help',
};

/** @param {any} n */
function tiles(n) {
  const now = n.curve.at(-1) ?? {};
  const last = n.ahead.at(-1);
  return [
    tile(verdicts[n.verdict], 'verdict', becauses[n.verdict]),
    tile(String(n.measured.poses), 'poses measured', plural(n.measured.readings, 'reading')),
    tile(
      quantity(now.expected, 'm', 3),
      'predicted error',
      now.upper === null || now.upper === undefined
        ? 'no bound yet'
        : `below ${quantity(now.upper, 'm', 3)} with ${100 * n.confidence} % confidence`,
    ),
    n.required === null
      ? tile('–', 'nothing required', 'only a flat curve says stop')
      : tile(quantity(n.required, 'm', 3), 'required', 'of the bound'),
    last && last.expected !== null
      ? tile(quantity(last.expected, 'm', 3), `after ${plural(last.poses, 'pose')}`, 'with the next poses below')
      : null,
  ];
}

/** @param {any} n */
function warnings(n) {
  return [
    n.unmodelled &&
      `The residuals contain a smooth effect of ${quantity(n.unmodelled.size, 'm', 3)} that no parameter describes; the fit counts it.`,
    n.interrupted && 'Stopped early.',
    ...(n.notes ?? []),
  ].filter(Boolean);
}

/** @param {any} n */
function posesSection(n) {
  if (n.poses.length === 0) return null;
  const [first] = n.poses;
  const shown = first.units.map((unit) => shownUnit(unit));
  const extra = [
    ...choicesOf(first).map(([, name], k) => [name, (p) => choicesOf(p)[k][2]]),
    ['of the list', (p) => p.listed && String(p.listed.id)],
  ].filter(([, of]) => of(first));
  const header = [
    'pose',
    ...extra.map(([title]) => title),
    ...first.names.map((name, k) => `#${name}${shown[k].name ? `, ${shown[k].name}` : ''}`),
  ];
  const rows = n.poses.map((p) => [
    String(p.id),
    ...extra.map(([, of]) => of(p)),
    ...p.configuration.map((v, k) => fixed(v * shown[k].factor, 3)),
  ]);
  return section(
    'poses',
    n.poses.length === 1 ? 'The next pose' : 'The next poses',
    `In this order, by criterion ${n.criterion} among ${n.candidates}.`,
    table(header, rows, 'Next poses'),
  );
}

/** @param {any} n */
function estimatesSection(n) {
  if (!n.estimates || n.estimates.length === 0) return null;
  const rows = n.estimates.map((e) => [e.name, quantity(e.value, e.unit, 6), quantity(e.sigma, e.unit, 2)]);
  return section(
    'parameters',
    'Parameters so far',
    `Estimated from what is measured; ${n.parameters.told} of ${n.parameters.count} are determined by the readings alone. posewright calibrate tests them.`,
    h(
      'details',
      { class: 'printed' },
      h('summary', {}, plural(n.estimates.length, 'parameter')),
      table(['parameter', '#value', '#σ'], rows, 'Parameters so far'),
    ),
  );
}

/** @param {any} n next.json @param {any} report @returns {import('../page.js').Page} */
export function nextPage(n, report) {
  const words = [
    n.data && `--data ${shellFile(n.data)}`,
    `--variant ${shell(n.variant)}`,
    n.required !== null && `--required ${shell(`${1e3 * n.required} mm`)}`,
    `-k ${Math.max(1, n.poses.length)}`,
    `--seed ${shell(n.seed)}`,
  ];
  return {
    kind: `Next poses${n.data ? `, from ${n.data}` : ''}${report.refresh > 0 ? '; this page follows the file' : ''}`,
    heading: headingOf(report.title, n.variant),
    title: `${n.stop ? 'Stop' : 'Go on'}: ${report.title}`,
    sections: [
      ['In short', inShort(tiles(n), warnings(n))],
      ['How far', section('progress', n.stop ? 'Enough is measured' : 'How far', n.reason, nextPlot(n))],
      ['Next poses', posesSection(n)],
      ['Parameters', estimatesSection(n)],
      [
        'Repeat',
        repeatSection(
          [...commonFacts(n, report), ['readings', n.data]],
          [`posewright next ${shellFile(n.problem.file)} ${words.filter(Boolean).join(' ')}`],
          'Options that are not in the result (--candidates, --no-prior) have to be given again.',
        ),
      ],
    ],
  };
}
