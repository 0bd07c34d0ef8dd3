import { h, svg, table } from '../dom.js';
import { amplification, amplified, deviation } from '../numerics/leg_points.js';
import { number } from '../text/units.js';
import { Plane, mapOf } from './plane.js';

/** @typedef {{name: string, points: import('../numerics/leg_points.js').LegPoint[]}} Model */

/** Bodies by the last letter of their points' names. */
const bodies = { a: 'Points a on the base', b: 'Points b on the platform' };

/** Shapes of the models' marks in turn, 5 px around their middle. */
const shapes = ['M-5 0a5 5 0 1 0 10 0a5 5 0 1 0 -10 0', 'M-4.5 -4.5l9 9m0 -9l-9 9', 'M0 -6l5.5 9.5h-11z', 'M-4.5 -4.5h9v9h-9z'];

/** @param {number} model @param {number} x @param {number} y */
const markOf = (model, x, y, data = {}) =>
  svg('path', {
    class: `mark mark-${model % shapes.length}`,
    d: shapes[model % shapes.length],
    transform: `translate(${x} ${y})`,
    ...data,
  });

/** @param {Plane} plane @param {number} model @param {import('../numerics/leg_points.js').LegPoint} p @param {number} times */
function deviationOf(plane, model, p, times) {
  const [x, y] = amplified(p, times);
  const line = { x1: plane.x(p.nominal[0]), y1: plane.y(p.nominal[1]), x2: plane.x(x), y2: plane.y(y) };
  return [
    svg('line', { class: 'deviation', ...line }),
    markOf(model, plane.x(x), plane.y(y), { 'data-point': p.name, 'data-model': model }),
  ];
}

/** @param {Model[]} models with the points of one body @param {string} title @param {number} times */
function bodyPicture(models, title, times) {
  const nominal = models[0].points;
  const places = models.flatMap(({ points }) => points.flatMap((p) => [p.nominal, amplified(p, times)])).map(([x, y]) => [x, y]);
  const plane = new Plane(places, 520, 0);
  const legOf = (p) => p.name.match(/\d+/)[0];
  return h(
    'div',
    {},
    h('h4', {}, title),
    mapOf(
      plane,
      `${title}: nominal, and by ${models.map((m) => m.name).join(', ')}, deviations ${number(times)} times as large`,
      models.flatMap(({ points }, k) => points.flatMap((p) => deviationOf(plane, k, p, times))),
      nominal.flatMap((p) => [
        svg('circle', { class: 'nominal-point', 'data-point': p.name, cx: plane.x(p.nominal[0]), cy: plane.y(p.nominal[1]), r: 3 }),
        svg('text', { class: 'soft', x: plane.x(p.nominal[0]) + 7, y: plane.y(p.nominal[1]) - 7 }, legOf(p)),
      ]),
    ),
  );
}

/** @param {Model[]} models */
function numbersOf(models) {
  const mm = (values) => values.map((v) => number(v === null ? null : 1e3 * v));
  const rows = models.flatMap(({ name, points }) =>
    points.map((p) => [name, p.name, ...mm(p.nominal), ...mm(deviation(p)), ...mm(p.sigma)]),
  );
  const head = ['model', 'point', '#x, mm', '#y', '#z', '#Δx', '#Δy', '#Δz', '#σ of x', '#σ of y', '#σ of z'];
  return h('details', { class: 'numbers' }, h('summary', {}, 'Numbers'), table(head, rows, 'Points of the legs'));
}

/** Points of the legs by each model, their deviations from nominal amplified. @param {Model[]} models */
export function legPointsPlot(models) {
  const times = amplification(models.flatMap((m) => m.points));
  const of = (body) => models.map(({ name, points }) => ({ name, points: points.filter((p) => p.name.endsWith(body)) }));
  const shown = Object.entries(bodies).filter(([body]) => of(body)[0].points.length > 0);
  return h(
    'figure',
    { id: 'plot-leg-points', class: 'figure' },
    h(
      'p',
      { class: 'legend-line' },
      models.map((m, k) =>
        h('span', {}, svg('svg', { viewBox: '-8 -8 16 16', width: 16, height: 16, 'aria-hidden': 'true' }, markOf(k, 0, 0)), ` ${m.name}`),
      ),
    ),
    h(
      'div',
      { class: 'plots' },
      shown.map(([body, title]) => bodyPicture(of(body), title, times)),
    ),
    h(
      'figcaption',
      {},
      `Seen along z. Dots: nominal points, with the number of their leg. Marks: deviations from them ${number(times)} times as large.`,
    ),
    numbersOf(models),
  );
}
