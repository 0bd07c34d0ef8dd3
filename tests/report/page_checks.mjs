// A report in the browser: what is seen, what moves, what a reader can do.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { check, near } from './checks.mjs';

const tip = (page) => page.locator('.view canvas, .view svg').first().getAttribute('data-tip');
const value = async (page, id) => Number(await page.locator(`#list-${id}`).getAttribute('data-value'));
const ids = (page) => page.locator('.rows li').evaluateAll((rows) => rows.map((r) => Number(r.dataset.id)));

/** The slider and the buttons move the robot. */
export async function checkViewer(page, { data, route }) {
  check((await page.locator('.view canvas').count()) === 1, 'there is a picture in WebGL');
  const slider = page.getByRole('slider', { name: 'Place in the measuring order' });
  const before = { tip: await tip(page), picture: await page.locator('.view canvas').screenshot() };
  await slider.fill(String(Math.floor(Number(await slider.getAttribute('max')) / 2)));
  await page.waitForTimeout(150);
  check((await tip(page)) !== before.tip, 'the slider moves the tip');
  check(!before.picture.equals(await page.locator('.view canvas').screenshot()), 'the slider changes the picture');
  check(Number(await slider.getAttribute('max')) === data.keyframes.length - 1, 'the slider has one place a keyframe');
  const order = route ? data.route.order : data.plan.poses.map((p) => p.id);
  await slider.fill('0');
  await page.getByRole('button', { name: 'Next pose' }).click();
  const second = route ? order[0] : order[1];
  check((await page.locator('.stop').textContent()).includes(`pose ${second}`), 'the next stop is named');
  const values = await page.locator('.values dd').allTextContents();
  check(
    values.length >= data.plan.poses[0].names.length && values.every((v) => / (deg|mm)$/.test(v)),
    'all joint values are shown in deg or mm',
    values.join(),
  );
  await page.getByRole('button', { name: 'Play' }).click();
  const start = await tip(page);
  await page.waitForFunction((was) => document.querySelector('.view canvas').dataset.tip !== was, start);
  await page.getByRole('button', { name: 'Pause' }).click();
  await page.locator(`.rows li[data-id="${order.at(-1)}"] .preview`).click();
  check(
    (await page.locator('.stop').textContent()).includes(`pose ${order.at(-1)}`),
    'a click on a row shows that pose',
  );
  if (data.candidates) await page.getByRole('checkbox', { name: 'Candidates' }).check();
}

