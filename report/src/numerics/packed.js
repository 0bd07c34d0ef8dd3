/**
 * Symmetric matrices as their lower triangle, row by row: entry (i, j), j ≤ i, at i(i+1)/2 + j.
 * @typedef {Float64Array} Packed
 */

/** A pivot smaller than this share of its diagonal entry counts as zero. */
export const smallestPivot = 1e-12;

/** @param {number} i @param {number} j */
export const at = (i, j) => (i >= j ? (i * (i + 1)) / 2 + j : (j * (j + 1)) / 2 + i);

/** @param {number} length of a packed triangle @returns {number} rows of the matrix */
export const rowsOf = (length) => Math.round((Math.sqrt(8 * length + 1) - 1) / 2);

/**
 * @param {Packed} sum changed in place
 * @param {ArrayLike<number>} term
 */
export function add(sum, term) {
  for (let k = 0; k < sum.length; ++k) sum[k] += term[k];
}

/**
 * Cholesky factor L of M = L Lᵀ. Rows of L from k on are the factor of the Schur complement of the first k rows, so
 * parameters that come first are eliminated without any further work.
 * @param {Packed} m
 * @returns {{factor: Packed, rank: number}} rank: rows done before a pivot vanished; all of them where M is regular
 */
export function cholesky(m) {
  const n = rowsOf(m.length);
  const factor = Float64Array.from(m);
  for (let i = 0; i < n; ++i) {
    const row = at(i, 0);
    for (let j = 0; j <= i; ++j) {
      const other = at(j, 0);
      let value = factor[row + j];
      for (let k = 0; k < j; ++k) value -= factor[row + k] * factor[other + k];
      if (j < i) factor[row + j] = value / factor[other + j];
      else if (!(value > smallestPivot * m[row + i])) return { factor, rank: i };
      else factor[row + i] = Math.sqrt(value);
    }
  }
  return { factor, rank: n };
}

/**
 * log det of the Schur complement that is left when the first rows are eliminated.
 * @param {Packed} factor from `cholesky`
 * @param {number} eliminated rows
 */
export function logDet(factor, eliminated = 0) {
  let sum = 0;
  for (let i = eliminated, n = rowsOf(factor.length); i < n; ++i) sum += 2 * Math.log(factor[at(i, i)]);
  return sum;
}

/**
 * M⁻¹ = L⁻ᵀ L⁻¹.
 * @param {Packed} factor from `cholesky`, of full rank
 * @returns {Packed}
 */
export function inverse(factor) {
  const n = rowsOf(factor.length);
  const l = new Float64Array(factor.length);
  for (let i = 0; i < n; ++i) {
    const pivot = 1 / factor[at(i, i)];
    for (let j = 0; j < i; ++j) {
      let value = 0;
      for (let k = j; k < i; ++k) value -= factor[at(i, k)] * l[at(k, j)];
      l[at(i, j)] = value * pivot;
    }
    l[at(i, i)] = pivot;
  }
  const result = new Float64Array(factor.length);
  for (let k = 0; k < n; ++k)
    for (let i = 0; i <= k; ++i) for (let j = 0; j <= i; ++j) result[at(i, j)] += l[at(k, i)] * l[at(k, j)];
  return result;
}

/**
 * tr(A B) of two symmetric matrices.
 * @param {ArrayLike<number>} a
 * @param {ArrayLike<number>} b
 */
export function traceOfProduct(a, b) {
  let sum = 0;
  for (let i = 0, k = 0; k < a.length; ++i) for (let j = 0; j <= i; ++j, ++k) sum += (i === j ? 1 : 2) * a[k] * b[k];
  return sum;
}

/**
 * Correlation of entries i and j of a covariance.
 * @param {Packed} covariance @param {number} i @param {number} j
 */
export const correlation = (covariance, i, j) =>
  covariance[at(i, j)] / Math.sqrt(covariance[at(i, i)] * covariance[at(j, j)]);
