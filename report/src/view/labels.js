import { h } from '../dom.js';

/** Names of stations, and the number of the pose beside the tip. */
export function placeLabels(labels, picture, list, legend, project) {
  const wanted = picture.report.stations.map((s) => ({
    text: `station ${s.name}`,
    at: s.placement.slice(0, 3),
    name: '',
  }));
  const tip = picture.tips.find((t) => t.id === list.current);
  if (tip) wanted.push({ text: `pose ${tip.id}`, at: tip.position, name: 'current' });
  labels.replaceChildren(
    ...wanted.map(({ text, at, name }) => {
      const place = project(at);
      const label = h('span', { class: `label ${name}` }, text);
      if (place) label.style.transform = `translate(${place[0].toFixed(0)}px, ${place[1].toFixed(0)}px)`;
      else label.hidden = true;
      return label;
    }),
    h('span', { class: 'legend' }, legend),
  );
}
