// Builds the page of `posewright report`: one file, dist/report.html, and the licences of what is in it.
// node build.mjs           writes them
// node build.mjs --check   fails where dist differs from what the sources give
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { deflateSync, inflateSync } from 'node:zlib';

const build = await import('esbuild').then(
  (esbuild) => esbuild.build,
  () => {
    console.log('Skipped: npm packages are missing (npm ci in report/ installs them).');
    process.exit(77);
  },
);

const here = new URL('.', import.meta.url);
const read = (path) => readFileSync(new URL(path, here), 'utf8');
const styles = ['base', 'parts', 'view', 'list', 'results', 'print'];
const bundled = ['three', 'uplot'];
const placeholder = '@REPORT_DATA@';

/** An inline element's text must not end it. @param {string} text @param {string} tag */
function inline(text, tag) {
  if (new RegExp(`</${tag}`, 'i').test(text)) throw new Error(`the ${tag} contains its own end`);
  return text;
}

/** @param {string} text */
const hash = (text) => `sha256-${createHash('sha256').update(text).digest('base64')}`;

function licences() {
  return bundled
    .map((name) => {
      const { version, license } = JSON.parse(read(`node_modules/${name}/package.json`));
      return `${name} ${version} (${license})\n\n${read(`node_modules/${name}/LICENSE`).trim()}\n`;
    })
    .join('\n\n');
}

async function script() {
  const result = await build({
    entryPoints: [new URL('src/main.js', here).pathname],
    bundle: true,
    minify: true,
    format: 'iife',
    target: 'es2022',
    legalComments: 'none',
    charset: 'ascii',
    write: false,
    absWorkingDir: new URL('.', here).pathname,
  });
  return result.outputFiles[0].text.trim();
}

async function style() {
  const text = [
    read('node_modules/uplot/dist/uPlot.min.css'),
    ...styles.map((name) => read(`src/styles/${name}.css`)),
  ].join('\n');
  const result = await build({ stdin: { contents: text, loader: 'css' }, minify: true, write: false });
  return result.outputFiles[0].text.trim();
}

async function page() {
  const whole = await script();
  const parts = {
    STYLE: inline(await style(), 'style'),
    LOADER: inline(read('src/loader.js').trim(), 'script'),
    PACKED: deflateSync(whole, { level: 9 }).toString('base64'),
    LICENSES: licences().replaceAll('--', '- -'),
  };
  // The browser runs what it unpacks by its hash alone.
  const hashes = { STYLE_HASH: hash(parts.STYLE), LOADER_HASH: hash(parts.LOADER), SCRIPT_HASH: hash(whole) };
  const all = { ...parts, ...hashes };
  const text = read('src/index.html').replace(/@([A-Z_]+)@/g, (word, name) => all[name] ?? word);
  if (text.split(placeholder).length !== 2) throw new Error(`${placeholder} must occur exactly once`);
  return text;
}

/** Versions of zlib pack differently. @param {string} text */
const unpacked = (text) =>
  text.replace(/(id="report-script">)([^<]*)/, (_, tag, packed) => tag + inflateSync(Buffer.from(packed, 'base64')));

const files = { 'dist/report.html': await page(), 'dist/LICENSES.txt': licences() };
if (process.argv.includes('--check')) {
  const stale = Object.keys(files).filter((path) => unpacked(read(path)) !== unpacked(files[path]));
  if (stale.length > 0) {
    console.error(`${stale.join(', ')}: not what the sources give; run: npm run build`);
    process.exit(1);
  }
  console.log('The built page is what the sources give.');
} else {
  mkdirSync(new URL('dist', here), { recursive: true });
  for (const [path, text] of Object.entries(files)) {
    writeFileSync(new URL(path, here), text);
    console.log(`${path}: ${Math.round(text.length / 1000)} kB`);
  }
}
