import { h } from '../dom.js';
import { quantity } from '../text/units.js';

/** Names of stations, the number of the pose beside the tip, the distance where bodies are nearest. */
export function placeLabels(labels, picture, list, gap, legend, project) {
  const wanted = picture.report.stations.map((s) => ({
    text: s.instrument ? `${s.instrument}, station ${s.name}` : `station ${s.name}`,
    at: s.placement.slice(0, 3),
    name: '',
  }));
  const tip = picture.tips.find((t) => t.id === list.current);
  if (tip) wanted.push({ text: `pose ${tip.id}`, at: tip.position, name: 'current' });
  if (gap) wanted.push({ text: quantity(gap.distance, 'm', 3), at: gap.points[0].map((v, k) => (v + gap.points[1][k]) / 2), name: 'gap' });
  labels.replaceChildren(
    ...wanted.map(({ text, at, name }) => {
      const place = project(at);
      const label = h('span', { class: `label ${name}` }, text);
      // Near the right edge a label stands on the left of its place.
      const back = place && place[0] > 0.8 * labels.clientWidth ? ' translateX(calc(-100% - 18px))' : '';
      if (place) label.style.transform = `translate(${place[0].toFixed(0)}px, ${place[1].toFixed(0)}px)${back}`;
      else label.hidden = true;
      return label;
    }),
    h('span', { class: 'legend' }, legend),
  );
}
