/** Colours of the page for what is drawn rather than styled. They change with the system's theme and for print. */
const listeners = new Set();

/** @param {string} name of a custom property without dashes */
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** @param {() => void} listener called when colours have changed */
export function onTheme(listener) {
  listeners.add(listener);
}

const changed = () => listeners.forEach((listener) => listener());

export function watchTheme() {
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', changed);
  addEventListener('beforeprint', () => {
    document.documentElement.dataset.theme = 'light';
    for (const details of document.querySelectorAll('details.printed')) details.open = true;
    changed();
  });
  addEventListener('afterprint', () => {
    delete document.documentElement.dataset.theme;
    changed();
  });
}

/** Viridis at five places. */
const viridis = [
  [68, 1, 84],
  [59, 82, 139],
  [33, 145, 140],
  [94, 201, 98],
  [253, 231, 37],
];

/** @param {number} share 0 to 1 @returns {[number, number, number]} 0 to 255 */
export function viridisAt(share) {
  const x = Math.min(1, Math.max(0, share)) * (viridis.length - 1);
  const k = Math.min(viridis.length - 2, Math.floor(x));
  return /** @type {any} */ (viridis[k].map((v, c) => v + (x - k) * (viridis[k + 1][c] - v)));
}
