// Poses that the reader moves and locks, and what a camera will see: judged by the program, which gets the saved list.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { check, near } from './checks.mjs';

const root = new URL('../../', import.meta.url);
const value = async (page, id) => Number(await page.locator(`#list-${id}`).getAttribute('data-value'));
const slider = (page, name, id) => page.getByRole('slider', { name: `${name} of pose ${id}`, exact: true });

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
  const csv = join(folder, 'moved.csv');
  await (await promise).saveAs(csv);
  return csv;
}

/** How far the sliders of a pose go, in steps: not beyond the limits of a coordinate.
 * @returns {Promise<[number, number][]>} */
async function reachOf(page, { data, plan }, id) {
  const { names } = plan.poses[0];
  const ends = [];
  for (const { index } of data.neighbours.coordinates) {
    const one = slider(page, names[index], id);
    ends.push([Number(await one.getAttribute('min')), Number(await one.getAttribute('max'))]);
  }
  return ends;
}

/** Places of two coordinates that the sliders reach: the first feasible one whose figures are held, and the first that is
 * not feasible.
 * @param {any} neighbours @param {number} id @param {[number, number][]} reach */
function looks(neighbours, id, reach) {
  const pose = neighbours.poses.find((p) => p.id === id);
  const within = (k) => k.every((v, j) => v >= reach[j][0] && v <= reach[j][1]);
  const of = (holds) =>
    neighbours.places.findIndex((k, place) => k.filter((v) => v !== 0).length === 2 && within(k) && holds(place));
  return [
    of((place) => pose.verdicts[place] < 0 && pose.told[place] === 1),
    of((place) => pose.verdicts[place] >= 0 && pose.told[place] === 1),
  ].filter((place) => place >= 0);
}

/** @param {any} page @param {import('./make_reports.mjs').Case} c @param {string} program */
export async function checkMoves(page, c, program) {
  const { data, plan, folder, problem } = c;
  const n = data.neighbours;
  check(n !== null, 'the page holds what is near to the poses', data.why_no_neighbours);
  if (n === null) return;
  const evaluate = (csv) =>
    run(program, ['evaluate', problem, csv, '--variant', plan.variant, '--candidates', '60', '--json', '--quiet']);
  const id = plan.poses.at(-1).id;
  await page.locator(`.rows li[data-id="${id}"] .preview`).click();
  const { names } = plan.poses[0];
  const setTo = async (k) => {
    for (const [j, steps] of k.entries()) await slider(page, names[n.coordinates[j].index], id).fill(String(steps));
  };
  const pose = n.poses.find((p) => p.id === id);
  for (const place of looks(n, id, await reachOf(page, c, id))) {
    await setTo(n.places[place]);
    const words = await page.locator('.verdict').innerText();
    const feasible = pose.verdicts[place] < 0;
    check(words.startsWith(feasible ? 'Feasible here' : 'Not feasible here'), 'the verdict is the program’s', words);
    const csv = await save(page, folder);
    const judged = evaluate(csv);
    check(Boolean(judged.failed) !== feasible, 'evaluate refuses exactly what the page calls not feasible', judged.failed);
    if (judged.failed) continue;
    const interest = data.columns.filter((column) => column.role === 'interest').length;
    const off = Math.abs((await value(page, 'logdet')) - judged.criterion.log_det) / interest;
    check(off <= 1.001 * n.errors.efficiency + 1e-9, 'log det of the moved list is evaluate’s, as near as the page says', off);
    if (plan.accuracy.rho0 !== null)
      near(await value(page, 'rho0'), judged.accuracy.rho0, 1.001 * n.errors.rho0 + 1e-9, 'so is the position error');
    // The list is in measuring order, where there is a route.
    const order = readFileSync(csv, 'utf8').trim().split('\n').slice(1).map((line) => Number(line.split(',')[0]));
    const there = judged.poses[order.indexOf(id)];
    if (there.nearest)
      check(
        Math.abs(pose.clearance[place] * 1e-4 - there.nearest.distance) <= 0.51e-4 && words.includes(there.nearest.between[0]),
        'so is the clearance, and between which bodies',
        words,
      );
    if (data.chain) {
      const tip = (await page.locator('.view canvas, .view svg').first().getAttribute('data-tip')).split(' ').map(Number);
      check(
        there.tool_pose.position.every((v, k) => Math.abs(v - tip[k]) < 2e-6),
        'the arm that is drawn has its tip there',
        tip,
      );
    }
  }
  await checkBeyond(page, c, id);
  await checkFixed(page, c, id, program);
  await page.getByRole('button', { name: 'Reset' }).click();
  near(await value(page, 'efficiency'), 1, 1e-9, 'reset puts moved poses back');
}

