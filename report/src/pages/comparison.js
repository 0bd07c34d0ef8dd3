import { h, section, table } from '../dom.js';
import { inShort, tile } from '../parts/tiles.js';
import { commonFacts, repeatSection } from '../parts/repeat.js';
import { shareTable } from '../parts/shares.js';
import { expectedPlots, worthPlot } from '../plots/comparison.js';
import { biasSection } from '../sections/bias.js';
import { shell, shellFile } from '../sections/reproduce.js';
import { list, number, percentDown, plural, quantity } from '../text/units.js';

/** @param {any} c @param {string} plan @param {string} variant */
const scoreOf = (c, plan, variant) => c.scores.find((s) => s.plan === plan && s.variant === variant);

/** @param {any} c */
function tiles(c) {
  const proved = c.scores.filter((s) => s.efficiency !== null);
  const worst = proved.length > 0 ? proved.reduce((a, b) => (b.efficiency < a.efficiency ? b : a)) : null;
  const known = c.variants.filter((v) => !v.why_not);
  const pays = c.worth.filter((w) => w.worth === true);
  return [
    tile(
      String(c.variants.length),
      'variants',
      known.length < c.variants.length ? `${known.length} of them can be identified` : 'all can be identified',
    ),
    tile(String(c.plans.length), c.plans.length === 1 ? 'plan' : 'plans', `judged on ${plural(c.candidates, 'candidate')}`),
    worst ? tile(`≥ ${percentDown(worst.efficiency, 1)}`, 'least efficiency', `of ${worst.plan} for ${worst.variant}`) : null,
    c.worth.length > 0 ? tile(`${pays.length} of ${c.worth.length}`, 'larger models pay', 'if they are the case') : null,
  ];
}

/** @param {any} c */
function warnings(c) {
  const outside = c.scores.filter((s) => s.infeasible_poses > 0);
  return [
    ...c.variants.filter((v) => v.why_not).map((v) => `${v.name}: ${v.why_not}`),
    ...outside.map(
      (s) =>
        `${s.plan}: ${plural(s.infeasible_poses, 'pose')} outside the workspace of ${s.variant} (${s.infeasible_because}); the figures hold for all poses.`,
    ),
  ];
}

/** @param {any} c */
function efficiencySection(c) {
  const variants = c.variants.map((v) => v.name);
  const cell = (r, k) => {
    const s = scoreOf(c, c.plans[r].name, variants[k]);
    if (!s || s.why_not) return { text: 'no', share: null, hint: s?.why_not };
    // From 60 % on: below it a plan is of no use, and differences above are what counts.
    return s.efficiency === null ? { text: '–', share: null } : { text: percentDown(s.efficiency), share: (s.efficiency - 0.6) / 0.4 };
  };
  return section(
    'efficiency',
    'What is a plan worth to the other variants?',
    'Plans down, variants across: at least this share of the information per parameter of the best plan that the candidates allow for that variant.',
    shareTable(
      variants,
      c.plans.map((p) => p.name),
      cell,
      'plan',
      'Efficiency',
    ),
    h(
      'p',
      { class: 'note' },
      'Proved. The diagonal is what the search reached; “no”: the poses do not determine the variant’s parameters. Colour: from 60 % (dark) to 100 %.',
    ),
  );
}

/** @param {any} c */
function accuracySection(c) {
  const withError = c.scores.some((s) => s.rho0 !== null);
  const header = [
    'plan',
    'variant',
    '#parameters',
    '#log det',
    '#largest σ/tolerance',
    'of',
    '#mean σ/tolerance',
    '#condition',
    ...(withError ? ['#position error'] : []),
  ];
  const rows = c.scores.map((s) => {
    const v = c.variants.find((variant) => variant.name === s.variant);
    if (s.why_not) return [s.plan, s.variant, String(v.interest), s.why_not, '', '', '', '', ...(withError ? [''] : [])];
    return [
      s.plan,
      s.variant,
      `${v.interest}${v.nuisance > 0 ? ` + ${v.nuisance}` : ''}`,
      number(s.log_det, 6),
      number(s.largest_sigma_per_tolerance, 3),
      s.largest_sigma_of ?? '',
      number(s.mean_sigma_per_tolerance, 3),
      number(s.condition, 3),
      ...(withError ? [quantity(s.rho0, 'm')] : []),
    ];
  });
  return section(
    'accuracy',
    'Accuracy',
    'By noise, and by the effect of a variant that has unmodelled, as if the variant were the case. Parameters: of interest, and nuisance beside them; mean: geometric, of those of interest; condition: largest over smallest singular value in units of tolerance.',
    table(header, rows, 'Accuracy'),
    h('div', { class: 'plots' }, expectedPlots(c)),
  );
}

/** @param {any} c */
function worthSection(c) {
  if (c.worth.length === 0) return null;
  return section(
    'worth',
    'Do more parameters pay?',
    'If the larger variant is the case: the error with it by noise, against the error without its parameters, by noise and by the bias that leaving them out makes.',
    h('div', { class: 'plots' }, worthPlot(c)),
    h(
      'ul',
      { class: 'sentences' },
      c.worth.map((w) => h('li', {}, `${w.text}.`)),
    ),
  );
}

/** @param {any} c @param {any} report */
function repeat(c, report) {
  const given = c.plans.filter((p) => !p.searched_for).map((p) => shellFile(p.name));
  const words = [
    ...given,
    `--variant ${c.variants.map((v) => shell(v.name)).join(',')}`,
    c.method && `--method ${shell(c.method)}`,
    `--seed ${shell(c.seed)}`,
  ];
  return repeatSection(
    [...commonFacts(c, report), ['criterion', c.criterion], ['method', c.method]],
    [`posewright compare ${shellFile(c.problem.file)} ${words.filter(Boolean).join(' ')} --json > comparison.json`],
    'Options that are not in the result (--poses, --candidates, --restarts, --truth) have to be given again.',
  );
}

/** @param {any} c comparison.json @param {any} report @returns {import('../page.js').Page} */
export function comparisonPage(c, report) {
  return {
    kind: `Comparison of ${list(c.variants.map((v) => v.name))}, from ${c.problem.file}`,
    heading: report.title,
    title: `Comparison: ${report.title}`,
    sections: [
      ['In short', inShort(tiles(c), warnings(c))],
      ['Efficiency', efficiencySection(c)],
      ['Accuracy', accuracySection(c)],
      ['More parameters', worthSection(c)],
      ['Bias', biasSection(c)],
      ['Repeat', repeat(c, report)],
    ],
  };
}
