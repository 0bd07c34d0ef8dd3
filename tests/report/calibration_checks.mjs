// Pages of calibrations: every figure is recomputed from the residuals that the file holds.
import { check, near } from './checks.mjs';
import { mm, plotted, read, rowsOf } from './shown.mjs';

const rms = (list) => Math.sqrt(list.reduce((sum, v) => sum + v * v, 0) / list.length);

/** Distances of the targets P1, P2, P3 at a pose. @param {number[]} r residuals */
const distances = (r) => [0, 3, 6].map((k) => Math.sqrt(r[k] ** 2 + r[k + 1] ** 2 + r[k + 2] ** 2));

export async function checkCalibration(page, { data }) {
  const c = data.result;
  // RMS by axis from the readings of the poses, not from the sums that the program states.
  const rows = await rowsOf(page, 'Errors by axis');
  for (const [axis, offset] of [
    ['x', 0],
    ['y', 1],
    ['z', 2],
  ])
    for (const held of [false, true]) {
      const of = (key) => rms(c.poses.filter((p) => p.held_back === held).flatMap((p) => [0, 3, 6].map((k) => p[key][k + offset])));
      const row = rows.find((r) => r[0] === axis && r[1] === (held ? 'held back' : 'fitted'));
      near(read(row[2]), mm * of('before'), 2e-3, `${axis} before, ${row[1]}`);
      near(read(row[3]), mm * of('residuals'), 2e-3, `${axis} after, ${row[1]}`);
    }
  const [, before, fitted, heldBack] = await plotted(page, 'plot-per-pose-m');
  check(before.length === c.poses.length, 'one dot a pose before', before.length);
  c.poses.forEach((p, k) => {
    near(before[k], mm * rms(distances(p.before)), 1e-9, `error before at pose ${p.id}`);
    near((p.held_back ? heldBack : fitted)[k], mm * rms(distances(p.residuals)), 1e-9, `error after at pose ${p.id}`);
    check((p.held_back ? fitted : heldBack)[k] === null, `pose ${p.id} is drawn once`);
  });
  const [, along] = await plotted(page, 'plot-along-z-m');
  check(along.filter((v) => v !== null).length === 3 * c.poses_fitted, 'one dot a target and fitted pose along z', along.length);
  const [, counts, expected] = await plotted(page, 'plot-histogram');
  check(counts.join() === c.histogram.counts.join(), 'the histogram is the file’s');
  const all = c.poses.filter((p) => !p.held_back).flatMap((p) => p.residuals).length;
  near(
    counts.reduce((a, b) => a + b),
    all,
    1e-12,
    'it holds every fitted residual',
  );
  near(
    expected.reduce((a, b) => a + b),
    all,
    1e-6,
    'normal noise would give as many',
  );
  // 68.27 % of normal numbers are within one σ, bins 7 to 10 (tables).
  near(expected.slice(7, 11).reduce((a, b) => a + b) / all, 0.682689, 1e-5, 'of which 68.27 % within 1 σ');
  await checkParameters(page, c);
  const frames = await rowsOf(page, 'Frames');
  check(frames.map((r) => r[0]).join() === c.frames.map((f) => f.name).join() && frames.length > 0, 'every frame has a row');
  c.frames.forEach((f, k) => {
    f.position.forEach((v, i) => check(Math.abs(read(frames[k][2 + i]) - mm * v) < 6e-5, `position of ${f.name}`));
    f.quaternion_xyzw.forEach((v, i) => check(Math.abs(read(frames[k][5 + i]) - v) < 1e-8, `quaternion of ${f.name}`));
  });
  const tile = page.locator('.tile', { hasText: 'poses not fitted' });
  near(
    read(await tile.locator('b').textContent()),
    mm * rms(c.poses.filter((p) => p.held_back).flatMap((p) => distances(p.residuals))),
    6e-3,
    'the tile of poses held back',
  );
  const effects = await rowsOf(page, 'Effects that are not fitted');
  effects.forEach((row, k) => near(read(row[1]), 100 * c.effects_left_out[k].share, 6e-2, `share of ${row[0]}`));
}

