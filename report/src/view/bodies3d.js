import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CylinderGeometry,
  DoubleSide,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshStandardMaterial,
  PlaneGeometry,
  Quaternion,
  SphereGeometry,
  SRGBColorSpace,
  Vector3,
} from 'three';
import { colour } from '../theme.js';

/** @param {import('three').Object3D} object @param {number[]} x placement */
export function place(object, x) {
  object.position.set(x[0], x[1], x[2]);
  object.quaternion.set(x[3], x[4], x[5], x[6]);
}

/** @param {import('../types.js').Shape} shape @param {number} size of a plane's visible part, m */
function geometryOf(shape, size) {
  switch (shape.type) {
    case 'box':
      return new BoxGeometry(...shape.size);
    case 'sphere':
      return new SphereGeometry(shape.radius, 32, 20);
    case 'cylinder':
      return new CylinderGeometry(shape.radius, shape.radius, shape.length, 40).rotateX(Math.PI / 2);
    case 'plane':
      return new PlaneGeometry(size, size).applyQuaternion(
        new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), new Vector3(...shape.normal).normalize()),
      );
    default: {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(new Float32Array(shape.vertices), 3));
      geometry.setIndex(shape.triangles);
      const flat = geometry.toNonIndexed();
      flat.computeVertexNormals();
      return flat;
    }
  }
}

/** Solids of robot, tool and surroundings; one group a frame, so that a pose moves groups alone. */
export class Bodies {
  /** @param {import('../types.js').Report} report @param {import('./extent.js').Extent} extent */
  constructor(report, extent) {
    this.root = new Group();
    this.groups = report.frames.map(() => new Group());
    this.root.add(...this.groups);
    this.parts = report.bodies.map((body) => this.#part(body, extent));
    this.paint();
  }

  /** @param {import('../types.js').Body} body @param {import('./extent.js').Extent} extent */
  #part(body, extent) {
    const plane = body.shape.type === 'plane';
    const geometry = geometryOf(body.shape, 2.4 * extent.radius);
    const material = new MeshStandardMaterial({ roughness: 0.75, metalness: 0.05, side: DoubleSide });
    material.transparent = body.kind === 'obstacle';
    material.opacity = plane ? 0.1 : body.kind === 'obstacle' ? 0.45 : 1;
    material.depthWrite = body.kind !== 'obstacle';
    const mesh = new Mesh(geometry, material);
    place(mesh, body.placement);
    if (plane) this.#centre(mesh, /** @type {any} */ (body.shape).normal, extent);
    const edges = new LineSegments(
      new EdgesGeometry(geometry, 25),
      new LineBasicMaterial({ transparent: true, opacity: plane ? 0.25 : 0.55 }),
    );
    mesh.add(edges);
    this.groups[body.frame].add(mesh);
    return { body, mesh, material, line: edges.material };
  }

  /** An endless plane is drawn about the middle of the scene. */
  #centre(mesh, normal, extent) {
    const n = new Vector3(...normal).normalize().applyQuaternion(mesh.quaternion);
    const centre = new Vector3(...extent.centre);
    const height = centre.clone().sub(mesh.position).dot(n);
    mesh.position.copy(centre.addScaledVector(n, -height));
  }

  paint() {
    for (const { body, material, line } of this.parts) {
      if (body.colour) material.color.setRGB(...body.colour, SRGBColorSpace);
      else material.color.set(colour(body.kind));
      line.color.set(colour(`${body.kind}-edge`));
    }
    this.mark(this.marked ?? []);
  }

  /** Bodies that come nearest to each other glow. @param {string[]} names */
  mark(names) {
    this.marked = names;
    for (const { body, material } of this.parts) {
      material.emissive.set(names.includes(body.name) ? colour('now') : 'black');
      material.emissiveIntensity = 0.8;
    }
  }

  /** @param {number[][]} frames */
  move(frames) {
    frames.forEach((x, k) => this.groups[k] && place(this.groups[k], x));
  }
}
