import { h } from '../dom.js';
import { messagesOf, progressOf } from './messages.js';
import { nameOf } from './project.js';

/**
 * Calls of the program that take their time: one at once, with progress, Stop, and what the program said.
 * @param {import('./main.js').Live} live
 */
export function taskLine(live) {
  const bar = h('progress', { hidden: true, 'aria-label': 'Progress' });
  const said = h('p', { class: 'busy', role: 'status' });
  const stop = h('button', { hidden: true, onclick: () => live.work.stop() }, 'Stop');
  const messages = h('ul', { class: 'messages', 'aria-live': 'polite' });
  const element = h('div', { class: 'task' }, h('div', { class: 'task-line' }, stop, bar, said), messages);

  /**
   * @param {string[]} args @param {string} doing
   * @param {{extra?: [string, Uint8Array][], keep?: boolean}} [files] extra: for this call alone; keep: what it writes stays in the project
   * @returns {Promise<import('./program.js').Outcome>}
   */
  const run = async (args, doing, { extra = [], keep = true } = {}) => {
    const { project } = live;
    const { text } = project;
    const start = performance.now();
    const seconds = () => Math.round((performance.now() - start) / 1000);
    live.planning = true;
    stop.hidden = bar.hidden = false;
    bar.removeAttribute('value');
    messages.replaceChildren();
    let now = doing;
    const tell = () => (said.textContent = `${now}, ${seconds()} s`);
    const clock = setInterval(tell, 1000);
    tell();
    const outcome = await live.work.run({
      args,
      files: new Map([...project.files, ...extra]),
      folder: project.folder,
      onLine: (line) => {
        const progress = progressOf(line);
        if (!progress) return;
        now = progress.text;
        if (progress.share === undefined) bar.removeAttribute('value');
        else bar.value = progress.share;
        tell();
      },
    });
    clearInterval(clock);
    live.planning = false;
    stop.hidden = bar.hidden = true;
    said.textContent = outcome.code === 130 ? 'Stopped.' : '';
    if (keep) project.add(outcome.files, text);
    const found = messagesOf(outcome.err, project.problem);
    if (outcome.code !== 0) live.editor.show(found.filter((m) => m.line > 0));
    messages.replaceChildren(...found.map((m) => h('li', { class: m.kind }, m.line > 0 ? `${nameOf(project.problem)}, line ${m.line}: ` : '', m.text)));
    return outcome;
  };
  return { element, run, say: (text) => (said.textContent = text) };
}
