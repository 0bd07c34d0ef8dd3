import { h } from '../dom.js';
import { onTheme } from '../theme.js';
import { duration, number } from '../text/units.js';
import { Picture } from './picture.js';
import { Player } from './player.js';
import { SvgView } from './svg_view.js';
import { sightsOf } from './sights.js';
import { poseCard } from './pose_card.js';
import { layerBoxes, lookButtons } from './viewer_controls.js';
import { Scene3d } from './scene3d.js';

function hasWebGl() {
  const context = document.createElement('canvas').getContext('webgl2');
  context?.getExtension('WEBGL_lose_context')?.loseContext();
  return context !== null;
}

/**
 * The robot in its cell, with a slider through the measuring order.
 * @param {import('../pose_list.js').PoseList} list
 */
export function viewer(list) {
  const { report } = list;
  const picture = new Picture(report);
  const player = new Player(list);
  const layers = { bodies: true, sights: true, candidates: false };
  const holder = h('div', { class: 'view' });
  const labels = h('div', { class: 'labels', 'aria-hidden': 'true' });
  const pick = (id) => player.goTo(id) || list.show(id);
  const solid = hasWebGl();
  const view = solid ? new Scene3d(holder, picture, pick) : new SvgView(holder, picture, pick);
  holder.append(labels);
  view.canvas.setAttribute('role', 'img');
  view.canvas.setAttribute('aria-label', 'Robot and its surroundings at the pose shown. Arrow keys turn the picture, plus and minus zoom.');

  const slider = h('input', { type: 'range', min: 0, step: 1, 'aria-label': 'Place in the measuring order',
    oninput: () => player.go(Number(slider.value)) });
  const play = h('button', { class: 'play', onclick: () => player.toggle() });
  const stop = h('output', { class: 'stop', 'aria-live': 'polite' });
  const card = h('div', { class: 'pose-card' });

  const show = () => {
    const drawn = picture.enlargedDrawing(player.drawn);
    const pose = list.poses.get(list.current ?? -1);
    view.show({ drawn, sights: pose && drawn ? sightsOf(report, pose, drawn.targets) : [], current: list.current,
      on: new Set(list.ids), layers });
    view.canvas.dataset.tip = drawn ? drawn.tip.map((v) => v.toFixed(6)).join(' ') : '';
    slider.max = String(player.last);
    slider.value = String(Math.floor(player.place));
    const text = stopText(player);
    if (stop.textContent !== text) stop.textContent = text;
    slider.setAttribute('aria-valuetext', text);
    card.replaceChildren(...poseCard(list));
  };
  const playText = () => {
    play.textContent = player.playing ? '❚❚ Pause' : '▶ Play';
    play.setAttribute('aria-pressed', String(player.playing));
  };
  player.addEventListener('frame', show);
  player.addEventListener('state', () => (playText(), show()));
  list.addEventListener('list', () => player.rebuild());
  list.addEventListener('current', show);
  onTheme(() => (view.paint(), show()));
  if (solid) printed(view, holder);
  view.onDraw = (project) => placeLabels(labels, picture, list, view.legend, project);
  new ResizeObserver(() => holder.clientWidth > 0 && view.resize(holder.clientWidth, holder.clientHeight)).observe(holder);

  const element = h('div', { class: 'viewer' },
    holder,
    h('div', { class: 'player' },
      h('button', { onclick: () => player.step(-1), 'aria-label': 'Previous pose' }, '‹ Back'), play,
      h('button', { onclick: () => player.step(1), 'aria-label': 'Next pose' }, 'Next ›'), slider),
    h('div', { class: 'tools' }, lookButtons(view, picture), layerBoxes(report, layers, show)),
    picture.possibleFactor > 1 ? enlarger(picture, view, show) : null,
    solid ? null : h('p', { class: 'note' }, 'This browser has no WebGL, so the picture is drawn in lines; bodies appear as boxes.'),
    h('div', { class: 'now' }, stop, card));
  playText();
  player.go(0);
  return { element, show: pick };
}

/** Browsers print what a WebGL canvas showed last, in the screen's colours: an image takes its place. @param {Scene3d} view @param {HTMLElement} holder */
function printed(view, holder) {
  const image = h('img', { class: 'printed-picture', alt: 'Robot and its surroundings', decoding: 'sync' });
  holder.append(image);
  addEventListener('beforeprint', () => {
    view.draw();
    image.src = view.canvas.toDataURL();
  });
}

/** @param {Player} player */
function stopText(player) {
  const key = player.keyframe;
  if (!key) return 'No pose to show';
  const time = player.routed ? `, after ${duration(key.seconds)}` : '';
  if (player.pose) {
    const stop = player.stops.findIndex((s) => s.id === player.pose);
    return `Stop ${stop + 1} of ${player.stops.length}: pose ${player.pose}${time}`;
  }
  if (key.pose === 0 && Number.isInteger(player.place)) return `Home${time}`;
  const before = [...player.stops].reverse().find((s) => s.index <= player.place);
  const after = player.stops.find((s) => s.index > player.place);
  return `On the way from ${before ? `pose ${before.id}` : 'home'} to ${after ? `pose ${after.id}` : 'the end'}${time}`;
}

/** Moves so small that one would see nothing are drawn larger; the reader can turn that off. */
function enlarger(picture, view, show) {
  const set = (on) => {
    picture.enlarge(on ? picture.possibleFactor : 1);
    show();
  };
  set(true);
  const box = h('input', { type: 'checkbox', checked: true, onchange: () => set(box.checked) });
  return h('label', { class: 'note enlarge' }, box,
    ` The robot moves so little that movements are drawn ${number(picture.possibleFactor)} times larger (untick for true size; all numbers are true).`);
}

/** Names of stations, and the number of the pose beside the tip. */
function placeLabels(labels, picture, list, legend, project) {
  const wanted = picture.report.stations.map((s) => ({ text: `station ${s.name}`, at: s.placement.slice(0, 3), name: '' }));
  const tip = picture.tips.find((t) => t.id === list.current);
  if (tip) wanted.push({ text: `pose ${tip.id}`, at: tip.position, name: 'current' });
  labels.replaceChildren(...wanted.map(({ text, at, name }) => {
    const place = project(at);
    const label = h('span', { class: `label ${name}` }, text);
    if (place) label.style.transform = `translate(${place[0].toFixed(0)}px, ${place[1].toFixed(0)}px)`;
    else label.hidden = true;
    return label;
  }), h('span', { class: 'legend' }, legend));
}
