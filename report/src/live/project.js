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
    /** Files that the program made, with the problem's text that each is of. @type {Map<string, string>} */
    this.made = new Map();
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

  /** The files without what the program made of them. */
  get given() {
    return new Map([...this.files].filter(([path]) => !this.made.has(path)));
  }

  /** Whether a file is there and is no result of another text of the problem. @param {string} path */
  current(path) {
    return this.files.has(path) && (this.made.get(path) ?? this.text) === this.text;
  }

  /** Another robot. @param {Map<string, Uint8Array>} files @param {string} problem @param {Map<string, string>} [made] */
  open(files, problem, made = new Map()) {
    this.files = files;
    this.problem = problem;
    this.made = made;
    this.before = [];
    this.#changed('files');
    this.#changed('text');
  }

  /** @param {string} text @param {any} [by] who changed it, so that its own listener may leave it alone */
  write(text, by) {
    if (text === this.text) return;
    // What is typed in one go is one step back.
    const typed = by?.typing === true;
    if (!typed || !this.typed) this.before.push(this.text);
    this.typed = typed;
    this.files.set(this.problem, encoder.encode(text));
    this.#changed('text', by);
  }

  undo() {
    const text = this.before.pop();
    if (text === undefined) return;
    this.typed = false;
    this.files.set(this.problem, encoder.encode(text));
    this.#changed('text');
  }

  /** @param {Map<string, Uint8Array>|[string, Uint8Array][]} files @param {string} [text] the problem that they are results of */
  add(files, text) {
    for (const [path, bytes] of files) {
      this.files.set(path, bytes);
      if (text === undefined) this.made.delete(path);
      else this.made.set(path, text);
    }
    this.#changed('files');
  }

  /** What the page had when it was closed. */
  async restore() {
    const old = await kept();
    if (old?.files.has(old.problem)) this.open(old.files, old.problem, old.made);
    return this.problem !== '';
  }

  #changed(name, by) {
    this.dispatchEvent(Object.assign(new Event(name), { by }));
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => keep({ files: this.files, problem: this.problem, made: this.made }), 500);
  }
}
