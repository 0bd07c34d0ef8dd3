/** Choices with a key of their own in a pose: key, which is their column in lists, and name on the page. */
const keys = [
  ['load_case', 'load case'],
  ['station', 'station'],
  ['instrument', 'instrument'],
];

/**
 * Choices of a pose besides its numbers: column in lists, name, label.
 * @param {any} pose @returns {[string, string, string][]}
 */
export function choicesOf(pose) {
  return [
    ...keys.map(([key, name]) => [key, name, pose[key]]).filter(([, , label]) => label),
    ...Object.entries(pose.conditions ?? {}).map(([name, label]) => [name, name, label]),
  ];
}

/** "station A", "load case heavy", "joint_a2 rising", "temperature 20". @param {any} pose */
export const choiceTexts = (pose) =>
  choicesOf(pose).map(([, name, label]) => `${name.replace(/\.approach$/, '')} ${label}`);
