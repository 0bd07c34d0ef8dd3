import { h, section, table } from '../dom.js';
import { number, percent, quantity } from '../text/units.js';

const inSigma = (p) => Math.max(Math.abs(p.bias_by_nominal ?? 0), Math.abs(p.bias_by_tolerance ?? 0)) / (p.sigma || Infinity);

/** @param {any} p of an alias's parameters */
const row = (p) => [
  p.name,
  p.role === 'nuisance' ? 'nuisance' : '',
  quantity(p.sigma, p.unit, 3),
  quantity(p.bias_by_nominal, p.unit, 3),
  quantity(p.bias_by_nominal_fitted, p.unit, 3),
  quantity(p.bias_by_tolerance, p.unit, 3),
  number(inSigma(p), 3),
];

/** @param {any} a of aliases */
function pair(a) {
  const title = `${a.fitted} fitted while ${a.truth} is true, ${a.plan}`;
  if (a.why_not) return h('p', { class: 'note' }, `${title}: ${a.why_not}`);
  const parameters = [...a.parameters].sort((p, q) => inSigma(q) - inSigma(p));
  const worst = parameters[0];
  const power = a.discrimination?.power;
  const told = [
    worst ? `${worst.name} most, ${number(inSigma(worst), 3)} σ` : '',
    power !== undefined && power !== null ? `a χ² test of the residuals shows it with ${percent(power)}` : '',
  ].filter(Boolean);
  return h(
    'details',
    { class: 'printed bias' },
    h('summary', {}, `${title}: ${told.join('; ')}`),
    table(['parameter', '', '#σ', '#bias by nominal', '#by the whole fit', '#bias by tolerance', '#bias / σ'], parameters.map(row), title),
  );
}

/** What is wrong if one variant is fitted while another is the case. @param {any} c comparison.json */
export function biasSection(c) {
  if (c.aliases.length === 0) return null;
  const worst = (a) => Math.max(0, ...(a.parameters ?? []).map(inSigma));
  return section(
    'bias',
    'What a variant that is too small gets wrong',
    'First-order bias of the estimates, largest first: by the nominal values in which the variants differ (with its sign), and by one tolerance of what is left out (root of the sum of squares).',
    [...c.aliases].sort((a, b) => worst(b) - worst(a)).map(pair),
  );
}
