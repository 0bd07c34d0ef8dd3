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

/** Options of the search, as far as plan.json tells. @param {any} plan @param {string} variant */
function planOptions(plan, variant) {
  const { criterion, certificate, statistics } = plan;
  const repeats = certificate.candidates?.repeats ?? 'forbid';
  return [
    variant,
    `--criterion ${shell(criterion.name)}`,
    `--method ${shell(plan.method)}`,
    `--poses ${plan.curve?.length > 0 ? 'auto' : newPoses(plan).length}`,
    `--candidates ${shell(statistics.candidates_feasible)}`,
    `--restarts ${shell(statistics.restarts)}`,
    repeats === 'forbid' ? '' : `--repeats ${shell(repeats)}`,
    criterion.scaling === 'tolerance' ? '' : `--scaling ${shell(criterion.scaling)}`,
    criterion.prior === 'tolerance' ? '--prior tolerance' : '',
    criterion.reserve ? '--reserve' : '',
    `--seed ${shell(plan.seed)}`,
  ].filter(Boolean);
}

/** @param {import('../types.js').Report} report */
function commands({ plan, route }) {
  const file = shellFile(plan.problem.file);
  const several = (plan.variants ?? []).length > 1;
  const variant = plan.variant && !several ? `--variant ${shell(plan.variant)}` : '';
  const lines = [
    `sha256sum ${file}`,
    `posewright plan ${file} ${planOptions(plan, variant).join(' ')} -o plan.json --poses-csv poses.csv`,
    `posewright evaluate ${file} poses.csv ${variant} --candidates ${shell(plan.statistics.candidates_feasible)} --seed ${shell(plan.seed)}`.replace(/ {2,}/g, ' '),
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
      'Poses measured before (--augment) and a time limit are not in the plan: give them again. ' +
        'A search that was ended by a time limit or by hand cannot be repeated exactly.',
    ),
  );
}
