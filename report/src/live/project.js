import { keep, kept } from './keep.js';

/** @param {string} path */
export const folderOf = (path) => path.split('/').slice(0, -1).join('/');
/** @param {string} path */
export const nameOf = (path) => path.split('/').at(-1);
/** @param {string} a @param {string} b */
export const joined = (a, b) => [a, b].filter(Boolean).join('/');

const encoder = new TextEncoder();
const decoder = new TextDecoder();

/**
 * The one state of the page: files by path, and which of them is the problem. Event "text": the problem's text has
 * changed; "files": others have.
 */
export class Project extends EventTarget {
  constructor() {
    super();
    /** @type {Map<string, Uint8Array>} */
    this.files = new Map();
    this.problem = '';
    /** @type {string[]} */
    this.before = [];
  }

  get text() {
    const bytes = this.files.get(this.problem);
    return bytes ? decoder.decode(bytes) : '';
  }

  get folder() {
    return folderOf(this.problem);
  }

  /** @param {string} path */
  read(path) {
    const bytes = this.files.get(path);
    return bytes && decoder.decode(bytes);
  }

  /** Another robot. @param {Map<string, Uint8Array>} files @param {string} problem */
  open(files, problem) {
    this.files = files;
    this.problem = problem;
    this.before = [];
    this.#changed('files');
    this.#changed('text');
  }

  /** @param {string} text @param {any} [by] who changed it, so that its own listener may leave it alone */
  write(text, by) {
    if (text === this.text) return;
    if (by?.typing !== true) this.before.push(this.text);
    this.files.set(this.problem, encoder.encode(text));
    this.#changed('text', by);
  }

  undo() {
    const text = this.before.pop();
    if (text === undefined) return;
    this.files.set(this.problem, encoder.encode(text));
    this.#changed('text');
  }

  /** @param {Map<string, Uint8Array>|[string, Uint8Array][]} files */
  add(files) {
    for (const [path, bytes] of files) this.files.set(path, bytes);
    this.#changed('files');
  }

  /** What the page had when it was closed. */
  async restore() {
    const old = await kept();
    if (old?.files.has(old.problem)) this.open(old.files, old.problem);
    return this.problem !== '';
  }

  #changed(name, by) {
    this.dispatchEvent(Object.assign(new Event(name), { by }));
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => keep({ files: this.files, problem: this.problem }), 500);
  }
}
