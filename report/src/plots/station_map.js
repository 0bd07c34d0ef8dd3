import { h, svg } from '../dom.js';
import { inkOn } from '../parts/shares.js';
import { convexHull } from '../numerics/outline.js';
import { viridisAt } from '../theme.js';
import { endsOf, placesOf, shareOf, valuesOf } from '../numerics/stations.js';
import { number } from '../text/units.js';

/** Map of places, obstacles and base seen from above. */
class Frame {
  /** @param {[number, number][]} points that must be seen @param {number} width px */
  constructor(points, width) {
    const side = (axis) => [Math.min(...points.map((p) => p[axis])), Math.max(...points.map((p) => p[axis]))];
    const [[left, right], [low, high]] = [side(0), side(1)];
    const room = 0.12 * Math.max(right - left, high - low, 0.5);
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

/** @param {Frame} frame */
function gridOf(frame) {
  const { step } = frame;
  const lines = [];
  const ticks = (axis) => {
    const first = Math.ceil(frame.least[axis] / step - 1e-9);
    const count = Math.floor(frame.most[axis] / step + 1e-9) - first;
    return Array.from({ length: count + 1 }, (_, k) => (first + k) * step);
  };
  const [right, bottom] = [frame.x(frame.most[0]), frame.y(frame.least[1])];
  for (const v of ticks(0)) {
    lines.push(svg('line', { class: 'grid', x1: frame.x(v), x2: frame.x(v), y1: 8, y2: bottom }));
    lines.push(svg('text', { class: 'soft', x: frame.x(v), y: bottom + 15, 'text-anchor': 'middle' }, number(1e3 * v)));
  }
  for (const v of ticks(1)) {
    lines.push(svg('line', { class: 'grid', x1: frame.edge, x2: right, y1: frame.y(v), y2: frame.y(v) }));
    lines.push(svg('text', { class: 'soft', x: frame.edge - 5, y: frame.y(v) + 4, 'text-anchor': 'end' }, number(1e3 * v)));
  }
  lines.push(svg('text', { class: 'soft', x: right - 2, y: bottom + 29, 'text-anchor': 'end' }, 'x, y in mm'));
  return lines;
}

/** @param {Frame} frame @param {any} place @param {any} s @param {Value} value */
function mark(frame, place, s, value) {
  const [x, y] = [frame.x(place.position[0]), frame.y(place.position[1])];
  const share = place.rank.why_not ? null : shareOf(s.ranking, place.rank, value);
  const rgb = share === null ? null : viridisAt(share);
  const best = s.ranking[0].stations[place.name] !== undefined;
  const circle = svg('circle', {
    class: `place${best ? ' best' : ''}${rgb ? '' : ' none'}`,
    'data-name': place.name,
    'data-share': share,
    cx: x,
    cy: y,
    r: place.rank.in_full ? 15 : 11,
  });
  if (rgb) circle.style.fill = `rgb(${rgb.map(Math.round).join(' ')})`;
  const text = svg('text', { x, y: y + 4, 'text-anchor': 'middle' }, place.rank.why_not ? '–' : String(place.place));
  if (rgb) text.style.fill = inkOn(rgb);
  circle.append(svg('title', {}, `${place.name}: ${place.rank.why_not || value.shown(value.of(place.rank))}`));
  return [circle, text, svg('text', { class: 'soft', x, y: y - 19, 'text-anchor': 'middle' }, place.name)];
}

/** @param {any} s stations.json */
export function stationMap(s) {
  const places = placesOf(s);
  const bodies = s.obstacles
    .map((o) => ({ name: o.name, hull: convexHull(o.points.map((p) => [p[0], p[1]])) }))
    .filter(({ hull }) => hull.length > 2);
  const points = [...places.map((p) => p.position), ...(s.base ? [s.base] : []), ...bodies.flatMap((b) => b.hull)].map((p) => [p[0], p[1]]);
  const values = valuesOf(s);
  const select = h(
    'select',
    { 'aria-label': 'Coloured by', onchange: () => draw() },
    values.map((v, k) => h('option', { value: k }, v.name)),
  );
  const holder = h('div', { class: 'map-holder' });
  const ramp = h('span', { class: 'ramp' });
  const draw = () => {
    const ends = endsOf(s.ranking, values[Number(select.value)]);
    if (ends)
      ramp.replaceChildren(
        `${values[Number(select.value)].shown(ends[0])} `,
        h('span', { class: 'ramp-bar' }),
        ` ${values[Number(select.value)].shown(ends[1])}`,
      );
    const width = Math.min(900, holder.clientWidth);
    if (width < 60) return;
    const frame = new Frame(points, width);
    const middle = (hull) => [0, 1].map((axis) => hull.reduce((sum, p) => sum + p[axis], 0) / hull.length);
    const outline = (hull) => hull.map(([x, y]) => `${frame.x(x)},${frame.y(y)}`).join(' ');
    const best = Object.keys(s.ranking[0].stations).map((name) => places.find((p) => p.name === name).position);
    holder.replaceChildren(
      svg(
        'svg',
        {
          class: 'map',
          viewBox: `0 0 ${frame.width} ${frame.height}`,
          width: frame.width,
          height: frame.height,
          role: 'img',
          'aria-label': `Places from above, coloured by ${values[Number(select.value)].name}`,
        },
        gridOf(frame),
        bodies.flatMap(({ name, hull }) => [
          svg('polygon', { class: 'obstacle', points: outline(hull) }),
          svg('text', { x: frame.x(middle(hull)[0]), y: frame.y(middle(hull)[1]) + 4, 'text-anchor': 'middle' }, name),
        ]),
        best.length > 1 ? svg('polyline', { class: 'link', fill: 'none', points: outline(best.map((p) => [p[0], p[1]])) }) : null,
        s.base ? baseMark(frame, s.base) : null,
        places.flatMap((place) => mark(frame, place, s, values[Number(select.value)])),
      ),
    );
  };
  new ResizeObserver(draw).observe(holder);
  return h(
    'figure',
    { id: 'plot-map', class: 'figure' },
    h('p', { class: 'choice' }, 'Coloured by ', select, ' ', ramp),
    holder,
    h('figcaption', {}, captionOf(s)),
  );
}

/** @param {Frame} frame @param {number[]} base */
function baseMark(frame, [x, y]) {
  const [u, v] = [frame.x(x), frame.y(y)];
  return svg(
    'g',
    {},
    svg('rect', { class: 'base', x: u - 9, y: v - 9, width: 18, height: 18 }),
    svg('text', { x: u, y: v + 25, 'text-anchor': 'middle' }, 'robot'),
  );
}

/** @param {any} s */
function captionOf(s) {
  const hidden = s.obstacles.filter((o) => o.points.length === 0).map((o) => o.name);
  const full = s.ranking.some((r) => r.in_full) && s.ranking.some((r) => !r.why_not && !r.in_full);
  return (
    'From above; the number is the rank, the thick edge the best choice. ' +
    (full ? 'Large dots were planned in full, small ones quickly; σ is against the best place that was planned alike. ' : '') +
    (hidden.length > 0 ? `Not drawn: ${hidden.join(', ')}.` : '')
  );
}
