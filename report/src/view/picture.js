import { exaggerated, middleOf } from './interpolate.js';
import { bodyCorners, extentOf, movement, sceneExtent, tipExtent } from './extent.js';

/**
 * What a view shows at one moment.
 * @typedef {object} Shown
 * @property {import('./interpolate.js').Drawn|undefined} drawn
 * @property {import('./sights.js').Sight[]} sights
 * @property {number|null} current pose id
 * @property {Set<number>} on ids of ticked poses
 * @property {string[]} nearest names of the two bodies that come nearest to each other here
 * @property {Gap|undefined} gap where they do
 * @property {CameraLines|undefined} camera
 * @property {{bodies: boolean, sights: boolean, candidates: boolean}} layers
 */

/**
 * @typedef {{points: [number[], number[]], distance: number}} Gap
 * @typedef {{view: number[][], board: number[][], points: number[][]}} CameraLines view and board are pairs of points
 */

/** Movements below this share of the scene's size are drawn larger. */
const smallMovement = 0.04;

/** What both views, WebGL and SVG, draw: the scene's size, the tips, how much larger movements appear than they are. */
export class Picture {
  /**
   * @param {import('../types.js').Report} report
   * @param {(id: number) => string|undefined} [colourOf] name of a pose's colour (theme.js); without one it is that of all tips
   */
  constructor(report, colourOf = () => undefined) {
    this.report = report;
    this.colourOf = colourOf;
    this.stops = report.keyframes.filter((k) => k.pose);
    this.rest = this.stops.length > 0 ? middleOf(this.stops) : undefined;
    this.factor = this.possibleFactor = this.#suggestedFactor();
    this.extent = sceneExtent(report);
    this.#measure();
  }

  /** 1, or a round number where nothing would be seen to move. */
  #suggestedFactor() {
    if (this.stops.length < 2) return 1;
    const moving = movement(this.stops),
      all = sceneExtent(this.report).radius;
    if (!(moving > 0) || moving > smallMovement * all) return 1;
    const wanted = (3 * smallMovement * all) / moving;
    const decade = 10 ** Math.floor(Math.log10(wanted));
    return Math.max(1, ([5, 2, 1].find((d) => d * decade <= wanted) ?? 1) * decade);
  }

  #measure() {
    const { report } = this;
    // The robot alone gives sizes of dots and rods; a station far away must not blow them up.
    const robot = this.stops.flatMap((k) => [k.tip.slice(0, 3), ...k.lines.flat()]);
    this.size = robot.length > 0 ? 2 * extentOf(robot).radius : 2 * this.extent.radius;
    const decade = 10 ** Math.floor(Math.log10(this.extent.radius / 2));
    this.grid = [5, 2, 1].map((d) => d * decade).find((d) => d <= this.extent.radius / 2) ?? decade;
    const first = report.keyframes[0];
    const floors = report.bodies
      .filter((b) => b.shape.type === 'plane' && b.frame === 0)
      .filter(
        (b) => /** @type {any} */ (b.shape).normal[2] > 0.99 && Math.hypot(b.placement[3], b.placement[4]) < 1e-3,
      );
    const solids = first ? report.bodies.flatMap((b) => bodyCorners(b, first.frames)) : [];
    this.ground = floors.length > 0 ? floors[0].placement[2] : Math.min(this.extent.low[2], ...solids.map((p) => p[2]));
    this.tips = this.stops
      .filter((k, n, all) => all.findIndex((other) => other.pose === k.pose) === n)
      .map((k) => ({ id: /** @type {number} */ (k.pose), position: this.enlarged(k.tip.slice(0, 3)), colour: this.colourOf(k.pose) }));
  }

  /** @param {number} factor */
  enlarge(factor) {
    this.factor = factor;
    this.#measure();
  }

  /** @param {import('./interpolate.js').Drawn|undefined} drawn */
  enlargedDrawing(drawn) {
    return drawn && this.rest ? exaggerated(drawn, this.rest, this.factor) : drawn;
  }

  /** A pose that the reader moved. @param {number} id @param {number[]} tip */
  moveTip(id, tip) {
    const shown = this.tips.find((t) => t.id === id);
    if (shown) shown.position = this.enlarged(tip.slice(0, 3));
  }

  /** Flat coordinates of points that move with the tip. @param {number[]} flat */
  enlarged(flat) {
    if (this.factor === 1 || !this.rest) return flat;
    const rest = this.rest.tip;
    return flat.map((value, k) => rest[k % 3] + this.factor * (value - rest[k % 3]));
  }

  /** Radius of a tip's dot: small beside the robot, and beside the cloud of them. */
  get dot() {
    return Math.min(0.009 * this.size, this.tipExtent.radius / 14);
  }

  /** Tips of the poses, as they are drawn. */
  get tipExtent() {
    return this.tips.length > 0 ? extentOf(this.tips.map((t) => t.position)) : this.extent;
  }
}
