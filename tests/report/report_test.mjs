// node tests/report/report_test.mjs --program PATH --out DIR [--screenshots DIR]
// Makes reports of the examples with the program and reads them in a browser. Returns 77 where there is none.
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { launch, missing, open, skipped } from './browser.mjs';
import { about, check, verdict } from './checks.mjs';
import { checkAltered } from './altered_checks.mjs';
import { makeReports } from './make_reports.mjs';
import { checkCamera, checkLocks } from './moves_checks.mjs';
import { checkNumbers } from './numbers_checks.mjs';
import { checkList, checkOverview, checkPlots, checkViewer } from './page_checks.mjs';
import { checkReading, checkRepeat, overflow } from './reading_checks.mjs';

const { values } = parseArgs({
  options: { program: { type: 'string' }, out: { type: 'string' }, screenshots: { type: 'string' } },
});
if (!values.program || !values.out) {
  console.error('usage: report_test.mjs --program PATH --out DIR [--screenshots DIR]');
  process.exit(2);
}
const lacking = missing();
if (lacking) {
  console.log(`Skipped: ${lacking}.`);
  process.exit(skipped);
}

/** @param {any} browser @param {import('./make_reports.mjs').Case} c */
async function checkPicture(browser, c) {
  about(`${c.name} in WebGL`);
  const { page, complaints } = await open(browser, c.page);
  await checkViewer(page, c);
  check(complaints.length === 0, 'no error, no warning, no request', complaints.join(' | '));
  await page.close();
}

/** All but the picture. @param {any} browser @param {import('./make_reports.mjs').Case} c */
async function checkCase(browser, c) {
  about(c.name);
  checkNumbers(c);
  const { page, complaints } = await open(browser, c.page);
  await checkOverview(page, c);
  await checkPlots(page, c);
  await checkList(page, c, values.program);
  await checkLocks(page, c, values.program);
  if (c.data.cameras.length > 0) await checkCamera(page, c);
  await checkReading(page, c);
  if (!c.route) await checkRepeat(page, c, values.program);
  check(complaints.length === 0, 'no error, no warning, no request', complaints.join(' | '));
  await page.close();
}

/** No page is wider than its window. @param {any} browser @param {import('./make_reports.mjs').Case} c */
async function checkSizes(browser, c) {
  about(`${c.name} in windows`);
  for (const width of [1280, 400]) {
    const { page: sized, complaints: others } = await open(browser, c.page, { viewport: { width, height: 900 } });
    for (const colorScheme of ['light', 'dark']) {
      await sized.emulateMedia({ colorScheme });
      const wider = await overflow(sized);
      check(wider <= 0, `nothing is wider than the page at ${width} px, ${colorScheme}`, wider);
    }
    check(others.length === 0, `no complaint at ${width} px`, others.join(' | '));
    await sized.close();
  }
}

/** @param {any} browser without WebGL @param {import('./make_reports.mjs').Case} c */
async function checkFallback(browser, c) {
  about(`${c.name} without WebGL`);
  const { page, complaints } = await open(browser, c.page);
  const rods = () =>
    page.locator('svg.wire polyline.rod').evaluateAll((all) => all.map((e) => e.getAttribute('points')).join(' '));
  const before = await rods();
  check(
    before.length > 0 &&
      (await page.locator('svg.wire circle.tip').count()) ===
        new Set(c.data.keyframes.map((k) => k.pose).filter(Boolean)).size,
    'skeleton and tips are drawn',
  );
  const slider = page.getByRole('slider', { name: 'Place in the measuring order' });
  await slider.fill('1');
  check((await rods()) !== before, 'the slider moves the skeleton');
  check(complaints.length === 0, 'no complaint', complaints.join(' | '));
  await page.close();
}

/** @param {any} browser @param {string} folder */
async function takeScreenshots(browser, folder) {
  mkdirSync(folder, { recursive: true });
  for (const c of makeReports(values.program, join(values.out, 'screenshots'), ['telescope', 'kr270', 'cell', 'camera'], true)) {
    for (const [suffix, width, height] of [['', 1400, 1420], ['-narrow', 420, 1420]]) {
      if (suffix && c.name !== 'cell') continue;
      const { page } = await open(browser, c.page, { viewport: { width, height } });
      await page.screenshot({ path: join(folder, `report-${c.name}${suffix}.png`) });
      await page.close();
    }
  }
}

