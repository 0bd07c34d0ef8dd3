// node tests/report/firefox_test.mjs --wasm DIR --out DIR [--screenshots DIR]
// The page that plans in Debian's Firefox: from an empty page and a URDF as vendors write them (meshes of a package, loose beside
// it) to a KRL program. Returns 77 where the program for pages or Firefox is missing.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { launchFirefox, missingFirefox, skipped } from './browser.mjs';
import { about, check, verdict } from './checks.mjs';
import { overflow } from './reading_checks.mjs';

const { values } = parseArgs({ options: Object.fromEntries(['wasm', 'out', 'screenshots'].map((name) => [name, { type: 'string' }])) });
if (!values.wasm || !values.out) {
  console.error('usage: firefox_test.mjs --wasm DIR --out DIR');
  process.exit(2);
}
const lacking = existsSync(join(values.wasm, 'posewright.wasm')) ? missingFirefox() : 'the program for pages is missing (scripts/wasm makes it)';
if (lacking) {
  console.log(`Skipped: ${lacking}.`);
  process.exit(skipped);
}

const root = fileURLToPath(new URL('../../', import.meta.url));
const out = resolve(values.out);
const file = join(out, 'posewright.html');
mkdirSync(out, { recursive: true });
execFileSync('node', [join(root, 'report/build_live.mjs'), resolve(values.wasm), file]);

/** A box of 0.2 m as STL. */
function boxMesh() {
  const corner = (k) => [k & 1, (k >> 1) & 1, k >> 2].map((v) => (v - 0.5) * 0.2).join(' ');
  const faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
  const facet = (...corners) => `facet normal 0 0 0\nouter loop\n${corners.map((k) => `vertex ${corner(k)}`).join('\n')}\nendloop\nendfacet\n`;
  return `solid box\n${faces.map(([a, b, c, d]) => facet(a, b, c) + facet(a, c, d)).join('')}endsolid box\n`;
}

/** The KR 270 with a mesh of a package at two of its links. @returns {string[]} its files */
function vendorRobot() {
  const mesh = (link) => `<link name="${link}"><collision><geometry><mesh filename="package://kuka_kr270_support/meshes/collision/${link}.stl"/></geometry></collision></link>`;
  const urdf = readFileSync(join(root, 'examples/kr270/kr270.urdf'), 'utf8').replace(/<link name="(link_[12])">.*?<\/link>/gs, (_, link) => mesh(link));
  const files = [['kr270l150.urdf', urdf], ['link_1.stl', boxMesh()], ['link_2.stl', boxMesh()]];
  for (const [name, text] of files) writeFileSync(join(out, name), text);
  return files.map(([name]) => join(out, name));
}

async function shot(page, name) {
  if (!values.screenshots) return;
  mkdirSync(values.screenshots, { recursive: true });
  for (const [suffix, width] of [['', 1400], ['-narrow', 420]]) {
    await page.setViewportSize({ width, height: 900 });
    await page.waitForTimeout(700);
    await page.screenshot({ path: join(values.screenshots, `firefox-${name}${suffix}.png`) });
  }
  await page.setViewportSize({ width: 1400, height: 900 });
}

const step = (page, name) => page.getByRole('tab', { name }).click();
const seconds = (start) => `${((performance.now() - start) / 1000).toFixed(1)} s`;

/** As many whole lines as there are numbers beside them. */
async function checkEditor(page) {
  const { lines, numbers } = await page.locator('.yaml').evaluate((area) => {
    const gutter = document.querySelector('.gutter');
    return { lines: (area.clientHeight - 8) / 20, numbers: (gutter.clientHeight - 8) / 20 };
  });
  check(Math.abs(lines - Math.round(lines)) < 0.02 && Math.round(lines) === numbers, 'no line of the editor is cut', `${lines}, ${numbers}`);
}

const saved = join(out, 'saved');
rmSync(saved, { recursive: true, force: true });
mkdirSync(saved);
const browser = await launchFirefox(saved);
const context = await browser.newContext({ viewport: { width: 1400, height: 900 } });
const page = await context.newPage();
page.setDefaultTimeout(240_000);
const complaints = [];
// A screenshot puts a style of its own into the page.
const complain = (text) => !(values.screenshots && /^Content-Security-Policy|blocked an inline style/.test(text)) && complaints.push(text);
page.on('console', (m) => m.type() === 'error' && complain(m.text()));
page.on('pageerror', (error) => complain(error.message ?? String(error)));
await page.goto(`file://${file}`);
about(`from an empty page to a KRL program in Firefox ${browser.version()}`);
const start = performance.now();
await shot(page, 'empty');
await page.locator('#step-0 input[type=file]').first().setInputFiles(vendorRobot());
await page.waitForFunction(() => Number(document.querySelector('.live-view')?.dataset.drawn ?? 0) > 0);
console.log(`A first picture after ${seconds(start)}`);
check((await page.locator('.yaml').inputValue()).includes('kr270l150.urdf'), 'init has written a problem for the URDF');
check((await page.locator('#step-0 [role=status]').innerText()) === 'kr270l150.urdf is read.', 'no mesh is missing');
check((await page.locator('.verdicts').innerText()).includes('can be measured'), 'configurations are judged');
await checkEditor(page);
await shot(page, 'robot');
await step(page, /Plan/);
await page.getByRole('slider', { name: 'Number of poses' }).fill('12');
await page.waitForFunction(() => /mm|µm/.test(document.querySelector('.expected').textContent));
await page.getByRole('slider', { name: 'Time at most' }).fill('10');
await page.getByRole('button', { name: 'Plan', exact: true }).click();
await page.locator('#result iframe').waitFor();
console.log(`A plan and its report after ${seconds(start)}`);
await shot(page, 'plan');
await step(page, /Take away/);
await page.getByRole('button', { name: 'Write the program' }).click();
await page.waitForFunction(() => /Saved/.test(document.querySelector('#step-4 .busy').textContent));
// Firefox makes an empty file first, and fills it later.
const there = () => readdirSync(saved).filter((name) => /\.(src|dat)$/.test(name) && statSync(join(saved, name)).size > 0).sort();
for (let k = 0; k < 100 && there().length < 2; k++) await page.waitForTimeout(200);
check(there().join() === 'CALPOSES.dat,CALPOSES.src', 'a KRL program is exported', there());
const points = there().includes('CALPOSES.src') ? (readFileSync(join(saved, 'CALPOSES.src'), 'utf8').match(/^\s*PTP /gm) ?? []) : [];
check(points.length >= 12, 'with a motion to each pose', points.length);
await shot(page, 'take');
for (const width of [1400, 420]) {
  await page.setViewportSize({ width, height: 900 });
  const wider = await overflow(page);
  check(wider <= 0, `nothing is wider than the page at ${width} px`, wider);
}
check(complaints.length === 0, 'no error', complaints.join(' | '));
await browser.close();
process.exitCode = verdict();
