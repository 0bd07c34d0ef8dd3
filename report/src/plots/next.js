import { around, curve, dots, figure, level, logGrid, logValues } from './figure.js';
import { number, quantity } from '../text/units.js';

const mm = (value) => (value === null || value === undefined ? null : 1e3 * value);

/** Dashed: not measured yet. @param {string} label @param {string} tint */
const ahead = (label, tint) => ({ ...curve(label, tint, true), dash: [5, 4] });

/** The curve up to now, and what the next poses are to bring. @param {any} n next.json */
export function nextPlot(n) {
  const more = [...n.ahead, ...(n.with_three_more && !n.ahead.some((p) => p.poses >= n.with_three_more.poses) ? [n.with_three_more] : [])];
  const now = n.curve.at(-1);
  const known = [...n.curve, ...more].filter((p) => p.expected !== null);
  if (known.length === 0) return null;
  const first = Math.min(...known.map((p) => p.poses));
  const x = [...new Set([...n.curve, ...more].map((p) => p.poses))].filter((p) => p >= first).sort((a, b) => a - b);
  const at = (points, key) => {
    const values = new Map(points.map((p) => [p.poses, mm(p[key])]));
    return x.map((poses) => values.get(poses) ?? null);
  };
  const coming = now ? [now, ...more] : more;
  const said = (n.history ?? []).filter((p) => p.poses >= first);
  const series = [
    [curve('expected, mm', 'plan', true), at(n.curve, 'expected')],
    [dots(`${100 * n.confidence} % bound at the time, mm`, 'ink-soft', 8), at([...said, ...(now ? [now] : [])], 'upper')],
    [ahead('with the next, mm', 'accent'), at(coming, 'expected')],
    ...(said.length > 1 ? [[dots('said at the time, mm', 'yours', 8), at(said, 'expected')]] : []),
    ...(n.required === null ? [] : [[level('required, mm', 'good'), x.map(() => mm(n.required))]]),
  ];
  return figure({
    id: 'plot-next',
    title: 'Predicted error over the number of poses',
    caption:
      `Root mean square of the position error at ${n.places.count} ${n.places.test_poses ? 'test poses' : 'poses throughout the workspace'}, from the poses measured in their order and, dashed, with those to come` +
      (n.required === null ? '.' : `; enough is measured if the bound is at or below ${quantity(n.required, 'm', 3)}.`) +
      ' The bound covers chance and any missing effect that the readings leave possible.',
    options: {
      series: [{ label: 'poses' }, ...series.map(([s]) => s)],
      scales: { x: { time: false, range: around }, y: { distr: 3 } },
      axes: [
        { label: 'poses measured', incrs: [1, 2, 5, 10, 20, 50, 100] },
        { label: 'error, mm', size: 66, values: logValues, grid: logGrid },
      ],
    },
    data: [x, ...series.map(([, values]) => values)],
    numbers: () => ({
      header: ['#poses', ...series.map(([s]) => `#${s.label}`)],
      rows: x.map((poses, k) => [poses, ...series.map(([, values]) => number(values[k]))]),
    }),
  }).element;
}
