import { Group, Mesh, MeshBasicMaterial, Plane, Raycaster, SphereGeometry, Vector2, Vector3 } from 'three';
import { colour } from '../theme.js';
import { place } from '../view/bodies3d.js';

/**
 * Grips at things that may be moved: a drag moves one across the floor, with Shift or "up and down" along z, of the frame in
 * which the file has its position: the measurement frame for instruments, for bodies of the cell that of the cell, which
 * moves in the picture where the base does.
 */
export class Handles {
  /**
   * @param {import('../view/scene3d.js').Scene3d} scene @param {import('./things.js').Thing[]} things
   * @param {{upright: () => boolean, moved: (thing: import('./things.js').Thing, position: number[]) => void}} use
   */
  constructor(scene, things, use) {
    this.scene = scene;
    this.use = use;
    const ball = new SphereGeometry(scene.picture.size * 0.02, 18, 12);
    const { cell } = scene.picture.report;
    this.still = new Group();
    this.cell = new Group();
    place(this.cell, cell.placement);
    for (const thing of things) {
      const grip = new Mesh(ball, new MeshBasicMaterial({ color: colour('yours'), transparent: true, opacity: 0.85, depthTest: false }));
      grip.position.set(...thing.position);
      grip.renderOrder = 5;
      grip.userData = thing;
      (thing.entry && !thing.station ? this.cell : this.still).add(grip);
    }
    scene.scene.add(this.still);
    scene.bodies.groups[cell.frame].add(this.cell);
    const shown = scene.onDraw;
    scene.onDraw = (project) => {
      shown?.(project);
      const at = (grip) => project(grip.getWorldPosition(new Vector3()).toArray());
      scene.canvas.dataset.grips = JSON.stringify(Object.fromEntries(this.#grips.map((grip) => [grip.userData.label, at(grip)])));
    };
    this.listeners = { pointerdown: (e) => this.#down(e), pointermove: (e) => this.#move(e), pointerup: (e) => this.#up(e), pointercancel: (e) => this.#up(e) };
    // Before the listeners that turn the picture.
    for (const [name, listener] of Object.entries(this.listeners)) scene.canvas.addEventListener(name, listener, { capture: true });
  }

  /** Where bodies are hidden, those of the cell cannot be dragged. */
  get #grips() {
    return [...this.still.children, ...(this.scene.bodies.root.visible ? this.cell.children : [])];
  }

  #ray(event) {
    const box = this.scene.canvas.getBoundingClientRect();
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height), this.scene.camera);
    return ray;
  }

  /** Where the pointer meets the plane of the drag, in the frame of the grip. @returns {Vector3|null} */
  #meets(event) {
    const toFrame = this.grip.parent.matrixWorld.clone().invert();
    return this.#ray(event).ray.applyMatrix4(toFrame).intersectPlane(this.plane, new Vector3());
  }

  #down(event) {
    const hit = this.#ray(event).intersectObjects(this.#grips)[0];
    if (!hit) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    this.grip = hit.object;
    const up = this.use.upright() || event.shiftKey || Boolean(this.grip.userData.plane);
    const toFrame = this.grip.parent.matrixWorld.clone().invert();
    const normal = up ? this.scene.camera.getWorldDirection(new Vector3()).transformDirection(toFrame).setZ(0).normalize() : new Vector3(0, 0, 1);
    this.plane = new Plane().setFromNormalAndCoplanarPoint(normal, this.grip.position);
    this.axes = up ? [false, false, true] : [true, true, false];
    this.from = this.grip.position.clone();
    this.offset = this.#meets(event)?.sub(this.from) ?? new Vector3();
    this.drawn = this.#drawnOf(this.grip.userData);
    this.scene.canvas.setPointerCapture(event.pointerId);
  }

  /** What the picture has of a thing. @param {import('./things.js').Thing} thing */
  #drawnOf(thing) {
    const { bodies, sights, picture } = this.scene;
    const own = thing.station && !thing.entry;
    const names = bodies.parts.filter(({ body }) => body.kind === 'obstacle' && (thing.entry ? body.name === thing.body : false));
    const cone = own ? sights.stations[picture.report.stations.findIndex((s) => s.name === thing.station && (s.instrument ?? '') === thing.instrument)] : undefined;
    return [...names.map((p) => p.mesh), cone].filter(Boolean).map((object) => ({ object, from: object.position.clone() }));
  }

  #move(event) {
    if (!this.grip) return;
    event.stopImmediatePropagation();
    const at = this.#meets(event);
    if (!at) return;
    at.sub(this.offset);
    const step = new Vector3(...this.axes.map((free, k) => (free ? at.getComponent(k) - this.from.getComponent(k) : 0)));
    this.grip.position.copy(this.from).add(step);
    const drawn = step.clone().applyQuaternion(this.grip.parent.quaternion);
    for (const { object, from } of this.drawn) object.position.copy(from).add(drawn);
    this.scene.request();
  }

  #up(event) {
    if (!this.grip) return;
    event.stopImmediatePropagation();
    const { grip, from } = this;
    this.grip = undefined;
    if (grip.position.distanceTo(from) > 1e-4) this.use.moved(grip.userData, grip.position.toArray());
  }
}
