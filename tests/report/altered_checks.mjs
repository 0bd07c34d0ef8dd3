// Reports that the examples do not give: altered data in the same page.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { about, check } from './checks.mjs';
import { open } from './browser.mjs';
import { overflow } from './reading_checks.mjs';

const slot = /(<script type="application\/json" id="report-data">)([\s\S]*?)(<\/script>)/;

/** @param {any} browser @param {import('./make_reports.mjs').Case} c @param {string} name @param {(data: any) => void} alter */
async function altered(browser, c, name, alter) {
  about(`${c.name}, ${name}`);
  const data = structuredClone(c.data);
  alter(data);
  const file = join(c.folder, `${name.replaceAll(' ', '_')}.html`);
  const text = JSON.stringify(data).replaceAll('<', '\\u003c');
  writeFileSync(
    file,
    readFileSync(c.page, 'utf8').replace(slot, (_, begin, __, end) => begin + text + end),
  );
  const { page, complaints } = await open(browser, file);
  check(complaints.length === 0, 'no complaint', complaints.join(' | '));
  return page;
}

/** @param {any} browser @param {import('./make_reports.mjs').Case} c with a route */
export async function checkAltered(browser, c) {
  const lost = c.data.route.order.at(-1);
  let page = await altered(browser, c, 'warnings', (data) => {
    data.plan.interrupted = true;
    data.route.problem_changed = true;
    data.route.order = data.route.order.filter((id) => id !== lost);
    data.route.unreachable = [{ pose: lost, reason: 'no motion leads to it' }];
    data.keyframes = data.keyframes.filter((k) => k.pose !== lost);
    data.singular_values[0] = 1e9;
  });
  const warnings = await page.locator('.warnings').innerText();
  for (const word of ['ended early', 'has changed since', `Pose ${lost} is left out of the route`, 'Ill-conditioned'])
    check(warnings.includes(word), `it warns: ${word}`, warnings);
  check(
    !(await page.getByRole('checkbox', { name: `Measure pose ${lost}`, exact: true }).isChecked()),
    'a pose that cannot be reached is ticked off',
  );
  await page.close();

  page = await altered(browser, c, 'hostile names', (data) => {
    const name = '</script><img src="x" onerror="document.title=1">';
    data.title = data.plan.parameters[0].name = data.columns.at(-1).name = name;
    Object.assign(data.plan.statistics.rejected, { [name]: 12 });
  });
  check(
    (await page.locator('img:not(.printed-picture)').count()) === 0 &&
      (await page.locator('h1').innerText()).includes('<img'),
    'names are text, never markup',
  );
  await page.close();

  page = await altered(browser, c, 'long path', (data) => {
    data.plan.problem.file = `/${'a_folder_with_a_long_name/'.repeat(8)}problem.yaml`;
  });
  await page.setViewportSize({ width: 400, height: 900 });
  check((await overflow(page)) === 0, 'a long path wraps at 400 px', await overflow(page));
  await page.close();

  page = await altered(browser, c, 'little data', (data) => {
    Object.assign(data, {
      candidates: null,
      keyframes: [],
      bodies: [],
      stations: [],
      targets: [],
      curve: [],
      route: null,
    });
    data.plan.certificate = { candidates: null, workspace: null };
    delete data.plan.statistics.cell;
  });
  check(
    (await page.locator('#words').innerText()).includes('no bound is computed'),
    'it says that nothing is proved',
  );
  await page.locator('.rows .preview').first().click();
  check((await page.locator('.values dd').count()) > 0, 'poses can be read where the robot is not drawn');
  await page.close();
}
