import { cameraLines } from './camera_lines.js';

/** @typedef {{centre: number[], radius: number, low: number[], high: number[], points: number[][]}} Extent points: some that must be in view */

const enoughPoints = 1000;

/** @param {number[][]} points @returns {Extent} */
export function extentOf(points) {
  const [low, high] = [
    [Infinity, Infinity, Infinity],
    [-Infinity, -Infinity, -Infinity],
  ];
  for (const p of points)
    for (let k = 0; k < 3; ++k) [low[k], high[k]] = [Math.min(low[k], p[k]), Math.max(high[k], p[k])];
  const centre = low.map((value, k) => (value + high[k]) / 2);
  const radius = Math.max(1e-6, Math.hypot(...high.map((value, k) => value - low[k])) / 2);
  const step = Math.ceil(points.length / enoughPoints);
  return { centre, radius, low, high, points: points.filter((_, k) => k % step === 0) };
}

/** The eight corners of what a body fills in its own frame; none of a plane. @param {import('../types.js').Shape} shape */
function corners(shape) {
  if (shape.type === 'plane') return [];
  if (shape.type === 'mesh') {
    const points = [];
    for (let k = 0; k < shape.vertices.length; k += 3) points.push(shape.vertices.slice(k, k + 3));
    if (points.length === 0) return [];
    const { low, high } = extentOf(points);
    return boxCorners(low, high);
  }
  const half =
    shape.type === 'box'
      ? shape.size.map((s) => s / 2)
      : shape.type === 'sphere'
        ? [shape.radius, shape.radius, shape.radius]
        : [shape.radius, shape.radius, shape.length / 2];
  return boxCorners(
    half.map((v) => -v),
    half,
  );
}

/** @param {number[]} low @param {number[]} high */
const boxCorners = (low, high) =>
  Array.from({ length: 8 }, (_, k) => [k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]]);

/** @param {number[]} x placement @param {number[]} p */
export function transformed(x, p) {
  const [qx, qy, qz, qw] = x.slice(3);
  const [tx, ty, tz] = [2 * (qy * p[2] - qz * p[1]), 2 * (qz * p[0] - qx * p[2]), 2 * (qx * p[1] - qy * p[0])];
  return [
    x[0] + p[0] + qw * tx + qy * tz - qz * ty,
    x[1] + p[1] + qw * ty + qz * tx - qx * tz,
    x[2] + p[2] + qw * tz + qx * ty - qy * tx,
  ];
}

/** Corners of a body in the measurement frame. @param {import('../types.js').Body} body @param {number[][]} frames */
export const bodyCorners = (body, frames) =>
  corners(body.shape).map((p) => transformed(frames[body.frame], transformed(body.placement, p)));

/**
 * What there is to see: the robot in all stops, its targets, stations, fields of view and things around it.
 * @param {import('../types.js').Report} report @returns {Extent}
 */
export function sceneExtent(report) {
  const points = report.stations.map((s) => s.placement.slice(0, 3));
  for (const keyframe of report.keyframes) {
    points.push(keyframe.tip.slice(0, 3), ...keyframe.lines.flat());
    points.push(.../** @type {number[][]} */ (keyframe.targets.filter((t) => t !== null)));
    if (keyframe.pose) points.push(...(cameraLines(report, keyframe)?.view ?? []));
  }
  const first = report.keyframes[0];
  if (first) for (const body of report.bodies) points.push(...bodyCorners(body, first.frames));
  return points.length > 0
    ? extentOf(points)
    : extentOf([
        [-1, -1, -1],
        [1, 1, 1],
      ]);
}

/** @param {import('../types.js').Keyframe[]} stops @returns {Extent} of the tip alone */
export const tipExtent = (stops) => extentOf(stops.map((s) => s.tip.slice(0, 3)));

/**
 * Radius in which the tip or a joint moves, whichever moves most: joined tips stay where they are, and the arms move.
 * @param {import('../types.js').Keyframe[]} stops at least one
 */
export function movement(stops) {
  const joints = stops[0].lines.flatMap((line, i) =>
    line.map((_, j) => extentOf(stops.flatMap((k) => (k.lines[i]?.[j] ? [k.lines[i][j]] : []))).radius),
  );
  return Math.max(tipExtent(stops).radius, ...joints);
}
