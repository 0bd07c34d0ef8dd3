// node tests/report/live_test.mjs --program PATH --wasm DIR --out DIR [--screenshots DIR] [--address URL]
// The page that plans, as one file from disk without a network: from a robot to its program, and from readings to a
// compensated program. DIR has posewright.js and posewright.wasm of `scripts/wasm`. Returns 77 where they or a browser are
// missing. --address lets the page connect to a program outside of it, for trials.
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { launch, missing, skipped } from './browser.mjs';
import { about, check, near, verdict } from './checks.mjs';
import { checkLeftovers, overflow } from './reading_checks.mjs';

const names = ['program', 'wasm', 'out', 'screenshots', 'address'];
const { values } = parseArgs({ options: Object.fromEntries(names.map((name) => [name, { type: 'string' }])) });
if (!values.program || !values.wasm || !values.out) {
  console.error('usage: live_test.mjs --program PATH --wasm DIR --out DIR');
  process.exit(2);
}
const lacking = existsSync(join(values.wasm, 'posewright.wasm')) ? missing() : 'the program for pages is missing (scripts/wasm makes it)';
if (lacking) {
  console.log(`Skipped: ${lacking}.`);
  process.exit(skipped);
}

const root = fileURLToPath(new URL('../../', import.meta.url));
const out = resolve(values.out);
const file = join(out, 'posewright.html');
mkdirSync(out, { recursive: true });
execFileSync('node', [join(root, 'report/build_live.mjs'), resolve(values.wasm), file, ...(values.address ? [values.address] : [])]);

/** A KR 270 with few candidates, its plan and the readings of a virtual one, made by the native program. */
function nativeFiles() {
  const run = (...words) => execFileSync(resolve(values.program), words, { cwd: out, encoding: 'utf8' });
  copyFileSync(join(root, 'examples/kr270/kr270.urdf'), join(out, 'kr270.urdf'));
  run('init', 'kr270.urdf', '--tracker', '--yes', '--poses', '16', '--force', '-o', 'my arm.yaml');
  const small = ['--candidates', '300', '--restarts', '1', '--proof-time', '0', '--force', '--quiet'];
  run('plan', 'my arm.yaml', ...small);
  run('simulate', 'my arm.yaml', 'plan.json', '--draws', '2', '--data', 'measured.csv', '--force', '--quiet');
  run('export', 'plan.json', '--to', 'kuka-krl', '-o', 'CALPOSES.src', '--force', '--quiet');
}

const drawings = (page) => page.locator('.live-view').evaluate((e) => Number(e.dataset.drawn ?? 0));
/** Does something and waits for the picture after it. */
async function redrawn(page, act) {
  const before = await drawings(page);
  await act();
  await page.waitForFunction((n) => Number(document.querySelector('.live-view').dataset.drawn ?? 0) > n, before);
}
const text = (page) => page.locator('.yaml').inputValue();
const step = (page, name) => page.getByRole('tab', { name }).click();
async function download(page, act) {
  const [saved] = await Promise.all([page.waitForEvent('download'), act()]);
  return { name: saved.suggestedFilename(), text: readFileSync(await saved.path(), 'utf8') };
}
async function shot(page, name) {
  if (!values.screenshots) return;
  mkdirSync(values.screenshots, { recursive: true });
  for (const [suffix, width] of [['', 1400], ['-narrow', 420]]) {
    await page.setViewportSize({ width, height: 900 });
    await page.waitForTimeout(700);
    await page.screenshot({ path: join(values.screenshots, `live-${name}${suffix}.png`) });
  }
  await page.setViewportSize({ width: 1400, height: 900 });
}

