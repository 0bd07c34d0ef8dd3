import { h } from '../dom.js';

/** @param {any} view @param {import('./picture.js').Picture} picture */
export function lookButtons(view, picture) {
  const looks = [['All', 'free', 'extent'], ['Poses', 'free', 'tipExtent'], ['Top', 'top', 'extent'], ['Front', 'front', 'extent'],
    ['Side', 'side', 'extent']];
  return h('div', { class: 'buttons', role: 'group', 'aria-label': 'Look at' },
    looks.map(([title, from, what]) => h('button', { class: 'small', onclick: () => view.look(from, picture[what]) }, title)));
}

/**
 * What is drawn besides the robot's skeleton.
 * @param {import('../types.js').Report} report @param {any} layers @param {() => void} show
 */
export function layerBoxes(report, layers, show) {
  const offers = [];
  if (report.bodies.length > 0) offers.push(['bodies', 'Bodies']);
  if (report.stations.length > 0) offers.push(['sights', 'Lines of sight']);
  if (report.candidates?.positions.length > 0) offers.push(['candidates', 'Candidates']);
  const scale = h('span', { class: 'ramp', hidden: true },
    h('span', { class: 'ramp-bar' }), ' colour: how much a measurement there would tell, from little (dark) to most (bright)');
  return h('div', { class: 'layers' }, offers.map(([key, title]) => {
    const box = h('input', { type: 'checkbox', checked: layers[key], onchange: () => {
      layers[key] = box.checked;
      scale.hidden = !layers.candidates;
      show();
    } });
    return h('label', {}, box, ` ${title}`);
  }), scale);
}
