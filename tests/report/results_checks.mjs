// Pages of results: every figure is recomputed from the file by loops of the test's own.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { check, near } from './checks.mjs';
import { mm, plotted, read, rowsOf } from './shown.mjs';

export async function checkSimulation(page, { data }) {
  const s = data.result;
  const rows = await rowsOf(page, 'Parameters');
  s.parameters.forEach((p, k) => {
    near(read(rows[k][6]), p.sigma_observed / p.sigma_predicted, 6e-3, `σ of ${p.name}, observed over predicted`);
    near(read(rows[k][10]), 100 * p.coverage, 1e-3, `coverage of ${p.name}`);
    // What lies within ±1.96 σ is at least what is within ±1.5, and at most what is within ±2: bins 6 to 11, 5 to 12.
    const within = (from, to) => p.histogram.slice(from, to).reduce((a, b) => a + b);
    check(p.histogram.reduce((a, b) => a + b) === s.draws.fitted, `every draw of ${p.name} is in its histogram`);
    check(
      within(6, 12) <= p.coverage * s.draws.fitted + 1e-9 && p.coverage * s.draws.fitted <= within(5, 13) + 1e-9,
      `the histogram of ${p.name} goes with its coverage`,
    );
  });
  const [, covered] = await plotted(page, 'plot-coverage');
  check(
    covered.every((v, k) => v === 100 * s.parameters[k].coverage),
    'coverage is drawn',
  );
  const [, pooled] = await plotted(page, 'plot-errors-all');
  check(pooled.reduce((a, b) => a + b) === s.draws.fitted * s.parameters.length, 'the histogram of all holds every error');
  const [centres, draws] = await plotted(page, 'plot-distances');
  check(draws.reduce((a, b) => a + b) === s.draws.fitted, 'one entry a draw');
  const spread = Math.sqrt(centres.reduce((sum, x, k) => sum + draws[k] * x * x, 0) / s.draws.fitted);
  check(
    Math.abs(spread - mm * s.accuracy.observed) < mm * s.accuracy.histogram.bin_width,
    'its root mean square is the observed error within a bin',
    spread,
  );
}

export async function checkComparison(page, { data }) {
  const c = data.result;
  const cells = await rowsOf(page, 'Efficiency');
  c.plans.forEach((plan, r) => {
    check(cells[r][0] === plan.name, `row of ${plan.name}`, cells[r][0]);
    c.variants.forEach((v, k) => {
      const score = c.scores.find((s) => s.plan === plan.name && s.variant === v.name);
      const shown = read(cells[r][k + 1]);
      check(
        shown <= 100 * score.efficiency && 100 * score.efficiency - shown < 0.01,
        `efficiency of ${plan.name} for ${v.name}, rounded down`,
        shown,
      );
    });
  });
  const rows = await rowsOf(page, 'Accuracy');
  check(rows.length === c.scores.length, 'one row a plan and variant');
  c.scores.forEach((s, k) => near(read(rows[k][6]), s.mean_sigma_per_tolerance, 6e-3, `mean σ of ${s.plan} for ${s.variant}`));
  const [, withIt, without] = await plotted(page, 'plot-worth');
  c.worth.forEach((w, k) => {
    near(withIt[k], w.error_with, 1e-12, `error with ${w.with}`);
    // What is left of noise and bias, which are independent.
    near(without[k], Math.sqrt(w.noise_without ** 2 + w.bias_without ** 2), 1e-9, `error without, ${w.without}`);
  });
  const [times, first] = await plotted(page, 'plot-expected-0');
  const { expected_error: expected } = c.scores.find((s) => s.variant === c.variants[0].name);
  times.forEach((t, k) =>
    near(
      first[k],
      mm * (t === 0 ? expected.by_noise : expected.with.find((w) => w.times === t).error),
      1e-12,
      `error with an effect of ${t} times the noise`,
    ),
  );
  const [title] = await page.locator('.bias summary').allTextContents();
  const worst = Math.max(
    ...c.aliases.flatMap((a) => a.parameters.map((p) => Math.max(Math.abs(p.bias_by_nominal), Math.abs(p.bias_by_tolerance)) / p.sigma)),
  );
  near(read(title.match(/most, ([\d.]+) σ/)[1]), worst, 6e-3, 'the largest bias comes first');
}

