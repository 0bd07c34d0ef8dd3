import { unpackedBytes, unpackedText } from './unpack.js';

/**
 * What a call gives back.
 * @typedef {object} Outcome
 * @property {number} code exit status; 130: stopped
 * @property {string} out
 * @property {string[]} err lines
 * @property {Map<string, Uint8Array>} files new or changed, by path
 */

/** Compiled once for all workers. */
let parts;

async function programParts() {
  parts ??= (async () => {
    const source = await unpackedText('program-script');
    const bytes = await unpackedBytes('program-wasm');
    try {
      return { url: URL.createObjectURL(new Blob([source], { type: 'text/javascript' })), module: await WebAssembly.compile(bytes) };
    } catch (error) {
      throw new Error(`This browser cannot run the program (${error.message}); browsers of 2023 or later can.`);
    }
  })();
  return parts;
}

/** The program in a worker of its own. Calls wait for each other. */
export class Program {
  #tail = Promise.resolve();

  /**
   * @param {{args: string[], files: Map<string, Uint8Array>, folder?: string, onLine?: (line: string) => void}} call
   * @returns {Promise<Outcome>}
   */
  run(call) {
    const turn = this.#tail.then(() => this.#run(call));
    this.#tail = turn.catch(() => {});
    return turn;
  }

  async #run({ args, files, folder = '', onLine }) {
    let ready;
    try {
      ready = await programParts();
    } catch (error) {
      return { code: 1, out: '', err: [`posewright: ${error.message}`], files: new Map() };
    }
    const { url, module } = ready;
    this.worker ??= new Worker(url);
    const err = [];
    return new Promise((resolve) => {
      const end = (outcome) => {
        this.#end = undefined;
        resolve({ code: 1, out: '', err, files: new Map(), ...outcome });
      };
      this.#end = () => end({ code: 130 });
      const broken = (text) => {
        this.#drop();
        end({ err: [...err, inWords(text)] });
      };
      this.worker.onmessage = ({ data }) => {
        if (data.line !== undefined) {
          err.push(data.line);
          onLine?.(data.line);
        } else if (data.failed !== undefined) broken(data.failed);
        else end({ ...data.done, files: new Map(data.done.files) });
      };
      this.worker.onerror = (event) => broken(event.message ?? 'unknown');
      this.worker.postMessage({ module, args, files: [...files], folder });
    });
  }

  #end;

  /** Ends the call that is running; its outcome has code 130. */
  stop() {
    if (!this.#end) return;
    const end = this.#end;
    this.#drop();
    end();
  }

  #drop() {
    this.worker?.terminate();
    this.worker = undefined;
  }
}

/** @param {string} text of an exception */
function inWords(text) {
  if (/memory|allocation|out of bounds/i.test(text))
    return 'posewright: the browser has no more memory for this problem: fewer candidates or coarser meshes need less (a page may use 4 GB at most)';
  return `posewright: the program ended unexpectedly (${text}); your problem is kept`;
}
