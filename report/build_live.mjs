// Builds the page that plans: one file with the program in it.
// node build_live.mjs WASM_FOLDER OUT.html [ADDRESS]   WASM_FOLDER has posewright.js, posewright.wasm and LICENSES.txt
// ADDRESS is one that the page may connect to, for trials with a program outside the page; none in a page that is given away.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { filled, hash, inline, licences, packed, read, script, style } from './build_parts.mjs';

const [, , wasm, out, address] = process.argv;
if (!out) {
  console.error('usage: node build_live.mjs WASM_FOLDER OUT.html');
  process.exit(2);
}

const examples = [
  { title: 'KUKA KR 270', files: ['kr270/kr270.urdf'], problem: '' },
  { title: 'KUKA KR 270 in a cell with a tracker', files: ['kr270/kr270.urdf', 'cell/problem.yaml'], problem: 'cell/problem.yaml' },
  { title: 'Hexapod of a telescope', files: ['telescope/problem.yaml'], problem: 'telescope/problem.yaml' },
  { title: 'Delta robot', files: ['delta/problem.yaml'], problem: 'delta/problem.yaml' },
].map((e) => ({ ...e, files: Object.fromEntries(e.files.map((path) => [path, read(`../examples/${path}`)])) }));

const wasmBytes = readFileSync(join(wasm, 'posewright.wasm'));
const policy = /Content-Security-Policy" content="([^"]*)/;
const reportPolicy = (wasmBytes.toString('latin1').match(policy) ?? read('dist/report.html').match(policy))[1];
/** Hashes that the program's report needs: a frame without an address of its own obeys this page's policy. @param {string} kind */
const reportHashes = (kind) => reportPolicy.match(new RegExp(`${kind} ([^;"]*)`))[1];

const whole = await script('src/live/main.js');
const styles = inline(await style(['base', 'parts', 'view', 'list', 'live']), 'style');
const loader = inline(read('src/loader.js').trim(), 'script');
/** A page from disk may start no worker that is a module. @param {string} module */
const classic = (module) => module.replace(/export\s+default\s+createPosewright;?/, '').replaceAll('import.meta.url', 'self.location.href');
const program = classic(readFileSync(join(wasm, 'posewright.js'), 'utf8')) + '\n' + read('src/live/worker.js');
const text = filled('src/live/index.html', {
  STYLE: styles,
  LOADER: loader,
  PACKED: packed(whole),
  SCRIPT_HASHES: `'${hash(loader)}' '${hash(whole)}' ${reportHashes('script-src')}`,
  STYLE_HASHES: `'${hash(styles)}' ${reportHashes('style-src')}`,
  CONNECT: address ?? "'none'",
  EXAMPLES: JSON.stringify(examples).replaceAll('<', '\\u003c'),
  PROGRAM_SCRIPT: packed(program),
  PROGRAM_WASM: packed(wasmBytes),
  LICENCES: packed([read('../LICENSE'), readFileSync(join(wasm, 'LICENSES.txt'), 'utf8'), '==== yaml', licences(['yaml'])].join('\n')),
  VERSION: read('../CMakeLists.txt').match(/VERSION (\d+\.\d+\.\d+)/)[1],
});
writeFileSync(out, text);
console.log(`${out}: ${(text.length / 1e6).toFixed(2)} MB`);
