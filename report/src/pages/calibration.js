import { headingOf } from '../page.js';
import { inShort, tile } from '../parts/tiles.js';
import { commonFacts, repeatSection } from '../parts/repeat.js';
import { calibratedParametersSection } from '../sections/calibrated_parameters.js';
import { errorsSection } from '../sections/calibrated_errors.js';
import { legPointsSection } from '../sections/leg_points.js';
import { shell, shellFile } from '../sections/reproduce.js';
import { testsSection } from '../sections/calibration_tests.js';
import { chance, seldom } from '../text/chances.js';
import { number, plural, quantity } from '../text/units.js';

/** Kinds of residuals, those that people ask for first. */
const kinds = [
  ['distance', 'm', 'distance of a target, RMS'],
  ['m', 'm', 'length, RMS'],
  ['angle', 'rad', 'angle, RMS'],
  ['rad', 'rad', 'angle, RMS'],
  ['px', 'px', 'in the picture, RMS'],
];

/** @param {any} c @param {string} poses @param {string} parameters @param {string} kind */
const rmsOf = (c, poses, parameters, kind) =>
  c.residuals.find((r) => r.poses === poses && r.parameters === parameters && r.kind === kind)?.rms;

/** RMS after, with what it was before. @param {any} c @param {string} poses */
function errorTile(c, poses) {
  const found = kinds.find(([kind]) => rmsOf(c, poses, 'calibrated', kind) !== undefined);
  if (!found) return null;
  const [kind, unit, title] = found;
  const before = rmsOf(c, poses, c.before, kind);
  const where = poses === 'fitted' ? 'poses fitted' : 'poses not fitted';
  return tile(quantity(rmsOf(c, poses, 'calibrated', kind), unit, 3), title, `${where}; ${quantity(before, unit, 3)} before`);
}

/** @param {any} c */
function warnings(c) {
  const named = c.effects_left_out.filter((e) => e.corrected < seldom);
  const smooth = c.smooth_effect;
  return [
    ...c.refusals.map((why) => `Not to be used: ${why}`),
    named.length > 0 &&
      `The residuals hold an effect that is not fitted: ${named[0].effect}, which explains ${number(100 * named[0].share, 2)} % of the squared residuals (p ${chance(named[0].corrected).startsWith('<') ? chance(named[0].corrected) : `= ${chance(named[0].corrected)}`})${named.length > 1 ? `; ${plural(named.length - 1, 'other')} would do so too` : ''}.`,
    !smooth.why_not &&
      smooth.probability < seldom &&
      !smooth.counted &&
      `Something smooth over the joints remains, ${quantity(smooth.size, 'm', 3)}: σ and intervals are too small.`,
    c.requirements?.some((r) => !r.met && !r.hidden_by_noise) && 'A required accuracy is not met.',
    c.weakest_combination,
    ...c.notes,
  ].filter(Boolean);
}

/** @param {any} c */
function tiles(c) {
  const estimated = c.parameters.filter((p) => p.estimated);
  const nuisance = estimated.filter((p) => p.role === 'nuisance').length;
  return [
    tile(String(c.poses_fitted), 'poses fitted', c.poses_held_back > 0 ? `${c.poses_held_back} held back` : 'none held back'),
    tile(String(estimated.length - nuisance), 'parameters', nuisance > 0 ? `and ${nuisance} estimated along with them` : 'estimated'),
    errorTile(c, 'fitted'),
    errorTile(c, 'held back'),
    tile(
      `${number(c.noise_scale, 3)} ×`,
      'the stated noise',
      c.tests.chi_square ? `residuals; p = ${chance(c.tests.chi_square.probability)}` : 'residuals',
    ),
  ];
}

/** The parts of the page that are of one model. @param {any} c calibration.json @returns {[string, HTMLElement|null][]} */
export const modelSections = (c) => [
  ['In short', inShort(tiles(c), warnings(c))],
  ['Errors', errorsSection(c)],
  ['Trust', testsSection(c)],
  ['Parameters', calibratedParametersSection(c)],
];

/** @param {any} c @param {string} variants */
function repeat(c, report, variants) {
  const data = [c.data, ...(c.campaigns ?? [])].map(shellFile).join(' ');
  const options = [variants, c.weights && c.weights !== 'wls' && `--weights ${shell(c.weights)}`, c.prior === 'none' && '--no-prior'];
  const file = shellFile(c.problem.file);
  return repeatSection(
    [...commonFacts(c, report), ['readings', [c.data, ...(c.campaigns ?? [])].join(', ')]],
    [`posewright calibrate ${file} ${data} ${options.filter(Boolean).join(' ')} --json > calibration.json`.replace(/ {2,}/g, ' ')],
    'Which poses were held back (--validate, --hold-back) is not in the command: give it again.',
  );
}

/** @param {any} c @param {any} report @returns {import('../page.js').Page} */
export function calibrationPage(c, report) {
  return {
    kind: `Calibration, from ${c.data}`,
    heading: headingOf(report.title, c.variant),
    title: `Calibration: ${report.title}`,
    sections: [...modelSections(c), ['Legs', legPointsSection([c])], ['Repeat', repeat(c, report, `--variant ${shell(c.variant)}`)]],
  };
}

export { repeat as repeatCalibration };
