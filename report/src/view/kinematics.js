import { transformed } from './extent.js';

/** Placements x y z qx qy qz qw. @param {number[]} a @param {number[]} b @returns {number[]} a · b */
export function composed(a, b) {
  const [ax, ay, az, aw] = a.slice(3);
  const [bx, by, bz, bw] = b.slice(3);
  return [
    ...transformed(a, b.slice(0, 3)),
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

/** @param {any} joint @param {number} value @returns {number[]} placement behind the joint */
function motion(joint, value) {
  const axis = joint.axis;
  if (joint.prismatic) return [...axis.map((v) => v * value), 0, 0, 0, 1];
  return [0, 0, 0, ...axis.map((v) => v * Math.sin(value / 2)), Math.cos(value / 2)];
}

/**
 * Where a serial arm is at a configuration, as keyframes have it.
 * @param {any} chain Report.chain @param {number[]} configuration @returns {import('./interpolate.js').Drawn}
 */
export function armAt(chain, configuration) {
  const frames = [[0, 0, 0, 0, 0, 0, 1]];
  let frame = chain.base;
  for (const joint of chain.joints) {
    const value = joint.multiplier * configuration[joint.coordinate] + joint.offset;
    frame = composed(composed(frame, joint.placement), motion(joint, value));
    frames.push(frame);
  }
  const tip = composed(frame, chain.tip);
  const line = [chain.base.slice(0, 3), ...frames.slice(1).map((x) => x.slice(0, 3)), tip.slice(0, 3)];
  return { frames, lines: [line], tip, targets: chain.targets.map((p) => transformed(tip, p)) };
}

/** @param {number[]} rest @param {[number, number[]][]} changes share and where it would be in full */
function changed(rest, changes) {
  const sum = rest.map((v, e) => changes.reduce((total, [share, full]) => total + share * (full[e] - v), v));
  if (rest.length !== 7) return sum;
  const length = Math.hypot(...sum.slice(3));
  return [...sum.slice(0, 3), ...sum.slice(3).map((v) => v / length)];
}

/**
 * A robot without a chain: to first order, by what is drawn at `reach` steps of each coordinate.
 * @param {import('./interpolate.js').Drawn} rest @param {import('./interpolate.js').Drawn[]} full @param {number[]} shares
 * @returns {import('./interpolate.js').Drawn}
 */
export function nearby(rest, full, shares) {
  const used = full.map((drawn, j) => /** @type {const} */ ([shares[j], drawn])).filter(([share]) => share !== 0);
  const mix = (own, of) =>
    own && used.every(([, d]) => of(d)) ? changed(own, used.map(([share, d]) => [share, of(d)])) : own;
  return {
    frames: rest.frames.map((x, f) => mix(x, (d) => d.frames[f])),
    lines: rest.lines.map((line, l) => line.map((p, e) => mix(p, (d) => d.lines[l]?.[e]))),
    tip: mix(rest.tip, (d) => d.tip),
    targets: rest.targets.map((p, t) => mix(p, (d) => d.targets[t])),
  };
}
