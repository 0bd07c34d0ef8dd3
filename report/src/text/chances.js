/** Below it a test refuses: as in the program's own words. */
export const seldom = 0.01;

/** @param {number|null|undefined} p */
export function chance(p) {
  if (p === null || p === undefined) return '–';
  if (p < 1e-6) return '< 1e-6';
  return p < 0.001 ? p.toExponential(1).replace('-', '−') : p.toPrecision(2);
}