/** What stands before everything else, and the table of what an operator looks for: asked of the plan's own file. */
export async function checkOverview(page, { data, plan, route }) {
  const expected = plan.expected_error;
  if (expected) {
    const [amount, unit] = (await page.locator('.tile', { hasText: 'expected after calibration' }).locator('b').textContent()).split(' ');
    const error = expected.with[expected.with.length >> 1].error;
    near((Number(amount) * { mm: 1e-3, µm: 1e-6, m: 1 }[unit]) / error, 1, 6e-3, 'the first error is the one to expect');
  }
  await page.setViewportSize({ width: 1400, height: 900 });
  const picture = await page.locator('.view').boundingBox();
  check(picture.y + picture.height <= 900, 'the picture is seen without scrolling at 1400 x 900', picture);
  const order = route ? data.route.order : plan.poses.map((p) => p.id);
  const worth = plan.poses.some((p) => p.nearest || p.targets?.length > 0);
  check((await page.locator('.measuring').count()) === (worth ? 1 : 0), 'there is a table where there is something to tell');
  if (!worth) return;
  const header = await page.locator('.measuring thead th').allTextContents();
  const rows = await page
    .locator('.measuring tbody tr')
    .evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
  check(rows.map((row) => row[0]).join() === order.join(), 'the table has the poses in measuring order', rows.length);
  const shown = (row, title) => row[header.indexOf(title)];
  for (const [place, id] of order.entries()) {
    const pose = plan.poses.find((p) => p.id === id);
    const targets = (pose.targets ?? []).filter((t) => t.visible !== false);
    const most = (of) => Math.max(...targets.map(of));
    if (header.includes('incidence, deg'))
      near(Number(shown(rows[place], 'incidence, deg')), (most((t) => t.incidence) * 180) / Math.PI, 0.51, `incidence at pose ${id}`);
    if (header.includes('distance, m'))
      near(Number(shown(rows[place], 'distance, m')), most((t) => t.distance), 0.0051, `distance at pose ${id}`);
    if (pose.nearest)
      near(parseFloat(shown(rows[place], 'clearance, mm')), 1000 * pose.nearest.distance, 0.051, `clearance at pose ${id}`);
    if (!route) continue;
    const motion = data.route.motions.find((m) => m.to === id);
    near(parseFloat(shown(rows[place], 'clearance on the way, mm')), 1000 * motion.nearest.distance, 0.051, `clearance on the way to pose ${id}`);
  }
  if (!route) return;
  const { travel, changes, settle, reading } = data.route.seconds;
  check(reading > 0, 'readings take time here', reading);
  const tile = await page.locator('.tile', { hasText: 'for the whole route' }).locator('b').textContent();
  const [amount, unit] = tile.split(' ');
  near(Number(amount) * { s: 1, min: 60, h: 3600 }[unit], travel + changes + settle + reading, 0.051 * ({ s: 1, min: 60, h: 3600 }[unit] / (travel + changes + settle + reading)), 'the whole route takes what route.json says');
  near(data.keyframes.at(-1).seconds, travel + changes + settle + reading, 1e-6, 'so does the film');
}

/** Every plot has its points. */
export async function checkPlots(page, { data, plan, name }) {
  const points = (id) =>
    page.locator(`#${id}`).evaluate((f) => f.plot.data.map((s) => s.filter((v) => v !== null).length));
  const [, contributions, losses] = await points('plot-contribution');
  check(contributions === plan.poses.length && losses === plan.poses.length, 'one bar and one dot a pose', [
    contributions,
    losses,
  ]);
  check(
    (await points('plot-spectrum'))[1] === data.singular_values.length,
    'one singular value a parameter of interest',
  );
  check(
    data.singular_values.length === data.columns.filter((c) => c.role === 'interest').length,
    'as many as there are parameters of interest',
  );
  if (data.candidates) {
    const [, all, chosen] = await points('plot-sensitivity');
    check(
      all === data.candidates.sensitivity.length && chosen === new Set(data.candidates.chosen).size,
      'all candidates, and those chosen',
      [all, chosen],
    );
    // At the best weights a candidate above the level has all the weight that it may have, one part in as many as there are poses.
    const above = data.candidates.sensitivity.filter((s) => s > 1.001).length;
    check(above <= plan.poses.length, 'no more candidates are worth measuring in full than there are poses', above);
  }
  const known = data.prefix.filter((p) => p && p.log_det !== null).length;
  check(
    (await points('plot-curve-log_det'))[1] === known,
    'the curve has a point for each number of poses that suffices',
  );
  const tests = plan.accuracy.test_poses.length;
  check(
    (await page.locator('#plot-test-poses').count()) === (tests > 0 ? 1 : 0),
    'test poses are plotted where there are some',
  );
  if (tests > 0) check((await points('plot-test-poses'))[1] === tests, 'one dot a test pose');
  const errors = data.position_errors;
  // What moves the tip is estimated everywhere but with the camera in the hand, where it is the camera's place alone.
  const places = name === 'camera' ? 0 : Math.min(200, data.candidates.sensitivity.length);
  check(errors.length === places && errors.every((e) => e > 0), 'errors are predicted all over the workspace', errors.length);
  if (errors.length > 0) {
    const [, drawn] = await page.locator('#plot-workspace').evaluate((f) => f.plot.data);
    check(
      drawn.every((v, k) => k === 0 || v >= drawn[k - 1]) && Math.abs(drawn.at(-1) - 1e3 * Math.max(...errors)) < 1e-9,
      'their curve rises to the largest',
    );
  }
  const rows = await page.locator('.parameters tbody tr').count();
  check(rows === plan.parameters.filter((p) => p.identifiable).length, 'one row a parameter', rows);
}

