/**
 * A point of a leg: leg_i.a on the base, leg_i.b on the platform.
 * @typedef {{name: string, nominal: number[], calibrated: number[], sigma: (number|null)[]}} LegPoint
 */

/** How far a point is from nominal, by coordinate. @param {LegPoint} p */
export const deviation = (p) => p.calibrated.map((v, k) => v - p.nominal[k]);

/** The same in the plane that is drawn. @param {LegPoint} p */
const inPlane = (p) => Math.hypot(...deviation(p).slice(0, 2));

/** The largest distance from nominal in space. @param {LegPoint[]} points */
export const largestDeviation = (points) => Math.max(0, ...points.map((p) => Math.hypot(...deviation(p))));

/** Where a point is drawn, its deviation so many times as large. @param {LegPoint} p @param {number} times */
export const amplified = (p, times) => deviation(p).map((v, k) => p.nominal[k] + times * v);

/**
 * How many times as large deviations are drawn, so that the largest takes at most a sixth of what the points extend over:
 * 1, 2 or 5 times a power of ten, and never less than once. 0: no point deviates.
 * @param {LegPoint[]} points of all models
 */
export function amplification(points) {
  const largest = Math.max(0, ...points.map(inPlane));
  if (!(largest > 0)) return 0;
  const side = (axis) => Math.max(...points.map((p) => p.nominal[axis])) - Math.min(...points.map((p) => p.nominal[axis]));
  const most = Math.max(side(0), side(1)) / 6 / largest;
  const decade = 10 ** Math.floor(Math.log10(most));
  return Math.max(1, ([5, 2].find((d) => d * decade <= most) ?? 1) * decade);
}
