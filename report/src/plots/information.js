import { around, bars, curve, dots, figure, level, logGrid, logValues } from './figure.js';
import { number, percent } from '../text/units.js';

const wholeNumbers = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000, 100000];

/** Singular values in units of tolerance. @param {import('../types.js').Report} report */
export function spectrumPlot(report) {
  const values = report.singular_values;
  if (values.length === 0) return null;
  const x = values.map((_, k) => k + 1);
  return figure({
    id: 'plot-spectrum',
    title: 'How well combinations of parameters are measured',
    caption:
      'Each dot is one independent combination of parameters: at 100 its σ is a hundredth of the tolerance; below the dashed line at 1 measuring tells less than the tolerance did.',
    options: {
      series: [{ label: 'combination' }, dots('tolerance / σ', 'plan'), level('as good as the tolerance', 'ink-soft')],
      scales: { x: { time: false, range: around }, y: { distr: 3 } },
      axes: [
        { label: 'combination, best known first', incrs: wholeNumbers },
        { label: 'tolerance / σ (singular value)', size: 66, values: logValues, grid: logGrid },
      ],
    },
    data: [x, values.map((v) => (v > 0 ? v : null)), x.map(() => 1)],
    numbers: () => ({ header: ['#combination', '#tolerance / σ'], rows: values.map((v, k) => [k + 1, number(v)]) }),
  }).element;
}

/** Sensitivities in order, the level from which a candidate is worth measuring, and what was chosen. @param {import('../types.js').Report} report */
export function sensitivityPlot(report) {
  if (!report.candidates) return null;
  const { sensitivity, bound, chosen } = report.candidates;
  const order = sensitivity.map((_, k) => k).sort((a, b) => sensitivity[b] - sensitivity[a]);
  const taken = new Set(chosen);
  const x = order.map((_, k) => k + 1);
  return figure({
    id: 'plot-sensitivity',
    title: 'What every candidate would add',
    caption:
      'Candidates drawn for this page and the poses of the plan, most telling first, judged at the weights that would be best if poses could be measured in fractions: above the dashed line a candidate is worth measuring in full, on it in part, below it not at all. Orange dots are in the plan.',
    options: {
      series: [
        { label: 'candidate, in order' },
        curve('sensitivity', 'plan'),
        { ...dots('chosen', 'accent', 6) },
        level('worth measuring', 'ink-soft'),
      ],
      scales: { x: { time: false }, y: { range: (u, low, high) => [0, 1.08 * Math.max(high, bound)] } },
      axes: [
        { label: 'candidates, most telling first', incrs: wholeNumbers },
        { label: 'sensitivity / what is worth it', size: 56 },
      ],
    },
    data: [
      x,
      order.map((k) => sensitivity[k]),
      order.map((k) => (taken.has(k) ? sensitivity[k] : null)),
      x.map(() => bound),
    ],
    numbers: () => ({
      header: ['#place', '#candidate', '#sensitivity', 'chosen'],
      rows: order.map((k, n) => [n + 1, k, number(sensitivity[k]), taken.has(k) ? 'yes' : '']),
    }),
  }).element;
}

/** Share of each pose and what its loss costs. @param {import('../types.js').Report} report */
export function contributionPlot(report) {
  const poses = report.plan.poses;
  const ids = poses.map((p) => p.id);
  const x = ids.map((_, k) => k + 1);
  const cost = poses.map((p) => (p.efficiency_without === undefined ? null : 100 * (1 - p.efficiency_without)));
  return figure({
    id: 'plot-contribution',
    title: 'What each pose contributes and what its loss costs',
    caption:
      'Bars: share of all information that a pose brings. Dots: how much efficiency the plan loses if that pose alone cannot be measured; 100 % means that it is indispensable.',
    options: {
      series: [
        { label: 'pose', value: (u, v) => (v === null ? '' : String(ids[Math.round(v) - 1] ?? '')) },
        bars('contribution, %', 'bar'),
        dots('loss without it, %', 'accent'),
      ],
      scales: { x: { time: false, range: around }, y: { range: (u, low, high) => [0, 1.1 * high] } },
      axes: [
        { label: 'pose', incrs: wholeNumbers, values: (u, splits) => splits.map((v) => String(ids[v - 1] ?? '')) },
        { label: '%', size: 50 },
      ],
    },
    data: [x, poses.map((p) => 100 * p.contribution), cost],
    numbers: () => ({
      header: ['pose', '#contribution', '#left without it'],
      rows: poses.map((p) => [p.id, percent(p.contribution, 2), percent(p.efficiency_without ?? null, 2)]),
    }),
  }).element;
}
