// Runs the program in a worker: one instance a call, files in memory. The build puts the program's own script in front,
// which defines `createPosewright`.
const root = '/work';
const decoder = new TextDecoder();

/** @param {any} FS @param {string} folder */
function makeFolder(FS, folder) {
  let at = '';
  for (const part of folder.split('/').filter(Boolean)) {
    at += `/${part}`;
    if (!FS.analyzePath(at).exists) FS.mkdir(at);
  }
}

/** @param {any} FS @param {string} folder @param {(path: string, bytes: Uint8Array) => void} take */
function walk(FS, folder, take) {
  for (const name of FS.readdir(folder)) {
    if (name === '.' || name === '..') continue;
    const path = `${folder}/${name}`;
    if (FS.isDir(FS.stat(path).mode)) walk(FS, path, take);
    else take(path.slice(root.length + 1), FS.readFile(path));
  }
}

const same = (a, b) => a !== undefined && a.length === b.length && a.every((v, k) => v === b[k]);

/** Takes bytes and gives whole lines. @param {(line: string) => void} take */
function lines(take) {
  let bytes = [];
  return (byte) => {
    if (byte !== 10) return bytes.push(byte);
    take(decoder.decode(Uint8Array.from(bytes)));
    bytes = [];
  };
}

async function call({ module, args, files, folder }) {
  const out = [];
  // By bytes: lines would count as a terminal's.
  const program = await createPosewright({
    noInitialRun: true,
    stdin: () => null,
    stdout: (byte) => out.push(byte),
    stderr: lines((line) => postMessage({ line })),
    instantiateWasm: (imports, done) => {
      WebAssembly.instantiate(module, imports).then((instance) => done(instance, module));
      return {};
    },
  });
  const { FS } = program;
  makeFolder(FS, `${root}/${folder}`);
  for (const [path, bytes] of files) {
    makeFolder(FS, `${root}/${path}`.replace(/\/[^/]*$/, ''));
    FS.writeFile(`${root}/${path}`, bytes);
  }
  FS.chdir(`${root}/${folder}`);
  let code;
  try {
    code = program.callMain(args);
  } catch (error) {
    if (typeof error?.status !== 'number') throw error;
    code = error.status;
  }
  const given = new Map(files);
  const written = [];
  walk(FS, root, (path, bytes) => same(given.get(path), bytes) || written.push([path, bytes]));
  return { code, out: decoder.decode(Uint8Array.from(out)), files: written };
}

onmessage = async ({ data }) => {
  try {
    postMessage({ done: await call(data) });
  } catch (error) {
    postMessage({ failed: String(error?.message ?? error) });
  }
};
