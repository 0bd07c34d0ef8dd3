import { h } from '../dom.js';
import { joined } from './project.js';

/** A page reads a file whole: a larger one would leave no memory for the program. */
const mostBytes = 100e6;

/** @param {any} entry of a folder @param {string} folder @returns {Promise<[string, File][]>} */
async function filesOf(entry, folder = '') {
  const path = joined(folder, entry.name);
  if (entry.isFile) return [[path, await new Promise((resolve, reject) => entry.file(resolve, reject))]];
  const reader = entry.createReader();
  const all = [];
  for (;;) {
    // A reader gives at most a hundred at a time.
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) break;
    for (const child of some) all.push(...(await filesOf(child, path)));
  }
  return all;
}

/** @param {[string, File][]} found @returns {Promise<{files: Map<string, Uint8Array>, refused: string[]}>} */
async function contents(found) {
  const files = new Map();
  const refused = [];
  for (const [path, file] of found) {
    if (file.size > mostBytes) refused.push(`${path} has ${Math.round(file.size / 1e6)} MB; files of up to 100 MB are read.`);
    else files.set(path, new Uint8Array(await file.arrayBuffer()));
  }
  return { files, refused };
}

/**
 * A place for files: dropped, or chosen by a button.
 * @param {{label: string, hint: string, take: (files: Map<string, Uint8Array>) => any, complain: (text: string) => void, folder?: boolean}} options
 */
export function dropZone({ label, hint, take, complain, folder = false }) {
  const taken = async (found) => {
    try {
      const { files, refused } = await contents(await found);
      if (files.size > 0) await take(files);
      if (refused.length > 0) complain(refused.join(' '));
    } catch (error) {
      complain(`These files cannot be read: ${error.message}.`);
    }
  };
  const chosen = (input) => taken([...input.files].map((f) => [f.webkitRelativePath || f.name, f]));
  const picker = (attributes) => {
    const input = h('input', { type: 'file', multiple: true, hidden: true, ...attributes, onchange: () => chosen(input).then(() => (input.value = '')) });
    return input;
  };
  const files = picker({ 'aria-label': label });
  const whole = folder ? picker({ webkitdirectory: true, 'aria-label': `${label}, folder` }) : null;
  return h(
    'div',
    {
      class: 'drop',
      ondragover: (event) => (event.preventDefault(), event.currentTarget.classList.add('over')),
      ondragleave: (event) => event.currentTarget.classList.remove('over'),
      ondrop: (event) => {
        event.preventDefault();
        event.stopPropagation();
        event.currentTarget.classList.remove('over');
        const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
        taken(Promise.all(entries.map((entry) => filesOf(entry))).then((all) => all.flat()));
      },
    },
    h('p', {}, hint),
    h('div', { class: 'buttons' }, h('button', { onclick: () => files.click() }, label), whole ? h('button', { onclick: () => whole.click() }, 'Choose a folder') : null),
    files,
    whole,
  );
}
