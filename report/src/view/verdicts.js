/**
 * Verdicts of the program's checks in four kinds, each with a colour that colour-blind readers tell apart.
 * @typedef {'feasible'|'sight'|'near'|'reach'} Kind
 */

/** @type {Record<Kind, string>} */
export const kindNames = {
  feasible: 'can be measured',
  sight: 'not seen by the instrument',
  near: 'too near to something',
  reach: 'beyond limits or reach',
};

/** @param {string|undefined} reason of the program; undefined: feasible @returns {Kind} */
export function kindOf(reason) {
  if (reason === undefined) return 'feasible';
  if (/collision/.test(reason)) return 'near';
  return /station|camera|board|picture|image|sight|read/.test(reason) ? 'sight' : 'reach';
}

/** @param {any} report of a problem @param {number} place of a keyframe @returns {string|undefined} */
export const reasonAt = (report, place) => report.reasons[report.verdicts[place]];

/** What the even draws met, most frequent first. @param {any} report @returns {{reason: string|undefined, kind: Kind, count: number}[]} */
export function countsOf(report) {
  const counts = new Map();
  for (let k = 1; k <= report.evenly; k++) counts.set(reasonAt(report, k), (counts.get(reasonAt(report, k)) ?? 0) + 1);
  return [...counts].map(([reason, count]) => ({ reason, kind: kindOf(reason), count })).sort((a, b) => b.count - a.count);
}
