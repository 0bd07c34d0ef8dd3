import {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  Color,
  Group,
  InstancedMesh,
  Line,
  LineBasicMaterial,
  LineDashedMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  Points,
  PointsMaterial,
  ConeGeometry,
  SphereGeometry,
  Vector3,
} from 'three';
import { colour, viridisAt } from '../theme.js';

/** The tip at every pose of the plan; the pose shown is larger, poses that are ticked off are pale. */
export class Tips {
  /** @param {import('./picture.js').Picture} picture */
  constructor(picture) {
    this.picture = picture;
    const ball = new SphereGeometry(1, 18, 12);
    this.mesh = new InstancedMesh(ball, new MeshBasicMaterial({ transparent: true }), Math.max(1, picture.tips.length));
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 2;
    this.mesh.count = picture.tips.length;
    // The tip shown is often inside a hand or a tool: it shines through.
    this.now = new Mesh(ball, new MeshBasicMaterial({ transparent: true, depthTest: false }));
    this.now.renderOrder = 3;
    this.root = new Group();
    this.root.add(this.mesh, this.now);
  }

  /** @param {number|null} current @param {Set<number>} on */
  update(current, on) {
    const matrix = new Matrix4();
    const { tips, dot } = this.picture;
    tips.forEach((tip, k) => {
      this.mesh.setMatrixAt(k, matrix.makeScale(dot, dot, dot).setPosition(new Vector3(...tip.position)));
      this.mesh.setColorAt(k, new Color(colour(on.has(tip.id) ? (tip.colour ?? 'tip') : 'off')));
    });
    this.mesh.instanceMatrix.needsUpdate = true;
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
    this.mesh.computeBoundingSphere();
    const shown = tips.find((tip) => tip.id === current);
    this.now.visible = shown !== undefined;
    if (!shown) return;
    this.now.position.set(...shown.position);
    this.now.scale.setScalar(1.9 * dot);
    this.now.material.color.set(colour('now'));
  }
}

/** A round dot for point clouds. */
function disc() {
  const canvas = Object.assign(document.createElement('canvas'), { width: 32, height: 32 });
  const context = canvas.getContext('2d');
  context.fillStyle = '#fff';
  context.arc(16, 16, 15, 0, 2 * Math.PI);
  context.fill();
  return new CanvasTexture(canvas);
}

/** @param {number[]} positions flat @param {number[]} sensitivity */
export function candidateCloud(positions, sensitivity) {
  const [low, high] = [Math.min, Math.max].map((end) => sensitivity.reduce((a, b) => end(a, b)));
  const colours = new Float32Array(3 * sensitivity.length);
  const c = new Color();
  sensitivity.forEach((s, k) => {
    const [r, g, b] = viridisAt(high > low ? (s - low) / (high - low) : 1);
    c.setRGB(r / 255, g / 255, b / 255, 'srgb').toArray(colours, 3 * k);
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute('color', new BufferAttribute(colours, 3));
  return new Points(
    geometry,
    new PointsMaterial({
      size: 6,
      sizeAttenuation: false,
      vertexColors: true,
      map: disc(),
      alphaTest: 0.3,
      transparent: true,
      opacity: 0.7,
    }),
  );
}

/** The shortest line between the two bodies that are nearest to each other. */
export class GapMark {
  /** @param {number} radius m */
  constructor(radius) {
    this.material = new MeshBasicMaterial({ depthTest: false, transparent: true });
    this.lineMaterial = new LineBasicMaterial({ depthTest: false, transparent: true });
    const ball = new SphereGeometry(radius, 16, 12);
    this.ends = [new Mesh(ball, this.material), new Mesh(ball, this.material)];
    this.line = new Line(new BufferGeometry(), this.lineMaterial);
    this.root = new Group();
    this.root.add(...this.ends, this.line);
    this.root.children.forEach((child) => (child.renderOrder = 4));
    this.line.frustumCulled = false;
    this.paint();
  }

  paint() {
    this.material.color.set(colour('now'));
    this.lineMaterial.color.set(colour('now'));
  }

  /** @param {import('./picture.js').Gap|undefined} gap */
  move(gap) {
    this.root.visible = Boolean(gap);
    if (!gap) return;
    this.ends.forEach((end, k) => end.position.set(...gap.points[k]));
    this.line.geometry.dispose();
    this.line.geometry = new BufferGeometry().setFromPoints(gap.points.map((p) => new Vector3(...p)));
  }
}

/** A camera's field of view, its board and the points on it. */
export class CameraMark {
  constructor() {
    this.view = new LineBasicMaterial({ transparent: true, opacity: 0.8 });
    this.board = new LineBasicMaterial();
    this.points = new PointsMaterial({ size: 5, sizeAttenuation: false });
    const empty = () => new BufferGeometry();
    this.parts = {
      view: new LineSegments(empty(), this.view),
      board: new LineSegments(empty(), this.board),
      points: new Points(empty(), this.points),
    };
    this.root = new Group();
    for (const part of Object.values(this.parts)) {
      part.frustumCulled = false;
      this.root.add(part);
    }
    this.paint();
  }

  paint() {
    this.view.color.set(colour('station'));
    this.board.color.set(colour('target'));
    this.points.color.set(colour('target'));
  }

  /** @param {import('./picture.js').CameraLines|undefined} lines @param {boolean} visible */
  move(lines, visible) {
    this.root.visible = visible && Boolean(lines);
    if (!lines) return;
    for (const [name, part] of Object.entries(this.parts)) {
      part.geometry.dispose();
      part.geometry = new BufferGeometry().setFromPoints(lines[name].map((p) => new Vector3(...p)));
    }
  }
}

/** Targets on the robot, stations, and the lines between them. */
export class Sights {
  /** @param {import('../types.js').Report} report @param {number} radius m */
  constructor(report, radius) {
    this.root = new Group();
    this.lines = new Group();
    this.targetMaterial = new MeshStandardMaterial({ roughness: 0.3 });
    this.targets = report.targets.map(() => new Mesh(new SphereGeometry(radius, 16, 12), this.targetMaterial));
    this.stationMaterial = new MeshStandardMaterial({ roughness: 0.6 });
    this.stations = report.stations.map((station) => {
      const cone = new Mesh(new ConeGeometry(radius * 1.8, radius * 4, 24).rotateX(Math.PI / 2), this.stationMaterial);
      cone.position.set(...station.placement.slice(0, 3));
      return cone;
    });
    this.root.add(this.lines, ...this.targets, ...this.stations);
    this.seen = new LineBasicMaterial();
    this.hidden = new LineDashedMaterial({ dashSize: radius * 3, gapSize: radius * 2 });
    this.paint();
  }

  paint() {
    this.targetMaterial.color.set(colour('target'));
    this.stationMaterial.color.set(colour('station'));
    this.seen.color.set(colour('sight'));
    this.hidden.color.set(colour('hidden'));
  }

  /** @param {(number[]|null)[]} targets @param {import('./sights.js').Sight[]} sights */
  move(targets, sights) {
    this.targets.forEach((mesh, k) => {
      mesh.visible = Boolean(targets[k]);
      if (targets[k]) mesh.position.set(...targets[k]);
    });
    for (const line of this.lines.children) line.geometry.dispose();
    this.lines.clear();
    for (const sight of sights) {
      const geometry = new BufferGeometry().setFromPoints([new Vector3(...sight.from), new Vector3(...sight.to)]);
      const line = new Line(geometry, sight.hidden ? this.hidden : this.seen);
      if (sight.hidden) line.computeLineDistances();
      this.lines.add(line);
    }
  }
}
