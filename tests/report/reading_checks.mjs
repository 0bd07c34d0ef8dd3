// What a reader reads: tables, heat map, names of controls, no leftovers, nothing too wide.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { check } from './checks.mjs';

/** Sorting, heat map, and that everything has a name. */
export async function checkReading(page, { plan }) {
  await page.getByRole('button', { name: 'σ / tolerance' }).click();
  const ratios = await page.locator('.parameters .ratio-value').allTextContents();
  const numbers = ratios.map((t) =>
    Number(
      t
        .replace('−', '-')
        .replace(/ · 10\^/, 'e')
        .replace('−', '-'),
    ),
  );
  check(
    numbers.every((v, k) => k === 0 || v <= numbers[k - 1]),
    'the table sorts by σ/tolerance, largest first',
  );
  await page.locator('.heat').focus();
  await page.keyboard.press('ArrowRight');
  check(
    / and .*: −?\d\.\d{4}/.test(await page.locator('.readout').textContent()),
    'the heat map names a pair and its value',
    await page.locator('.readout').textContent(),
  );
  await checkLeftovers(page);
  const text = await page.locator('main').innerText();
  check(text.includes(plan.problem.sha256) && text.includes(`--seed ${plan.seed}`), 'sha256 and seed are there');
}

/** On every page: controls have names, and nothing of the program shows. @param {any} page */
export async function checkLeftovers(page) {
  const nameless = await page
    .locator('button, input, select, canvas.heat')
    .evaluateAll((all) =>
      all
        .filter((e) => !e.textContent.trim() && !e.getAttribute('aria-label') && !e.closest('label'))
        .map((e) => e.outerHTML),
    );
  check(nameless.length === 0, 'every control has a name', nameless);
  const text = await page.locator('main').innerText();
  check(
    !/\b(undefined|NaN|null|Infinity)\b/.test(text),
    'no leftover of the program shows',
    text.match(/.{20}\b(undefined|NaN|null|Infinity)\b.{20}/)?.[0],
  );
}

/** The command that the page states makes the same plan again. @param {import('./make_reports.mjs').Case} c */
export async function checkRepeat(page, { plan, folder }, program) {
  const line = (await page.locator('#reproduce pre').innerText())
    .split('\n')
    .find((l) => l.startsWith('posewright plan '));
  const again = join(folder, 'again.json');
  const words = line
    .split(' ')
    .slice(1)
    .map((w) => ({ 'plan.json': again, 'poses.csv': '-' })[w] ?? w);
  execFileSync(resolve(program), [...words, '--force', '--quiet'], { cwd: new URL('../../', import.meta.url) });
  const configurations = (p) => JSON.stringify(p.poses.map((pose) => pose.configuration));
  check(
    configurations(JSON.parse(readFileSync(again, 'utf8'))) === configurations(plan),
    'the command stated gives the same poses',
  );
}

/** @param {any} page */
export const overflow = (page) =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
