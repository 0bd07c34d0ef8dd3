import { h, table } from '../dom.js';
import { fixed } from '../text/units.js';

/** Where base, stations, camera and board stand by the estimate, as other programs ask for it.
 * @param {any} c calibration.json */
export function calibratedFrames(c) {
  if (!(c.frames?.length > 0)) return null;
  const rows = c.frames.map((f) => [
    f.name,
    `the ${f.in}`,
    ...f.position.map((v) => fixed(1e3 * v, 4)),
    ...f.quaternion_xyzw.map((v) => fixed(v, 8)),
  ]);
  const head = ['frame', 'in the frame of', '#x mm', '#y mm', '#z mm', '#qx', '#qy', '#qz', '#qw'];
  return h('div', {}, h('h3', {}, 'Where frames stand, and how they are turned'), table(head, rows, 'Frames'));
}
