// Builds the page of `posewright report`: one file, dist/report.html, and the licences of what is in it.
// node build.mjs           writes them
// node build.mjs --check   fails where dist differs from what the sources give
import { mkdirSync, writeFileSync } from 'node:fs';
import { inflateSync } from 'node:zlib';
import { filled, hash, here, inline, licences, packed, read, script, style } from './build_parts.mjs';

const styles = ['base', 'parts', 'view', 'list', 'results', 'print'];
const bundled = ['three', 'uplot'];
const placeholder = '@REPORT_DATA@';

async function page() {
  const whole = await script('src/main.js');
  const parts = {
    STYLE: inline(await style(styles), 'style'),
    LOADER: inline(read('src/loader.js').trim(), 'script'),
    PACKED: packed(whole),
    LICENSES: licences(bundled).replaceAll('--', '- -'),
  };
  // The browser runs what it unpacks by its hash alone.
  const hashes = { STYLE_HASH: hash(parts.STYLE), LOADER_HASH: hash(parts.LOADER), SCRIPT_HASH: hash(whole) };
  const text = filled('src/index.html', { ...parts, ...hashes });
  if (text.split(placeholder).length !== 2) throw new Error(`${placeholder} must occur exactly once`);
  return text;
}

/** Versions of zlib pack differently. @param {string} text */
const unpacked = (text) =>
  text.replace(/(id="report-script">)([^<]*)/, (_, tag, packed) => tag + inflateSync(Buffer.from(packed, 'base64')));

const files = { 'dist/report.html': await page(), 'dist/LICENSES.txt': licences(bundled) };
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
