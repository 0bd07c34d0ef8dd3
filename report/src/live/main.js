import { h } from '../dom.js';
import { watchTheme } from '../theme.js';
import { editor } from './editor.js';
import { licences } from './licences.js';
import { liveView } from './live_view.js';
import { messagesOf } from './messages.js';
import { Program } from './program.js';
import { Project, joined, nameOf } from './project.js';
import { resultFrame } from './result_frame.js';
import { placeMeshes, robotAmong } from './robot_files.js';
import { cellStep } from './steps/cell.js';
import { instrumentStep } from './steps/instrument.js';
import { measuredStep } from './steps/measured.js';
import { planStep } from './steps/plan.js';
import { robotStep } from './steps/robot.js';
import { takeStep } from './steps/take.js';
import { stepTabs } from './step_tabs.js';
import { documentOf } from './yaml_edit.js';

/**
 * What the parts of the page share.
 * @typedef {object} Live
 * @property {Project} project
 * @property {Program} look draws and looks quickly; a newer question ends an older one
 * @property {Program} work what a user has asked for
 * @property {ReturnType<typeof editor>} editor
 * @property {ReturnType<typeof resultFrame>} result
 * @property {(text: string) => void} complain
 * @property {(args: string[]) => Promise<any>} list what the program lists as JSON; undefined: it could not
 * @property {() => string|undefined} robotOf path of the URDF that the problem names
 * @property {(files: Map<string, Uint8Array>, robot?: string) => Promise<boolean>} begin writes a problem for the robot; whether it could
 * @property {() => string[]} [instrumentWords] options of init
 * @property {boolean} [planning]
 * @property {() => void} quickLook the error to expect, roughly
 * @property {() => Promise<void>} showPlan the report of the plan that is there
 * @property {{text: string, bytes: Uint8Array, poses: Uint8Array}} [quick] its plan, its poses, and the problem they are for
 */

const project = new Project();
const said = h('p', { class: 'complaint', role: 'alert', hidden: true });

/** @type {any} */
const live = {
  project,
  look: new Program(),
  work: new Program(),
  result: resultFrame(project, async (csv) => {
    const list = joined(project.folder, 'moved.csv');
    const files = new Map([...project.files, [list, new TextEncoder().encode(csv)]]);
    const { code, out, err } = await live.look.run({ args: ['report', 'plan.json', '--problem', nameOf(project.problem), '--judge', 'moved.csv', '--json'], files, folder: project.folder });
    return code === 0 ? JSON.parse(out) : { failed: messagesOf(err, '').map((m) => m.text).join(' ') || 'The program was stopped.' };
  }),
  complain(text) {
    said.textContent = text;
    said.hidden = text === '';
  },
  robotOf() {
    const urdf = documentOf(project.text)?.getIn(['robot', 'urdf']);
    return typeof urdf === 'string' ? joined(project.folder, urdf) : undefined;
  },
  async list(args) {
    const { code, out, err } = await live.work.run({ args: [...args, '--json'], files: new Map() });
    if (code === 0) return JSON.parse(out);
    live.complain(messagesOf(err, '').map((m) => m.text).join(' '));
    return undefined;
  },
  async begin(files, robot = live.robotOf()) {
    live.complain('');
    if (!robot) {
      live.complain('There is no robot yet: drop a URDF or choose an example.');
      return false;
    }
    // A problem of the same robot keeps its name and what can be undone.
    const again = live.robotOf() === robot;
    const problem = again ? live.project.problem : 'problem.yaml';
    const args = ['init', robot, ...live.instrumentWords(), '--yes', '-o', problem, '--force'];
    const { code, err, files: written } = await live.work.run({ args, files: new Map([...files].filter(([path]) => path !== problem)) });
    const messages = messagesOf(err, robot);
    if (code !== 0 || !written.has(problem)) {
      live.complain(messages.map((m) => (m.line > 0 ? `${nameOf(robot)}, line ${m.line}: ${m.text}` : m.text)).join(' '));
      return false;
    }
    if (again) {
      live.project.add([...files, ...written].filter(([path]) => path !== problem));
      live.project.write(new TextDecoder().decode(written.get(problem)));
    } else live.project.open(new Map([...files, ...written]), problem);
    live.complain(messages.map((m) => m.text).join(' '));
    return true;
  },
};

function build() {
  const examples = JSON.parse(document.getElementById('examples').textContent);
  live.editor = editor(live.project);
  const view = liveView(live, live.editor);
  const steps = stepTabs([
    ['Robot', robotStep(live, examples)],
    ['Instrument', instrumentStep(live)],
    ['Cell', cellStep(live)],
    ['Plan', planStep(live)],
    ['Take away', takeStep(live)],
    ['Measured data', measuredStep(live)],
  ], () => live.quickLook());
  document.getElementById('page').append(
    steps.tabs,
    said,
    h('div', { class: 'live' }, h('section', { class: 'picture-part', 'aria-label': 'Cell' }, view.element), h('div', { class: 'work-part' }, steps.panels, live.editor.element)),
    live.result.element,
  );
}

watchTheme();
build();
licences();
addEventListener('beforeunload', (event) => live.planning && event.preventDefault());
for (const name of ['dragover', 'drop']) addEventListener(name, (event) => event.preventDefault());
const given = document.getElementById('given').textContent;
if (given.startsWith('{')) {
  const { files, problem } = JSON.parse(given);
  const bytes = new Map(Object.entries(files).map(([path, text]) => [path, Uint8Array.from(atob(text), (c) => c.charCodeAt(0))]));
  const robot = robotAmong(bytes);
  if (robot) placeMeshes(bytes, robot);
  live.project.open(bytes, problem);
} else live.project.restore();
