import { h, section } from '../dom.js';
import { newPoses } from '../text/sentences.js';

/** A word of a shell command, quoted where it has to be. @param {string} word */
const shell = (word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

/** Options of the search, as far as plan.json tells. @param {any} plan @param {string} variant */
function planOptions(plan, variant) {
  const { criterion, certificate, statistics } = plan;
  const repeats = certificate.candidates?.repeats ?? 'forbid';
  return [
    variant,
    `--criterion ${criterion.name}`,
    `--method ${shell(plan.method)}`,
    `--poses ${plan.curve?.length > 0 ? 'auto' : newPoses(plan).length}`,
    `--candidates ${statistics.candidates_feasible}`,
    `--restarts ${statistics.restarts}`,
    repeats === 'forbid' ? '' : `--repeats ${shell(String(repeats))}`,
    criterion.scaling === 'tolerance' ? '' : `--scaling ${shell(criterion.scaling)}`,
    criterion.prior === 'tolerance' ? '--prior tolerance' : '',
    criterion.reserve ? '--reserve' : '',
    `--seed ${plan.seed}`,
  ].filter(Boolean);
}

/** @param {import('../types.js').Report} report */
function commands({ plan, route }) {
  const file = shell(plan.problem.file);
  const several = (plan.variants ?? []).length > 1;
  const variant = plan.variant && !several ? `--variant ${shell(plan.variant)}` : '';
  const lines = [
    `sha256sum ${file}`,
    `posewright plan ${file} ${planOptions(plan, variant).join(' ')} -o plan.json --poses-csv poses.csv`,
    `posewright evaluate ${file} poses.csv ${variant} --candidates ${plan.statistics.candidates_feasible} --seed ${plan.seed}`.replace(/ {2,}/g, ' '),
  ];
  if (!route) return lines;
  const ends = `${route.from_home ? '--from-home ' : ''}${route.closed ? '--closed ' : ''}`;
  return [...lines, `posewright route plan.json ${ends}--seed ${route.seed} -o route.json`];
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
    h('pre', { tabindex: '0' }, commands(report).join('\n')),
    h(
      'p',
      { class: 'note' },
      'Poses measured before (--augment) and a time limit are not in the plan: give them again. ' +
        'A search that was ended by a time limit or by hand cannot be repeated exactly.',
    ),
  );
}
