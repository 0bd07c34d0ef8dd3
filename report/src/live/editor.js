import { h } from '../dom.js';
import { messageOf } from './messages.js';

/**
 * The problem's text with numbers of lines, and the program's messages at theirs.
 * @param {import('./project.js').Project} project
 */
export function editor(project) {
  const area = h('textarea', { class: 'yaml', spellcheck: 'false', wrap: 'off', autocapitalize: 'off', autocomplete: 'off', 'aria-label': 'Problem file (YAML)' });
  const gutter = h('div', { class: 'gutter', 'aria-hidden': 'true' });
  const undo = h('button', { class: 'small', onclick: () => project.undo() }, 'Undo');
  const list = h('ul', { class: 'messages', 'aria-live': 'polite' });
  let messages = /** @type {import('./messages.js').Message[]} */ ([]);
  let typing;

  const number = () => {
    const lines = area.value.split('\n').length;
    const kinds = new Map([...messages].reverse().map((m) => [m.line, m]));
    gutter.replaceChildren(
      ...Array.from({ length: lines }, (_, k) => {
        const message = kinds.get(k + 1);
        return h('div', { class: message?.kind, title: message?.text }, message ? `${message.kind === 'error' ? '✕' : '!'} ${k + 1}` : String(k + 1));
      }),
    );
    fit();
    gutter.scrollTop = area.scrollTop;
  };
  /** The bar below long lines takes nothing of the last line. */
  const fit = () => box.style.setProperty('--bar', `${area.offsetHeight - area.clientHeight}px`);
  const goTo = (line) => {
    const start = area.value.split('\n').slice(0, line - 1).reduce((sum, l) => sum + l.length + 1, 0);
    area.focus();
    area.setSelectionRange(start, start + (area.value.split('\n')[line - 1] ?? '').length);
    area.scrollTop = Math.max(0, (line - 4) * parseFloat(getComputedStyle(area).lineHeight));
  };
  area.addEventListener('scroll', () => (gutter.scrollTop = area.scrollTop));
  area.addEventListener('input', () => {
    number();
    clearTimeout(typing);
    typing = setTimeout(() => project.write(area.value, { typing: true }), 600);
  });
  project.addEventListener('text', (event) => {
    undo.disabled = project.before.length === 0;
    if (event.by?.typing) return;
    clearTimeout(typing);
    const { scrollTop } = area;
    area.value = project.text;
    area.scrollTop = scrollTop;
    number();
  });

  const box = h('div', { class: 'editor' }, gutter, area);
  new ResizeObserver(fit).observe(area);

  return {
    element: h('div', { class: 'editor-part' }, h('div', { class: 'editor-head' }, h('h2', {}, 'Problem file'), undo), list, box),
    /** @param {import('./messages.js').Message[]} found */
    show(found) {
      messages = found;
      list.replaceChildren(
        ...found.map((m) =>
          h('li', { class: m.kind }, m.line > 0 ? h('button', { class: 'bare line', onclick: () => goTo(m.line) }, `Line ${m.line}`) : null, m.line > 0 ? ': ' : '', m.text),
        ),
      );
      number();
    },
    /** @param {string[]} faults of a drawing */
    faults: (faults) => faults.map((text) => messageOf(text, project.problem)),
  };
}
