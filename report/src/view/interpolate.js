/** Where the robot is between two keyframes, and how movements too small to be seen are drawn larger. */

/** @typedef {Pick<import('../types.js').Keyframe, 'frames'|'lines'|'tip'|'targets'|'instrument'>} Drawn */

/** @param {number[]} a @param {number[]} b @param {number} t */
const mixed = (a, b, t) => a.map((value, k) => value + t * (b[k] - value));

/** Spherical interpolation, or extrapolation where t is beyond 0 to 1. @param {number[]} a @param {number[]} b @param {number} t */
function turned(a, b, t) {
  let cosine = a.reduce((sum, value, k) => sum + value * b[k], 0);
  const sign = cosine < 0 ? -1 : 1;
  cosine = Math.min(1, cosine * sign);
  const angle = Math.acos(cosine);
  if (angle < 1e-9) return a;
  const [u, v] = [Math.sin((1 - t) * angle) / Math.sin(angle), (sign * Math.sin(t * angle)) / Math.sin(angle)];
  return a.map((value, k) => u * value + v * b[k]);
}

/** @param {number[]} a @param {number[]} b @param {number} t @returns {number[]} */
export const placementBetween = (a, b, t) => [
  ...mixed(a.slice(0, 3), b.slice(0, 3), t),
  ...turned(a.slice(3), b.slice(3), t),
];

/** @param {Drawn} a @param {Drawn} b @param {number} t @returns {Drawn} */
export function between(a, b, t) {
  if (t <= 0) return a;
  if (t >= 1) return b;
  const near = t < 0.5 ? a : b;
  return {
    instrument: near.instrument,
    frames: a.frames.map((frame, k) => placementBetween(frame, b.frames[k], t)),
    lines: a.lines.map((line, l) =>
      line.length === b.lines[l]?.length ? line.map((p, k) => mixed(p, b.lines[l][k], t)) : (near.lines[l] ?? line),
    ),
    tip: placementBetween(a.tip, b.tip, t),
    targets: a.targets.map((p, k) => (p && b.targets[k] ? mixed(p, b.targets[k], t) : near.targets[k])),
  };
}

/**
 * Moves every point away from where it is in `rest`, `factor` times as far.
 * @param {Drawn} drawn @param {Drawn} rest @param {number} factor @returns {Drawn}
 */
export function exaggerated(drawn, rest, factor) {
  if (factor === 1) return drawn;
  return {
    instrument: drawn.instrument,
    frames: drawn.frames.map((frame, k) => placementBetween(rest.frames[k], frame, factor)),
    lines: drawn.lines.map((line, l) =>
      line.map((p, k) => (rest.lines[l]?.[k] ? mixed(rest.lines[l][k], p, factor) : p)),
    ),
    tip: placementBetween(rest.tip, drawn.tip, factor),
    targets: drawn.targets.map((p, k) => (p && rest.targets[k] ? mixed(rest.targets[k], p, factor) : p)),
  };
}

/** Mean position with the orientation of the first. @param {number[][]} placements */
const meanPlacement = (placements) => [...meanPoint(placements.map((p) => p.slice(0, 3))), ...placements[0].slice(3)];

/** @param {number[][]} points */
const meanPoint = (points) => points[0].map((_, k) => points.reduce((sum, p) => sum + p[k], 0) / points.length);

/** The middle of all stops. @param {import('../types.js').Keyframe[]} stops @returns {Drawn} */
export function middleOf(stops) {
  const first = stops[0];
  const same = stops.filter((s) => s.lines.every((line, l) => line.length === first.lines[l]?.length));
  return {
    frames: first.frames.map((_, k) => meanPlacement(same.map((s) => s.frames[k]))),
    lines: first.lines.map((line, l) => line.map((_, k) => meanPoint(same.map((s) => s.lines[l][k])))),
    tip: meanPlacement(same.map((s) => s.tip)),
    targets: first.targets.map((p, k) => {
      const seen = same.map((s) => s.targets[k]).filter((q) => q !== null);
      return seen.length > 0 ? /** @type {any} */ (meanPoint(seen)) : p;
    }),
  };
}
