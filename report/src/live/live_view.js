import { h } from '../dom.js';
import { CellViewer } from '../view/cell_viewer.js';
import { Handles } from './handles3d.js';
import { messagesOf } from './messages.js';
import { nameOf } from './project.js';
import { moved, thingsOf } from './things.js';

/**
 * The picture that follows the problem. The program draws it after every change; while it works the last one stays.
 * @param {import('./main.js').Live} live @param {ReturnType<typeof import('./editor.js').editor>} text
 */
export function liveView(live, text) {
  const { project, look: program } = live;
  const viewer = new CellViewer();
  const upright = h('input', { type: 'checkbox' });
  const busy = h('p', { class: 'busy', role: 'status' });
  let wanted = 0;
  let grips = /** @type {Handles|undefined} */ (undefined);

  const handles = () => {
    if (!viewer.solid) return;
    grips = new Handles(viewer.view, thingsOf(project.text), {
      upright: () => upright.checked,
      moved: (thing, position) => {
        const now = thingsOf(project.text).find((t) => t.key === thing.key);
        if (now) project.write(moved(project.text, now, position));
      },
    });
  };

  /** @param {string[]} words @returns whether the picture is that of the text as it is now */
  const drawWith = async (own, words) => {
    const { code, out, err } = await program.run({
      args: ['report', nameOf(project.problem), ...words, '--json', '-o', '-'],
      files: project.files,
      folder: project.folder,
    });
    if (own !== wanted || code === 130) return false;
    if (code !== 0) {
      text.show(messagesOf(err, project.problem));
      busy.textContent = viewer.report ? 'The picture is that of the last text without an error.' : 'There is no picture: see the messages at the text.';
      return false;
    }
    const report = JSON.parse(out);
    text.show([...text.faults(report.faults), ...report.notes.map((note) => ({ text: note, line: 0, kind: 'note' })), ...messagesOf(err, project.problem)]);
    // Nobody's hand loses what it drags: letting go asks for the next picture.
    if (grips?.grip) return true;
    viewer.show(report);
    lifts.hidden = !viewer.solid;
    hint.textContent = viewer.solid
      ? 'Drag a purple grip to move what stands in the cell.'
      : 'This browser has no WebGL: the picture is drawn in lines, and nothing can be dragged. Type positions in the steps or in the problem file.';
    handles();
    element.dataset.drawn = String(own);
    return true;
  };
  const draw = async () => {
    const own = ++wanted;
    if (project.text === '') return;
    program.stop();
    busy.textContent = 'The program looks at the cell…';
    if (!(await drawWith(own, ['--brief']))) return;
    busy.textContent = 'The program looks for ways from home…';
    if (!(await drawWith(own, []))) return;
    busy.textContent = '';
    live.quickLook();
  };
  let waiting;
  project.addEventListener('text', () => {
    clearTimeout(waiting);
    waiting = setTimeout(draw, 250);
  });

  const lifts = h('label', { class: 'note', hidden: true }, upright, ' grips move up and down');
  const hint = h('p', { class: 'note' });
  const element = h('div', { class: 'live-view' }, viewer.element, lifts, hint, busy);
  return { element, viewer };
}
