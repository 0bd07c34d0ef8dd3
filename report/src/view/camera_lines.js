import { transformed } from './extent.js';
import { composed } from './kinematics.js';

/** The camera that reads where this instrument does; undefined: none does. @param {import('../types.js').Camera[]} cameras @param {string} [instrument] */
export const cameraOf = (cameras, instrument) => cameras.find((c) => c.instrument === instrument || c.with?.includes(instrument ?? ''));

/**
 * Field of view and board of the camera that reads, in the measurement frame, as pairs of points; undefined: none does.
 * @param {import('../types.js').Report} report @param {import('./interpolate.js').Drawn} drawn
 * @returns {import('./picture.js').CameraLines|undefined}
 */
export function cameraLines(report, drawn) {
  const camera = cameraOf(report.cameras, drawn.instrument);
  if (!camera) return undefined;
  const [eye, board] = [camera.camera, camera.board].map(({ frame, placement }) => composed(drawn.frames[frame], placement));
  const points = camera.points.map((p) => transformed(board, p));
  const middle = [0, 1, 2].map((k) => points.reduce((sum, p) => sum + p[k], 0) / points.length);
  const depth = Math.hypot(...middle.map((v, k) => v - eye[k]));
  const corners = camera.corners.map((ray) => transformed(eye, ray.map((v) => v * depth)));
  const rim = rimOf(camera.points).map((p) => transformed(board, p));
  const around = (ring) => ring.flatMap((p, k) => [p, ring[(k + 1) % ring.length]]);
  return {
    view: [...corners.flatMap((p) => [eye.slice(0, 3), p]), ...around(corners)],
    board: around(rim),
    points,
  };
}

/** The rectangle around the points of a board, whose plane is z = 0 of its own frame. @param {number[][]} points */
function rimOf(points) {
  const [x, y] = [0, 1].map((k) => points.map((p) => p[k]));
  const [x0, x1, y0, y1] = [Math.min(...x), Math.max(...x), Math.min(...y), Math.max(...y)];
  return [
    [x0, y0, 0],
    [x1, y0, 0],
    [x1, y1, 0],
    [x0, y1, 0],
  ];
}
