import { h, svg } from '../dom.js';
import { cameraOf } from './camera_lines.js';

/**
 * What the camera will see at the pose shown: its picture's frame with the board's points where the model predicts them.
 * @param {import('../pose_list.js').PoseList} list
 */
export function cameraPicture(list) {
  const { cameras } = list.report;
  if (cameras.length === 0) return null;
  const drawing = svg('svg', { class: 'camera', role: 'img' });
  const caption = h('figcaption', { class: 'note' });
  const element = h('figure', { class: 'camera-picture' }, drawing, caption);
  const fill = () => {
    const pose = list.poses.get(list.current ?? -1);
    const camera = pose && cameraOf(cameras, pose.instrument);
    element.hidden = !camera;
    if (!camera) return;
    const pixels = list.pictures.get(pose.id);
    const [width, height] = camera.size;
    drawing.setAttribute('viewBox', `0 0 ${width} ${height}`);
    const parts = [svg('rect', { class: 'frame', width, height })];
    if (pixels) parts.push(...points(pixels, hiddenPoints(camera, pose), width));
    drawing.replaceChildren(...parts);
    caption.textContent = captionOf(camera, pose, pixels);
    drawing.setAttribute('aria-label', caption.textContent);
  };
  for (const event of ['list', 'current']) list.addEventListener(event, fill);
  fill();
  return element;
}

/** Names of the points that something hides. @param {any} camera @param {any} pose */
const hiddenPoints = (camera, pose) => {
  const hidden = new Set((pose.targets ?? []).filter((t) => t.visible === false).map((t) => t.target));
  return camera.names.map((name) => hidden.has(name));
};

/** @param {([number, number]|null)[]} pixels @param {boolean[]} hidden @param {number} width */
function points(pixels, hidden, width) {
  const r = width / 130;
  return pixels.flatMap((p, k) => {
    if (p === null) return [];
    const [u, v] = p;
    if (hidden[k])
      return [svg('path', { class: 'hidden', d: `M${u - r} ${v - r}l${2 * r} ${2 * r}M${u - r} ${v + r}l${2 * r} ${-2 * r}`, 'data-point': k })];
    return [svg('circle', { class: k === 0 ? 'first' : 'seen', cx: u, cy: v, r: k === 0 ? 1.5 * r : r, 'data-point': k })];
  });
}

/** @param {any} camera @param {any} pose @param {any[]|undefined} pixels */
function captionOf(camera, pose, pixels) {
  if (!pixels) return `No picture is predicted at pose ${pose.id}.`;
  const hidden = hiddenPoints(camera, pose).filter(Boolean).length;
  return (
    `Predicted picture at pose ${pose.id}, ${camera.size.join(' × ')} px: the ${pixels.length} points of the board, the first one larger` +
    (hidden > 0 ? `; ${hidden} hidden (crosses)` : '') +
    '.'
  );
}
