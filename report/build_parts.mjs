// What the builds of both pages share: bundles, styles, hashes, licences.
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { deflateSync } from 'node:zlib';

const { build } = await import('esbuild').catch(() => {
  console.log('Skipped: npm packages are missing (npm ci in report/ installs them).');
  process.exit(77);
});

export const here = new URL('.', import.meta.url);
/** @param {string} path */
export const read = (path) => readFileSync(new URL(path, here), 'utf8');

/** An inline element's text must not end it. @param {string} text @param {string} tag */
export function inline(text, tag) {
  if (new RegExp(`</${tag}`, 'i').test(text)) throw new Error(`the ${tag} contains its own end`);
  return text;
}

/** @param {string} text */
export const hash = (text) => `sha256-${createHash('sha256').update(text).digest('base64')}`;
/** @param {string|Buffer} bytes */
export const packed = (bytes) => deflateSync(bytes, { level: 9 }).toString('base64');

/** @param {string[]} packages that are in a bundle */
export const licences = (packages) =>
  packages
    .map((name) => {
      const { version, license } = JSON.parse(read(`node_modules/${name}/package.json`));
      return `${name} ${version} (${license})\n\n${read(`node_modules/${name}/LICENSE`).trim()}\n`;
    })
    .join('\n\n');

/** @param {string} entry */
export async function script(entry) {
  const result = await build({
    entryPoints: [new URL(entry, here).pathname],
    bundle: true,
    minify: true,
    format: 'iife',
    target: 'es2022',
    legalComments: 'none',
    charset: 'ascii',
    write: false,
    absWorkingDir: here.pathname,
  });
  return result.outputFiles[0].text.trim();
}

/** @param {string[]} names of src/styles */
export async function style(names) {
  const text = [read('node_modules/uplot/dist/uPlot.min.css'), ...names.map((name) => read(`src/styles/${name}.css`))].join('\n');
  const result = await build({ stdin: { contents: text, loader: 'css' }, minify: true, write: false });
  return result.outputFiles[0].text.trim();
}

/** A page with its parts in place; names that are no part stay. @param {string} path @param {Record<string, string>} parts */
export const filled = (path, parts) => read(path).replace(/@([A-Z_]+)@/g, (word, name) => parts[name] ?? word);
