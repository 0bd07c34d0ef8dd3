import { isSeq } from 'yaml';
import { documentOf, metres, withEntry, withoutEntry, withValue, written } from './yaml_edit.js';

/**
 * What stands in the cell and may be moved.
 * @typedef {object} Thing
 * @property {string} key
 * @property {string} label
 * @property {'instrument'|'cell'} step of the page
 * @property {import('./yaml_edit.js').Path} path of its position
 * @property {number[]} position m, in the frame of the file: instruments in the measurement frame, bodies in the cell's
 * @property {string} [body] drawn under this name
 * @property {string} [station] whose body it is
 * @property {string} [instrument] of several: whose station it is
 * @property {import('./yaml_edit.js').Path} [entry] in the list of obstacles
 * @property {{path: import('./yaml_edit.js').Path, values: number[]}} [size] of a box
 */

/** @param {any} value */
const point = (value) => (Array.isArray(value) && value.length === 3 ? value.map(metres) : undefined);
const obstacles = ['workspace', 'collision', 'obstacles'];

/** Each instrument with its path; `name` is empty where there is one alone. */
function instruments(document) {
  const { measurement } = document.toJS();
  return Array.isArray(measurement)
    ? measurement.map((own, k) => ({ own: own ?? {}, path: ['measurement', k], name: own?.name ?? `instrument ${k + 1}` }))
    : [{ own: measurement ?? {}, path: ['measurement'], name: '' }];
}

const named = (instrument, text) => (instrument ? `${instrument}, ${text}` : text);

/** @returns {Thing[]} */
function stations({ own, path: root, name: instrument }) {
  const path = [...root, 'device', 'stations'];
  const found = own.device?.stations;
  if (!found || typeof found !== 'object' || Array.isArray(found)) return [];
  return Object.entries(found).map(([name, value]) => {
    const at = Array.isArray(value) ? [...path, name] : [...path, name, 'position'];
    const label = instrument ? `${instrument}, station ${name}` : `Tracker or station ${name}`;
    return { key: named(instrument, `station ${name}`), label, step: 'instrument', path: at, position: point(Array.isArray(value) ? value : value?.position), station: name, instrument };
  });
}

/** The one of camera and board that stands still; neither where the instrument rides on a tip. @returns {Thing[]} */
function cameraThings({ own, path, name: instrument }) {
  if (own.type !== 'camera' || own.in) return [];
  const name = own.mount === 'fixed' ? 'camera' : 'board';
  return [{ key: named(instrument, name), label: named(instrument, name === 'camera' ? 'Camera' : 'Board'), step: 'instrument', path: [...path, name, 'position'], position: point(own[name]?.position) }];
}

/** @returns {Thing[]} */
function bodies(document) {
  const list = document.getIn(obstacles);
  if (!isSeq(list)) return [];
  return list.toJSON().map((body, k) => ({
    key: `body ${k}`,
    label: body?.name ?? `body ${k + 1}`,
    step: 'cell',
    path: [...obstacles, k, 'at'],
    position: body?.at === undefined ? [0, 0, 0] : point(body.at),
    body: body?.name,
    station: body?.station,
    entry: [...obstacles, k],
    plane: body?.plane,
    size: point(body?.box) && { path: [...obstacles, k, 'box'], values: point(body.box) },
  }));
}

/** @param {string} text of the problem @returns {Thing[]} */
export function thingsOf(text) {
  const document = documentOf(text);
  if (!document) return [];
  return [...instruments(document).flatMap((one) => [...stations(one), ...cameraThings(one)]), ...bodies(document)].filter((t) => t.position?.every(Number.isFinite));
}

/** The text with a thing elsewhere; the body of a station goes with it. @param {string} text @param {Thing} thing @param {number[]} position */
export function moved(text, thing, position) {
  let result = withValue(text, thing.path, position.map(written));
  if (thing.entry || !thing.station) return result;
  const step = position.map((v, k) => v - thing.position[k]);
  for (const body of thingsOf(text).filter((t) => t.entry && t.station === thing.station))
    result = withValue(result, body.path, body.position.map((v, k) => written(v + step[k])));
  return result;
}

/** @param {string} text @param {Thing} thing @param {number[]} size of a box */
export const resized = (text, thing, size) => withValue(text, thing.size.path, size.map(written));

/** @param {string} text @param {Thing} thing */
export const removed = (text, thing) => withoutEntry(text, thing.entry);

const shapes = {
  box: { box: ['600 mm', '600 mm', '600 mm'] },
  cylinder: { cylinder: { radius: '150 mm', length: 1 } },
  floor: { plane: [0, 0, 1] },
  wall: { plane: [0, -1, 0] },
};

/** @param {string} text @param {keyof typeof shapes|'mesh'} kind @param {number[]} at @param {string} [mesh] file */
export function added(text, kind, at, mesh) {
  const names = new Set(thingsOf(text).map((t) => t.label));
  const base = mesh ? mesh.replace(/\.\w+$/, '').replace(/\W+/g, '_') : kind;
  let name = base;
  for (let k = 2; names.has(name); k++) name = `${base}_${k}`;
  const shape = mesh ? { mesh } : shapes[kind];
  return withEntry(text, obstacles, { name, ...shape, at: at.map(written) });
}
