// Poses that the reader locks, and what a camera will see: judged by the program, which gets the saved list.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { check } from './checks.mjs';

const root = new URL('../../', import.meta.url);

/** @param {string} program @param {string[]} words @returns {{failed: string}|any} the result, or what the program says */
function run(program, words) {
  try {
    const text = execFileSync(resolve(program), words, { cwd: root, encoding: 'utf8', maxBuffer: 1e9, stdio: 'pipe' });
    return JSON.parse(text);
  } catch (error) {
    return { failed: String(error.stderr ?? error) };
  }
}

async function save(page, folder) {
  const promise = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Save as poses.csv' }).click();
  const csv = join(folder, 'locked.csv');
  await (await promise).saveAs(csv);
  return csv;
}

/** A page outside of posewright.html has no program: it says where poses are moved. Locked poses are in the next plan.
 * @param {any} page @param {import('./make_reports.mjs').Case} c @param {string} program */
export async function checkLocks(page, { plan, folder, problem }, program) {
  check((await page.locator('.mover').count()) === 0, 'no pose can be moved without the program');
  check((await page.locator('.viewer').innerText()).includes('Poses are moved in posewright.html'), 'the page says where they can');
  const locked = plan.poses.filter((p) => !p.measured).slice(0, 2);
  const reset = page.getByRole('button', { name: 'Reset' });
  check(await reset.isDisabled(), 'there is nothing to reset at first');
  for (const { id } of locked) await page.getByRole('button', { name: `Keep pose ${id} in the next plan`, exact: true }).click();
  const csv = await save(page, folder);
  await reset.click();
  check((await page.locator('.rows .lock[aria-pressed=true]').count()) === plan.poses.filter((p) => p.fixed).length, 'Reset takes the locks off');
  const lines = readFileSync(csv, 'utf8').trim().split('\n').map((line) => line.split(','));
  const marks = lines.slice(1).filter((line) => line.at(-1) === 'yes').map((line) => Number(line[0]));
  check(lines[0].at(-1) === 'fixed' && marks.sort((a, b) => a - b).join() === locked.map((p) => p.id).join(), 'the list marks what is locked', marks);
  const next = join(folder, 'next.json');
  const words = ['--candidates', '60', '--restarts', '1', '--method', 'exchange', '--seed', '3', '-o', next, '--poses-csv', '-', '--force'];
  const made = run(program, ['plan', problem, '--fixed', csv, '--poses', String(plan.poses.length), ...words, '--json', '--quiet']);
  check(!made.failed, 'plan --fixed takes the list', made.failed);
  if (made.failed) return;
  const fixed = made.poses.filter((p) => p.fixed).map((p) => p.configuration.join());
  check(
    fixed.length === 2 && made.poses.length === plan.poses.length && locked.every((p) => fixed.includes(p.configuration.join())),
    'and has both poses among its own, to the last digit',
    fixed.length,
  );
}

/** @param {any} page @param {import('./make_reports.mjs').Case} c */
export async function checkCamera(page, { data, plan }) {
  const [camera] = data.cameras;
  const own = plan.poses.filter((p) => p.instrument === camera.instrument);
  check(camera.pictures.length === own.length, 'every pose that a camera reads has a picture');
  for (const { id } of plan.poses.filter((p) => p.instrument !== camera.instrument).slice(0, 1)) {
    await page.locator(`.rows li[data-id="${id}"] .preview`).click();
    check(!(await page.locator('.camera-picture').isVisible()), 'other poses have none');
  }
  for (const id of [own[0].id, own.at(-1).id]) {
    await page.locator(`.rows li[data-id="${id}"] .preview`).click();
    const drawn = await page
      .locator('svg.camera circle')
      .evaluateAll((all) => all.map((e) => [Number(e.getAttribute('cx')), Number(e.getAttribute('cy'))]));
    const { pixels } = camera.pictures.find((p) => p.pose === id);
    check(JSON.stringify(drawn) === JSON.stringify(pixels), `points of pose ${id} are where the model sees them`, drawn.length);
    check(
      drawn.every(([u, v]) => u >= 0 && v >= 0 && u <= camera.size[0] && v <= camera.size[1]),
      'all of them inside the picture',
    );
  }
}
