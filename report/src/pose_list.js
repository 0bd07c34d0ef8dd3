import { Neighbours } from './numerics/neighbours.js';
import { PlanFigures } from './numerics/plan_figures.js';
import { armAt, nearby } from './view/kinematics.js';

/**
 * The list the reader works on: which poses, where, in which order, which of them a new plan must keep, and what they
 * tell. Events: "list" after a tick or a move, "current" when another pose is shown.
 */
export class PoseList extends EventTarget {
  /** @param {import('./types.js').Report} report */
  constructor(report) {
    super();
    this.report = report;
    this.engine = new PlanFigures(report.columns, report.information);
    this.neighbours = new Neighbours(report.neighbours, report.columns.length);
    /** Poses measured before count whatever the reader ticks. */
    this.measured = report.plan.poses.filter((p) => p.measured).map((p) => p.id);
    this.planned = this.engine.of(this.engine.blocks.keys());
    this.current = /** @type {number|null} */ (null);
    this.#original = {
      poses: new Map(report.plan.poses.map((p) => [p.id, p])),
      keyframes: new Map(report.keyframes.filter((k) => k.pose).map((k) => [k.pose, k])),
      blocks: new Map(this.engine.blocks),
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
    /** @type {Map<number, number[]>} steps of each coordinate from where the plan has the pose */
    this.moves = new Map();
    /** @type {Set<number>} */
    this.locked = new Set(this.report.plan.poses.filter((p) => p.fixed).map((p) => p.id));
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

  get changed() {
    const start = this.#start();
    return this.moves.size > 0 || this.entries.some((e, k) => e.id !== start[k].id || e.on !== start[k].on);
  }

  /** Ids of the ticked poses in order. */
  get ids() {
    return this.entries.filter((e) => e.on).map((e) => e.id);
  }

  /** Ticked poses that were moved to where nothing is known of their information: figures leave them out. */
  get unknown() {
    return this.ids.filter((id) => this.moves.has(id) && !this.known(id)?.told);
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

  /** Steps of a pose from where the plan has it. @param {number} id @returns {number[]} */
  steps(id) {
    return this.moves.get(id) ?? (this.report.neighbours?.coordinates ?? []).map(() => 0);
  }

  /** Coordinates that the reader may move, with their steps. @param {number} id */
  coordinates(id) {
    return this.neighbours.coordinates(id, this.#original.poses.get(id).configuration);
  }

  /** What is known of a pose where it is now; null: nothing. @param {number} id */
  known(id) {
    return this.neighbours.place(id, this.steps(id));
  }

  /** Moves a pose, which locks it: nobody moves a pose that the next plan may drop.
   * @param {number} id @param {number} coordinate @param {number} step from where the plan has it */
  moveTo(id, coordinate, step) {
    const k = this.steps(id).map((old, j) => (j === coordinate ? step : old));
    if (k.every((v) => v === 0)) this.moves.delete(id);
    else this.moves.set(id, k);
    this.locked.add(id);
    this.#place(id, k);
    this.#changed();
  }

  /** Back to where the plan has it. @param {number} id */
  putBack(id) {
    this.moves.delete(id);
    this.#place(id, this.steps(id));
    this.#changed();
  }

  /** @param {number} id @param {number[]} k */
  #place(id, k) {
    const { poses, keyframes, blocks } = this.#original;
    const [pose, keyframe, own] = [poses.get(id), keyframes.get(id), blocks.get(id)];
    if (!this.moves.has(id)) {
      this.poses.set(id, pose);
      if (keyframe) this.keyframes.set(id, keyframe);
      this.engine.blocks.set(id, own);
      return;
    }
    const configuration = [...pose.configuration];
    this.coordinates(id).forEach(({ index, step }, j) => {
      if (k[j] !== 0) configuration[index] = pose.configuration[index] + k[j] * step;
    });
    const known = this.neighbours.place(id, k);
    const drawn = keyframe && this.#drawn(id, keyframe, configuration, k);
    this.poses.set(id, {
      ...pose,
      configuration,
      moved: true,
      actuators: undefined,
      targets: undefined,
      contribution: undefined,
      efficiency_without: undefined,
      tool_pose: drawn && this.report.chain ? { position: drawn.tip.slice(0, 3) } : undefined,
      nearest: known?.nearest,
    });
    if (drawn) this.keyframes.set(id, { ...keyframe, ...drawn });
    this.engine.blocks.set(id, known?.told ? this.neighbours.information(id, k, own) : new Float64Array(own.length));
  }

  #drawn(id, keyframe, configuration, k) {
    if (this.report.chain) return armAt(this.report.chain, configuration);
    const { reach, poses } = this.report.neighbours;
    const full = poses.find((p) => p.id === id).drawn;
    return nearby(keyframe, full, k.map((steps) => steps / reach));
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
