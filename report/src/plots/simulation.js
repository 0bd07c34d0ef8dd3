import { around, dots, figure, level, namedAxis, unlisted } from './figure.js';
import { number, percent } from '../text/units.js';

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
    caption: `One dot a parameter, in the order of the table; 1 is as predicted. Between the dashed lines a difference is no more than chance (three Monte Carlo errors, ± ${number(error, 2)}).`,
    options: {
      series: [named(parameters), dots('observed / predicted', 'plan'), level('chance', 'ink-soft'), unlisted(level('chance', 'ink-soft'))],
      scales: { x: { time: false, range: around }, y: { range: (u, low, high) => [Math.min(low, 1 - error) - 0.02, Math.max(high, 1 + error) + 0.02] } },
      axes: [namedAxis(parameters.map((_, k) => k + 1), 'parameter'), { label: 'σ observed / predicted', size: 58 }],
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
      scales: { x: { time: false, range: around }, y: { range: (u, low, high) => [Math.min(low, 95 - error) - 1, Math.max(high, top) + 1] } },
      axes: [namedAxis(parameters.map((_, k) => k + 1), 'parameter'), { label: 'covered, %', size: 58 }],
    },
    data: [x, covered, x.map(() => 95 - error), x.map(() => top)],
    numbers: () => ({ header: ['parameter', '#covered'], rows: parameters.map((p) => [p.name, percent(p.coverage)]) }),
  }).element;
}