export async function checkStations(page, { data }) {
  const s = data.result;
  const good = s.ranking.filter((r) => !r.why_not);
  const rows = await rowsOf(page, 'Ranking');
  check(rows.length === good.length, 'one row a place', rows.length);
  good.forEach((r, k) => {
    const best = Math.max(...good.filter((o) => o.in_full === r.in_full && o.parameters === r.parameters).map((o) => o.phi));
    near(read(rows[k][6]), Math.exp((best - r.phi) / (2 * r.parameters)), 6e-4, `σ from ${rows[k][1]}`);
    if (r.sigma_ratio !== null) near(read(rows[k][6]), r.sigma_ratio, 6e-4, `σ from ${rows[k][1]}, as the program says`);
  });
  const marks = await page
    .locator('.map circle.place')
    .evaluateAll((all) =>
      all.map((e) => ({ name: e.dataset.name, x: e.cx.baseVal.value, y: e.cy.baseVal.value, share: Number(e.dataset.share) })),
    );
  check(marks.length === s.ranking.length, 'every place is on the map', marks.length);
  const at = (name) => s.ranking.find((r) => r.stations[name]).stations[name].position;
  const [a, b] = [marks[0], marks.find((m) => at(m.name)[0] !== at(marks[0].name)[0])];
  const scale = (b.x - a.x) / (at(b.name)[0] - at(a.name)[0]);
  check(scale > 0, 'x goes to the right');
  for (const m of marks) {
    near(m.x - a.x, scale * (at(m.name)[0] - at(a.name)[0]), 1e-6, `x of ${m.name}`);
    near(m.y - a.y, -scale * (at(m.name)[1] - at(a.name)[1]), 1e-6, `y of ${m.name}, upwards`);
  }
  check(Math.max(...marks.map((m) => m.share)) === 1, 'the best place has the end of the colours');
  const named = await page.locator('.map text').allTextContents();
  check(named.includes('table') && named.includes('robot'), 'obstacle and robot are on the map', named);
}

export async function checkNext(page, { data }) {
  const n = data.result;
  const [poses, expected, bound, ahead] = await plotted(page, 'plot-next');
  for (const p of n.curve.filter((q) => q.expected !== null)) {
    near(expected[poses.indexOf(p.poses)], mm * p.expected, 1e-12, `expected after ${p.poses} poses`);
  }
  const now = n.curve.at(-1);
  near(bound[poses.indexOf(now.poses)], mm * now.upper, 1e-12, `bound after ${now.poses} poses`);
  for (const p of n.ahead) near(ahead[poses.indexOf(p.poses)], mm * p.expected, 1e-12, `what is to come with ${p.poses} poses`);
  check(expected[poses.indexOf(n.ahead[0].poses)] === null, 'what is not measured yet is drawn as that');
  const level = (await plotted(page, 'plot-next')).at(-1);
  check(
    level.every((v) => Math.abs(v - mm * n.required) < 1e-12),
    'the required error is a level',
  );
  const rows = await rowsOf(page, 'Next poses');
  n.poses.forEach((p, k) => {
    check(rows[k][0] === String(p.id), `pose ${p.id} is in its place`);
    p.configuration.forEach((v, j) =>
      check(Math.abs(read(rows[k][j + 1]) - (v * 180) / Math.PI) <= 5.01e-4, `${p.names[j]} of pose ${p.id}`, rows[k][j + 1]),
    );
  });
  check((await page.locator('#progress .lead').textContent()) === n.reason, 'the reason is the file’s');
  check((await page.locator('.tile').first().locator('b').textContent()) === (n.stop ? 'stop' : 'go on'), 'the verdict comes first');
}

