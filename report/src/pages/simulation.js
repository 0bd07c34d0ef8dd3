import { headingOf } from '../page.js';
import { h, section, table } from '../dom.js';
import { inShort, tile } from '../parts/tiles.js';
import { commonFacts, repeatSection } from '../parts/repeat.js';
import { accuracyHistogram, coveragePlot, errorHistograms, sigmaPlot } from '../plots/simulation.js';
import { shell, shellFile } from '../sections/reproduce.js';
import { number, percent, plural, quantity } from '../text/units.js';

const observed = (s) => s.parameters.filter((p) => p.sigma_observed !== null);

/** @param {any} s */
function tiles(s) {
  const known = observed(s);
  const ratios = known.map((p) => p.sigma_observed / p.sigma_predicted);
  const covered = known.map((p) => p.coverage);
  const mean = (list) => list.reduce((sum, v) => sum + v, 0) / list.length;
  const { accuracy, chi_square: chi } = s;
  return [
    tile(
      s.draws.fitted.toLocaleString('en'),
      'virtual calibrations',
      `of ${plural(s.poses, 'pose')}, ${plural(s.readings, 'reading')} each`,
    ),
    known.length > 0
      ? tile(
          `${number(Math.min(...ratios), 3)} to ${number(Math.max(...ratios), 3)}`,
          'σ observed / predicted',
          `± ${number(s.sigma_error, 2)} by the number of draws`,
        )
      : null,
    known.length > 0
      ? tile(
          percent(mean(covered)),
          'of the 95 % intervals',
          `hold the truth; ${percent(Math.min(...covered))} to ${percent(Math.max(...covered))} by parameter`,
        )
      : null,
    accuracy ? tile(quantity(accuracy.observed, 'm', 3), 'position error', `${quantity(accuracy.predicted, 'm', 3)} was predicted`) : null,
    chi.rejected === null
      ? null
      : tile(
          percent(chi.rejected),
          'refused by the χ² test',
          s.truth === s.variant ? 'of the draws; 5 % is right' : 'of the draws: its power',
        ),
  ];
}

/** @param {any} s */
function warnings(s) {
  const { draws } = s;
  return [
    draws.interrupted && `Stopped early: ${draws.asked.toLocaleString('en')} draws were requested.`,
    draws.not_converged > 0 && `${plural(draws.not_converged, 'draw')} did not converge and are left out.`,
    draws.failed > 0 && `${plural(draws.failed, 'draw')} could not be calibrated: ${draws.first_failure}.`,
  ].filter(Boolean);
}

/** What the truth was. @param {any} s */
function truthText(s) {
  const o = s.options;
  const noise = Object.entries(o.truth_noise ?? {})
    .filter(([, v]) => v !== null)
    .map(([name, v]) => `${name} ${number(v)}`);
  return [
    `The robot that is measured is ${o.exact ? `the nominal one of ${s.truth}` : o.truth_nominal ? `nominal as in ${s.truth}, off by one tolerance (1σ) where ${s.variant} estimates` : `of ${s.truth}, each parameter off by its tolerance (1σ)`}.`,
    noise.length > 0 && ` Its noise differs from the stated one (SI): ${noise.join(', ')}.`,
    o.missing > 0 && ` ${percent(o.missing)} of the targets are missing; the prediction includes that.`,
    o.outliers > 0 && ` ${percent(o.outliers)} of the targets are ${number(o.outlier_size)} σ off.`,
  ]
    .filter(Boolean)
    .join('');
}

/** @param {any} s */
const verdictSection = (s) =>
  section(
    'verdict',
    s.confirmed ? 'As predicted' : 'Not as predicted',
    truthText(s),
    h(
      'ul',
      { class: 'sentences' },
      s.verdict.map((line) => h('li', {}, line)),
    ),
  );

/** @param {any} s */
function parametersSection(s) {
  const profiled = s.parameters.some((p) => typeof p.profile_coverage === 'number');
  const rows = s.parameters.map((p, k) => [
    String(k + 1),
    p.name,
    p.role === 'nuisance' ? 'nuisance' : '',
    quantity(p.tolerance, p.unit, 3),
    quantity(p.sigma_predicted, p.unit, 3),
    quantity(p.sigma_observed, p.unit, 3),
    p.sigma_observed === null ? '–' : number(p.sigma_observed / p.sigma_predicted, 3),
    quantity(p.sigma_stated, p.unit, 3),
    quantity(p.bias, p.unit, 2),
    quantity(p.bias_error, p.unit, 2),
    percent(p.coverage),
    ...(profiled ? [percent(p.profile_coverage)] : []),
  ]);
  return section(
    'parameters',
    'Parameters',
    'σ predicted by the plan, observed over the draws, and stated by the calibrations for themselves; bias with its standard error.',
    table(
      ['##', 'parameter', '', '#tolerance', '#σ predicted', '#σ observed', '#ratio', '#σ stated', '#bias', '#± error', '#covered', ...(profiled ? ['#by profile'] : [])],
      rows,
      'Parameters',
    ),
  );
}

/** @param {any} s @param {any} report */
function repeat(s, report) {
  const o = s.options;
  const words = [
    `--variant ${shell(s.variant)}`,
    s.truth !== s.variant && `--truth ${shell(s.truth)}`,
    `--draws ${shell(o.draws)}`,
    o.exact && '--exact',
    o.truth_nominal && '--truth-nominal',
    o.prior === false && '--no-prior',
    o.weights !== 'wls' && `--weights ${shell(o.weights)}`,
    o.missing > 0 && `--missing ${shell(o.missing)}`,
    o.outliers > 0 && `--outliers ${shell(o.outliers)} --outlier-size ${shell(o.outlier_size)}`,
    `--seed ${shell(s.seed)}`,
  ];
  return repeatSection(
    [...commonFacts(s, report), ['poses', s.plan]],
    [`posewright simulate ${shellFile(s.problem.file)} ${shellFile(s.plan)} ${words.filter(Boolean).join(' ')} --json > simulation.json`],
    'A draw belongs to the seed and its number: more draws leave the first ones as they are. Another noise of the truth (--truth-repeatability and its like), --validation and --candidates have to be given again.',
  );
}

/** @param {any} s simulation.json @param {any} report @returns {import('../page.js').Page} */
export function simulationPage(s, report) {
  const plots = [sigmaPlot(s), coveragePlot(s), errorHistograms(s), accuracyHistogram(s.accuracy)].filter(Boolean);
  return {
    kind: `Virtual calibrations with ${s.plan}`,
    heading: headingOf(report.title, s.variant),
    title: `Simulation: ${report.title}`,
    sections: [
      ['In short', inShort(tiles(s), warnings(s))],
      ['Verdict', verdictSection(s)],
      [
        'Truth and prediction',
        plots.length > 0 ? section('figures', 'Truth and prediction', null, h('div', { class: 'plots' }, plots)) : null,
      ],
      ['Parameters', parametersSection(s)],
      ['Repeat', repeat(s, report)],
    ],
  };
}
