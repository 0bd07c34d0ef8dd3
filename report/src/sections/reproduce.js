import { h, section } from '../dom.js';
import { newPoses } from '../text/sentences.js';

/** A word of a shell command, quoted where it has to be. @param {string} word */
const shell = (word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

/** @param {import('../types.js').Report} report */
function commands(report) {
  const { plan, route } = report;
  const file = shell(plan.problem.file);
  const several = (plan.variants ?? []).length > 1;
  const variant = plan.variant && !several ? ` --variant ${shell(plan.variant)}` : '';
  const lines = [
    `sha256sum ${file}`,
    `posewright plan ${file}${variant} --criterion ${plan.criterion.name} --method ${shell(plan.method)} --poses ${newPoses(plan).length} --restarts ${plan.statistics.restarts} --seed ${plan.seed} -o plan.json --poses-csv poses.csv`,
    `posewright evaluate ${file} poses.csv${variant}`,
  ];
  if (route)
    lines.push(
      `posewright route plan.json${route.from_home ? ' --from-home' : ''}${route.closed ? ' --closed' : ''} --seed ${route.seed} -o route.json`,
    );
  return lines;
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
      'Number of candidates, repeats and other options come from the problem file unless they were given on the command line; then give them again. ' +
        'A search that was ended by a time limit or by hand is not repeatable.',
    ),
  );
}
