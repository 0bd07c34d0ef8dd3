// node tests/report/newcomer_test.mjs --wasm DIR --out DIR [--program PATH] [--robot FOLDER] [--seconds N] [--screenshots DIR]
// What docs/live.md promises to a person who has never seen a problem file: from the folder of a robot that the page does not know
// to its program in under five minutes, by what can be seen and clicked. FOLDER is as a maker's package is unpacked. The native
// program PATH judges the plan then. N is the time of the search on the page's slider (20; its own is 60). Returns 77 where the
// program for pages, a browser or the robot is missing.
import { execFileSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { basename, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { launch, missing, skipped } from './browser.mjs';
import { about, check, verdict } from './checks.mjs';

const names = ['program', 'wasm', 'out', 'robot', 'seconds', 'screenshots'];
const { values } = parseArgs({ options: Object.fromEntries(names.map((name) => [name, { type: 'string' }])) });
if (!values.wasm || !values.out) {
  console.error('usage: newcomer_test.mjs --wasm DIR --out DIR [--program PATH] [--robot FOLDER] [--seconds N] [--screenshots DIR]');
  process.exit(2);
}
const root = fileURLToPath(new URL('../../', import.meta.url));
const robot = resolve(values.robot ?? join(root, '../shared/robots/kuka_kr300_r2700_2'));
const there = { robot: existsSync(robot), wasm: existsSync(join(values.wasm, 'posewright.wasm')) };
const lacking = !there.wasm ? 'the program for pages is missing (scripts/wasm makes it)' : !there.robot ? `${robot} is missing` : missing();
if (lacking) {
  console.log(`Skipped: ${lacking}.`);
  process.exit(skipped);
}
const out = resolve(values.out);
const file = join(out, 'posewright.html');
mkdirSync(out, { recursive: true });
execFileSync('node', [join(root, 'report/build_live.mjs'), resolve(values.wasm), file]);

const browser = await launch({ webgl: true });
const context = await browser.newContext({ viewport: { width: 1400, height: 900 }, colorScheme: 'light', reducedMotion: 'reduce', acceptDownloads: true });
await context.setOffline(true);
const page = await context.newPage();
page.setDefaultTimeout(240_000);
const complaints = [];
page.on('console', (m) => m.type() === 'error' && complaints.push(m.text()));
page.on('pageerror', (error) => complaints.push(String(error)));

/** What the person does, in the words of the page. */
const done = [];
async function click(role, name) {
  await page.getByRole(role, { name, exact: true }).click();
  done.push(`click "${name}"`);
}
/** A number typed into the field of that name, and Tab. */
async function type(name, value) {
  const field = page.getByRole('spinbutton', { name, exact: true });
  await field.click();
  await field.fill(value);
  await page.keyboard.press('Tab');
  done.push(`type ${value} into "${name}"`);
}
const drawings = () => page.evaluate(() => Number(document.querySelector('.live-view')?.dataset.drawn ?? 0));
async function redrawn(act) {
  const before = await drawings();
  await act();
  await page.waitForFunction((n) => Number(document.querySelector('.live-view')?.dataset.drawn ?? 0) > n, before);
}
async function shot(name) {
  if (!values.screenshots) return;
  mkdirSync(values.screenshots, { recursive: true });
  for (const [suffix, width] of [['', 1400], ['-narrow', 420]]) {
    await page.setViewportSize({ width, height: 900 });
    await page.waitForTimeout(700);
    await page.screenshot({ path: join(values.screenshots, `newcomer-${name}${suffix}.png`) });
  }
  await page.setViewportSize({ width: 1400, height: 900 });
}

/** Pulls the purple grip at the tracker by so many pixels, as seen from above. */
async function dragTracker(dx, dy) {
  const canvas = page.locator('.live-view canvas');
  const box = await canvas.boundingBox();
  const grips = await canvas.evaluate((c) => JSON.parse(c.dataset.grips));
  const [name, [x, y]] = Object.entries(grips).find(([key]) => /station|tracker|A/.test(key)) ?? [];
  check(name !== undefined, 'the tracker has a grip', Object.keys(grips).join());
  await page.mouse.move(box.x + x, box.y + y);
  await page.mouse.down();
  await page.mouse.move(box.x + x + dx, box.y + y + dy, { steps: 5 });
  await page.mouse.up();
  done.push('drag the tracker');
}

about(`a newcomer with ${basename(robot)}`);
const start = performance.now();
const waited = {};
const since = async (what, act) => {
  const from = performance.now();
  await act();
  waited[what] = (performance.now() - from) / 1000;
};
await page.goto(`file://${file}`);
await shot('empty');
await since('picture', () =>
  redrawn(async () => {
    const chooser = page.waitForEvent('filechooser');
    await click('button', 'Choose a folder');
    await (await chooser).setFiles(robot);
    done.push('choose the folder');
  }),
);
const said = await page.locator('#step-0 [role=status]').innerText();
check(/ is read\./.test(said), 'no mesh that checks need is missing', said);
check((await page.locator('.verdicts').innerText()).includes('can be measured'), 'configurations are judged');
await shot('robot');

await click('tab', '2 Instrument');
await click('button', 'Top');
await page.waitForTimeout(500);
const written = () => page.locator('.yaml').inputValue();
const before = await written();
await redrawn(() => dragTracker(-30, 10));
const changed = (await written()).split('\n').filter((line, k) => line !== before.split('\n')[k]);
check(changed.length === 1, 'the drag has moved the tracker, and nothing else', changed.join(' | '));
await click('tab', '3 Cell');
await redrawn(() => click('button', 'Add a box'));
const stop = page.locator('.live-view .stop');
if ((await stop.innerText()).includes('collision with box')) await redrawn(() => type('box, y, mm', '1500'));
check(!(await stop.innerText()).includes('box'), 'a box in the way of the home is seen and moved aside', await stop.innerText());
await shot('cell');

await click('tab', '4 Plan');
if (values.seconds !== '60') await page.getByRole('slider', { name: 'Time at most' }).fill(values.seconds ?? '20');
await since('error to expect', () => page.waitForFunction(() => /mm|µm/.test(document.querySelector('.expected').textContent)));
await since('plan and report', async () => {
  await click('button', 'Plan');
  await page.locator('#result iframe').waitFor();
  await page.frameLocator('#result iframe').locator('.tile b').first().waitFor();
});
const poses = Number(await page.frameLocator('#result iframe').locator('.tile b').first().textContent());
check(poses >= 10, 'the report tells how many poses', poses);
await shot('plan');

await click('tab', '5 Take away');
const saved = new Map();
page.on('download', async (d) => saved.set(d.suggestedFilename(), readFileSync(await d.path(), 'utf8')));
await page.waitForFunction(() => document.querySelector('#step-4 select').options.length > 0);
await click('button', 'Write the program');
await page.waitForFunction(() => /Saved/.test(document.querySelector('#step-4 .busy').textContent));
const seconds = (performance.now() - start) / 1000;
for (let k = 0; k < 100 && saved.size < 2; k++) await page.waitForTimeout(100);
await shot('take');
check(saved.size > 0 && [...saved.values()].every((text) => text.length > 0), 'a program is saved', [...saved.keys()].join());
const motions = saved.get('CALPOSES.src')?.match(/^\s*PTP /gm)?.length ?? 0;
if (/kuka/.test(robot)) check(motions >= poses, 'in KRL, with a motion to each pose', motions);
else check(!saved.has('CALPOSES.src'), 'in the format of another maker', [...saved.keys()].join());
// A person reads, and looks for what to click: five seconds each.
const thought = 5 * done.length;
check(seconds + thought < 300, 'all that in under five minutes', `${seconds.toFixed(0)} s and ${thought} s of thought`);
check((await page.locator('.complaint').innerText()).split('\n').length === 1, 'notes are one paragraph');

console.log(`${done.length} actions, ${seconds.toFixed(0)} s: ${done.join('; ')}`);
console.log(Object.entries(waited).map(([what, s]) => `${what}: ${s.toFixed(1)} s`).join('; '));

/** The native program finds each pose of the page's plan feasible in the problem that the page wrote. */
async function checkNatively() {
  for (const name of ['problem.yaml', 'poses.csv']) await page.getByRole('button', { name, exact: true }).click();
  for (let k = 0; k < 100 && !(saved.has('problem.yaml') && saved.has('poses.csv')); k++) await page.waitForTimeout(100);
  const folder = join(out, 'native');
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  cpSync(robot, join(folder, basename(robot)), { recursive: true });
  for (const name of ['problem.yaml', 'poses.csv']) writeFileSync(join(folder, name), saved.get(name));
  const words = ['evaluate', 'problem.yaml', 'poses.csv', '--candidates', '100', '--json', '--quiet'];
  const { criterion } = JSON.parse(execFileSync(resolve(values.program), words, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] }));
  check(Boolean(criterion), 'the native program evaluates the plan: all poses are feasible');
}
if (values.program) await checkNatively();
check(complaints.length === 0, 'no error', complaints.join(' | '));
await browser.close();

process.exitCode = verdict();
