import { at } from './packed.js';

/**
 * What the report holds of the neighbourhood of each pose: whole steps of one or two coordinates to either side. Verdict
 * and clearance at these places are those that posewright computed; the information there is that of a block interpolated
 * between them, at places where that was found to stand for the model's.
 */
export class Neighbours {
  /** @param {any} data Report.neighbours or null @param {number} columns */
  constructor(data, columns) {
    this.data = data;
    this.columns = columns;
    this.poses = new Map((data?.poses ?? []).map((pose) => [pose.id, pose]));
    this.places = new Map((data?.places ?? []).map((k, place) => [k.join(), place]));
    this.terms = new Map();
  }

  /** @param {number} id */
  has(id) {
    return this.poses.has(id);
  }

  /** Of each coordinate: index in the configuration, step, and how many steps reach to its limits.
   * @param {number} id @param {number[]} configuration of the plan */
  coordinates(id, configuration) {
    return this.data.coordinates.map(({ index, lower, upper }, j) => {
      const step = this.poses.get(id).steps[j];
      const most = (limit) => (limit - configuration[index]) / step;
      return { index, step, least: Math.ceil(most(lower) - 1e-9) || 0, most: Math.floor(most(upper) + 1e-9) || 0 };
    });
  }

  /**
   * What is known k steps away; null where nothing is.
   * @param {number} id @param {number[]} k
   * @returns {{reason: string|null, nearest: {distance: number, between: [string, string]}|undefined, told: boolean}|null}
   */
  place(id, k) {
    const place = this.places.get(k.join());
    const pose = this.poses.get(id);
    if (place === undefined || !pose) return null;
    const verdict = pose.verdicts[place];
    const bodies = this.data.bodies[pose.between[place] ?? -1];
    return {
      reason: verdict < 0 ? null : this.data.reasons[verdict],
      nearest: bodies && { distance: pose.clearance[place] * 1e-4, between: bodies },
      told: pose.told[place] === 1,
    };
  }

  /**
   * JᵀJ k steps away, packed, in units of tolerance: that of the pose and the change of the interpolated block's.
   * @param {number} id @param {number[]} k @param {ArrayLike<number>} own of the pose @returns {Float64Array}
   */
  information(id, k, own) {
    const [moved, middle] = [this.#block(id, k), this.#block(id, k.map(() => 0))];
    const m = this.columns;
    const sum = Float64Array.from(own);
    for (let r = 0; r < middle.length / m; ++r)
      for (let i = 0; i < m; ++i)
        for (let j = 0; j <= i; ++j)
          sum[at(i, j)] += moved[r * m + i] * moved[r * m + j] - middle[r * m + i] * middle[r * m + j];
    return sum;
  }

  /** B(k) = T₀ + Σ k_i T_i + Σ_{i ≤ j} k_i k_j T_ij, row by row. @param {number} id @param {number[]} k */
  #block(id, k) {
    const { rows, scale } = this.poses.get(id);
    const terms = this.#terms(id);
    const size = rows * this.columns;
    const block = new Float64Array(size);
    const include = (term, factor, order) => {
      if (factor !== 0)
        for (let e = 0; e < size; ++e) block[e] += factor * (terms[term * size + e] * scale[order][e % this.columns]);
    };
    include(0, 1, 0);
    k.forEach((steps, i) => include(1 + i, steps, 1));
    let term = 1 + k.length;
    for (let i = 0; i < k.length; ++i) for (let j = i; j < k.length; ++j, ++term) include(term, k[i] * k[j], 2);
    return block;
  }

  /** @param {number} id @returns {Int16Array} */
  #terms(id) {
    if (!this.terms.has(id)) this.terms.set(id, wholeNumbers(this.poses.get(id).terms));
    return this.terms.get(id);
  }
}

/** Two bytes a number, the lower one first. @param {string} base64 */
export function wholeNumbers(base64) {
  const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  return Int16Array.from({ length: bytes.length / 2 }, (_, k) => view.getInt16(2 * k, true));
}
