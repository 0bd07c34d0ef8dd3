import { h, section, table } from '../dom.js';
import { histogram } from '../plots/histogram.js';
import { heldBackPlot, perAxisPlots, perPosePlots } from '../plots/residuals.js';
import { normalCounts } from '../numerics/normal.js';
import { number, quantity } from '../text/units.js';

const titles = { distance: 'distance', angle: 'angle', m: 'each length', rad: 'each angle', px: 'each pixel' };
const units = { distance: 'm', angle: 'rad', m: 'm', rad: 'rad', px: 'px' };

/** @param {any} a of axes */
const axisRow = (a) => [
  a.axis,
  a.poses,
  quantity(a.before.rms, a.unit),
  quantity(a.after.rms, a.unit),
  a.after.rms > 0 ? `${number(a.before.rms / a.after.rms, 2)} ×` : '–',
  quantity(a.before.largest, a.unit),
  quantity(a.after.largest, a.unit),
  String(a.after.largest_at_pose),
];

/** @param {any} c */
function axesTable(c) {
  if (c.axes.length === 0) return null;
  return h(
    'div',
    { class: 'by-axis' },
    h('h3', {}, 'By axis'),
    table(
      ['error', 'poses', '#RMS before', '#after', '#better by', '#largest before', '#after', 'at pose'],
      c.axes.map(axisRow),
      'Errors by axis',
    ),
    h(
      'p',
      { class: 'note' },
      `Along and about the instrument’s axes; distance and angle: all axes together. Before: ${c.before === 'placed' ? 'uncalibrated, with base, tool, targets and nuisance parameters fitted' : 'nominal parameters'}. The instrument’s own noise is in every figure.`,
    ),
  );
}

/** @param {any} c */
function requirementsTable(c) {
  if (!(c.requirements?.length > 0)) return null;
  const rows = c.requirements.map((r) => [
    r.axis,
    r.poses,
    quantity(r.largest, r.unit),
    String(r.largest_at_pose),
    quantity(r.by_noise, r.unit),
    quantity(r.required, r.unit),
    r.met ? 'met' : r.hidden_by_noise ? 'hidden by the instrument’s noise' : 'not met',
  ]);
  return h(
    'div',
    {},
    h('h3', {}, 'Required of the tip'),
    table(['tip', 'poses', '#largest error', 'at pose', '#by noise alone', '#required', ''], rows, 'Requirements'),
    h('p', { class: 'note' }, 'The tip’s pose follows from all targets of a pose. In 95 of 100 runs noise alone makes no larger error than stated.'),
  );
}

/** @param {any} c */
function kindsTable(c) {
  const rows = c.residuals.map((r) => [
    titles[r.kind] ?? r.kind,
    r.poses,
    r.parameters,
    String(r.count),
    quantity(r.rms, units[r.kind] ?? ''),
    quantity(r.largest, units[r.kind] ?? ''),
    String(r.largest_at_pose),
  ]);
  return h(
    'details',
    { class: 'printed' },
    h('summary', {}, 'With nominal, placed and calibrated parameters'),
    table(['residual', 'poses', 'parameters', '#count', '#RMS', '#largest', 'at pose'], rows, 'Residuals by parameters'),
  );
}

/** @param {any} c calibration.json */
export function errorsSection(c) {
  return section(
    'errors',
    'Errors before and after',
    'How far readings were from what the robot model predicts.',
    axesTable(c),
    requirementsTable(c),
    h('div', { class: 'plots' }, [perPosePlots(c), perAxisPlots(c), heldBackPlot(c), residualHistogram(c)].filter(Boolean)),
    kindsTable(c),
  );
}

/** @param {any} c */
function residualHistogram(c) {
  const { from, bin_width: width, counts } = c.histogram;
  const count = counts.reduce((sum, n) => sum + n, 0);
  if (count === 0) return null;
  return histogram({
    id: 'plot-histogram',
    title: 'Residuals in units of their own size',
    caption: `${count} residuals, whitened by the noise that the problem states and divided by their own size, beside what normal noise gives. Bars far out are gross errors; a shape that is not a bell is an effect that the model lacks.`,
    histogram: c.histogram,
    axis: 'residual, σ',
    counted: 'residuals',
    expected: normalCounts(from, width, counts.length, count),
    open: true,
  });
}