/** Unticking, reordering, saving. */
export async function checkList(page, { plan, folder, problem, data }, program) {
  const start = await ids(page);
  near(await value(page, 'efficiency'), 1, 1e-9, 'the whole list has all the efficiency');
  for (const pose of plan.poses.slice(0, 5)) {
    const box = page.getByRole('checkbox', { name: `Measure pose ${pose.id}`, exact: true });
    await box.uncheck();
    const left = await value(page, 'efficiency');
    check(left < 1, `without pose ${pose.id} efficiency is lower`);
    near(left, pose.efficiency_without, 1e-6, `without pose ${pose.id} it is what the plan says`);
    await box.check();
  }
  await page.getByRole('checkbox', { name: `Measure pose ${start[2]}`, exact: true }).uncheck();
  await page.getByRole('button', { name: `Move pose ${start[0]} later` }).click();
  await drag(page, start[4], start[1]);
  const expected = [start[4], start[1], start[0], start[2], start[3], ...start.slice(5)];
  check(String(await ids(page)) === String(expected), 'buttons and dragging reorder', await ids(page));
  const promise = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Save as poses.csv' }).click();
  const csv = join(folder, 'poses.csv');
  await (await promise).saveAs(csv);
  const lines = readFileSync(csv, 'utf8').trim().split('\n');
  check(
    lines
      .slice(1)
      .map((l) => Number(l.split(',')[0]))
      .join() === expected.filter((id) => id !== start[2]).join(),
    'the saved list has the ticked poses in order',
    lines.length,
  );
  check(
    lines[0].startsWith(`pose,${plan.poses[0].names[0]} [${plan.poses[0].units[0]}],`),
    'its header names and units',
    lines[0],
  );
  const judged = JSON.parse(
    execFileSync(resolve(program), ['evaluate', problem, csv, '--variant', plan.variant, '--candidates', '60', '--json', '--quiet'], {
      cwd: new URL('../../', import.meta.url),
      encoding: 'utf8',
      maxBuffer: 1e9,
    }),
  );
  near(
    judged.criterion.log_det,
    await value(page, 'logdet'),
    1e-8,
    'posewright evaluate reads it and finds the same log det',
  );
  check(await page.locator('.reminder').isVisible(), 'the page says that the list has been changed');
  await page.getByRole('button', { name: 'Reset' }).click();
  check(
    String(await ids(page)) === String(start) && !(await page.locator('.reminder').isVisible()),
    'reset brings the plan’s list back',
  );
  for (const id of start.slice(1))
    await page.getByRole('checkbox', { name: `Measure pose ${id}`, exact: true }).uncheck();
  check(
    (await page.locator('#list-efficiency').textContent()) === 'not identifiable',
    'one pose alone is said not to do',
    data.columns.length,
  );
  await page.getByRole('button', { name: 'Reset' }).click();
}

/** By the handle, as with a mouse. */
async function drag(page, id, before) {
  await page.locator(`.rows li[data-id="${before}"]`).scrollIntoViewIfNeeded();
  const handle = await page.locator(`.rows li[data-id="${id}"] .handle`).boundingBox();
  const goal = await page.locator(`.rows li[data-id="${before}"]`).boundingBox();
  await page.mouse.move(handle.x + handle.width / 2, handle.y + handle.height / 2);
  await page.mouse.down();
  await page.mouse.move(handle.x + 5, goal.y + goal.height, { steps: 4 });
  await page.mouse.move(handle.x + 5, goal.y + 3, { steps: 3 });
  await page.mouse.up();
}
