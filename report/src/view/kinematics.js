import { transformed } from './extent.js';

/** Placements x y z qx qy qz qw. @param {number[]} a @param {number[]} b @returns {number[]} a · b */
export function composed(a, b) {
  const [ax, ay, az, aw] = a.slice(3);
  const [bx, by, bz, bw] = b.slice(3);
  return [
    ...transformed(a, b.slice(0, 3)),
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}
