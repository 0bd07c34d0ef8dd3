import { h } from '../../dom.js';
import { joined } from '../project.js';
import { saveFile } from '../save_files.js';
import { taskLine } from '../task.js';

const offered = ['plan.json', 'poses.csv', 'report.html', 'calibrated.yaml', 'calibration.html', 'next.csv', 'corrected.urdf'];

/** @param {import('../main.js').Live} live */
export function takeStep(live) {
  const { project } = live;
  const task = taskLine(live);
  const buttons = h('div', { class: 'buttons' });
  const format = h('select', { 'aria-label': 'Format of the program' });
  const needs = h('p', { class: 'note' });
  const words = h('input', { 'aria-label': 'Further options', placeholder: 'further options, such as --speed 20' });
  let formats = [];
  const planFile = () => joined(project.folder, 'plan.json');

  const show = () => {
    const there = [project.problem, ...offered.map((name) => joined(project.folder, name))].filter((path) => project.files.has(path));
    buttons.replaceChildren(...there.map((path) => h('button', { onclick: () => saveFile(path, project.files.get(path)) }, path.split('/').at(-1))));
    go.disabled = !project.files.has(planFile());
  };
  const go = h('button', { class: 'main', disabled: true }, 'Write the program');
  go.addEventListener('click', async () => {
    const before = new Set(project.files.keys());
    const args = ['export', 'plan.json', '--to', format.value, '--force', ...words.value.split(/\s+/).filter(Boolean)];
    const { code, files } = await task.run(args, 'Writing');
    if (code !== 0) return;
    for (const [path, bytes] of files) saveFile(path, bytes);
    for (const path of files.keys()) if (!before.has(path)) project.files.delete(path);
    task.say(`Saved: ${[...files.keys()].join(', ')}`);
  });
  format.addEventListener('change', () => (needs.textContent = formats.find((f) => f.name === format.value)?.needs ?? ''));

  /** The formats are the program's. */
  const fill = async () => {
    if (formats.length > 0) return;
    const { out } = await live.work.run({ args: ['export', '--to', 'list', '--json'], files: new Map() });
    formats = JSON.parse(out).formats;
    format.replaceChildren(...formats.map((f) => h('option', { value: f.name }, `${f.name}: ${f.description}`)));
    format.dispatchEvent(new Event('change'));
  };
  for (const event of ['text', 'files']) project.addEventListener(event, show);
  const element = h(
    'div',
    { class: 'fields' },
    h('h3', {}, 'Files'),
    buttons,
    h('h3', {}, 'Robot program or list of poses'),
    h('label', {}, 'Format ', format),
    needs,
    words,
    h('p', {}, go),
    task.element,
  );
  return Object.assign(element, { shown: fill });
}
