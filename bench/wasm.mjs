// node bench/wasm.mjs PROGRAM WASM_BUILD [COUNT...]
// Seconds of the processor for a start and for plans of the KR 270 from COUNT candidates (2000, 10000): the native PROGRAM with
// one thread, and the same program as WebAssembly in node and in Chromium. WASM_BUILD is build/wasm, after `scripts/wasm`.
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { launch } from '../tests/report/browser.mjs';

const [, , program, build, ...counts] = process.argv;
if (!build) {
  console.error('usage: node bench/wasm.mjs PROGRAM WASM_BUILD [COUNT...]');
  process.exit(2);
}
const folder = fileURLToPath(new URL('../examples/kr270/', import.meta.url));
const files = ['problem.yaml', 'kr270.urdf'].map((name) => [name, readFileSync(join(folder, name), 'utf8')]);
const plan = (count) => ['plan', 'problem.yaml', '--candidates', count, '--proof-time', '0', '-o', '-', '--poses-csv', '-', '--quiet', '--json', '--threads', '1'];
const works = [['start', ['--version']], ...(counts.length > 0 ? counts : ['2000', '10000']).map((n) => [`plan, ${n} candidates`, plan(n)])];
const logDet = (text) => text.match(/"log_det": ?([\d.]+)/)?.[1] ?? '';

function inSystem(command) {
  const { stdout, stderr } = spawnSync('bash', ['-c', 'TIMEFORMAT="%U %S"; time "$@"', 'bash', ...command], { cwd: folder, encoding: 'utf8' });
  const [user, system] = stderr.trim().split('\n').at(-1).split(' ').map(Number);
  return { seconds: user + system, value: logDet(stdout) };
}

/** The module for pages on an empty page. The start has the compilation of the module, as a page has. */
async function inChromium(words) {
  const browser = await launch({ webgl: false });
  const page = await browser.newPage();
  page.setDefaultTimeout(0);
  const session = await page.context().newCDPSession(page);
  await session.send('Performance.enable', { timeDomain: 'threadTicks' });
  const busy = async () => (await session.send('Performance.getMetrics')).metrics.find((m) => m.name === 'TaskDuration').value;
  const script = readFileSync(join(build, 'page/posewright.js'), 'utf8').replace(/export\s+default\s+createPosewright;?/, '').replaceAll('import.meta.url', '"file:///posewright.js"');
  await page.addScriptTag({ content: script });
  await page.evaluate((text) => (window.wasmBinary = Uint8Array.from(atob(text), (c) => c.charCodeAt(0))), readFileSync(join(build, 'page/posewright.wasm')).toString('base64'));
  const before = await busy();
  const out = await page.evaluate(async ({ words, files }) => {
    const lines = [];
    const program = await createPosewright({ wasmBinary: window.wasmBinary, print: (line) => lines.push(line), printErr: () => {} });
    for (const [name, text] of files) program.FS.writeFile(name, text);
    program.callMain(words);
    return lines.join('\n');
  }, { words, files });
  const seconds = (await busy()) - before;
  await browser.close();
  return { seconds, value: logDet(out) };
}

for (const [name, words] of works) {
  const native = inSystem([resolve(program), ...words]);
  const node = inSystem(['node', resolve(build, 'npm/posewright.mjs'), ...words]);
  const chromium = await inChromium(words);
  for (const [where, r] of Object.entries({ native, node, chromium })) console.log(`${name}, ${where}: ${r.seconds.toFixed(2)} s ${r.value}`);
}
