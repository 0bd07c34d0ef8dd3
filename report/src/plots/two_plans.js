import { around, dots, figure, level, logGrid, logValues, namedAxis } from './figure.js';
import { number } from '../text/units.js';

/** σ/tolerance of both plans. @param {[any, any][]} pairs of parameters */
export function sigmaPairsPlot(pairs) {
  if (pairs.length === 0) return null;
  const x = pairs.map((_, k) => k + 1);
  const ratio = (k) => pairs.map((pair) => pair[k].sigma / pair[k].tolerance);
  return figure({
    id: 'plot-two-sigma',
    title: 'σ / tolerance of both plans',
    caption: 'One pair of dots a parameter, in the order of the table, on a logarithmic scale; at the dashed line measuring tells no more than the tolerance did.',
    options: {
      series: [
        { label: 'parameter', value: (u, v) => (v === null ? '' : (pairs[v - 1]?.[0].name ?? '')) },
        dots('A', 'plan', 8),
        dots('B', 'accent', 8),
        level('tolerance', 'ink-soft'),
      ],
      scales: { x: { time: false, range: around }, y: { distr: 3 } },
      axes: [namedAxis(x, 'parameter'), { label: 'σ / tolerance', size: 66, values: logValues, grid: logGrid }],
    },
    data: [x, ratio(0), ratio(1), x.map(() => 1)],
    numbers: () => ({ header: ['parameter', '#A', '#B'], rows: pairs.map(([p, q]) => [p.name, number(p.sigma / p.tolerance), number(q.sigma / q.tolerance)]) }),
  }).element;
}
