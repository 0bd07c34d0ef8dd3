import { h } from '../dom.js';
import { choiceTexts } from '../text/choices.js';
import { nearestText } from '../text/sentences.js';
import { coordinate, percent, quantity } from '../text/units.js';

/**
 * What there is to know of the pose that is shown.
 * @param {import('../pose_list.js').PoseList} list
 */
export function poseCard(list) {
  const pose = list.poses.get(list.current ?? -1);
  if (!pose) return [h('p', { class: 'note' }, 'Joint values are shown where the robot stands still.')];
  const parts = [];
  if (list.keyframes.size > 0 && !list.keyframes.has(pose.id))
    parts.push(h('p', { class: 'note' }, `Not drawn: ${list.unreachable.get(pose.id) ?? 'the route leaves it out'}.`));
  parts.push(
    h(
      'dl',
      { class: 'values' },
      ...coordinates(pose, list.report.actuator_units ?? {}).map(([name, value]) =>
        h('div', {}, h('dt', {}, name), h('dd', {}, value)),
      ),
    ),
  );
  const facts = [
    ...choiceTexts(pose),
    pose.contribution !== undefined && `${percent(pose.contribution)} of all information`,
    tipText(pose),
    pose.nearest && nearestText(pose.nearest),
  ].filter(Boolean);
  if (facts.length > 0) parts.push(h('p', { class: 'note' }, `${facts.join(' · ')}.`));
  const sights = sightText(pose);
  if (sights) parts.push(h('p', { class: 'note' }, sights));
  return parts;
}

/** @param {any} pose @param {Object<string, string>} actuatorUnits */
function coordinates(pose, actuatorUnits) {
  const own = (pose.names ?? []).map((name, k) => [name, coordinate(pose.configuration[k], pose.units[k])]);
  const driven = Object.entries(pose.actuators ?? {}).map(([name, value]) => [
    name,
    actuatorUnits[name] ? coordinate(value, actuatorUnits[name]) : String(Number(value.toPrecision(6))),
  ]);
  return [...own, ...driven];
}

/** @param {any} pose */
function tipText(pose) {
  const p = pose.tool_pose?.position;
  return p ? `tip at ${p.map((v) => quantity(v, 'm', 5).replace(' mm', '')).join(', ')} mm` : '';
}

/** @param {any} pose */
function sightText(pose) {
  const judged = (pose.targets ?? []).filter((t) => t.visible !== null);
  if (judged.length === 0) return '';
  const hidden = judged.filter((t) => !t.visible);
  if (hidden.length === 0) return `All ${judged.length} targets are seen.`;
  return `${judged.length - hidden.length} of ${judged.length} targets are seen; hidden: ${hidden
    .map((t) => `${t.target} (${t.hidden_by})`)
    .join(', ')}.`;
}