async function checkParameters(page, c) {
  const estimated = c.parameters.filter((p) => p.estimated);
  const rows = page.locator('.calibrated tbody tr');
  check((await rows.count()) === estimated.length, 'one row a parameter that was estimated', await rows.count());
  for (const p of estimated) {
    const factor = { m: 1e3, rad: 180 / Math.PI }[p.unit];
    const cells = await page.locator(`.calibrated tr[data-name="${p.name}"] td`).allTextContents();
    check(Math.abs(read(cells[1]) - factor * p.value) <= 0.06 * factor * p.sigma, `value of ${p.name}`, cells[1]);
    near(read(cells[3]), factor * p.sigma, 6e-2, `σ of ${p.name}`);
    if (p.interval)
      check(
        cells[4].includes(' to ') && Math.abs(read(cells[4]) - factor * p.interval[0]) <= 0.06 * factor * p.sigma,
        `interval of ${p.name}`,
        cells[4],
      );
  }
}

export async function checkCalibrations(page, { data }) {
  const all = data.result;
  const rows = await rowsOf(page, 'Models');
  check(rows.map((r) => r[0]).join() === all.models.map((c) => c.variant).join(), 'all models are in the table', rows.length);
  all.models.forEach((c, k) => near(read(rows[k][2]), Math.sqrt(c.chi_square / c.freedom), 6e-3, `residuals over noise of ${c.variant}`));
  const count = async () => page.locator('.calibrated tbody tr').count();
  for (const c of all.models) {
    await page.getByLabel('Model', { exact: true }).selectOption(c.variant);
    check((await count()) === c.parameters.filter((p) => p.estimated).length, `the parameters of ${c.variant} are shown when it is chosen`);
  }
}

/** Marks of the telescope's points are where the estimated parameters put them, as many times as the caption states. */
export async function checkLegs(page, { data }) {
  const models = data.result.models;
  const figure = page.locator('#plot-leg-points');
  const times = read((await figure.locator('figcaption').textContent()).match(/([\d,.]+) times/)[1]);
  const nominal = await figure
    .locator('.nominal-point')
    .evaluateAll((all) => all.map((e) => ({ point: e.dataset.point, x: e.cx.baseVal.value, y: e.cy.baseVal.value })));
  const marks = await figure.locator('.mark[data-point]').evaluateAll((all) =>
    all.map((e) => {
      const { e: x, f: y } = e.transform.baseVal[0].matrix;
      return { point: e.dataset.point, model: Number(e.dataset.model), x, y };
    }),
  );
  check(nominal.length === 12 && marks.length === 36, 'twelve points, one mark of each model', [nominal.length, marks.length]);
  const of = (model, name) => models[model].parameters.find((p) => p.name === name && p.estimated);
  const at = (name) => nominal.find((n) => n.point === name);
  // Nominal x of legs 1 and 2 give the scale of each picture; they are parameters of rigid_6.
  const scaleOf = (body) =>
    (at(`leg_1.${body}`).x - at(`leg_2.${body}`).x) / (of(0, `leg_1.${body}x`).nominal - of(0, `leg_2.${body}x`).nominal);
  let [widest, moved] = [0, 0];
  for (const { point, model, x, y } of marks) {
    const scale = scaleOf(point.at(-1));
    const change = (axis) => (of(model, point + axis) ? of(model, point + axis).value - of(model, point + axis).nominal : 0);
    near(x - at(point).x, scale * times * change('x'), 1e-4, `x of ${point} by ${models[model].variant}`);
    near(y - at(point).y, -scale * times * change('y'), 1e-4, `y of ${point} by ${models[model].variant}, upwards`);
    widest = Math.max(widest, Math.hypot(change('x'), change('y')));
    moved += change('x') !== 0 ? 1 : 0;
  }
  check(moved === 36, 'every mark stands for an estimate', moved);
  // The points of the platform extend over 347 mm (examples/telescope/problem.yaml).
  check(times * widest <= 0.347 / 6 && 2.5 * times * widest > 0.347 / 6, 'deviations are amplified as far as they fit', times);
  const rows = await rowsOf(page, 'Points of the legs');
  const b1 = rows.find((r) => r[0] === 'matrix' && r[1] === 'leg_1.b');
  near(read(b1[5]), mm * (of(2, 'leg_1.bx').value - of(2, 'leg_1.bx').nominal), 1e-3, 'deviation of b of leg 1 by matrix');
  near(read(b1[8]), mm * of(2, 'leg_1.bx').sigma, 1e-3, 'and its σ');
}
