/** Numbers as people read them: mm, deg, µm/N, … @type {Object<string, [number, string]>} */
const shownUnits = {
  m: [1e3, 'mm'],
  rad: [180 / Math.PI, 'deg'],
  'rad/(N·m)': [1e6, 'µrad/(N·m)'],
  'm/N': [1e6, 'µm/N'],
  'N/m': [1e-3, 'N/mm'],
  'N·m/rad': [1e-3, 'kN·m/rad'],
  1: [1, ''],
};

export const missing = '–';

/** @param {number|null|undefined} value @param {number} digits significant */
export function number(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return missing;
  const text = value === 0 ? '0' : String(Number(value.toPrecision(digits)));
  return text
    .replace(/-/g, '−')
    .replace(/e([−+]?)(\d+)/, ' · 10^$1$2')
    .replace('^+', '^');
}

/** @param {number} value @param {number} decimals */
export const fixed = (value, decimals) =>
  value
    .toFixed(decimals)
    .replace(/^-(?=0(\.0*)?$)/, '')
    .replace('-', '−');

/** @param {string} unit SI @returns {{factor: number, name: string}} */
export function shownUnit(unit) {
  const [factor, name] = shownUnits[unit] ?? [1, unit];
  return { factor, name };
}

/** @param {number|null|undefined} value SI @param {string} unit SI @param {number} digits */
export function quantity(value, unit, digits = 4) {
  const { factor, name } = shownUnit(unit);
  if (value === null || value === undefined || !Number.isFinite(value)) return missing;
  return number(value * factor, digits) + (name ? ` ${name}` : '');
}

/** A coordinate of the robot: mm and deg with three decimals. @param {number} value SI @param {string} unit */
export function coordinate(value, unit) {
  const { factor, name } = shownUnit(unit);
  return unit === 'm' || unit === 'rad' ? `${fixed(value * factor, 3)} ${name}` : quantity(value, unit, 6);
}

/** Rounded down: what is proved must not read as more. @param {number|null} share @param {number} decimals */
export const percentDown = (share, decimals = 2) =>
  share === null || !Number.isFinite(share) ? missing : `${(Math.floor(share * 10 ** (decimals + 2)) / 10 ** decimals).toFixed(decimals)} %`;

/** @param {number|null} share @param {number} decimals */
export const percent = (share, decimals = 1) =>
  share === null || !Number.isFinite(share) ? missing : `${fixed(100 * share, decimals)} %`;

/** @param {number} seconds */
export function duration(seconds) {
  if (seconds < 120) return `${fixed(seconds, 1)} s`;
  if (seconds < 7200) return `${fixed(seconds / 60, 1)} min`;
  return `${fixed(seconds / 3600, 1)} h`;
}

/** @param {number} count @param {string} one @param {string} many */
export const plural = (count, one, many = `${one}s`) => `${count.toLocaleString('en')} ${count === 1 ? one : many}`;

/** @param {string[]} words "a, b and c" @param {number} most the rest is counted */
export function list(words, most = 6) {
  const shown = words.length > most + 1 ? [...words.slice(0, most), `${words.length - most} more`] : [...words];
  const last = shown.pop() ?? '';
  return shown.length > 0 ? `${shown.join(', ')} and ${last}` : last;
}