/** Where nothing is held. */
async function checkBeyond(page, c, id) {
  const { data, plan } = c;
  const reach = await reachOf(page, c, id);
  const { names } = plan.poses[0];
  const { coordinates } = data.neighbours;
  for (const j of [0, 1, 2].filter((k) => k < coordinates.length))
    await slider(page, names[coordinates[j].index], id).fill(reach[j][1] >= 1 ? '1' : '-1');
  const words = await page.locator('.verdict').innerText();
  check(words.startsWith('Not known here') && words.includes('plan --fixed'), 'three moved coordinates are not known', words);
  check((await page.locator('.side .warn').innerText()).includes(`without pose ${id}`), 'the figures say what they leave out');
  const before = await value(page, 'logdet');
  await page.getByRole('checkbox', { name: `Measure pose ${id}`, exact: true }).uncheck();
  near(await value(page, 'logdet'), before, 1e-12, 'they are those of the list without it');
  await page.getByRole('checkbox', { name: `Measure pose ${id}`, exact: true }).check();
  await page.locator(`.rows li[data-id="${id}"] .preview`).click();
  await page.getByRole('button', { name: 'Put it back' }).click();
  near(await value(page, 'efficiency'), 1, 1e-9, 'a pose that is put back tells what it told');
}

/** A moved pose and a locked one are in the next plan. */
async function checkFixed(page, { data, plan, folder, problem }, id, program) {
  const { names } = plan.poses[0];
  const { index } = data.neighbours.coordinates[0];
  const pose = data.neighbours.poses.find((p) => p.id === id);
  const one = data.neighbours.places.findIndex(
    (k, place) => k[0] !== 0 && k.filter((v) => v !== 0).length === 1 && pose.verdicts[place] < 0 && pose.told[place] === 1,
  );
  const steps = data.neighbours.places[one]?.[0] ?? 0;
  await slider(page, names[index], id).fill(String(steps));
  const other = plan.poses.find((p) => !p.measured).id;
  await page.getByRole('button', { name: `Keep pose ${other} in the next plan`, exact: true }).click();
  const csv = await save(page, folder);
  const lines = readFileSync(csv, 'utf8').trim().split('\n').map((line) => line.split(','));
  const marks = lines.slice(1).filter((line) => line.at(-1) === 'yes').map((line) => Number(line[0]));
  check(lines[0].at(-1) === 'fixed' && marks.sort((a, b) => a - b).join() === [other, id].sort((a, b) => a - b).join(), 'the list marks what is locked', marks);
  const next = join(folder, 'next.json');
  const words = ['--candidates', '60', '--restarts', '1', '--method', 'exchange', '--seed', '3', '-o', next, '--poses-csv', '-', '--force'];
  const made = run(program, ['plan', problem, '--fixed', csv, '--poses', String(plan.poses.length), ...words, '--json', '--quiet']);
  check(!made.failed, 'plan --fixed takes the list', made.failed);
  if (made.failed) return;
  const fixed = made.poses.filter((p) => p.fixed);
  const value = plan.poses.at(-1).configuration[index] + steps * pose.steps[0];
  check(
    fixed.length === 2 && made.poses.length === plan.poses.length && fixed.some((p) => p.configuration[index] === value),
    'and has both poses among its own, the moved one to the last digit',
    fixed.length,
  );
}

/** @param {any} page @param {import('./make_reports.mjs').Case} c */
export async function checkCamera(page, { data, plan }) {
  const { camera } = data;
  check(camera.pictures.length === plan.poses.length, 'every pose has a picture');
  for (const id of [plan.poses[0].id, plan.poses.at(-1).id]) {
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
