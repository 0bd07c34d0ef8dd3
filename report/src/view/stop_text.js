import { duration } from '../text/units.js';

/** The stops that the robot is between. @param {import('./player.js').Player} player */
const around = ({ stops, place }) => ({
  before: [...stops].reverse().find((s) => s.index <= place),
  after: stops.find((s) => s.index > place),
});

/** Where a route ends: home, or the first pose again. */
const lastStop = ({ stops }, { report }) => (report.route?.closed && !report.route.from_home ? stops[0]?.id : 0);

/** Which bodies come nearest at the pose shown, or on the motion. @param {import('./player.js').Player} player
 * @param {import('../pose_list.js').PoseList} list */
export function nearestHere(player, list) {
  if (list.current !== null) return list.poses.get(list.current)?.nearest;
  const { before, after } = around(player);
  const from = before?.id ?? 0,
    to = after?.id ?? lastStop(player, list);
  return list.report.route?.motions.find((m) => m.from === from && m.to === to)?.nearest;
}

/** Where the robot is, in words. @param {import('./player.js').Player} player */
export function stopText(player) {
  const key = player.keyframe;
  if (!key) return 'No pose to show';
  const time = player.routed ? `, after ${duration(key.seconds)}` : '';
  if (player.pose) {
    const stop = player.stops.findIndex((s) => s.id === player.pose);
    return `Stop ${stop + 1} of ${player.stops.length}: pose ${player.pose}${time}`;
  }
  if (key.pose === 0 && Number.isInteger(player.place)) return `Home${time}`;
  const { before, after } = around(player);
  return `On the way from ${before ? `pose ${before.id}` : 'home'} to ${after ? `pose ${after.id}` : 'the end'}${time}`;
}
