import { h } from '../../dom.js';
import { usualError } from '../../numerics/expected_error.js';
import { quantity } from '../../text/units.js';
import { messagesOf } from '../messages.js';
import { joined, nameOf } from '../project.js';
import { taskLine } from '../task.js';
import { documentOf, withValue } from '../yaml_edit.js';

/** A look that takes a few seconds: enough to show what more poses would bring. */
const quickly = ['--candidates', '300', '--restarts', '1', '--proof-time', '0'];

/** @param {any} plan plan.json */
function errorText(plan) {
  const error = plan.expected_error;
  if (!error) return `${plan.poses.length} poses`;
  return `${quantity(usualError(error), 'm', 3)} with ${plan.poses.length} poses; ${quantity(error.by_noise, 'm', 3)} from noise alone`;
}

/** A slider with its value beside it. */
function slider(label, unit, attributes, oninput, onchange) {
  const shown = h('output', {});
  const input = h('input', { type: 'range', 'aria-label': label, ...attributes, oninput: () => (tell(), oninput?.()), onchange });
  const tell = () => (shown.textContent = `${input.value}${unit}`);
  tell();
  return { input, tell, element: h('label', {}, h('span', {}, label), input, shown) };
}

/** @param {import('../main.js').Live} live */
export function planStep(live) {
  const { project } = live;
  const poses = slider('Number of poses', '', { min: 3, max: 100, value: 30 }, undefined, () => project.write(withValue(project.text, ['design', 'poses'], poses.input.valueAsNumber)));
  const time = slider('Time at most', ' s', { min: 5, max: 600, step: 5, value: 60 });
  const expected = h('output', { class: 'expected' }, '–');
  const note = h('p', { class: 'note' });
  const task = taskLine(live);
  const go = h('button', { class: 'main' }, 'Plan');
  const inFolder = (name) => joined(project.folder, name);
  const planFile = () => inFolder('plan.json');

  project.addEventListener('text', () => {
    const written = documentOf(project.text)?.getIn(['design', 'poses']);
    if (Number.isInteger(written)) poses.input.value = String(written);
    poses.tell();
    expected.textContent = '–';
    note.textContent = '';
  });

  /** After every change that the program could draw. */
  live.quickLook = async () => {
    if (go.disabled || element.closest('[hidden]')) return;
    note.textContent = 'A quick look at the error to expect…';
    const { text } = project;
    const args = ['plan', nameOf(project.problem), ...quickly, '-o', 'quick.json', '--poses-csv', 'quick.csv', '--force', '--quiet'];
    const { code, files, err } = await live.look.run({ args, files: project.files, folder: project.folder });
    if (project.text !== text || code === 130) return;
    const bytes = files.get(inFolder('quick.json'));
    note.textContent = bytes ? 'From a quick look; Plan searches on.' : (err.at(-1) ?? '');
    if (!bytes) return;
    live.quick = { text, bytes, poses: files.get(inFolder('quick.csv')) };
    expected.textContent = errorText(JSON.parse(new TextDecoder().decode(bytes)));
  };

  const showReport = async () => {
    expected.textContent = errorText(JSON.parse(project.read(planFile())));
    const done = await task.run(['report', 'plan.json', '--problem', nameOf(project.problem), '--brief', '-o', 'report.html', '--force', '--quiet'], 'The report');
    const page = project.read(inFolder('report.html'));
    if (done.code === 0 && page) live.result.show('Plan', page);
    return done;
  };
  live.showPlan = async () => {
    const { code, err } = await showReport();
    if (code !== 0) live.complain(messagesOf(err, '').map((m) => m.text).join(' '));
  };

  /** The plan of the quick look takes the place of one that was stopped. */
  const keepQuick = () => {
    if (live.quick?.text !== project.text) return false;
    const { text, bytes, poses } = live.quick;
    project.add([[inFolder('plan.json'), bytes], [inFolder('poses.csv'), poses]], text);
    return true;
  };

  go.addEventListener('click', async () => {
    if (project.text === '') return live.complain('There is no problem yet: choose a robot first.');
    go.disabled = true;
    live.look.stop();
    note.textContent = '';
    const args = ['plan', nameOf(project.problem), '--time-limit', time.input.value, '-o', 'plan.json', '--poses-csv', 'poses.csv', '--force', '--verbose'];
    const { code } = await task.run(args, 'Planning');
    const advice = 'The slider of time ends a search with its best plan so far.';
    if (code === 0 && !project.current(planFile())) task.say('The problem has changed during the search: plan again.');
    else if (code === 0) await showReport();
    else if (code === 130 && project.current(planFile())) task.say(`Stopped: the plan from before stays. ${advice}`);
    else if (code === 130 && keepQuick()) {
      await showReport();
      task.say(`Stopped: this is the plan of the quick look. ${advice}`);
    } else if (code === 130) task.say(`Stopped before there was a plan. ${advice}`);
    go.disabled = false;
  });

  const element = h(
    'div',
    {},
    h('div', { class: 'sliders' }, poses.element, time.element),
    h('p', { class: 'expected-line' }, 'Error to expect after calibration: ', expected),
    note,
    go,
    task.element,
  );
  return element;
}
