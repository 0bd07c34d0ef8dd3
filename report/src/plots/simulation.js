import { around, dots, figure, level, namedAxis, unlisted } from './figure.js';
import { choice } from './choice.js';
import { histogram } from './histogram.js';
import { normalCounts } from '../numerics/normal.js';
import { number, percent, quantity } from '../text/units.js';

const observed = (s) => s.parameters.filter((p) => p.sigma_observed !== null);

/** Name of the parameter under the pointer. @param {any[]} parameters */
const named = (parameters) => ({ label: 'parameter', value: (u, v) => (v === null ? '' : (parameters[v - 1]?.name ?? '')) });

/** @param {any} s simulation.json */
export function sigmaPlot(s) {
  const parameters = observed(s);
  if (parameters.length === 0) return null;
  const x = parameters.map((_, k) => k + 1);
  const ratio = parameters.map((p) => p.sigma_observed / p.sigma_predicted);
  const error = 3 * s.sigma_error;
  return figure({
    id: 'plot-sigma',
    title: 'σ observed over the draws, beside the predicted one',
    caption: `One dot a parameter, in the order of the table; 1 is as predicted. Between the dashed lines a difference is no more than chance (three Monte Carlo errors, ± ${number(error, 2)}; of 370 right dots one lies outside all the same).`,
    options: {
      series: [named(parameters), dots('observed / predicted', 'plan'), level('chance', 'ink-soft'), unlisted(level('chance', 'ink-soft'))],
      scales: {
        x: { time: false, range: around },
        y: { range: (u, low, high) => [Math.min(low, 1 - error) - 0.02, Math.max(high, 1 + error) + 0.02] },
      },
      axes: [
        namedAxis(
          parameters.map((_, k) => k + 1),
          'parameter',
        ),
        { label: 'σ observed / predicted', size: 58 },
      ],
    },
    data: [x, ratio, x.map(() => 1 - error), x.map(() => 1 + error)],
    numbers: () => ({ header: ['parameter', '#observed / predicted'], rows: parameters.map((p, k) => [p.name, number(ratio[k])]) }),
  }).element;
}

/** @param {any} s simulation.json */
export function coveragePlot(s) {
  const parameters = observed(s);
  if (parameters.length === 0) return null;
  const x = parameters.map((_, k) => k + 1);
  const error = 300 * s.coverage_error;
  const covered = parameters.map((p) => 100 * p.coverage);
  const top = Math.min(100, 95 + error);
  return figure({
    id: 'plot-coverage',
    title: 'How many 95 % intervals hold the truth',
    caption: `One dot a parameter, in the order of the table. 95 % is right; between the dashed lines a difference is no more than chance (three Monte Carlo errors). Below: intervals are too short.`,
    options: {
      series: [named(parameters), dots('covered, %', 'plan'), level('chance', 'ink-soft'), unlisted(level('chance', 'ink-soft'))],
      scales: {
        x: { time: false, range: around },
        y: { range: (u, low, high) => [Math.min(low, 95 - error) - 1, Math.max(high, top) + 1] },
      },
      axes: [
        namedAxis(
          parameters.map((_, k) => k + 1),
          'parameter',
        ),
        { label: 'covered, %', size: 58 },
      ],
    },
    data: [x, covered, x.map(() => 95 - error), x.map(() => top)],
    numbers: () => ({ header: ['parameter', '#covered'], rows: parameters.map((p) => [p.name, percent(p.coverage)]) }),
  }).element;
}

/** @param {any} s */
export function errorHistograms(s) {
  const { from, bin_width: width } = s.histogram;
  const known = s.parameters.filter((p) => p.histogram);
  if (known.length === 0) return null;
  const add = (lists) => lists[0].map((_, k) => lists.reduce((sum, list) => sum + list[k], 0));
  const of = (id, name, counts) => [
    name,
    histogram({
      id: `plot-errors-${id}`,
      headed: false,
      title: `Errors: ${name}`,
      caption:
        'Estimate less truth, in units of the σ that each calibration states for itself; the line is what normal errors give. A narrower bell: σ is stated too large; one beside zero: a bias.',
      histogram: { from, bin_width: width, counts },
      axis: '(estimate − truth) / σ',
      counted: 'draws',
      expected: normalCounts(
        from,
        width,
        counts.length,
        counts.reduce((sum, n) => sum + n, 0),
      ),
      open: true,
    }),
  ];
  return choice('Truth against estimate:', 'Which parameter', [
    of('all', 'all parameters', add(known.map((p) => p.histogram))),
    ...known.map((p, k) => of(String(k), p.name, p.histogram)),
  ]);
}

/** @param {any} accuracy */
export function accuracyHistogram(accuracy) {
  if (!accuracy?.histogram || !(accuracy.histogram.bin_width > 0)) return null;
  const { from, bin_width: width, counts } = accuracy.histogram;
  return histogram({
    id: 'plot-distances',
    title: 'Position error of the calibrated robots',
    caption: `Draws by the root mean square of their error at the ${accuracy.places} ${accuracy.of === 'test_poses' ? 'test poses' : 'random places'}. Upright lines: ${quantity(accuracy.predicted, 'm', 3)} predicted, ${quantity(accuracy.observed, 'm', 3)} observed over all draws (root mean square); the worst place of all was ${quantity(accuracy.largest, 'm', 3)} off.`,
    histogram: { from: 1e3 * from, bin_width: 1e3 * width, counts },
    axis: 'error, mm',
    counted: 'draws',
    marks: [
      { value: 1e3 * accuracy.observed, label: 'observed', tint: 'plan' },
      { value: 1e3 * accuracy.predicted, label: 'predicted', tint: 'accent' },
    ],
  });
}