/** From an empty page to a picture; what is wrong in space is seen. */
async function checkCell(page) {
  about('robot, instrument and cell');
  const start = performance.now();
  await redrawn(page, () => page.getByRole('combobox', { name: 'Example' }).selectOption('KUKA KR 270'));
  console.log(`A first picture after ${((performance.now() - start) / 1000).toFixed(1)} s`);
  check((await text(page)).includes('laser tracker'), 'init has written a problem');
  check((await page.locator('.verdicts').innerText()).includes('can be measured'), 'configurations are judged');
  await shot(page, 'robot');

  await step(page, /Cell/);
  const before = await text(page);
  await redrawn(page, () => page.getByRole('button', { name: 'Add a box' }).click());
  check((await page.locator('.live-view .stop').innerText()).trim() === 'Home: collision with box', 'home in the box is seen');
  await shot(page, 'cell');
  const x = page.getByRole('spinbutton', { name: 'box, x, mm' });
  await redrawn(page, async () => (await x.fill('-1500'), await x.blur()));
  check((await text(page)).includes('at: ["-1500 mm"') || (await text(page)).includes('at: [-1.5'), 'a number moves the box in the text');
  check(!(await page.locator('.live-view .stop').innerText()).includes('box'), 'and in the picture');
  await redrawn(page, () => page.getByRole('button', { name: 'Remove box' }).click());
  check((await text(page)) === before, 'the text is as it was, with all comments');

  const wrong = before.replace('laser_tracker', 'laser_trackr');
  await page.locator('.yaml').fill(wrong);
  await page.locator('.gutter .error').waitFor();
  const line = wrong.split('\n').findIndex((l) => l.includes('laser_trackr')) + 1;
  check((await page.locator('.gutter .error').innerText()).endsWith(String(line)), 'a message stands at its line', line);
  check((await page.locator('.editor-part .messages').innerText()).includes("did you mean 'laser_tracker'"), 'with what the program says');
  await redrawn(page, () => page.locator('.yaml').fill(before));
}

