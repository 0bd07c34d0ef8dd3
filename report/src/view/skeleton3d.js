import {
  CylinderGeometry,
  Group,
  InstancedMesh,
  Matrix4,
  MeshStandardMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
} from 'three';
import { colour } from '../theme.js';

const along = new Vector3(0, 1, 0);

/** The robot as rods between joints. */
export class Skeleton {
  /** @param {number[][][]} lines as many as there will be @param {number} radius of a rod, m */
  constructor(lines, radius) {
    this.radius = radius;
    const rods = lines.reduce((sum, line) => sum + Math.max(0, line.length - 1), 0);
    const joints = lines.reduce((sum, line) => sum + line.length, 0);
    this.rodMaterial = new MeshStandardMaterial({ roughness: 0.6, metalness: 0.1 });
    this.jointMaterial = new MeshStandardMaterial({ roughness: 0.5, metalness: 0.1 });
    this.rods = new InstancedMesh(new CylinderGeometry(1, 1, 1, 20), this.rodMaterial, Math.max(1, rods));
    this.joints = new InstancedMesh(new SphereGeometry(1, 20, 14), this.jointMaterial, Math.max(1, joints));
    this.rods.frustumCulled = this.joints.frustumCulled = false;
    this.root = new Group();
    this.root.add(this.rods, this.joints);
    this.paint();
  }

  paint() {
    this.rodMaterial.color.set(colour('rod'));
    this.jointMaterial.color.set(colour('joint'));
  }

  /** @param {number[][][]} lines */
  move(lines) {
    const matrix = new Matrix4(),
      turn = new Quaternion();
    let rod = 0,
      joint = 0;
    for (const line of lines) {
      const points = line.map((p) => new Vector3(p[0], p[1], p[2]));
      points.forEach((point, k) => {
        const size = this.radius * 1.5;
        if (joint < this.joints.instanceMatrix.count)
          this.joints.setMatrixAt(joint++, matrix.makeScale(size, size, size).setPosition(point));
        if (k === 0 || rod >= this.rods.instanceMatrix.count) return;
        const way = point.clone().sub(points[k - 1]);
        const length = way.length();
        turn.setFromUnitVectors(along, length > 1e-9 ? way.divideScalar(length) : along);
        this.rods.setMatrixAt(
          rod++,
          matrix.compose(
            point
              .clone()
              .add(points[k - 1])
              .multiplyScalar(0.5),
            turn,
            new Vector3(this.radius, Math.max(length, 1e-9), this.radius),
          ),
        );
      });
    }
    [this.rods.count, this.joints.count] = [rod, joint];
    this.rods.instanceMatrix.needsUpdate = this.joints.instanceMatrix.needsUpdate = true;
  }
}
