import { PlanFigures } from './numerics/plan_figures.js';

/**
 * The list the reader works on: which poses, in which order, and what they tell.
 * Events: "list" after a tick or a move, "current" when another pose is shown.
 */
export class PoseList extends EventTarget {
  /** @param {import('./types.js').Report} report */
  constructor(report) {
    super();
    this.report = report;
    /** @type {Map<number, any>} */
    this.poses = new Map(report.plan.poses.map((p) => [p.id, p]));
    this.keyframes = new Map(report.keyframes.filter((k) => k.pose).map((k) => [k.pose, k]));
    this.unreachable = new Map((report.route?.unreachable ?? []).map((u) => [u.pose, u.reason]));
    this.engine = new PlanFigures(report.columns, report.information);
    /** Poses measured before count whatever the reader ticks. */
    this.measured = report.plan.poses.filter((p) => p.measured).map((p) => p.id);
    this.planned = this.engine.of(this.engine.blocks.keys());
    this.current = /** @type {number|null} */ (null);
    this.reset();
  }

  /** Poses to be measured, as the route or the plan has them; what cannot be reached comes last, ticked off. */
  #start() {
    const open = this.report.plan.poses.filter((p) => !p.measured).map((p) => p.id);
    const order = this.report.route ? this.report.route.order.filter((id) => open.includes(id)) : open;
    const rest = open.filter((id) => !order.includes(id));
    return [...order, ...rest].map((id) => ({ id, on: !this.unreachable.has(id) }));
  }

  reset() {
    this.entries = this.#start();
    this.#changed();
  }

  get changed() {
    const start = this.#start();
    return this.entries.some((e, k) => e.id !== start[k].id || e.on !== start[k].on);
  }

  /** Ids of the ticked poses in order. */
  get ids() {
    return this.entries.filter((e) => e.on).map((e) => e.id);
  }

  get figures() {
    return (this.memo ??= this.engine.of([...this.measured, ...this.ids]));
  }

  /** Figures after each of the ticked poses. */
  get growing() {
    return this.engine.growing(this.ids, this.measured);
  }

  get efficiency() {
    return this.engine.efficiency(this.figures, this.planned);
  }

  /** @param {number} id @param {boolean} on */
  tick(id, on) {
    const entry = this.entries.find((e) => e.id === id);
    if (!entry || entry.on === on) return;
    entry.on = on;
    this.#changed();
  }

  /** @param {number} from @param {number} to places in the list */
  move(from, to) {
    if (to < 0 || to >= this.entries.length || from === to) return;
    this.entries.splice(to, 0, ...this.entries.splice(from, 1));
    this.#changed();
  }

  /** @param {number|null} id */
  show(id) {
    if (this.current === id) return;
    this.current = id;
    this.dispatchEvent(new Event('current'));
  }

  #changed() {
    this.memo = null;
    this.dispatchEvent(new Event('list'));
  }
}
