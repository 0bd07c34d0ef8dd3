import { isMap, isSeq, parseDocument } from 'yaml';

/** @typedef {(string|number)[]} Path */

/** The text as a document; undefined where it is no YAML. @param {string} text */
export function documentOf(text) {
  const document = parseDocument(text, { keepSourceTokens: false });
  return document.errors.length === 0 && isMap(document.contents) ? document : undefined;
}

/** A value in flow style. @param {any} value */
export function flow(value) {
  if (Array.isArray(value)) return `[${value.map(flow).join(', ')}]`;
  if (value && typeof value === 'object') return `{${Object.entries(value).map(([key, v]) => `${key}: ${flow(v)}`).join(', ')}}`;
  return typeof value === 'string' && !/^[A-Za-z_][\w.-]*$/.test(value) ? JSON.stringify(value) : String(value);
}

/**
 * The text with another value at a path. Only the value's own characters change, so that comments, order and layout stay.
 * @param {string} text @param {Path} path @param {any} value @returns {string}
 */
export function withValue(text, path, value) {
  const document = documentOf(text);
  if (!document) return text;
  const node = document.getIn(path, true);
  if (node?.range) return replaced(text, node.range[0], node.range[1], flow(value));
  const parent = path.length > 1 ? document.getIn(path.slice(0, -1), true) : document.contents;
  if (isMap(parent)) return withKey(text, parent, path.at(-1), value);
  if (path.length < 2) return text;
  return withValue(text, path.slice(0, -1), { [path.at(-1)]: value });
}

/** The text with one more entry at the end of a list, which is made where it is missing. @param {string} text @param {Path} path @param {any} value */
export function withEntry(text, path, value) {
  const list = documentOf(text)?.getIn(path, true);
  if (!isSeq(list)) return withValue(text, path, [value]);
  if (list.flow) {
    const end = list.range[1] - 1;
    return replaced(text, end, end, `${list.items.length > 0 ? ', ' : ''}${flow(value)}`);
  }
  const last = list.items.at(-1);
  const end = endOfLine(text, last.range[1]);
  return replaced(text, end, end, `\n${indent(text, last.range[0] - 2)}- ${flow(value)}`);
}

/** The text without an entry of a list. @param {string} text @param {Path} path */
export function withoutEntry(text, path) {
  const document = documentOf(text);
  const list = document?.getIn(path.slice(0, -1), true);
  const node = document?.getIn(path, true);
  if (!isSeq(list) || !node) return text;
  if (list.flow || list.items.length === 1) {
    const kept = list.items.filter((item) => item !== node).map((item) => text.slice(item.range[0], item.range[1]));
    return replaced(text, list.range[0], list.items.at(-1).range[1] + (list.flow ? 1 : 0), `[${kept.join(', ')}]`);
  }
  const from = text.lastIndexOf('\n', node.range[0]) + 1;
  return replaced(text, from, endOfLine(text, node.range[1]) + 1, '');
}

function withKey(text, map, key, value) {
  const last = map.items.at(-1);
  if (map.flow || !last) {
    const end = map.range[1] - 1;
    return replaced(text, end, end, `${last ? ', ' : ''}${key}: ${flow(value)}`);
  }
  const end = endOfLine(text, (last.value ?? last.key).range[1]);
  return replaced(text, end, end, `\n${indent(text, last.key.range[0])}${key}: ${flow(value)}`);
}

const replaced = (text, from, to, by) => text.slice(0, from) + by + text.slice(to);

/** @param {string} text @param {number} at */
function endOfLine(text, at) {
  // The range of a block ends behind its last line break.
  const from = text[at - 1] === '\n' ? at - 1 : at;
  const end = text.indexOf('\n', from);
  return end < 0 ? text.length : end;
}

/** Blanks that put something in the column of a place. @param {string} text @param {number} at */
const indent = (text, at) => ' '.repeat(at - text.lastIndexOf('\n', at - 1) - 1);

const unitSizes = { mm: 1e-3, m: 1, um: 1e-6, 'µm': 1e-6, cm: 1e-2, in: 0.0254, inch: 0.0254 };

/** A length as the file has it, m; NaN: it cannot be read here. @param {any} value */
export function metres(value) {
  if (typeof value === 'number') return value;
  const [, amount, unit] = String(value).match(/^\s*([-+.\deE]+)\s*([a-zµ]*)\s*$/) ?? [];
  return amount === undefined ? NaN : Number(amount) * (unit ? (unitSizes[unit] ?? NaN) : 1);
}

/** A length as a file should have it. @param {number} value m */
export function written(value) {
  const mm = Math.round(value * 1e4) / 10;
  if (mm === 0) return 0;
  return Math.abs(mm) < 1000 ? `${mm} mm` : Math.round(value * 1e4) / 1e4;
}
