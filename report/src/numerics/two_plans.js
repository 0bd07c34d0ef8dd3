import { choicesOf } from '../text/choices.js';
import { matricesOf } from './information.js';
import { PlanFigures } from './plan_figures.js';

/** Coordinates that differ by less are one: what encoders and rounding leave, rad or m. */
const same = 1e-5;

/** What two poses must share to be one measurement. @param {any} p @param {any} q */
function alike(p, q) {
  if (JSON.stringify(choicesOf(p)) !== JSON.stringify(choicesOf(q))) return false;
  if (p.names.length !== q.names.length) return false;
  return p.names.every((name, k) => {
    const other = q.names.indexOf(name);
    return other >= 0 && Math.abs(p.configuration[k] - q.configuration[other]) < same;
  });
}

/** Pairs of poses that both plans have, each pose once. @param {any[]} a @param {any[]} b @returns {[any, any][]} */
export function inCommon(a, b) {
  const left = [...b];
  return a.flatMap((p) => {
    const k = left.findIndex((q) => alike(p, q));
    return k < 0 ? [] : [[p, left.splice(k, 1)[0]]];
  });
}

/** Why the information of two reports cannot be held against each other; empty: it can. */
export function whyNotComparable(a, b) {
  const names = ({ columns }, role) =>
    columns
      .filter((c) => c.role === role)
      .map((c) => c.name)
      .sort()
      .join('\n');
  if (names(a, 'interest') !== names(b, 'interest')) return 'they identify different parameters';
  return names(a, 'nuisance') === names(b, 'nuisance') ? '' : 'they estimate different nuisance parameters';
}

/** Information per parameter of interest of b compared with a, exp((log det b − log det a)/h); null where a plan does not
 * determine its parameters. @param {import('../types.js').Report} a @param {import('../types.js').Report} b */
export function efficiencyOf(a, b) {
  const [first, second] = [a, b].map((r) => new PlanFigures(r.columns, matricesOf(r.information, r.columns.length)));
  const [p, q] = [first, second].map((f) => f.of(f.blocks.keys()).logDet);
  return p === null || q === null ? null : Math.exp((q - p) / first.interest);
}
