import { h } from '../dom.js';
import { number } from '../text/units.js';

/** @param {any} view @param {import('./picture.js').Picture} picture */
export function lookButtons(view, picture) {
  const looks = [
    ['All', 'free', 'extent'],
    ['Poses', 'free', 'tipExtent'],
    ['Top', 'top', 'extent'],
    ['Front', 'front', 'extent'],
    ['Side', 'side', 'extent'],
  ];
  return h(
    'div',
    { class: 'buttons', role: 'group', 'aria-label': 'Look at' },
    looks.map(([title, from, what]) =>
      h('button', { class: 'small', onclick: () => view.look(from, picture[what]) }, title),
    ),
  );
}

/**
 * What is drawn besides the robot's skeleton.
 * @param {import('../types.js').Report} report @param {any} layers @param {() => void} show
 */
export function layerBoxes(report, layers, show) {
  const offers = [];
  if (report.bodies.length > 0) offers.push(['bodies', 'Bodies']);
  if (report.stations.length > 0) offers.push(['sights', 'Lines of sight']);
  else if (report.cameras.length > 0) offers.push(['sights', 'Field of view']);
  if (report.candidates?.positions.length > 0) offers.push(['candidates', 'Candidates']);
  const [least, most] = [Math.min, Math.max].map((end) => number((report.candidates?.sensitivity ?? [0]).reduce((a, b) => end(a, b)), 3));
  const scale = h(
    'span',
    { class: 'ramp', hidden: true },
    h('span', { class: 'ramp-bar' }),
    ` colour: how much a measurement there would add, from ${least} (dark) to ${most} (bright); 1 is worth it in full`,
  );
  return h(
    'div',
    { class: 'layers' },
    offers.map(([key, title]) => {
      const box = h('input', {
        type: 'checkbox',
        checked: layers[key],
        onchange: () => {
          layers[key] = box.checked;
          scale.hidden = !layers.candidates;
          show();
        },
      });
      return h('label', {}, box, ` ${title}`);
    }),
    scale,
  );
}

/** Moves so small that one would see nothing are drawn larger; the reader can turn that off. */
export function enlarger(picture, show) {
  const set = (on) => {
    picture.enlarge(on ? picture.possibleFactor : 1);
    show();
  };
  set(true);
  const box = h('input', { type: 'checkbox', checked: true, onchange: () => set(box.checked) });
  return h(
    'label',
    { class: 'note enlarge' },
    box,
    ` The robot moves so little that movements are drawn ${number(picture.possibleFactor)} times larger (untick for true size; all numbers are true).`,
  );
}

/** Back, play, next and the slider. @param {import('./player.js').Player} player */
export function playerControls(player) {
  const slider = h('input', {
    type: 'range',
    min: 0,
    step: 1,
    'aria-label': 'Place in the measuring order',
    oninput: () => player.go(Number(slider.value)),
  });
  const play = h('button', { class: 'play', onclick: () => player.toggle() });
  const element = h(
    'div',
    { class: 'player' },
    h('button', { onclick: () => player.step(-1), 'aria-label': 'Previous pose' }, '‹ Back'),
    play,
    h('button', { onclick: () => player.step(1), 'aria-label': 'Next pose' }, 'Next ›'),
    slider,
  );
  const update = (text) => {
    slider.max = String(player.last);
    slider.value = String(Math.floor(player.place));
    slider.setAttribute('aria-valuetext', text);
    play.textContent = player.playing ? '❚❚ Pause' : '▶ Play';
    play.setAttribute('aria-pressed', String(player.playing));
  };
  return { element, update };
}
