// A page that reads itself again while the command that writes it is at work.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { setTimeout as wait } from 'node:timers/promises';
import { open } from './browser.mjs';
import { about, check } from './checks.mjs';

/** @param {any} browser @param {import('./make_results.mjs').ResultCase} c */
export async function checkRefresh(browser, c) {
  about('a page that is written again');
  const file = c.page.replace('.html', '-again.html');
  // Seconds: on a busy machine the reader below must be done before the page reads itself again.
  const text = readFileSync(c.page, 'utf8').replace('"refresh":0.0', '"refresh":5');
  check(text.includes('"refresh":5,'), 'the page is told to read itself again');
  writeFileSync(file, text);
  const { page, complaints } = await open(browser, file);
  await page.locator('#parameters').scrollIntoViewIfNeeded();
  await page.locator('#tests details').evaluate((details) => (details.open = true));
  const before = await page.evaluate(() => scrollY);
  check(before > 300, 'the reader has scrolled', before);
  writeFileSync(file, text.replace(`"title":"${c.data.title}"`, '"title":"written again"').replace('"refresh":5,', '"refresh":0.0,'));
  await page.waitForFunction(() => document.getElementById('title').textContent.startsWith('written again, variant'));
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

/** The page that is written anew when its result is: `report --watch`. @param {string} program @param {import('./make_results.mjs').ResultCase} c */
export async function checkWatch(program, c) {
  about('report --watch');
  const [file, page] = ['watched.json', 'watched.html'].map((name) => join(c.files.folder, name));
  const result = structuredClone(c.data.result);
  rmSync(page, { force: true });
  writeFileSync(file, JSON.stringify(result));
  const child = spawn(resolve(program), ['report', file, '--watch', '-o', page, '--quiet'], { stdio: 'ignore' });
  const ended = once(child, 'exit');
  const data = () => JSON.parse(readFileSync(page, 'utf8').match(/id="report-data">(.*?)<\/script>/s)[1]);
  const until = async (holds) => {
    for (let k = 0; k < 200 && !(existsSync(page) && holds(data())); ++k) await wait(50);
    return existsSync(page) && holds(data());
  };
  check(await until((d) => d.refresh > 0), 'an open page is told to read itself again');
  writeFileSync(file, JSON.stringify(result).slice(0, 5000));
  await wait(500);
  check(data().result.variant === result.variant, 'half a file changes nothing');
  writeFileSync(file, JSON.stringify({ ...result, variant: 'another' }));
  check(await until((d) => d.result.variant === 'another' && d.refresh > 0), 'the page is the new result’s');
  child.kill('SIGINT');
  const [code] = await ended;
  check(code === 130 && data().refresh === 0, 'after Ctrl-C the last page stands still', [code, data().refresh]);
}
