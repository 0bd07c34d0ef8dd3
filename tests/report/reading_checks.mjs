// What a reader reads: tables, heat map, names of controls, no leftovers, nothing too wide.
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
  const nameless = await page
    .locator('button, input, select, canvas.heat')
    .evaluateAll((all) =>
      all
        .filter((e) => !e.textContent.trim() && !e.getAttribute('aria-label') && !e.closest('label'))
        .map((e) => e.outerHTML),
    );
  check(nameless.length === 0, 'every control has a name', nameless);
  const text = await page.locator('main').innerText();
  check(text.includes(plan.problem.sha256) && text.includes(`--seed ${plan.seed}`), 'sha256 and seed are there');
  check(
    !/\b(undefined|NaN|null|Infinity)\b/.test(text),
    'no leftover of the program shows',
    text.match(/.{20}\b(undefined|NaN|null|Infinity)\b.{20}/)?.[0],
  );
}

/** @param {any} page */
export const overflow = (page) =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
