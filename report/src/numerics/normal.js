/** Chance that a normal number of mean 0 and variance 1 is below x (Abramowitz and Stegun 1964, 7.1.26: 1.5e-7 off at
 * most, far less than a plot shows). @param {number} x */
export function normalBelow(x) {
  const z = Math.abs(x) / Math.SQRT2;
  const t = 1 / (1 + 0.3275911 * z);
  const tail = (((((1.061405429 * t - 1.453152027) * t + 1.421413741) * t - 0.284496736) * t + 0.254829592) * t * Math.exp(-z * z)) / 2;
  return x > 0 ? 1 - tail : tail;
}

/** How many of `count` normal numbers each bin would hold; the ends hold what is beyond too.
 * @param {number} from @param {number} width @param {number} bins @param {number} count */
export const normalCounts = (from, width, bins, count) =>
  Array.from({ length: bins }, (_, k) => {
    const below = k === 0 ? 0 : normalBelow(from + k * width);
    const above = k === bins - 1 ? 1 : normalBelow(from + (k + 1) * width);
    return count * (above - below);
  });
