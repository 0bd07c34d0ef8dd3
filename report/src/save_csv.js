import { choicesOf } from './text/choices.js';

/** A name as a CSV cell: quoted where it has a comma or a quote. @param {string} name */
const quoted = (name) => (/[",]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name);

/**
 * The list as poses.csv: header `pose,NAME [unit],…`, one line a pose, actuators after the configuration (none of a pose
 * that was moved), then load case and station where there are some, and `fixed` where poses are locked. Numbers read back
 * bit-equal.
 * @param {any[]} poses of plan.json, in order @param {Object<string, string>} actuatorUnits @param {Set<number>} locked
 */
export function posesCsv(poses, actuatorUnits = {}, locked = new Set()) {
  if (poses.length === 0) return '';
  const first = poses[0];
  const actuators = Object.keys(poses.find((pose) => pose.actuators)?.actuators ?? {});
  const withUnit = (name, unit) => (unit ? `${name} [${unit}]` : name);
  const header = [
    'pose',
    ...first.names.map((name, k) => withUnit(name, first.units[k])),
    ...actuators.map((name) => withUnit(name, actuatorUnits[name])),
    ...choicesOf(first).map(([column]) => column),
    ...(locked.size > 0 ? ['fixed'] : []),
  ];
  const lines = poses.map((pose) =>
    [
      pose.id,
      ...pose.configuration,
      ...actuators.map((name) => pose.actuators?.[name] ?? ''),
      ...choicesOf(pose).map(([, , label]) => quoted(label)),
      ...(locked.size > 0 ? [locked.has(pose.id) ? 'yes' : 'no'] : []),
    ].join(','),
  );
  return [header.join(','), ...lines, ''].join('\n');
}

/** @param {string} name @param {string} text @param {string} type */
export function download(name, text, type) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
