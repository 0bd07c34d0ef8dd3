import { around, curve, dots, figure, level, logGrid, logValues, namedAxis } from './figure.js';
import { number } from '../text/units.js';

/** σ/tolerance of both plans. @param {[any, any][]} pairs of parameters */
export function sigmaPairsPlot(pairs) {
  if (pairs.length === 0) return null;
  const x = pairs.map((_, k) => k + 1);
  const ratio = (k) => pairs.map((pair) => pair[k].sigma / pair[k].tolerance);
  return figure({
    id: 'plot-two-sigma',
    title: 'σ / tolerance of both plans',
    caption:
      'One pair of dots a parameter, in the order of the table, on a logarithmic scale; at the dashed line measuring tells no more than the tolerance did.',
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
    numbers: () => ({
      header: ['parameter', '#A', '#B'],
      rows: pairs.map(([p, q]) => [p.name, number(p.sigma / p.tolerance), number(q.sigma / q.tolerance)]),
    }),
  }).element;
}

/** What is known after each pose in the order of both plans. @param {import('../types.js').Report[]} reports */
export function growingPlot(reports) {
  const [of, title, axis] = reports.some((r) => r.prefix.some((p) => p?.rho0))
    ? [(p) => (p.rho0 === null ? null : 1e3 * p.rho0), 'position error', 'position error, mm']
    : [(p) => p.largest_sigma_ratio, 'largest σ / tolerance', 'largest σ / tolerance'];
  const most = Math.max(...reports.map((r) => r.prefix.length));
  const known = (r, k) => (r.prefix[k] ? of(r.prefix[k]) : null);
  const x = Array.from({ length: most }, (_, k) => k + 1).filter((n) => reports.some((r) => known(r, n - 1) !== null));
  if (x.length < 2) return null;
  const lines = reports.map((r) => x.map((n) => known(r, n - 1)));
  return figure({
    id: 'plot-growing',
    title: `Number of poses and ${title}`,
    caption:
      'What is known after so many poses in the order of each plan, on a logarithmic scale; a line begins where all parameters can be identified.',
    options: {
      series: [{ label: 'poses' }, curve('A', 'plan', true), curve('B', 'accent', true)],
      scales: { x: { time: false, range: around }, y: { distr: 3 } },
      axes: [
        { label: 'poses measured', incrs: [1, 2, 5, 10, 20, 50, 100] },
        { label: axis, size: 66, values: logValues, grid: logGrid },
      ],
    },
    data: [x, ...lines],
    numbers: () => ({ header: ['#poses', '#A', '#B'], rows: x.map((n, k) => [n, number(lines[0][k]), number(lines[1][k])]) }),
  }).element;
}
