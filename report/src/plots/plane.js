import { svg } from '../dom.js';
import { number } from '../text/units.js';

/** A plane seen from above: x to the right, y upwards, one scale for both. */
export class Plane {
  /** @param {[number, number][]} points that must be seen @param {number} width px @param {number} least m that it shows */
  constructor(points, width, least) {
    const side = (axis) => [Math.min(...points.map((p) => p[axis])), Math.max(...points.map((p) => p[axis]))];
    const [[left, right], [low, high]] = [side(0), side(1)];
    const room = 0.12 * Math.max(right - left, high - low, least);
    this.least = [left - room, low - room];
    this.most = [right + room, high + room];
    this.edge = 40;
    this.scale = (width - this.edge - 8) / (this.most[0] - this.least[0]);
    // A narrow strip of places must not become a tower.
    const tallest = 460;
    this.scale = Math.min(this.scale, tallest / (this.most[1] - this.least[1]));
    this.width = this.edge + this.scale * (this.most[0] - this.least[0]) + 8;
    this.height = this.scale * (this.most[1] - this.least[1]) + 44;
  }

  x(value) {
    return this.edge + this.scale * (value - this.least[0]);
  }

  y(value) {
    return 8 + this.scale * (this.most[1] - value);
  }

  /** Round lengths for the grid, m. */
  get step() {
    const wanted = 80 / this.scale;
    const decade = 10 ** Math.floor(Math.log10(wanted));
    return [1, 2, 5, 10].map((d) => d * decade).find((d) => d >= wanted) ?? decade * 10;
  }
}

/** The picture of a plane over its grid. @param {Plane} plane @param {string} label of what it shows @param {any[]} drawn on it */
export function mapOf(plane, label, ...drawn) {
  return svg(
    'svg',
    {
      class: 'map',
      viewBox: `0 0 ${plane.width} ${plane.height}`,
      width: plane.width,
      height: plane.height,
      role: 'img',
      'aria-label': label,
    },
    gridOf(plane),
    ...drawn,
  );
}

/** @param {Plane} plane */
function gridOf(plane) {
  const { step } = plane;
  const lines = [];
  const ticks = (axis) => {
    const first = Math.ceil(plane.least[axis] / step - 1e-9);
    const count = Math.floor(plane.most[axis] / step + 1e-9) - first;
    return Array.from({ length: count + 1 }, (_, k) => (first + k) * step);
  };
  const [right, bottom] = [plane.x(plane.most[0]), plane.y(plane.least[1])];
  for (const v of ticks(0)) {
    lines.push(svg('line', { class: 'grid', x1: plane.x(v), x2: plane.x(v), y1: 8, y2: bottom }));
    lines.push(svg('text', { class: 'soft', x: plane.x(v), y: bottom + 15, 'text-anchor': 'middle' }, number(1e3 * v)));
  }
  for (const v of ticks(1)) {
    lines.push(svg('line', { class: 'grid', x1: plane.edge, x2: right, y1: plane.y(v), y2: plane.y(v) }));
    lines.push(svg('text', { class: 'soft', x: plane.edge - 5, y: plane.y(v) + 4, 'text-anchor': 'end' }, number(1e3 * v)));
  }
  lines.push(svg('text', { class: 'soft', x: right - 2, y: bottom + 29, 'text-anchor': 'end' }, 'x, y in mm'));
  return lines;
}
