import { h, section, svg } from '../dom.js';
import { number, quantity, shownUnit } from '../text/units.js';
import { calibratedFrames } from './calibrated_frames.js';

/** Where the interval lies from nominal, in tolerances; a mark at the edge says that it goes on beyond. */
const reach = 3;

/** @param {any} p of parameters */
function picture(p) {
  if (!p.estimated || p.sigma === null || !(p.tolerance > 0)) return '';
  const at = (value) => 60 + (60 * (value - p.nominal)) / p.tolerance / reach;
  const inside = (x) => Math.min(118, Math.max(2, x));
  const [lower, upper] = p.interval
    ? [p.interval[0] ?? -Infinity, p.interval[1] ?? Infinity]
    : [p.value - 1.96 * p.sigma, p.value + 1.96 * p.sigma];
  const value = at(p.value);
  const beyond = value < 2 || value > 118;
  return svg(
    'svg',
    { class: 'interval', viewBox: '0 0 120 16', width: 120, height: 16, 'aria-hidden': 'true' },
    svg('rect', { class: 'tolerance-band', x: 60 - 60 / reach, y: 1, width: 120 / reach, height: 14 }),
    svg('line', { class: 'zero', x1: 60, y1: 0, x2: 60, y2: 16 }),
    svg('line', { class: 'span', x1: inside(at(lower)), y1: 8, x2: inside(Math.max(at(upper), at(lower) + 1)), y2: 8 }),
    beyond
      ? svg('path', { class: 'value', d: value < 2 ? 'M8 3 L1 8 L8 13 Z' : 'M112 3 L119 8 L112 13 Z' })
      : svg('circle', { class: 'value', cx: value, cy: 8, r: 3 }),
  );
}

/** Value, σ and interval with as many digits as σ has a meaning. @param {number} value @param {any} p */
function toSigma(value, p) {
  const { factor, name } = shownUnit(p.unit);
  const decimals = p.sigma > 0 ? Math.min(9, Math.max(0, 1 - Math.floor(Math.log10(p.sigma * factor)))) : 4;
  return `${(value * factor).toFixed(decimals).replace('-', '−')}${name ? ` ${name}` : ''}`;
}

/** @param {number | null} end of an interval @param {any} p */
const endOf = (end, p) => (end === null ? 'no end' : toSigma(end, p));

/** What a file's rounding left of zero is zero. @param {number} value SI */
const clean = (value) => (Math.abs(value) < 1e-12 ? 0 : value);

/** @param {any} p */
function line(p) {
  const cells = [
    toSigma(p.value, p),
    quantity(p.value - p.nominal, p.unit, 3),
    p.sigma === null ? '–' : quantity(p.sigma, p.unit, 2),
    p.interval ? `${endOf(p.interval[0], p)} to ${endOf(p.interval[1], p)}` : '–',
  ];
  const notes = [
    p.role === 'nuisance' && 'nuisance',
    p.given.length > 0 && `given ${p.given.join(', ')} at nominal`,
    p.tells_less_than_tolerance && 'told less than its tolerance',
    p.prior === 'stated' && 'tolerance counts',
    p.interval_by === 'profile' &&
      `by profile; linear ${toSigma(p.linear_interval[0], p)} to ${toSigma(p.linear_interval[1], p)}`,
    p.prior === 'assumed' && 'tolerance counts, assumed',
  ].filter(Boolean);
  return h(
    'tr',
    { class: p.role, 'data-name': p.name },
    h('th', { scope: 'row' }, p.name),
    h('td', { class: 'number nominal' }, quantity(clean(p.nominal), p.unit)),
    h('td', { class: 'number' }, cells[0]),
    h('td', { class: 'number' }, cells[1]),
    h('td', { class: 'number nominal' }, cells[2]),
    h('td', { class: 'number interval-text' }, cells[3]),
    h('td', { class: 'nominal' }, picture(p)),
    h('td', { class: 'role' }, notes.join('; ')),
  );
}

/** @param {any} c */
function notEstimated(c) {
  const left = c.parameters.filter((p) => !p.estimated);
  if (left.length === 0) return null;
  return h(
    'details',
    { class: 'printed', open: left.length <= 8 },
    h('summary', {}, `Not estimated: ${left.length}, which stay at their nominal values`),
    h(
      'ul',
      { class: 'equations' },
      left.map((p) => h('li', {}, p.why_not ? `${p.name}: ${p.why_not}` : p.name)),
    ),
  );
}

/** The frame whose angles have no interval of their own. @param {any} o of orientations */
const turned = (o) =>
  h(
    'li',
    {},
    `${o.frame} is turned by ${o.rx_ry_rz.map((v) => quantity(v, 'rad', 6)).join(', ')} (rx, ry, rz), ± ${o.half_width.map((v) => quantity(v, 'rad', 2)).join(', ')} (95 %) about the axes of its parent.`,
  );

/** @param {any} c calibration.json */
export function calibratedParametersSection(c) {
  const head = [
    'Parameter',
    '#Nominal',
    '#Calibrated',
    '#Change',
    '#σ',
    '#95 % interval',
    `Change in tolerances, −${reach} to ${reach}`,
    '',
  ];
  const hidden = new Set([1, 4, 6]);
  const estimated = c.parameters.filter((p) => p.estimated);
  return section(
    'parameters',
    'Parameters',
    `${estimated.length} estimated. The dot is how far a parameter is from nominal, the line its 95 % interval, the band one tolerance to either side; an arrow: further than ${reach} tolerances.`,
    h(
      'div',
      { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': 'Parameters' },
      h(
        'table',
        { class: 'parameters calibrated' },
        h(
          'thead',
          {},
          h(
            'tr',
            {},
            head.map((title, k) =>
              h(
                'th',
                {
                  scope: 'col',
                  class: [title.startsWith('#') && 'number', hidden.has(k) && 'nominal', k === 7 && 'role'].filter(Boolean).join(' '),
                },
                title.replace('#', ''),
              ),
            ),
          ),
        ),
        h('tbody', {}, estimated.map(line)),
      ),
    ),
    notEstimated(c),
    c.orientations.length > 0 ? h('ul', { class: 'sentences' }, c.orientations.map(turned)) : null,
    calibratedFrames(c),
    c.noise_factor > 1
      ? h(
          'p',
          { class: 'note' },
          `σ and intervals use the noise of the residuals, ${number(c.noise_factor, 3)} times the stated one.`,
        )
      : null,
  );
}
