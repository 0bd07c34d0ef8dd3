// node tests/report/result_screenshots.mjs --program PATH --out DIR --screenshots DIR
// The pictures of result pages in the documentation: larger examples than the test's, the measured FANUC where its data are.
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, symlinkSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { launch, open } from './browser.mjs';

const root = fileURLToPath(new URL('../../', import.meta.url));
const { values } = parseArgs({ options: { program: { type: 'string' }, out: { type: 'string' }, screenshots: { type: 'string' } } });
if (!values.program || !values.out || !values.screenshots) {
  console.error('usage: result_screenshots.mjs --program PATH --out DIR --screenshots DIR');
  process.exit(2);
}
const folder = resolve(values.out);
mkdirSync(folder, { recursive: true });
const program = resolve(values.program);
// As a reader's folder has them: names of files stand on the pages.
const example = (name) => join('examples', name);
if (!existsSync(join(folder, 'examples'))) symlinkSync(join(root, 'examples'), join(folder, 'examples'));
const run = (...words) => execFileSync(program, words, { cwd: folder, encoding: 'utf8', maxBuffer: 1e9 });
const save = (name, ...words) => writeFileSync(join(folder, `${name}.json`), run(...words, '--json', '--quiet'));

/** The FANUC's readings, or those of a virtual KR 270. @returns {[string, string]} problem and data */
function readings() {
  const data = join(root, '../shared/data/fanuc_r2000');
  if (!existsSync(data)) return [example('kr270/problem.yaml'), 'measured.csv'];
  execFileSync('python3', [example('real_data/fanuc_r2000/convert.py'), data, 'fanuc.csv'], { cwd: folder });
  return [example('real_data/fanuc_r2000/problem.yaml'), 'fanuc.csv'];
}

const kr270 = example('kr270/problem.yaml');
const quick = ['--candidates', '1000', '--restarts', '1', '--method', 'exchange', '--quiet', '--force', '--poses-csv', '-'];
run('plan', kr270, '--poses', '18', ...quick, '-o', 'a.json');
run('plan', kr270, '--poses', '24', ...quick, '-o', 'b.json');
save('simulation', 'simulate', kr270, 'a.json', '--draws', '2000', '--data', 'measured.csv', '--force');
const [problem, data] = readings();
save('calibration', 'calibrate', problem, data, '--hold-back', '4');
save(
  'comparison',
  'compare',
  example('telescope/problem.yaml'),
  '--variant',
  'rigid,linear,matrix',
  '--truth',
  'matrix',
  '--candidates',
  '400',
  '--restarts',
  '1',
);
save('stations', 'stations', example('cell/problem.yaml'), '--poses', '14', '--candidates', '300', '--restarts', '1', '--full', '3');

copyFileSync(join(root, 'tests/report/next.json'), join(folder, 'next.json'));
const pages = [
  { name: 'calibration', words: ['calibration.json'], height: 1900, narrow: true },
  { name: 'simulation', words: ['simulation.json'], height: 1450 },
  { name: 'comparison', words: ['comparison.json'], height: 1500 },
  { name: 'stations', words: ['stations.json'], height: 1420 },
  { name: 'next', words: ['next.json'], height: 1050 },
  { name: 'two-plans', words: ['a.json', 'b.json'], height: 1500 },
];
const browser = await launch({ webgl: true });
for (const { name, words, height, narrow } of pages) {
  const page = join(folder, `${name}.html`);
  run('report', ...words, '-o', page, '--force', '--quiet');
  for (const [suffix, width] of [['', 1400], ...(narrow ? [['-narrow', 420]] : [])]) {
    const { page: shown } = await open(browser, page, { viewport: { width, height } });
    await shown.screenshot({ path: join(values.screenshots, `report-${name}${suffix}.png`) });
    await shown.close();
  }
}
await browser.close();
