/**
 * Residuals of one pose, in the order of the readings, as errors that people speak of: distances of targets, what a pose
 * is turned by, pixels; whatever has no such meaning stays as it is read.
 *
 * @typedef {{key: string, title: string, unit: string, of: (residuals: (number|null)[]) => number|null}} Measure
 *   root mean square over the pose; null where nothing was read
 * @typedef {{key: string, unit: string, at: number[]}} Axis places among the readings that err along it
 */

const ends = { m: ['x', 'y', 'z'], rad: ['rx', 'ry', 'rz'], px: ['u', 'v'] };
const titles = { m: 'distance of a target', rad: 'turned by', px: 'distance in the picture' };

/** Readings that are one vector, by the unit and what they are called before the last dot.
 * @param {{name: string, unit: string}[]} readings @returns {Map<string, number[][]>} unit → places of each vector */
function vectors(readings) {
  const found = new Map();
  for (const [unit, axes] of Object.entries(ends)) {
    const byName = new Map();
    readings.forEach(({ name, unit: own }, k) => {
      const dot = name.lastIndexOf('.');
      const axis = axes.indexOf(name.slice(dot + 1));
      if (own !== unit || dot < 0 || axis < 0) return;
      const places = byName.get(name.slice(0, dot)) ?? [];
      places[axis] = k;
      byName.set(name.slice(0, dot), places);
    });
    const whole = [...byName.values()].filter((places) => axes.every((_, a) => places[a] !== undefined));
    if (whole.length > 0) found.set(unit, whole);
  }
  return found;
}

/** @param {(number|null)[]} values @returns {number|null} */
const norm = (values) => (values.some((v) => v === null) ? null : Math.hypot(.../** @type {number[]} */ (values)));

/** @param {(number|null)[]} values of those that are there @returns {number|null} */
export function rootMeanSquare(values) {
  const read = values.filter((v) => v !== null);
  return read.length === 0 ? null : Math.hypot(...read) / Math.sqrt(read.length);
}

/** @param {{name: string, unit: string}[]} readings @returns {Measure[]} */
export function measuresOf(readings) {
  const taken = new Set();
  const measures = [];
  for (const [unit, places] of vectors(readings)) {
    places.flat().forEach((k) => taken.add(k));
    measures.push({
      key: unit,
      title: titles[unit],
      unit,
      of: (residuals) => rootMeanSquare(places.map((vector) => norm(vector.map((k) => residuals[k])))),
    });
  }
  for (const unit of new Set(readings.filter((_, k) => !taken.has(k)).map((r) => r.unit))) {
    const places = readings.flatMap((r, k) => (r.unit === unit && !taken.has(k) ? [k] : []));
    measures.push({
      key: `other-${unit}`,
      title: 'readings',
      unit,
      of: (residuals) => rootMeanSquare(places.map((k) => residuals[k])),
    });
  }
  return measures;
}

/** What readings err along: x of every target, u of every point, what stands alone by itself.
 * @param {{name: string, unit: string}[]} readings @returns {Axis[]} */
export function axesOf(readings) {
  const axes = new Map();
  readings.forEach(({ name, unit }, k) => {
    const end = name.slice(name.lastIndexOf('.') + 1);
    const key = (ends[unit] ?? []).includes(end) && name.includes('.') ? end : 'all readings';
    const id = `${key} ${unit}`;
    if (!axes.has(id)) axes.set(id, { key, unit, at: [] });
    axes.get(id).at.push(k);
  });
  return [...axes.values()];
}