/** A drag in the picture changes the text. */
async function checkDrag(page) {
  await step(page, /Instrument/);
  check(!(await page.getByRole('combobox', { name: 'Camera' }).isVisible()), 'a tracker asks for no camera');
  const before = await text(page);
  await page.getByRole('button', { name: 'Top' }).click();
  await page.waitForTimeout(500);
  const box = await page.locator('.live-view canvas').boundingBox();
  const place = await page.locator('.label', { hasText: 'station A' }).evaluate((label) => label.style.transform.match(/-?\d+/g).map(Number));
  await page.mouse.move(box.x + place[0], box.y + place[1]);
  await page.mouse.down();
  await page.mouse.move(box.x + place[0] - 40, box.y + place[1] + 10, { steps: 4 });
  await redrawn(page, () => page.mouse.up());
  const changed = (await text(page)).split('\n').filter((l, k) => l !== before.split('\n')[k]);
  check(changed.length === 1 && /stations: \{A: \[/.test(changed[0]), 'dragging the tracker changes its line alone', changed);
  await redrawn(page, () => page.getByRole('button', { name: 'Undo' }).click());
  check((await text(page)) === before, 'Undo brings it back');
}

/** Where the base moves, the cell is not in the measurement frame: a body stays where it is dropped all the same. */
async function checkMovingBase(page) {
  about('a base that moves');
  await step(page, /Robot/);
  const given = (name) => ({ name, mimeType: 'text/plain', buffer: readFileSync(join(root, 'examples/two_arms', name)) });
  const files = [given('left_sees_right.yaml'), given('two_arms.urdf')];
  await redrawn(page, () => page.locator('#step-0 input[type=file]').first().setInputFiles(files));
  await step(page, /Cell/);
  await redrawn(page, () => page.getByRole('button', { name: 'Add a box' }).click());
  await page.locator('.live-view').getByRole('button', { name: 'All' }).click();
  await page.waitForTimeout(500);
  const canvas = page.locator('.live-view canvas');
  const grip = () => canvas.evaluate((c) => JSON.parse(c.dataset.grips).box);
  const [before, box, from] = [await text(page), await canvas.boundingBox(), await grip()];
  await page.mouse.move(box.x + from[0], box.y + from[1]);
  await page.mouse.down();
  await page.mouse.move(box.x + from[0] + 12, box.y + from[1] - 9, { steps: 4 });
  await redrawn(page, () => page.mouse.up());
  const to = await grip();
  check((await text(page)) !== before, 'dragging the box changes the text');
  check(Math.hypot(to[0] - from[0] - 12, to[1] - from[1] + 9) < 2, 'it is drawn where it was dropped', [from, to]);
  const drawn = Math.hypot(to[0] - from[0], to[1] - from[1]);
  check(drawn > 5, 'which is elsewhere', drawn);
}

/** @returns the text of the program that was exported */
async function checkPlan(page) {
  about('plan and program');
  await step(page, /Plan/);
  await redrawn(page, async () => {
    await page.getByRole('slider', { name: 'Number of poses' }).fill('14');
    await page.getByRole('slider', { name: 'Number of poses' }).dispatchEvent('change');
  });
  check(/\n {2}poses: 14\n/.test(await text(page)), 'the slider changes the text');
  await page.waitForFunction(() => /mm|µm/.test(document.querySelector('.expected').textContent));
  await page.getByRole('slider', { name: 'Time at most' }).fill('10');
  const start = performance.now();
  await page.getByRole('button', { name: 'Plan', exact: true }).click();
  await page.locator('#result iframe').waitFor();
  const report = page.frameLocator('#result iframe');
  check((await report.locator('.tile b').first().textContent()) === '14', 'the report has 14 poses');
  console.log(`A plan and its report after ${((performance.now() - start) / 1000).toFixed(1)} s`);
  await shot(page, 'plan');
  await step(page, /Take away/);
  const plan = JSON.parse((await download(page, () => page.getByRole('button', { name: 'plan.json' }).click())).text);
  check(plan.poses.length === 14, 'plan.json can be taken away', plan.poses.length);
  const files = [];
  page.on('download', async (d) => files.push(d.suggestedFilename()));
  const program = await download(page, () => page.getByRole('button', { name: 'Write the program' }).click());
  await page.waitForTimeout(500);
  check(files.includes('CALPOSES.src') && files.includes('CALPOSES.dat'), 'a KRL program can be taken away', files);
  check(program.text.length > 100, 'that is not empty');
  await shot(page, 'take');
  const edited = (await text(page)).replace('poses: 14', 'poses: 13');
  await redrawn(page, () => page.locator('.yaml').fill(edited));
  check((await page.getByRole('button', { name: 'plan.json' }).count()) === 0, 'the plan of another text cannot be taken away');
  check(await page.getByRole('button', { name: 'Write the program' }).isDisabled(), 'nor its program');
  check(/changed since plan.json/.test(await page.locator('#step-4').innerText()), 'and the page says why');
  check(/before it was changed/.test(await page.locator('#result-title').innerText()), 'its report is marked');
  await redrawn(page, () => page.locator('.yaml').fill(edited.replace('poses: 13', 'poses: 14')));
  check((await page.getByRole('button', { name: 'plan.json' }).count()) === 1, 'with its own text it can');
}

/** A pose that is moved in the report: what the page shows of the list is what the native program evaluates. */
async function checkMove(page) {
  about('a moved pose');
  const report = page.frameLocator('#result iframe');
  const value = async (id) => Number(await report.locator(`#list-${id}`).getAttribute('data-value'));
  const verdict = report.locator('.mover .verdict');
  await report.locator('.rows li .preview').last().click();
  await report.locator('.mover summary').click();
  const slider = report.getByRole('slider', { name: /^joint_a1 of pose/ });
  await slider.waitFor();
  check((await verdict.innerText()).startsWith('Feasible here'), 'where the plan has it a pose is feasible', await verdict.innerText());
  const [before, tip] = [await value('logdet'), await report.locator('.view canvas, .view svg').first().getAttribute('data-tip')];
  const judged = async (act) => {
    await act();
    await report.locator('.mover .verdict:not([data-asked])').waitFor();
  };
  const start = performance.now();
  await judged(() => slider.fill('20'));
  console.log(`A moved pose is judged after ${(performance.now() - start).toFixed(0)} ms`);
  check((await report.locator('.view canvas, .view svg').first().getAttribute('data-tip')) !== tip, 'the picture follows');
  check((await value('logdet')) !== before, 'so do the figures');
  const list = join(out, 'moved.csv');
  const { text: csv } = await download(page, () => report.getByRole('button', { name: 'Save as poses.csv' }).click());
  writeFileSync(list, csv);
  writeFileSync(join(out, 'moved.yaml'), await text(page));
  mkdirSync(join(out, 'kr270'), { recursive: true });
  copyFileSync(join(root, 'examples/kr270/kr270.urdf'), join(out, 'kr270/kr270.urdf'));
  check(/,yes$/m.test(csv), 'a moved pose is locked');
  const feasible = (await verdict.innerText()).startsWith('Feasible');
  let evaluation;
  try {
    evaluation = JSON.parse(execFileSync(resolve(values.program), ['evaluate', 'moved.yaml', 'moved.csv', '--criterion', 'o1', '--candidates', '100', '--json', '--quiet'], { cwd: out, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] }));
  } catch {
    evaluation = undefined;
  }
  check(Boolean(evaluation) === feasible, 'evaluate refuses what the page calls not feasible', await verdict.innerText());
  if (evaluation) near(await value('logdet'), evaluation.criterion.log_det, 1e-6, 'log det is that of evaluate');
  await report.getByRole('button', { name: 'Put it back' }).click();
  near(await value('logdet'), before, 1e-12, 'put back it tells what it told');
  await judged(() => report.getByRole('slider', { name: /^joint_a2 of pose/ }).fill('-20'));
  await report.getByRole('button', { name: 'Reset', exact: true }).click();
  near(await value('logdet'), before, 1e-12, 'Reset puts it back too');
}

/** Stop ends a search; the plan from before stays. */
async function checkStop(page) {
  await step(page, /Plan/);
  const stop = page.locator('#step-3').getByRole('button', { name: 'Stop' });
  await page.getByRole('button', { name: 'Plan', exact: true }).click();
  await stop.click();
  await page.waitForFunction(() => /Stopped: the plan from before stays/.test(document.querySelector('#step-3 .busy').textContent));
  check(!(await stop.isVisible()) && (await page.getByRole('button', { name: 'Plan', exact: true }).isEnabled()), 'a search can be stopped and begun again');
  let asked = 0;
  page.on('dialog', async (dialog) => (asked++, await dialog.dismiss()));
  await page.getByRole('button', { name: 'Plan', exact: true }).click();
  await stop.waitFor();
  await page.close({ runBeforeUnload: true });
  for (let k = 0; k < 50 && asked === 0; k++) await new Promise((resolve) => setTimeout(resolve, 100));
  check(asked === 1, 'a page that plans asks before it is left', asked);
  const other = await page.context().newPage();
  await other.goto(page.url());
  await other.waitForFunction(() => document.querySelector('.yaml')?.value.length > 0);
  check((await text(other)) === (await text(page)), 'and its problem is there in another tab, should this one be lost');
  await other.close();
  await stop.click();
}

/** Readings are calibrated as the native program does it; its programs come back compensated. */
async function checkMeasured(page) {
  about('measured data');
  nativeFiles();
  await step(page, /Robot/);
  await redrawn(page, () => page.locator('#step-0 input[type=file]').first().setInputFiles([join(out, 'my arm.yaml'), join(out, 'kr270.urdf')]));
  check((await page.locator('#step-0 [role=status]').innerText()) === 'my arm.yaml is read.', 'a problem of any name is read');
  await page.evaluate(() => document.querySelector('#result iframe')?.remove());
  await step(page, /Measured/);
  await page.locator('#step-5 input[type=file]').first().setInputFiles(join(out, 'measured.csv'));
  await page.locator('#result iframe').waitFor();
  const native = (...words) => execFileSync(resolve(values.program), words, { cwd: out, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
  const calibrated = JSON.parse(native('calibrate', 'my arm.yaml', 'measured.csv', '--json', '--quiet', '--force', '-o', 'calibrated.yaml'));
  const report = page.frameLocator('#result iframe');
  const shown = JSON.parse(await report.locator('#report-data').textContent()).result;
  check(shown.poses.length === 16 && shown.poses[0].residuals.length === calibrated.poses[0].residuals.length, 'the report has residuals of all poses');
  shown.poses.forEach((p, k) => p.residuals.forEach((v, i) => check(Math.abs(v - calibrated.poses[k].residuals[i]) < 1e-9, `residual ${i} of pose ${p.id}`, v)));
  check(JSON.stringify(shown.verdict) === JSON.stringify(calibrated.verdict), 'and the verdict of the native program', JSON.stringify(shown.verdict));
  await step(page, /Take away/);
  const own = (await download(page, () => page.getByRole('button', { name: 'calibrated.yaml' }).click())).text;
  const value = (p) => Number(own.match(new RegExp(`${p.name.replace(/\./g, '\\.')}["']?:\\s*\\{[^}]*?value: ([-+.e\\d]+)`))?.[1] ?? NaN);
  const some = calibrated.parameters.filter((p) => Number.isFinite(value(p)));
  check(some.length > 2, 'calibrated.yaml has the parameters', some.length);
  for (const p of some.slice(0, 3)) near(value(p), p.value, 1e-6, `${p.name} is as the native program has it`);
  check((await download(page, () => page.getByRole('button', { name: 'my arm.yaml' }).click())).name === 'my arm.yaml', 'the problem is saved under its own name');
  await shot(page, 'measured');
  await step(page, /Measured/);
  const urdf = await download(page, () => page.getByRole('button', { name: 'Corrected URDF' }).click());
  check(urdf.name === 'corrected.urdf' && urdf.text.includes('<robot'), 'the calibrated robot can be taken away', urdf.name);
  await page.getByRole('button', { name: 'Next poses' }).click();
  await page.waitForFunction(() => document.querySelector('#result-title').textContent === 'Next poses');
  await shot(page, 'next');
  native('next', 'my arm.yaml', '--data', 'measured.csv', '--poses', '5', '--state', '-', '-o', 'next.csv', '--force', '--quiet');
  native('compensate', 'calibrated.yaml', 'poses.csv', '-o', 'compensated.csv', '--force', '--quiet');
  native('compensate', 'calibrated.yaml', 'CALPOSES.src', 'CALPOSES.dat', '-o', 'compensated', '--force', '--quiet');
  const numbers = (list) => (list.match(/-?\d+\.\d+/g) ?? []).map(Number);
  const alike = (one, path, what) => {
    const [a, b] = [numbers(one), numbers(readFileSync(join(out, path), 'utf8'))];
    check(a.length > 20 && a.length === b.length && a.every((v, k) => Math.abs(v - b[k]) < 2e-4), what, `${a.length} numbers, ${b.length}`);
  };
  await step(page, /Take away/);
  alike((await download(page, () => page.getByRole('button', { name: 'next.csv' }).click())).text, 'next.csv', 'the next poses are those of the native program');
  await step(page, /Measured/);
  const give = (...names) => page.locator('#step-5 input[type=file]').nth(1).setInputFiles(names.map((name) => join(out, name)));
  const compensated = await download(page, () => give('poses.csv'));
  check(compensated.name === 'corrected-poses.csv', 'poses come back compensated', compensated.name);
  check(compensated.text !== readFileSync(join(out, 'poses.csv'), 'utf8'), 'and are other ones');
  alike(compensated.text, 'compensated.csv', 'those of the native program');
  const krl = new Map();
  const keep = async (d) => krl.set(d.suggestedFilename(), readFileSync(await d.path(), 'utf8'));
  page.on('download', keep);
  await give('CALPOSES.src', 'CALPOSES.dat');
  for (let k = 0; k < 300 && krl.size < 2; k++) await page.waitForTimeout(100);
  page.off('download', keep);
  check(krl.has('CALPOSES.dat'), 'so does a program of the robot', [...krl.keys()]);
  for (const [name, own] of krl) if (name === 'CALPOSES.dat') alike(own, `compensated/${name}`, `${name} is that of the native program`);

  await step(page, /Instrument/);
  const before = await text(page);
  await redrawn(page, () => page.getByRole('button', { name: 'Write the problem anew' }).click());
  check((await text(page)) !== before && (await page.evaluate(() => document.querySelector('.yaml').value)).includes('laser tracker'), 'a problem written anew');
  await step(page, /Take away/);
  check((await page.getByRole('button', { name: 'my arm.yaml' }).count()) === 1, 'keeps its name');
  await redrawn(page, () => page.getByRole('button', { name: 'Undo' }).click());
  check((await text(page)) === before, 'and can be undone');
}

/** A thousand poses of a UR5 before a laser tracker: the residuals are those of the native program. */
async function checkRealData(page) {
  about('real data');
  const data = join(root, '../shared/data/ur5_gts3800');
  if (!existsSync(data)) return console.log('Left out: real data (../shared is missing)');
  const folder = join(out, 'real');
  const example = join(root, 'examples/real_data/ur5_gts3800');
  mkdirSync(folder, { recursive: true });
  execFileSync('/usr/bin/python3', [join(example, 'convert.py'), data, folder]);
  await step(page, /Robot/);
  await redrawn(page, () => page.locator('#step-0 input[type=file]').first().setInputFiles(['problem.yaml', 'ur5.urdf'].map((name) => join(example, name))));
  await page.evaluate(() => document.querySelector('#result iframe')?.remove());
  await step(page, /Measured/);
  const start = performance.now();
  await page.locator('#step-5 input[type=file]').first().setInputFiles(join(folder, 'grid.csv'));
  await page.locator('#result iframe').waitFor();
  console.log(`1,000 poses are calibrated and drawn after ${((performance.now() - start) / 1000).toFixed(1)} s`);
  const shown = JSON.parse(await page.frameLocator('#result iframe').locator('#report-data').textContent()).result;
  const words = ['calibrate', join(example, 'problem.yaml'), 'grid.csv', '--json', '--quiet', '--force', '-o', 'calibrated.yaml'];
  const native = JSON.parse(execFileSync(resolve(values.program), words, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'], maxBuffer: 1e8 }));
  check(shown.verdict === native.verdict && shown.poses.length === 1000, 'verdict and poses are those of the native program', `${shown.verdict}, ${shown.poses.length} poses`);
  const apart = Math.max(...shown.poses.flatMap((p, k) => p.residuals.map((v, i) => Math.abs(v - native.poses[k].residuals[i]))));
  check(apart < 1e-9, 'so are the residuals', apart);
}

/** More candidates than 4 GB hold are refused before they are drawn, and nothing is lost. */
async function checkMemory(page) {
  about('memory');
  const before = await text(page);
  const large = before.includes('candidates:') ? before.replace(/candidates: \d+/, 'candidates: 9000000') : before.replace(/^design: *\{/m, 'design: {candidates: 9000000, ').replace(/^design:\n/m, 'design:\n  candidates: 9000000\n');
  await redrawn(page, () => page.locator('.yaml').fill(large));
  await step(page, /Plan/);
  await page.getByRole('button', { name: 'Plan', exact: true }).click();
  const said = page.locator('#step-3 .messages li', { hasText: 'memory' });
  await said.waitFor();
  check(/^9000000 candidates need up to \d+\.\d GB of memory, and 4\.3 GB is all there is; ask for at most \d+$/.test(await said.innerText()), 'what does not fit is one sentence', await said.innerText());
  check((await text(page)) === large, 'and the problem stays');
  await redrawn(page, () => page.locator('.yaml').fill(before));
}

async function checkBadInput(page) {
  about('bad input');
  await step(page, /Robot/);
  const before = await text(page);
  const give = (name, buffer) => page.locator('#step-0 input[type=file]').first().setInputFiles({ name, mimeType: 'text/plain', buffer });
  const said = () => page.locator('.complaint').innerText();
  await give('notes.txt', Buffer.from('nothing'));
  await page.waitForFunction(() => /no robot/.test(document.querySelector('.complaint').textContent));
  await give('broken.urdf', Buffer.from('<robot name="b"><link name="a"/>'));
  await page.waitForFunction(() => /broken.urdf/.test(document.querySelector('.complaint').textContent));
  check(!(await said()).includes('\n'), 'a broken URDF is one sentence', await said());
  check((await text(page)) === before, 'the problem stays', (await text(page)).slice(0, 200));
  await page.locator('#step-0 .drop').evaluate((drop) => {
    const data = new DataTransfer();
    const large = new File(['<robot'], 'large.urdf');
    Object.defineProperty(large, 'size', { value: 2e8 });
    data.items.add(large);
    const entry = { isFile: true, name: 'large.urdf', file: (take) => take(large) };
    const event = new DragEvent('drop', { bubbles: true, cancelable: true });
    Object.defineProperty(event, 'dataTransfer', { value: { items: [{ webkitGetAsEntry: () => entry }] } });
    drop.dispatchEvent(event);
  });
  await page.waitForFunction(() => /100 MB/.test(document.querySelector('.complaint').textContent));
  check((await text(page)) === before, 'nothing is lost');

  const mesh = (link) => `<link name="${link}"><collision><geometry><mesh filename="package://arm/meshes/${link}.stl"/></geometry></collision></link>`;
  const solid = readFileSync(join(root, 'examples/kr270/kr270.urdf'), 'utf8');
  await give('bare.urdf', Buffer.from(solid.replace(/<link name="(link_[12])">.*?<\/link>/gs, (_, link) => mesh(link))));
  await page.waitForFunction(() => /2 of its meshes are missing \(link_1.stl, link_2.stl\)/.test(document.querySelector('#step-0 [role=status]').textContent));
  check((await text(page)).includes('bare.urdf') && /no collision is checked/.test(await said()), 'a robot without its meshes has a problem');
  await give('link_1.stl', Buffer.from('no mesh'));
  await page.waitForFunction(() => /link_1.stl' is not an STL/.test(document.querySelector('.complaint').textContent));
  check(!(await said()).includes('\n'), 'a broken mesh is one sentence', await said());
}

/** What stands on a page whose browser cannot run the program. @param {() => void} spoil runs before the page's own scripts */
async function complaintWith(context, spoil) {
  const page = await context.newPage();
  await page.addInitScript(spoil);
  await page.goto(`file://${file}`);
  await page.getByRole('combobox', { name: 'Example' }).selectOption('KUKA KR 270');
  await page.locator('.complaint').waitFor();
  const said = await page.locator('.complaint').innerText();
  await page.close();
  return said;
}

/** `init --show` of an installation that has the page. */
async function checkShow(context) {
  about('init --show');
  const installed = join(out, 'installed');
  for (const folder of ['bin', 'share/posewright']) mkdirSync(join(installed, folder), { recursive: true });
  copyFileSync(resolve(values.program), join(installed, 'bin/posewright'));
  copyFileSync(file, join(installed, 'share/posewright/posewright.html'));
  copyFileSync(join(root, 'examples/kr270/kr270.urdf'), join(out, 'kr270.urdf'));
  const words = ['init', 'kr270.urdf', '--tracker', '--yes', '--show', '--force', '-o', 'shown.yaml'];
  const said = execFileSync(join(installed, 'bin/posewright'), words, { cwd: out, encoding: 'utf8', env: { PATH: process.env.PATH } });
  check(said.includes(join(out, 'shown.html')), 'the path of the page is printed', said);
  const page = await context.newPage();
  page.setDefaultTimeout(240_000);
  await page.goto(`file://${join(out, 'shown.html')}`);
  await page.waitForFunction(() => document.querySelector('.live-view')?.dataset.drawn);
  check((await text(page)) === readFileSync(join(out, 'shown.yaml'), 'utf8'), 'the page begins with the problem');
  check((await page.locator('.editor-part .messages li.error').count()) === 0, 'and can read all its files');
  await page.close();
}

async function checkWeakBrowsers(context) {
  about('browsers that cannot run the program');
  const old = await complaintWith(context, () => (WebAssembly.compile = () => Promise.reject(new Error('invalid SIMD opcode'))));
  check(old === 'This browser cannot run the program (invalid SIMD opcode); browsers of 2023 or later can.', 'one without SIMD is told', old);
  const full = await complaintWith(context, () => {
    window.Worker = class {
      postMessage() {
        setTimeout(() => this.onmessage({ data: { failed: 'RuntimeError: memory access out of bounds' } }));
      }
      terminate() {}
    };
  });
  check(/^the browser has no more memory for this problem: fewer candidates/.test(full), 'one without memory is told', full);
}

const browser = await launch({ webgl: true });
const context = await browser.newContext({ viewport: { width: 1400, height: 900 }, colorScheme: 'light', reducedMotion: 'reduce', acceptDownloads: true });
if (!values.address) await context.setOffline(true);
const page = await context.newPage();
page.setDefaultTimeout(240_000);
const complaints = [];
page.on('console', (m) => ['error', 'warning'].includes(m.type()) && !/GPU stall/.test(m.text()) && complaints.push(m.text()));
page.on('pageerror', (error) => complaints.push(String(error)));
page.on('request', (r) => !r.isNavigationRequest() && !/^(data|blob):/.test(r.url()) && !(values.address && r.url().startsWith(values.address)) && complaints.push(`request of ${r.url()}`));
await page.goto(`file://${file}`);
await checkCell(page);
await checkDrag(page);
await checkPlan(page);
await checkMove(page);
await checkStop(page);
await checkMeasured(page);
await checkRealData(page);
await checkMemory(page);
await checkMovingBase(page);
await checkBadInput(page);
await checkLeftovers(page);
about('the page');
for (const width of [1400, 420]) {
  await page.setViewportSize({ width, height: 900 });
  for (const name of [/Robot/, /Instrument/, /Cell/, /Plan/, /Take away/, /Measured/]) {
    await step(page, name);
    const wider = await overflow(page);
    check(wider <= 0, `nothing is wider than the page at ${width} px, ${name}`, wider);
  }
}
await page.getByRole('button', { name: 'Licences' }).click();
const licences = await page.locator('dialog pre').innerText();
for (const name of ['BSD 3-Clause', 'eigen3', 'nlopt', 'GNU LESSER', 'ompl', 'musl', 'three', 'uplot', 'yaml']) check(licences.toLowerCase().includes(name.toLowerCase()), `the licence of ${name} is shown`);
await page.getByRole('button', { name: 'Close' }).click();
const kept = await text(page);
await page.waitForTimeout(1000);
await page.reload();
await page.waitForFunction(() => document.querySelector('.live-view')?.dataset.drawn);
check((await text(page)) === kept, 'the problem is there when the page is opened again');
check(complaints.length === 0, 'no error, no warning, no request', complaints.join(' | '));
await page.close();
await checkShow(context);
await checkWeakBrowsers(context);
await browser.close();
process.exitCode = verdict();
