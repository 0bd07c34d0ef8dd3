import { usualError } from './expected_error.js';
import { number, percent, quantity } from '../text/units.js';

/**
 * What a place may be coloured by.
 * @typedef {object} Value
 * @property {string} name
 * @property {(rank: any) => number|null} of larger is better unless `least`
 * @property {(value: number) => string} shown
 * @property {boolean} [least] smaller is better
 * @property {number} span differences below it are not worth a colour: relative to the best
 */

/** How many times as large σ is as from the best place that was planned alike, of a determinant: exp((Φ* − Φ)/(2 m)).
 * @param {any[]} ranking @param {any} rank */
export function sigmaRatio(ranking, rank) {
  const best = Math.max(...alike(ranking, rank).map((r) => r.phi));
  return Math.exp((best - rank.phi) / (2 * Math.max(rank.parameters, 1)));
}

/** Whether differences of the criterion are ratios of σ: then the best place has one. @param {any} s */
export const hasRatios = (s) => s.ranking.some((r) => typeof r.sigma_ratio === 'number');

/** Whether a plan was looked for; not where the search was ended before. @param {any} rank */
export const isLookedAt = (rank) => rank.looked_at !== false;

/** How many choices were looked at, of how many, and how many of them give a plan. @param {any[]} ranking */
export const counts = (ranking) => ({
  looked: ranking.filter(isLookedAt).length,
  all: ranking.length,
  planned: ranking.filter((r) => !r.why_not).length,
});

/** Places that can be compared with this one. @param {any[]} ranking @param {any} rank */
const alike = (ranking, rank) => ranking.filter((r) => !r.why_not && r.in_full === rank.in_full && r.parameters === rank.parameters);

/** @param {any} rank */
const errorOf = (rank) => (rank.expected_error ? usualError(rank.expected_error) : null);

/** @param {any} s stations.json @returns {Value[]} */
export function valuesOf(s) {
  const good = s.ranking.filter((r) => !r.why_not);
  return [
    hasRatios(s)
      ? { name: 'σ against the best place', of: (r) => sigmaRatio(s.ranking, r), shown: (v) => `${number(v, 4)} ×`, least: true, span: 0.1 }
      : { name: `criterion ${s.criterion}`, of: (r) => r.phi, shown: (v) => number(v, 5), span: 0.1 },
    { name: 'share of feasible configurations', of: (r) => r.feasible_share, shown: (v) => percent(v), span: 0.1 },
    ...(good.some((r) => r.expected_error !== null)
      ? [{ name: 'position error', of: errorOf, shown: (v) => quantity(v, 'm', 3), least: true, span: 0.1 }]
      : []),
  ];
}

/** Where the colours begin (worst) and end (best). @param {any[]} ranking @param {Value} value @returns {[number, number]|null} */
export function endsOf(ranking, value) {
  const all = ranking
    .filter((r) => !r.why_not)
    .map(value.of)
    .filter((v) => v !== null);
  if (all.length === 0) return null;
  const [low, high] = [Math.min(...all), Math.max(...all)];
  return value.least ? [Math.max(high, low * (1 + value.span)), low] : [Math.min(low, high - value.span * Math.abs(high)), high];
}

/** 0: worst, 1: best. @param {any[]} ranking @param {any} rank @param {Value} value */
export function shareOf(ranking, rank, value) {
  const own = value.of(rank);
  const ends = endsOf(ranking, value);
  return own === null || ends === null || ends[0] === ends[1] ? null : (own - ends[0]) / (ends[1] - ends[0]);
}

/** Every place with the best of the sets that it is in. @param {any} s */
export function placesOf(s) {
  const places = new Map();
  s.ranking.forEach((rank, k) => {
    for (const [name, { position }] of Object.entries(rank.stations))
      if (!places.has(name)) places.set(name, { name, position, rank, place: k + 1 });
  });
  return [...places.values()];
}
