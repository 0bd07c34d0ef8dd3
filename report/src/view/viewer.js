import { h } from '../dom.js';
import { onTheme } from '../theme.js';
import { InstrumentColours } from './instrument_colours.js';
import { Picture } from './picture.js';
import { placeLabels } from './labels.js';
import { Player } from './player.js';
import { poseMover } from './pose_mover.js';
import { poseCard } from './pose_card.js';
import { Scene3d } from './scene3d.js';
import { sightsOf } from './sights.js';
import { nearestHere, stopText } from './stop_text.js';
import { SvgView } from './svg_view.js';
import { cameraLines } from './camera_lines.js';
import { cameraPicture } from './camera_picture.js';
import { enlarger, layerBoxes, lookButtons, playerControls } from './viewer_controls.js';

function hasWebGl() {
  const context = document.createElement('canvas').getContext('webgl2');
  context?.getExtension('WEBGL_lose_context')?.loseContext();
  return context !== null;
}

/** @param {HTMLElement} holder @param {Picture} picture @param {(id: number) => void} pick */
export function makeView(holder, picture, pick) {
  const solid = hasWebGl();
  const view = solid ? new Scene3d(holder, picture, pick) : new SvgView(holder, picture, pick);
  const use = 'Drag or arrow keys turn the picture; plus, minus and, after a click, the wheel zoom.';
  view.canvas.setAttribute('role', 'img');
  view.canvas.setAttribute('aria-label', `Robot and its surroundings at the pose shown. ${use}`);
  holder.title = use;
  if (solid) printed(view, holder);
  const sizes = new ResizeObserver(() => holder.clientWidth > 0 && view.resize(holder.clientWidth, holder.clientHeight));
  sizes.observe(holder);
  return { view, solid, sizes };
}

/**
 * The robot in its cell, with a slider through the measuring order.
 * @param {import('../pose_list.js').PoseList} list @param {boolean} [movable] whether the reader may move poses
 */
export function viewer(list, movable = true) {
  const { report } = list;
  const instruments = new InstrumentColours(report.plan);
  const picture = new Picture(report, (id) => instruments.of(list.poses.get(id)));
  const player = new Player(list);
  const layers = { bodies: true, sights: true, candidates: false };
  const pick = (id) => player.goTo(id) || list.show(id);
  const holder = h('div', { class: 'view' });
  const { view, solid } = makeView(holder, picture, pick);
  const labels = h('div', { class: 'labels', 'aria-hidden': 'true' });
  holder.append(labels);
  let gap = /** @type {import('./picture.js').Gap|undefined} */ (undefined);
  view.onDraw = (project) => placeLabels(labels, picture, list, gap, view.legend, project);
  const controls = playerControls(player);
  const stop = h('output', { class: 'stop', 'aria-live': 'polite' });
  const card = h('div', { class: 'pose-card' });

  const show = () => {
    const drawn = picture.enlargedDrawing(player.drawn);
    const pose = list.poses.get(list.current ?? -1);
    const sights = pose && drawn ? sightsOf(report, pose, drawn.targets) : [];
    const nearest = nearestHere(player, list);
    // Where movements are drawn larger, points of bodies are elsewhere.
    gap = nearest?.points && picture.factor === 1 ? nearest : undefined;
    const camera = drawn && cameraLines(report, drawn);
    const on = new Set(list.ids);
    view.show({ drawn, sights, current: list.current, on, nearest: nearest?.between ?? [], gap, camera, layers });
    view.canvas.dataset.tip = drawn ? drawn.tip.map((v) => v.toFixed(6)).join(' ') : '';
    // Nobody wants every step of a film read out.
    stop.setAttribute('aria-live', player.playing ? 'off' : 'polite');
    const text = stopText(player);
    if (stop.textContent !== text) stop.textContent = text;
    controls.update(text);
    card.replaceChildren(...poseCard(list));
  };
  for (const event of ['frame', 'state']) player.addEventListener(event, show);
  list.addEventListener('list', () => {
    for (const [id, keyframe] of list.keyframes) picture.moveTip(id, keyframe.tip);
    player.rebuild();
  });
  list.addEventListener('current', show);
  onTheme(() => (view.paint(), show()));
  player.go(player.stops[0]?.index ?? 0);

  const lines = 'This browser has no WebGL, so the picture is drawn in lines; bodies appear as boxes.';
  const element = h(
    'div',
    { class: 'viewer' },
    holder,
    controls.element,
    h('div', { class: 'tools' }, lookButtons(view, picture), layerBoxes(report, layers, show)),
    instruments.legend(list),
    picture.possibleFactor > 1 ? enlarger(picture, show) : null,
    solid ? null : h('p', { class: 'note' }, lines),
    h('div', { class: 'now' }, stop, card),
    cameraPicture(list) ?? '',
    movable ? poseMover(list) : '',
  );
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
