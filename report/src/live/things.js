import { isMap, isSeq } from 'yaml';
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
 * @property {import('./yaml_edit.js').Path} [entry] in the list of obstacles
 * @property {{path: import('./yaml_edit.js').Path, values: number[]}} [size] of a box
 */

/** @param {any} value */
const point = (value) => (Array.isArray(value) && value.length === 3 ? value.map(metres) : undefined);
const obstacles = ['workspace', 'collision', 'obstacles'];

/** @returns {Thing[]} */
function stations(document) {
  const path = ['measurement', 'device', 'stations'];
  const found = document.getIn(path);
  if (!isMap(found)) return [];
  return Object.entries(found.toJSON()).map(([name, value]) => {
    const own = Array.isArray(value) ? [...path, name] : [...path, name, 'position'];
    return { key: `station ${name}`, label: `Tracker or station ${name}`, step: 'instrument', path: own, position: point(Array.isArray(value) ? value : value?.position), station: name };
  });
}

/** The one of camera and board that stands still. @returns {Thing[]} */
function cameraThings(document) {
  const measurement = document.toJS().measurement ?? {};
  if (measurement.type !== 'camera') return [];
  const name = measurement.mount === 'fixed' ? 'camera' : 'board';
  const path = ['measurement', name, 'position'];
  return [{ key: name, label: name === 'camera' ? 'Camera' : 'Board', step: 'instrument', path, position: point(measurement[name]?.position) }];
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
  return [...stations(document), ...cameraThings(document), ...bodies(document)].filter((t) => t.position?.every(Number.isFinite));
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
