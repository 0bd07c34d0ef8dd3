import { h, section } from '../dom.js';
import { newPoses } from '../text/sentences.js';

/**
 * A word of a shell command, quoted where it has to be: everything here comes from a file that somebody may have edited.
 * @param {unknown} value
 */
export const shell = (value) => {
  const word = String(value);
  return /^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
};

/** A file's name as a word that is no option. @param {string} name */
export const shellFile = (name) => shell(name.startsWith('-') ? `./${name}` : name);

/** Keys that options of their own state, or files of poses. */
const stated = new Set(
  ['variant', 'criterion', 'method', 'poses', 'candidates', 'candidates_from', 'restarts', 'repeats', 'scaling', 'prior', 'reserve'].map(
    (key) => `design.${key}`,
  ),
);

/** What options changed besides. @param {any} plan */
const otherKeys = (plan) =>
  (plan.problem.set ?? []).filter(({ key }) => !stated.has(key)).map(({ key, value }) => `--set ${shell(`${key}=${value}`)}`);

/** Options of the search, as far as plan.json tells. @param {any} plan @param {string} variant */
function planOptions(plan, variant) {
  const { criterion, certificate, statistics } = plan;
  const repeats = certificate.candidates?.repeats ?? 'forbid';
  return [
    variant,
    `--criterion ${shell(criterion.name)}`,
    `--method ${shell(plan.method)}`,
    `--poses ${plan.curve?.length > 0 ? 'auto' : newPoses(plan).length}`,
    statistics.candidates_from
      ? `--candidates-from ${shellFile(statistics.candidates_from)}`
      : `--candidates ${shell(statistics.candidates_feasible)}`,
    `--restarts ${shell(statistics.restarts)}`,
    repeats === 'forbid' ? '' : `--repeats ${shell(repeats)}`,
    criterion.scaling === 'tolerance' ? '' : `--scaling ${shell(criterion.scaling)}`,
    criterion.prior === 'tolerance' ? '--prior tolerance' : '',
    criterion.reserve ? '--reserve' : '',
    ...otherKeys(plan),
    `--seed ${shell(plan.seed)}`,
  ].filter(Boolean);
}

/** @param {import('../types.js').Report} report */
export function commands({ plan, route }) {
  const file = shellFile(plan.problem.file);
  const several = (plan.variants ?? []).length > 1;
  const variant = plan.variant && !several ? `--variant ${shell(plan.variant)}` : '';
  const from = plan.statistics.candidates_from;
  const candidates = from
    ? `--set ${shell(`design.candidates_from=${from}`)}`
    : `--candidates ${shell(plan.statistics.candidates_feasible)}`;
  const lines = [
    `sha256sum ${file}`,
    `posewright plan ${file} ${planOptions(plan, variant).join(' ')} -o plan.json --poses-csv poses.csv`,
    `posewright evaluate ${file} poses.csv ${[variant, candidates, ...otherKeys(plan), `--seed ${shell(plan.seed)}`].filter(Boolean).join(' ')}`,
  ];
  if (!route) return lines;
  const ends = `${route.from_home ? '--from-home ' : ''}${route.closed ? '--closed ' : ''}`;
  return [...lines, `posewright route plan.json ${ends}--seed ${shell(route.seed)} -o route.json`];
}

/** @param {import('../types.js').Report} report */
export function reproduceSection(report) {
  const { plan } = report;
  const fact = (title, value) => h('div', {}, h('dt', {}, title), h('dd', {}, h('code', {}, value)));
  return section(
    'reproduce',
    'How to repeat this',
    'The same problem file, version, seed and options give the same plan on any machine, with any number of threads.',
    h(
      'dl',
      { class: 'facts' },
      fact('problem file', plan.problem.file),
      fact('its sha256', plan.problem.sha256),
      fact('posewright', plan.version),
      fact('seed', String(plan.seed)),
      fact('criterion, method', `${plan.criterion.name}, ${plan.method}`),
    ),
    // Far below the picture, which they would push out of the first screen.
    ...(plan.statistics.notes ?? []).map((text) => h('p', { class: 'note' }, text)),
    h('pre', { tabindex: '0' }, commands(report).join('\n')),
    h(
      'p',
      { class: 'note' },
      'Poses measured before (--augment), fixed poses (--fixed) and a time limit are not in the plan: give them again. ' +
        'A search that was ended by a time limit or by hand cannot be repeated exactly.',
    ),
  );
}
