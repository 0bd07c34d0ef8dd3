import { duration } from '../text/units.js';

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
  const before = [...player.stops].reverse().find((s) => s.index <= player.place);
  const after = player.stops.find((s) => s.index > player.place);
  return `On the way from ${before ? `pose ${before.id}` : 'home'} to ${after ? `pose ${after.id}` : 'the end'}${time}`;
}
