import { h, section, table } from '../dom.js';
import { chance, seldom } from '../text/chances.js';
import { number, quantity } from '../text/units.js';

/** @param {any} test @param {string} good @param {string} bad */
const verdict = (test, good, bad) => (test.probability < seldom ? h('span', { class: 'refused' }, bad) : good);

/**
 * One row a test of the residuals: its name in the file, the question, its figure, what is said where it holds and where it refuses.
 * @type {[string, string, (statistic: number, c: any) => string, (c: any) => string, (c: any) => string][]}
 */
const asked = [
  [
    'chi_square',
    'Is the noise as stated? (χ²)',
    (statistic, c) => `${number(statistic, 4)} of ${c.freedom}`,
    (c) => `${number(c.noise_scale, 3)} times the stated noise, as expected`,
    (c) =>
      `${number(c.noise_scale, 3)} times the stated noise: ${c.noise_scale > 1 ? 'the model lacks something, or the noise is larger' : 'it is smaller than stated'}`,
  ],
  [
    'lack_of_fit',
    'Does the model fit? (scatter within poses, F)',
    (statistic) => number(statistic, 3),
    () => 'the scatter within poses and what is stated to stay at one explain the residuals',
    () => 'more stays at a pose than is stated: larger repeatability, or a missing effect',
  ],
  [
    'within_pose_correlation',
    'Do readings of a pose err together?',
    (statistic) => number(statistic, 2),
    () => 'no clear sign of it',
    () => 'they do: state a repeatability, or σ is too small',
  ],
  [
    'serial_correlation',
    'From pose to pose? (drift)',
    (statistic) => number(statistic, 2),
    () => 'no clear sign of it',
    () => 'poses after each other err alike: drift, temperature',
  ],
  [
    'normality',
    'Are there gross errors? (normality)',
    (statistic) => number(statistic, 3),
    () => 'no clear sign of them',
    () => 'residuals are not normal: see the histogram, try --weights robust',
  ],
];

/** What is left of intervals where the problem is not linear. @param {any} c */
function notLinear(c) {
  const profiled = c.parameters.filter((p) => p.interval_by === 'profile').length;
  if (profiled === 0) return 'no: intervals are rough';
  return `no: σ are rough; ${profiled} intervals are by profile${c.intrinsic_curvature > 0.15 ? ', and rough, too' : ''}`;
}

/** What poses left out say of the estimate; beyond two standard errors it is no accident. @param {any} left left_out */
export function leftOut(left) {
  const refused = (text) => ({ holds: false, text });
  if (!left.gains)
    return left.gain === null || left.gain < -2
      ? refused('worse than base and tool alone, beyond chance')
      : refused('no better than base and tool alone beyond chance');
  return typeof left.gain_in_range === 'number' && left.gain_in_range <= 2
    ? refused('better between the measured poses, not beyond chance over the range of the joints')
    : { holds: true, text: 'poses left out, predicted in units of the stated noise, against base and tool alone' };
}

/** @param {any} c */
function rowsOf(c) {
  const rows = asked
    .filter(([key]) => c.tests[key])
    .map(([key, question, figure, good, bad]) => {
      const test = c.tests[key];
      return [question, figure(test.statistic, c), chance(test.probability), verdict(test, good(c), bad(c))];
    });
  addSmooth(c, rows);
  const left = c.left_out;
  if (left.groups > 0)
    rows.push([
      'Are the parameters of use? (poses left out)',
      `${number(left.estimated, 3)} against ${number(left.placed, 3)}`,
      '',
      leftOut(left).holds ? leftOut(left).text : h('span', { class: 'refused' }, leftOut(left).text),
    ]);
  if (c.curvature !== null)
    rows.push([
      'Is it linear within one σ? (curvature)',
      number(c.curvature, 2),
      '',
      c.curvature > 0.15 ? h('span', { class: 'refused' }, notLinear(c)) : 'yes: intervals hold',
    ]);
  return rows;
}

/** @param {any} c */
function addSmooth(c, rows) {
  const s = c.smooth_effect;
  if (s.why_not) return;
  const found = s.probability < seldom;
  const text = `${quantity(s.size, 'm', 3)}${s.upper === null ? '' : ` (${quantity(s.lower, 'm', 2)} to ${quantity(s.upper, 'm', 2)})`} over ${quantity(s.length, 'rad', 3)}`;
  rows.push([
    'Does something smooth over the joints remain?',
    text,
    chance(s.probability),
    found
      ? h(
          'span',
          { class: 'refused' },
          c.smooth_effect.counted ? 'yes; σ and intervals include it' : 'yes: plain intervals are too small; let the variant have unmodelled',
        )
      : 'no clear sign of it',
  ]);
}

/** @param {any} e of effects_left_out */
function effectRow(e) {
  const full = h('span', { class: 'fill' });
  full.style.width = `${Math.min(100, 100 * e.share)}%`;
  return [
    e.effect,
    h(
      'span',
      { class: 'ratio' },
      h('span', { class: 'bar', 'aria-hidden': 'true' }, full),
      h('span', { class: 'ratio-value' }, `${number(100 * e.share, 2)} %`),
    ),
    number(e.statistic, 3),
    chance(e.probability),
    chance(e.corrected),
    e.corrected < seldom ? h('strong', {}, 'found') : '',
  ];
}

/** @param {any} c */
function effects(c) {
  const all = c.effects_left_out;
  if (all.length === 0) return null;
  const head = ['effect', 'explains of the squared residuals', '#F', '#p', '#p of the best of so many', ''];
  const rest = all.slice(8);
  return h(
    'div',
    { class: 'effects' },
    h('h3', {}, 'Which effect is missing?'),
    h(
      'p',
      { class: 'note' },
      'Each line is something that this variant does not fit. Of effects that look alike at these poses the table cannot say which is the case: posewright compare tells, and plan --criterion discriminate finds poses that do.',
    ),
    table(head, all.slice(0, 8).map(effectRow), 'Effects that are not fitted'),
    rest.length > 0
      ? h('details', { class: 'printed' }, h('summary', {}, `${rest.length} more`), table(head, rest.map(effectRow), 'More effects'))
      : null,
  );
}

/** @param {any} c calibration.json */
export function testsSection(c) {
  const rows = rowsOf(c);
  if (rows.length === 0) return null;
  return section(
    'tests',
    'Can the result be trusted?',
    'p is the chance of being as far off by accident; below 0.01 a test refuses.',
    table(['question', '#figure', '#p', 'answer'], rows, 'Tests'),
    effects(c),
  );
}
