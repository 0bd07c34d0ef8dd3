import { h } from '../../dom.js';
import { dropZone } from '../dropped.js';
import { joined, nameOf } from '../project.js';
import { saveFile } from '../save_files.js';
import { taskLine } from '../task.js';

/** @param {import('../main.js').Live} live */
export function measuredStep(live) {
  const { project } = live;
  const task = taskLine(live);
  const encoder = new TextEncoder();
  const problem = () => nameOf(project.problem);
  const inFolder = (name) => joined(project.folder, name);
  /** Readings: their name and bytes. */
  let data = /** @type {[string, Uint8Array]|undefined} */ (undefined);
  const readings = () => ({ extra: /** @type {[string, Uint8Array][]} */ ([[inFolder(data[0]), data[1]]]) });

  /** A result as a page. @param {string} name of its files @param {string} title @param {string} out JSON */
  const showResult = async (name, title, out) => {
    const { code } = await task.run(['report', `${name}.json`, '-o', `${name}.html`, '--force', '--quiet'], 'The report', { extra: [[inFolder(`${name}.json`), encoder.encode(out)]] });
    if (code === 0) live.result.show(title, project.read(inFolder(`${name}.html`)));
  };
  const calibrate = async (files) => {
    if (project.text === '') return live.complain('Readings need their problem file: choose the robot or drop the problem first.');
    const csv = [...files.keys()].find((path) => /\.csv$/i.test(path));
    if (!csv) return live.complain('Readings are a CSV file: a row a pose, columns of joints and readings as in poses.csv.');
    data = [nameOf(csv), files.get(csv)];
    const { code, out } = await task.run(['calibrate', problem(), data[0], '-o', 'calibrated.yaml', '--force', '--json'], 'Calibrating', readings());
    if (out.startsWith('{')) await showResult('calibration', 'Calibration', out);
    for (const button of then) button.disabled = code !== 0;
  };
  const next = async () => {
    const { code, out } = await task.run(['next', problem(), '--data', data[0], '--poses', '5', '--state', '-', '-o', 'next.csv', '--force', '--json'], 'Choosing the next poses', readings());
    if (code === 0) await showResult('next', 'Next poses', out);
  };
  const urdf = async () => {
    const { code, files } = await task.run(['calibrate', problem(), data[0], '--urdf', 'corrected.urdf', '-o', '-', '--force', '--quiet'], 'Writing the URDF', { ...readings(), keep: false });
    if (code === 0) for (const [path, bytes] of files) saveFile(path, bytes);
  };
  const compensate = async (files) => {
    if (!project.current(inFolder('calibrated.yaml'))) return live.complain('Programs are compensated by a calibration of this problem: drop measured data first.');
    const extra = [...files].map(([path, bytes]) => /** @type {[string, Uint8Array]} */ ([inFolder(nameOf(path)), bytes]));
    const names = [...files.keys()].map(nameOf);
    const to = names.length > 1 ? 'corrected' : `corrected-${names[0]}`;
    const { code, files: written } = await task.run(['compensate', 'calibrated.yaml', ...names, '-o', to, '--force'], 'Compensating', { extra, keep: false });
    if (code === 0) for (const [path, bytes] of written) saveFile(path, bytes);
  };
  const then = [
    h('button', { disabled: true, onclick: next }, 'Next poses'),
    h('button', { disabled: true, onclick: urdf }, 'Corrected URDF'),
  ];
  return h(
    'div',
    {},
    dropZone({ label: 'Choose readings', hint: 'Drop the readings of the poses (CSV): the program calibrates and judges.', take: calibrate, complain: live.complain }),
    h('div', { class: 'buttons' }, then),
    dropZone({ label: 'Choose programs', hint: 'Then drop robot programs or lists of poses: they come back compensated.', take: compensate, complain: live.complain }),
    task.element,
  );
}
