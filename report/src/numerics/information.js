import { at } from './packed.js';

// Integers in a unit of whitened rows.
const rowUnit = 2 ** 30;

/**
 * Whitened rows W of a pose: 32-bit integers in units of 2⁻³⁰, the least significant byte first, as base64.
 * @param {string} text @param {number} m columns @returns {Float64Array} row by row
 */
export function whitenedRows(text, m) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  const rows = new Float64Array(bytes.length / 4);
  if (rows.length % m !== 0) throw new Error(`rows of ${m} columns expected`);
  for (let k = 0; k < rows.length; ++k) rows[k] = view.getInt32(4 * k, true) / rowUnit;
  return rows;
}

/**
 * J = W Lᵀ.
 * @param {Float64Array} rows W @param {ArrayLike<number>} factor L, packed @param {number} m
 */
function unwhitened(rows, factor, m) {
  const result = new Float64Array(rows.length);
  for (let first = 0; first < rows.length; first += m)
    for (let j = 0; j < m; ++j) {
      let value = 0;
      for (let k = 0; k <= j; ++k) value += rows[first + k] * factor[at(j, k)];
      result[first + j] = value;
    }
  return result;
}

/**
 * JᵀJ of rows.
 * @param {ArrayLike<number>} rows row by row @param {number} m columns
 * @returns {Float64Array} packed
 */
export function gram(rows, m) {
  const result = new Float64Array((m * (m + 1)) / 2);
  for (let first = 0; first < rows.length; first += m)
    for (let i = 0, k = 0; i < m; ++i) for (let j = 0; j <= i; ++j, ++k) result[k] += rows[first + i] * rows[first + j];
  return result;
}

/**
 * Matrices of what a report has as rows.
 * @param {import('../types.js').Information} information @param {number} m columns
 * @returns {import('../types.js').Matrices}
 */
export function matricesOf({ factor, poses, prior, test }, m) {
  return {
    poses: poses.map(({ id, rows }) => ({ id, packed: gram(unwhitened(whitenedRows(rows, m), factor, m), m) })),
    prior,
    test: test.map(({ weight, rows }) => ({ weight, packed: gram(rows.flat(), m) })),
  };
}
