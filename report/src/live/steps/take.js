import { h } from '../../dom.js';
import { joined, nameOf } from '../project.js';
import { saveFile } from '../save_files.js';
import { taskLine } from '../task.js';

const offered = ['plan.json', 'poses.csv', 'report.html', 'calibrated.yaml', 'calibration.html', 'next.csv'];

/** What in the path of a URDF tells whose controller the robot has, or that no maker's format is for it. */
const makers = Object.entries({
  'kuka-krl': /kuka/,
  'abb-rapid': /abb|irb/,
  'fanuc-tp': /fanuc/,
  urscript: /universal|(^|[^a-z])ur\d/,
  'yaskawa-inform': /yaskawa|motoman/,
  'staubli-val3': /st[aä]e?ubli/,
  'joint-trajectory': /franka|panda/,
});

/** @param {import('../main.js').Live} live */
export function takeStep(live) {
  const { project } = live;
  const task = taskLine(live);
  const buttons = h('div', { class: 'buttons' });
  const old = h('p', { class: 'note' });
  const format = h('select', { 'aria-label': 'Format of the program' });
  const needs = h('p', { class: 'note' });
  const words = h('input', { 'aria-label': 'Further options', placeholder: 'further options, such as --speed 20' });
  let formats = [];
  const planFile = () => joined(project.folder, 'plan.json');

  const show = () => {
    const there = [project.problem, ...offered.map((name) => joined(project.folder, name))].filter((path) => project.files.has(path));
    const now = there.filter((path) => project.current(path));
    buttons.replaceChildren(...now.map((path) => h('button', { onclick: () => saveFile(path, project.files.get(path)) }, nameOf(path))));
    const names = there.filter((path) => !now.includes(path)).map(nameOf);
    old.textContent = names.length > 0 ? `The problem has changed since ${names.join(', ')}: plan or calibrate again, or undo the change.` : project.files.has(planFile()) ? '' : 'There is no plan yet: the step "Plan" makes one.';
    go.disabled = formats.length === 0 || !project.current(planFile());
  };
  const go = h('button', { class: 'main', disabled: true }, 'Write the program');
  go.addEventListener('click', async () => {
    const args = ['export', 'plan.json', '--to', format.value, '--force', ...words.value.split(/\s+/).filter(Boolean)];
    const { code, files } = await task.run(args, 'Writing', { keep: false });
    if (code !== 0) return;
    for (const [path, bytes] of files) saveFile(path, bytes);
    task.say(`Saved: ${[...files.keys()].map(nameOf).join(', ')}`);
  });
  const tell = () => (needs.textContent = formats.find((f) => f.name === format.value)?.needs ?? '');
  /** The format of the robot's maker, once for each robot: a reader may choose another. */
  let proposedFor = '';
  const propose = () => {
    const robot = live.robotOf() ?? '';
    if (formats.length === 0 || robot === proposedFor) return;
    proposedFor = robot;
    const [name] = makers.find(([, mark]) => mark.test(robot.toLowerCase())) ?? [];
    format.value = formats.find((f) => f.name === name)?.name ?? formats[0].name;
    tell();
  };
  format.addEventListener('change', tell);

  /** The formats are the program's. */
  const fill = async () => {
    if (formats.length > 0) return propose();
    formats = (await live.list(['export', '--to', 'list']))?.formats ?? [];
    format.replaceChildren(...formats.map((f) => h('option', { value: f.name }, `${f.name}: ${f.description}`)));
    tell();
    propose();
    show();
  };
  for (const event of ['text', 'files']) project.addEventListener(event, show);
  const element = h(
    'div',
    { class: 'fields' },
    h('h3', {}, 'Files'),
    buttons,
    old,
    h('h3', {}, 'Robot program or list of poses'),
    h('label', {}, 'Format ', format),
    needs,
    words,
    h('p', {}, go),
    task.element,
  );
  return Object.assign(element, { shown: fill });
}