export async function checkTwoPlans(page, { data, files }) {
  const [a, b] = ['a', 'b'].map((name) => JSON.parse(readFileSync(join(files.folder, `${name}.json`), 'utf8')));
  const interest = a.parameters.filter((p) => p.identifiable && p.role === 'interest').length;
  const tile = page.locator('.tile', { hasText: 'information of B' }).locator('b');
  near(
    read(await tile.textContent()),
    100 * Math.exp((b.criterion.log_det - a.criterion.log_det) / interest),
    1e-3,
    'efficiency of B by the log det of both files',
  );
  // Lines of the lists of poses that are the same text but for their number.
  const lines = (name) =>
    readFileSync(join(files.folder, `${name}.csv`), 'utf8')
      .trim()
      .split('\n')
      .slice(1)
      .map((l) => l.replace(/^\d+,/, ''));
  const other = new Set(lines('b'));
  const common = lines('a').filter((l) => other.has(l)).length;
  check(common > 0, 'the plans have poses in common', common);
  check(
    (await page.locator('.tile', { hasText: 'in common' }).locator('small').textContent()).includes(`${common} in common`),
    'as many as the lists of poses have',
    common,
  );
  check((await page.locator('.viewer').count()) === 2, 'both are drawn');
  const [, p, q] = await plotted(page, 'plot-two-sigma');
  const kept = a.parameters.filter((x) => x.identifiable);
  kept.forEach((x, k) => {
    near(p[k], x.sigma / x.tolerance, 1e-12, `σ of A of ${x.name}`);
    near(q[k], b.parameters.find((y) => y.name === x.name).sigma / x.tolerance, 1e-12, `σ of B of ${x.name}`);
  });
  const stop = (k) => page.locator('.stop').nth(k).textContent();
  const [idA, idB] = (await rowsOf(page, 'Poses in both plans')).at(-1);
  await page.locator('.common').evaluate((details) => (details.open = true));
  const place = a.poses.findIndex((x) => x.id === Number(idA));
  await page.getByRole('slider', { name: 'Place in the measuring order' }).first().fill(String(place));
  check((await stop(0)).includes(`pose ${idA}`) && (await stop(1)).includes(`pose ${idB}`), 'a pose of both is shown in both pictures', [
    await stop(0),
    await stop(1),
  ]);
  check(data.plans.length === 2 && data.files.join() === 'a.json,b.json', 'the page holds both plans');
}

/** What is wrong is said, shares are those of the verdicts, and the slider shows each reason. */
export async function checkProblem(page, { data }) {
  check(data.faults.length > 0 && /station A stands inside pillar/.test(data.faults[0]), 'the fault is in the data', data.faults);
  check((await page.locator('#faults').innerText()).includes(data.faults[0]), 'and on the page');
  const reason = (k) => (data.verdicts[k] < 0 ? 'can be measured' : data.reasons[data.verdicts[k]]);
  const even = Array.from({ length: data.evenly }, (_, k) => reason(k + 1));
  for (const text of await page.locator('.verdicts li').allTextContents()) {
    const [, share, what] = text.match(/^(\d+) % (.*)$/);
    const expected = (100 * even.filter((r) => r === what).length) / data.evenly;
    check(Math.abs(Number(share) - expected) <= 0.5, `share of "${what}"`, share);
  }
  const slider = page.getByRole('slider', { name: 'Configuration shown' });
  for (const k of [0, 1, data.verdicts.length - 1]) {
    await slider.fill(String(k));
    check((await page.locator('.stop').innerText()).endsWith(reason(k)), `the reason of configuration ${k} is shown`);
  }
  const fills = await page.locator('.wire .tip:not(.now)').evaluateAll((dots) => dots.map((dot) => dot.style.fill));
  const measurable = data.verdicts.slice(1, -1).filter((verdict) => verdict < 0).length;
  check(fills.filter((fill) => fill === 'var(--verdict-feasible)').length === measurable, 'a picture in lines has the colours of the verdicts', fills.length);
}
