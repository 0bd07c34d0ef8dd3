import { matricesOf } from './numerics/information.js';
import { PlanFigures } from './numerics/plan_figures.js';

/**
 * The list the reader works on: which poses, where, in which order, which of them a new plan must keep, and what they
 * tell. Events: "list" after a tick or a move, "current" when another pose is shown.
 */
export class PoseList extends EventTarget {
  /** @param {import('./types.js').Report} report */
  constructor(report) {
    super();
    this.report = report;
    this.engine = new PlanFigures(report.columns, matricesOf(report.information, report.columns.length));
    /** Poses measured before count whatever the reader ticks. */
    this.measured = report.plan.poses.filter((p) => p.measured).map((p) => p.id);
    this.planned = this.engine.of(this.engine.blocks.keys());
    this.current = /** @type {number|null} */ (null);
    this.#original = {
      poses: new Map(report.plan.poses.map((p) => [p.id, p])),
      keyframes: new Map(report.keyframes.filter((k) => k.pose).map((k) => [k.pose, k])),
      blocks: new Map(this.engine.blocks),
      pictures: new Map(report.cameras.flatMap((c) => c.pictures).map((p) => [p.pose, p.pixels])),
    };
    this.unreachable = new Map((report.route?.unreachable ?? []).map((u) => [u.pose, u.reason]));
    this.#restore();
    this.reset();
  }

  #original;

  #restore() {
    /** @type {Map<number, any>} */
    this.poses = new Map(this.#original.poses);
    this.keyframes = new Map(this.#original.keyframes);
    this.engine.blocks = new Map(this.#original.blocks);
    /** @type {Map<number, any[]>} what a camera sees at each pose */
    this.pictures = new Map(this.#original.pictures);
    /** @type {Map<number, string|null>} of moved poses: why one is not feasible, null: it is */
    this.moves = new Map();
    /** @type {Set<number>} */
    this.locked = this.#startLocked();
  }

  #startLocked() {
    return new Set(this.report.plan.poses.filter((p) => p.fixed).map((p) => p.id));
  }

  /** Poses to be measured, as the route or the plan has them; what cannot be reached comes last, ticked off. */
  #start() {
    const open = this.report.plan.poses.filter((p) => !p.measured).map((p) => p.id);
    const order = this.report.route ? this.report.route.order.filter((id) => open.includes(id)) : open;
    const rest = open.filter((id) => !order.includes(id));
    return [...order, ...rest].map((id) => ({ id, on: !this.unreachable.has(id) }));
  }

  reset() {
    this.#restore();
    this.entries = this.#start();
    this.#changed();
  }

  /** Whether poses, places or order are not the plan's. Locks are for the next plan and change no figure. */
  get changed() {
    const start = this.#start();
    return this.moves.size > 0 || this.entries.some((e, k) => e.id !== start[k].id || e.on !== start[k].on);
  }

  /** Whether there is anything to reset. */
  get touched() {
    const start = this.#startLocked();
    return this.changed || this.locked.size !== start.size || [...this.locked].some((id) => !start.has(id));
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

  /** A locked pose is one that the next plan has whatever its search finds. @param {number} id @param {boolean} on */
  lock(id, on) {
    if (on) this.locked.add(id);
    else this.locked.delete(id);
    this.#changed();
  }

  /** @param {number} from @param {number} to places in the list */
  move(from, to) {
    if (to < 0 || to >= this.entries.length || from === to) return;
    this.entries.splice(to, 0, ...this.entries.splice(from, 1));
    this.#changed();
  }

  /**
   * Puts a pose where the program has judged it, which locks it: nobody moves a pose that the next plan may drop.
   * @param {number} id @param {import('./types.js').JudgedPose} judged
   */
  place(id, { reason, pose, keyframe, packed, pixels }) {
    const { poses, keyframes } = this.#original;
    const there = { contribution: undefined, efficiency_without: undefined, id, moved: true };
    this.poses.set(id, { ...poses.get(id), nearest: undefined, ...pose, ...there });
    if (keyframes.has(id)) this.keyframes.set(id, { ...keyframes.get(id), ...keyframe, pose: id, seconds: keyframes.get(id).seconds });
    this.engine.blocks.set(id, packed);
    this.pictures.set(id, pixels);
    this.moves.set(id, reason);
    this.locked.add(id);
    this.#changed();
  }

  /** Back to where the plan has it. @param {number} id */
  putBack(id) {
    const { poses, keyframes, blocks, pictures } = this.#original;
    this.poses.set(id, poses.get(id));
    if (keyframes.has(id)) this.keyframes.set(id, keyframes.get(id));
    this.engine.blocks.set(id, blocks.get(id));
    this.pictures.set(id, pictures.get(id));
    this.moves.delete(id);
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
