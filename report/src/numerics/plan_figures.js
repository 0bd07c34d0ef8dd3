import { add, at, cholesky, inverse, logDet, traceOfProduct } from './packed.js';

/**
 * What a list of poses tells about the parameters.
 * @typedef {object} Figures
 * @property {boolean} identifiable
 * @property {string|null} stuck name of a parameter that the poses cannot tell from those before it
 * @property {number|null} logDet of the parameters of interest, nuisance eliminated, in SI units as in plan.json
 * @property {number[]|null} sigma predicted 1σ of each column, SI
 * @property {{name: string, ratio: number}|null} worst largest σ/tolerance among the parameters of interest
 * @property {number[]|null} testErrors predicted position error at each test pose, m
 * @property {number|null} rho0 their weighted root mean square, m; null without test poses
 * @property {Float64Array|null} covariance packed, in units of tolerance
 */

/** Computes figures of any part of a plan from the information of its poses. */
export class PlanFigures {
  /**
   * @param {import('../types.js').Column[]} columns nuisance first
   * @param {import('../types.js').Matrices} information
   */
  constructor(columns, information) {
    this.columns = columns;
    this.test = information.test;
    this.prior = information.prior;
    this.size = (columns.length * (columns.length + 1)) / 2;
    this.nuisance = columns.filter((c) => c.role === 'nuisance').length;
    this.interest = columns.length - this.nuisance;
    // det of D⁻¹ M D⁻¹, D the tolerances
    this.inSi = -2 * columns.slice(this.nuisance).reduce((sum, c) => sum + Math.log(c.tolerance), 0);
    this.blocks = new Map(information.poses.map((p) => [p.id, p.packed]));
  }

  /** @param {Iterable<number>} ids of poses @returns {Figures} */
  of(ids) {
    const sum = this.#start();
    for (const id of ids) add(sum, this.blocks.get(id) ?? []);
    return this.#figures(sum);
  }

  /**
   * The same after each pose of a list.
   * @param {number[]} ids in measuring order @param {number[]} before ids of poses measured before @returns {Figures[]}
   */
  growing(ids, before = []) {
    const sum = this.#start();
    for (const id of before) add(sum, this.blocks.get(id) ?? []);
    return ids.map((id) => {
      add(sum, this.blocks.get(id) ?? []);
      return this.#figures(sum);
    });
  }

  /**
   * What a part keeps of the whole, exp((log det part − log det whole)/h), h parameters of interest; 0 where something
   * is not identifiable any more.
   * @param {Figures} part @param {Figures} whole
   */
  efficiency(part, whole) {
    if (part.logDet === null || whole.logDet === null) return 0;
    return Math.exp((part.logDet - whole.logDet) / this.interest);
  }

  #start() {
    return this.prior ? Float64Array.from(this.prior) : new Float64Array(this.size);
  }

  /** @param {Float64Array} information @returns {Figures} */
  #figures(information) {
    const { factor, rank } = cholesky(information);
    if (rank < this.columns.length)
      return {
        identifiable: false,
        stuck: this.columns[rank].name,
        logDet: null,
        sigma: null,
        worst: null,
        testErrors: null,
        rho0: null,
        covariance: null,
      };
    const covariance = inverse(factor);
    const ratios = this.columns.map((_, j) => Math.sqrt(covariance[at(j, j)]));
    const variances = this.test.map((t) => traceOfProduct(t.packed, covariance));
    const weight = this.test.reduce((sum, t) => sum + t.weight, 0);
    return {
      identifiable: true,
      stuck: null,
      logDet: logDet(factor, this.nuisance) + this.inSi,
      sigma: ratios.map((ratio, j) => ratio * this.columns[j].tolerance),
      worst: this.#worst(ratios),
      testErrors: variances.map((v) => Math.sqrt(Math.max(0, v))),
      rho0: weight > 0 ? Math.sqrt(this.test.reduce((sum, t, k) => sum + t.weight * variances[k], 0) / weight) : null,
      covariance,
    };
  }

  /** @param {number[]} ratios */
  #worst(ratios) {
    let worst = null;
    for (let j = this.nuisance; j < ratios.length; ++j)
      if (worst === null || ratios[j] > worst.ratio) worst = { name: this.columns[j].name, ratio: ratios[j] };
    return worst;
  }
}