/** A plan for the tolerances, at both widths: what the page says of drawn robots is what plan.json has. @param {any} browser @param {import('./make_reports.mjs').Case} c */
async function checkRobots(browser, c) {
  about(`${c.name}, drawn robots`);
  const { robust } = c.plan;
  for (const width of [1400, 420]) {
    const { page, complaints } = await open(browser, c.page, { viewport: { width, height: 900 } });
    const tile = await page.locator('.tile', { hasText: `on ${robust.draws} drawn robots` }).locator('b').textContent();
    check(Math.abs(parseFloat(tile) - 100 * robust.value) < 0.0101, `the tile has the value at ${width} px`, tile);
    const [x, own, nominal, bound] = await page.locator('#plot-robots').evaluate((f) => f.plot.data);
    const sorted = (all) => [...all].sort((a, b) => a - b).map((e) => 100 * e).join();
    check(x.length === robust.draws, 'one place a robot', x.length);
    check(own.join() === sorted(robust.efficiency), 'the plan on each robot, worst first');
    check(nominal.join() === sorted(robust.nominal_plan.efficiency), 'so the plan for the nominal robot');
    check(bound.every((b) => Math.abs(b - 100 * Math.min(1, robust.bound)) < 1e-9), 'and the bound');
    const wider = await overflow(page);
    check(wider <= 0, `nothing is wider than the page at ${width} px`, wider);
    check(complaints.length === 0, 'no complaint', complaints.join(' | '));
    await page.close();
  }
}

/** Poses of several instruments: the legend counts them, and each dot has the colour of its own. @param {any} browser without WebGL @param {import('./make_reports.mjs').Case} c */
async function checkInstruments(browser, c) {
  about(`${c.name} of a list`);
  const { page, complaints } = await open(browser, c.page);
  const names = c.plan.instruments.map((i) => i.name);
  const legend = () => page.locator('.instruments li').allInnerTexts();
  const counted = (left) => names.map((name) => left.filter((p) => p.instrument === name).length).map((n, k) => `${names[k]} ${n} ${n === 1 ? 'pose' : 'poses'}`);
  check((await legend()).join() === counted(c.plan.poses).join(), 'the legend has every instrument', await legend());
  const fills = () => page.locator('svg.wire circle.tip').evaluateAll((dots) => dots.map((dot) => dot.style.fill));
  const expected = c.plan.poses.map((p, k) => (k === 0 ? '' : `var(--instrument-${names.indexOf(p.instrument) + 1})`));
  check((await fills()).join() === expected.join(), 'each dot has the colour of its instrument, but for the one shown', await fills());
  const last = c.plan.poses.at(-1);
  await page.getByRole('checkbox', { name: `Measure pose ${last.id}`, exact: true }).uncheck();
  check((await legend()).join() === counted(c.plan.poses.slice(0, -1)).join(), 'a pose that is ticked off is not counted', await legend());
  check((await fills()).at(-1) === '', 'and has no colour of an instrument');
  check(complaints.length === 0, 'no complaint', complaints.join(' | '));
  await page.close();
}

const every = makeReports(values.program, values.out);
const drawn = every.filter((c) => c.plan.robust);
const listed = every.filter((c) => c.plan.instruments);
const cases = every.filter((c) => !c.plan.robust && !c.plan.instruments);
const browser = await launch({ webgl: true });
for (const c of cases) await checkPicture(browser, c);
// Software draws slowly, and every tick of the list draws again: the rest of the page is checked without WebGL below.
await checkSizes(
  browser,
  cases.find((c) => c.route),
);
await checkAltered(
  browser,
  cases.find((c) => c.route),
);
if (values.screenshots) await takeScreenshots(browser, values.screenshots);
await browser.close();
const plain = await launch({ webgl: false });
for (const c of cases) await checkCase(plain, c);
for (const c of cases) await checkSizes(plain, c);
for (const c of cases.filter((k) => k.name !== 'test_poses')) await checkFallback(plain, c);
for (const c of drawn) await checkRobots(plain, c);
for (const c of listed) await checkInstruments(plain, c);
check(drawn.length > 0 && listed.length > 0, 'there are plans for the tolerances and of several instruments');
await plain.close();
process.exitCode = verdict();
