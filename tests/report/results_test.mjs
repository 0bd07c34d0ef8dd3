// node tests/report/results_test.mjs --program PATH --out DIR
// Pages of results of every command that has one, in a browser. Returns 77 where there is none.
import { parseArgs } from 'node:util';
import { launch, missing, open, skipped } from './browser.mjs';
import { about, check, verdict } from './checks.mjs';
import { makeResults } from './make_results.mjs';
import { checkLeftovers, overflow } from './reading_checks.mjs';
import { checkRefresh, checkWatch } from './refresh_checks.mjs';
import { checkCalibration, checkCalibrations, checkLegs } from './calibration_checks.mjs';
import * as checks from './results_checks.mjs';

const { values } = parseArgs({ options: { program: { type: 'string' }, out: { type: 'string' } } });
if (!values.program || !values.out) {
  console.error('usage: results_test.mjs --program PATH --out DIR');
  process.exit(2);
}
const lacking = missing();
if (lacking) {
  console.log(`Skipped: ${lacking}.`);
  process.exit(skipped);
}

const own = {
  calibration: checkCalibration,
  calibrations: checkCalibrations,
  legs: checkLegs,
  simulation: checks.checkSimulation,
  comparison: checks.checkComparison,
  stations: checks.checkStations,
  next: checks.checkNext,
  two_plans: checks.checkTwoPlans,
  problem: checks.checkProblem,
};

/** No page is wider than its window, in light or dark. @param {any} browser @param {import('./make_results.mjs').ResultCase} c */
async function checkPage(browser, c) {
  about(c.name);
  const { page, complaints } = await open(browser, c.page, { viewport: { width: 1400, height: 900 } });
  await own[c.name](page, c);
  await checkLeftovers(page);
  await page.locator('details').evaluateAll((all) => all.forEach((details) => (details.open = true)));
  for (const width of [1400, 420]) {
    await page.setViewportSize({ width, height: 900 });
    for (const colorScheme of ['light', 'dark']) {
      await page.emulateMedia({ colorScheme });
      const wider = await overflow(page);
      check(wider <= 0, `nothing is wider than the page at ${width} px, ${colorScheme}`, wider);
    }
  }
  check(complaints.length === 0, 'no error, no warning, no request', complaints.join(' | '));
  await page.close();
}

const cases = makeResults(values.program, values.out);
const browser = await launch({ webgl: false });
for (const c of cases) await checkPage(browser, c);
await checkRefresh(
  browser,
  cases.find((c) => c.name === 'calibration'),
);
await browser.close();
await checkWatch(
  values.program,
  cases.find((c) => c.name === 'calibration'),
);
process.exitCode = verdict();
