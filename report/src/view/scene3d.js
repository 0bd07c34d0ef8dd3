import {
  DirectionalLight,
  GridHelper,
  HemisphereLight,
  AxesHelper,
  PerspectiveCamera,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { colour } from '../theme.js';
import { quantity } from '../text/units.js';
import { Bodies } from './bodies3d.js';
import { Skeleton } from './skeleton3d.js';
import { directions } from './directions.js';
import { onClick, orbit } from './scene_controls.js';
import { CameraMark, GapMark, Sights, Tips, candidateCloud } from './marks3d.js';

/** The 3-D picture. Drawn only when something has changed. */
export class Scene3d {
  /**
   * @param {HTMLElement} holder
   * @param {import('./picture.js').Picture} picture
   * @param {(id: number) => void} pick called with the pose whose tip was clicked
   */
  constructor(holder, picture, pick) {
    this.picture = picture;
    this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.canvas = this.renderer.domElement;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(40, 1, picture.extent.radius / 500, picture.extent.radius * 60);
    this.camera.up.set(0, 0, 1);
    this.legend = `axes: x red, y green, z blue; grid ${quantity(picture.grid, 'm')}`;
    holder.append(this.canvas);
    this.#light();
    this.#furnish();
    this.controls = orbit(this);
    onClick(this, (at) => this.#pick(at, pick));
    this.look('free', picture.extent);
    this.paint();
  }

  #light() {
    this.scene.add(new HemisphereLight(0xffffff, 0x8a8f99, 2.2));
    const sun = new DirectionalLight(0xffffff, 1.6);
    sun.position.set(1, -0.8, 2);
    this.scene.add(sun);
  }

  #furnish() {
    const { report, extent } = this.picture;
    const unit = this.picture.size;
    const solid = report.bodies.some((b) => b.kind === 'robot');
    this.bodies = new Bodies(report, extent);
    this.skeleton = new Skeleton(this.picture.rest?.lines ?? [], unit * (solid ? 0.004 : 0.009));
    this.tips = new Tips(this.picture);
    this.sights = new Sights(report, unit * 0.008);
    this.gap = new GapMark(unit * 0.006);
    this.cameraMark = new CameraMark();
    for (const part of [this.bodies, this.skeleton, this.tips, this.sights, this.gap, this.cameraMark])
      this.scene.add(part.root);
    const step = this.picture.grid;
    this.grid = new GridHelper(step * 20, 20);
    this.grid.rotation.x = Math.PI / 2;
    this.grid.position.set(
      Math.round(extent.centre[0] / step) * step,
      Math.round(extent.centre[1] / step) * step,
      this.picture.ground,
    );
    this.grid.material.transparent = true;
    this.grid.material.opacity = 0.5;
    this.scene.add(this.grid, new AxesHelper(unit * 0.12));
  }

  /** @param {Vector2} at @param {(id: number) => void} pick */
  #pick(at, pick) {
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    const hit = ray.intersectObject(this.tips.mesh)[0];
    if (hit?.instanceId !== undefined) pick(this.picture.tips[hit.instanceId].id);
  }

  /** @param {keyof typeof directions} from @param {import('./extent.js').Extent} extent */
  look(from, extent) {
    this.looking = { from, extent };
    const centre = new Vector3(...extent.centre);
    const direction = new Vector3(...directions[from]).normalize();
    const points = extent.points.map((p) => new Vector3(...p));
    const inside = (distance) => {
      this.camera.position.copy(centre).addScaledVector(direction, distance);
      this.camera.lookAt(centre);
      this.camera.updateMatrixWorld();
      return points.every((point) => {
        const p = point.clone().project(this.camera);
        return p.z < 1 && Math.max(Math.abs(p.x), Math.abs(p.y)) < 0.9;
      });
    };
    let distance = 0.5 * extent.radius;
    while (!inside(distance) && distance < 50 * extent.radius) distance *= 1.05;
    this.controls.target.copy(centre);
    this.controls.update();
    this.request();
  }

  /** @param {import('./picture.js').Shown} shown */
  show(shown) {
    if (shown.drawn) {
      this.bodies.move(shown.drawn.frames);
      this.skeleton.move(shown.drawn.lines);
      this.sights.move(shown.drawn.targets, shown.sights);
    }
    this.tips.update(shown.current, shown.on);
    this.bodies.mark(shown.nearest);
    this.gap.move(shown.layers.bodies ? shown.gap : undefined);
    this.cameraMark.move(shown.camera, shown.layers.sights);
    this.bodies.root.visible = shown.layers.bodies;
    this.sights.lines.visible = shown.layers.sights;
    if (shown.layers.candidates && this.cloudFactor !== this.picture.factor) {
      this.scene.remove(...(this.cloud ? [this.cloud] : []));
      this.cloudFactor = this.picture.factor;
      const { positions, sensitivity } = this.picture.report.candidates;
      this.cloud = candidateCloud(this.picture.enlarged(positions), sensitivity);
      this.scene.add(this.cloud);
    }
    if (this.cloud) this.cloud.visible = shown.layers.candidates;
    // Among thousands of candidates the poses chosen would not be seen.
    this.tips.mesh.material.depthTest = !shown.layers.candidates;
    this.request();
  }

  paint() {
    this.renderer.setClearColor(colour('scene'));
    for (const part of [this.bodies, this.skeleton, this.sights, this.gap, this.cameraMark]) part.paint();
    const lines = this.grid.geometry.getAttribute('color');
    this.grid.material.vertexColors = lines === undefined;
    this.grid.material.color.set(colour('grid'));
    this.grid.material.needsUpdate = true;
    this.request();
  }

  /** @param {number} width @param {number} height */
  resize(width, height) {
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.turned) this.look(this.looking.from, this.looking.extent);
    this.draw();
  }

  /** Looks from where another scene was looked at. @param {Scene3d} other */
  lookLike(other) {
    this.turned = other.turned;
    this.looking = other.looking;
    this.camera.position.copy(other.camera.position);
    this.controls.target.copy(other.controls.target);
    this.controls.update();
  }

  dispose() {
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.canvas.remove();
  }

  request() {
    this.waiting ??= requestAnimationFrame(() => this.draw());
  }

  draw() {
    cancelAnimationFrame(this.waiting);
    this.waiting = undefined;
    this.renderer.render(this.scene, this.camera);
    this.onDraw?.((p) => this.#project(p));
  }

  /** @param {number[]} p @returns {[number, number]|null} pixels from the upper left corner */
  #project(p) {
    const v = new Vector3(...p).project(this.camera);
    const { clientWidth, clientHeight } = this.canvas;
    return v.z > 1 ? null : [((v.x + 1) / 2) * clientWidth, ((1 - v.y) / 2) * clientHeight];
  }
}
