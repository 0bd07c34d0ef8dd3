import { svg } from '../dom.js';
import { bodyCorners } from './extent.js';
import { directions } from './directions.js';

const boxEdges = [
  [0, 1],
  [1, 3],
  [3, 2],
  [2, 0],
  [4, 5],
  [5, 7],
  [7, 6],
  [6, 4],
  [0, 4],
  [1, 5],
  [2, 6],
  [3, 7],
];

/** The same picture in lines, for browsers without WebGL: parallel projection, bodies as their boxes. */
export class SvgView {
  /**
   * @param {HTMLElement} holder @param {import('./picture.js').Picture} picture @param {(id: number) => void} pick
   */
  constructor(holder, picture, pick) {
    this.picture = picture;
    this.pick = pick;
    this.canvas = svg('svg', { class: 'wire', tabindex: 0 });
    holder.append(this.canvas);
    this.legend = '';
    [this.width, this.height] = [600, 400];
    this.canvas.addEventListener('keydown', (event) => this.#key(event));
    this.canvas.addEventListener(
      'pointermove',
      (event) => event.buttons === 1 && this.#turn(-event.movementX, event.movementY),
    );
    this.look('free', picture.extent);
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const turns = { ArrowLeft: [12, 0], ArrowRight: [-12, 0], ArrowUp: [0, 10], ArrowDown: [0, -10] };
    const zooms = { '+': 0.85, '=': 0.85, '-': 1 / 0.85 };
    if (zooms[event.key]) this.span = this.span.map((s) => s * zooms[event.key]);
    else if (!turns[event.key]) return;
    event.preventDefault();
    this.#turn(...(turns[event.key] ?? [0, 0]));
  }

  /** @param {number} right @param {number} up pixels */
  #turn(right, up) {
    this.azimuth += right / 100;
    this.elevation = Math.min(1.56, Math.max(-1.56, this.elevation + up / 100));
    this.draw();
  }

  /** @param {keyof typeof directions} from @param {import('./extent.js').Extent} extent */
  look(from, extent) {
    const [x, y, z] = directions[from];
    this.azimuth = Math.atan2(y, x);
    this.elevation = Math.atan2(z, Math.hypot(x, y));
    this.centre = extent.centre;
    const points = extent.points.map((p) => this.#turned(p));
    this.span = [0, 1].map((k) => 2.2 * Math.max(1e-9, ...points.map((p) => Math.abs(p[k]))));
    this.draw();
  }

  /** @param {import('./picture.js').Shown} shown */
  show(shown) {
    this.shown = shown;
    this.draw();
  }

  paint() {}

  /** @param {SvgView} other */
  lookLike({ azimuth, elevation, centre, span }) {
    Object.assign(this, { azimuth, elevation, centre, span });
  }

  dispose() {
    this.canvas.remove();
  }

  /** @param {number} width @param {number} height */
  resize(width, height) {
    [this.width, this.height] = [width, height];
    this.canvas.setAttribute('viewBox', `0 0 ${width} ${height}`);
    this.draw();
  }

  /** To the right and upwards, m from the middle. @param {number[]} p @returns {[number, number]} */
  #turned(p) {
    const [x, y, z] = p.map((v, k) => v - this.centre[k]);
    const [ca, sa, ce, se] = [
      Math.cos(this.azimuth),
      Math.sin(this.azimuth),
      Math.cos(this.elevation),
      Math.sin(this.elevation),
    ];
    return [-sa * x + ca * y, -se * (ca * x + sa * y) + ce * z];
  }

  /** @param {number[]} p @returns {[number, number]} pixels */
  #project(p) {
    const scale = Math.min(this.width / this.span[0], this.height / this.span[1]);
    const [right, up] = this.#turned(p);
    return [this.width / 2 + scale * right, this.height / 2 - scale * up];
  }

  /** @param {number[][]} points @param {string} name of the class */
  #line(points, name) {
    return svg('polyline', {
      class: name,
      points: points
        .map((p) =>
          this.#project(p)
            .map((v) => v.toFixed(1))
            .join(','),
        )
        .join(' '),
    });
  }

  /** @param {number[]} p @param {string} name @param {number} radius px */
  #dot(p, name, radius) {
    const [cx, cy] = this.#project(p);
    return svg('circle', { class: name, cx: cx.toFixed(1), cy: cy.toFixed(1), r: radius });
  }

  draw() {
    const { shown, picture } = this;
    if (!shown) return;
    const parts = [];
    const drawn = shown.drawn;
    if (drawn && shown.layers.bodies)
      for (const body of picture.report.bodies) {
        const corners = bodyCorners(body, drawn.frames);
        if (corners.length > 0)
          for (const [a, b] of boxEdges) parts.push(this.#line([corners[a], corners[b]], `edge ${body.kind}`));
      }
    if (shown.layers.candidates) parts.push(...this.#candidates());
    if (shown.layers.sights)
      for (const s of shown.sights) parts.push(this.#line([s.from, s.to], s.hidden ? 'sight hidden' : 'sight'));
    if (shown.gap && shown.layers.bodies) parts.push(this.#line(shown.gap.points, 'gap'));
    if (shown.camera && shown.layers.sights)
      for (const name of ['view', 'board'])
        for (let k = 0; k < shown.camera[name].length; k += 2)
          parts.push(this.#line(shown.camera[name].slice(k, k + 2), `camera-${name}`));
    for (const station of picture.report.stations) parts.push(this.#dot(station.placement, 'station', 6));
    for (const line of drawn?.lines ?? [])
      parts.push(this.#line(line, 'rod'), ...line.map((p) => this.#dot(p, 'joint', 3.5)));
    for (const target of drawn?.targets ?? []) if (target) parts.push(this.#dot(target, 'target', 3));
    for (const tip of picture.tips) {
      const dot = this.#dot(
        tip.position,
        `tip ${tip.id === shown.current ? 'now' : shown.on.has(tip.id) ? '' : 'off'}`,
        tip.id === shown.current ? 7 : 4,
      );
      if (tip.colour && tip.id !== shown.current && shown.on.has(tip.id)) dot.style.fill = `var(--${tip.colour})`;
      dot.addEventListener('click', () => this.pick(tip.id));
      parts.push(dot);
    }
    this.canvas.replaceChildren(...parts);
    this.onDraw?.((p) => this.#project(p));
  }

  /** Every so many: thousands of circles make a browser slow. */
  #candidates() {
    const { positions, sensitivity } = this.picture.report.candidates;
    const flat = this.picture.enlarged(positions);
    const step = Math.ceil(sensitivity.length / 1500);
    const highest = sensitivity.reduce((a, b) => Math.max(a, b), 1e-12);
    const dots = [];
    for (let k = 0; k < sensitivity.length; k += step) {
      const dot = this.#dot(flat.slice(3 * k, 3 * k + 3), 'candidate', 2);
      dot.style.opacity = String(0.15 + (0.85 * sensitivity[k]) / highest);
      dots.push(dot);
    }
    return dots;
  }
}
