// A page that reads itself again while the command that writes it is at work.
import { readFileSync, writeFileSync } from 'node:fs';
import { open } from './browser.mjs';
import { about, check } from './checks.mjs';

/** @param {any} browser @param {import('./make_results.mjs').ResultCase} c */
export async function checkRefresh(browser, c) {
  about('a page that is written again');
  const file = c.page.replace('.html', '-again.html');
  const text = readFileSync(c.page, 'utf8').replace('"refresh":0.0', '"refresh":1');
  check(text.includes('"refresh":1,'), 'the page is told to read itself again');
  writeFileSync(file, text);
  const { page, complaints } = await open(browser, file);
  await page.locator('#parameters').scrollIntoViewIfNeeded();
  await page.locator('#tests details').evaluate((details) => (details.open = true));
  const before = await page.evaluate(() => scrollY);
  check(before > 300, 'the reader has scrolled', before);
  writeFileSync(file, text.replace(`"title":"${c.data.title}"`, '"title":"written again"').replace('"refresh":1,', '"refresh":0.0,'));
  await page.waitForFunction(() => document.getElementById('title').textContent === 'written again');
  await page.waitForTimeout(300);
  check(Math.abs((await page.evaluate(() => scrollY)) - before) <= 1, 'it shows the new file where the reader was', before);
  check(await page.locator('#tests details').evaluate((details) => details.open), 'what they had opened is open');
  await page.waitForTimeout(1500);
  check(
    (await page.evaluate(() => performance.getEntriesByType('navigation')[0].type)) === 'reload' && complaints.length === 0,
    'no complaint',
    complaints.join(' | '),
  );
  await page.close();
}
