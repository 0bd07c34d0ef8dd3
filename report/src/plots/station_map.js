import { h, svg } from '../dom.js';
import { inkOn } from '../parts/shares.js';
import { convexHull } from '../numerics/outline.js';
import { viridisAt } from '../theme.js';
import { endsOf, placesOf, shareOf, valuesOf } from '../numerics/stations.js';
import { Plane, mapOf } from './plane.js';

/** @param {Plane} plane @param {any} place @param {any} s @param {Value} value */
function mark(plane, place, s, value) {
  const [x, y] = [plane.x(place.position[0]), plane.y(place.position[1])];
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
    const plane = new Plane(points, width, 0.5);
    const middle = (hull) => [0, 1].map((axis) => hull.reduce((sum, p) => sum + p[axis], 0) / hull.length);
    const outline = (hull) => hull.map(([x, y]) => `${plane.x(x)},${plane.y(y)}`).join(' ');
    const best = Object.keys(s.ranking[0].stations).map((name) => places.find((p) => p.name === name).position);
    holder.replaceChildren(
      mapOf(
        plane,
        `Places from above, coloured by ${values[Number(select.value)].name}`,
        bodies.flatMap(({ name, hull }) => [
          svg('polygon', { class: 'obstacle', points: outline(hull) }),
          svg('text', { x: plane.x(middle(hull)[0]), y: plane.y(middle(hull)[1]) + 4, 'text-anchor': 'middle' }, name),
        ]),
        best.length > 1 ? svg('polyline', { class: 'link', fill: 'none', points: outline(best.map((p) => [p[0], p[1]])) }) : null,
        s.base ? baseMark(plane, s.base) : null,
        places.flatMap((place) => mark(plane, place, s, values[Number(select.value)])),
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

/** @param {Plane} plane @param {number[]} base */
function baseMark(plane, [x, y]) {
  const [u, v] = [plane.x(x), plane.y(y)];
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
