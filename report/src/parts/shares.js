import { h } from '../dom.js';
import { viridisAt } from '../theme.js';

/** Black or white, whichever is read on it (WCAG 2.1, relative luminance). @param {number[]} rgb */
export function inkOn(rgb) {
  const [r, g, b] = rgb.map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.179 ? '#10151c' : '#ffffff';
}

/**
 * A table of figures whose cells are coloured from the worst to the best.
 * @param {string[]} columns @param {string[]} rows @param {(row: number, column: number) => {text: string, share: number|null, hint?: string}} cell
 * @param {string} corner @param {string} label
 */
export function shareTable(columns, rows, cell, corner, label) {
  const td = (r, c) => {
    const { text, share, hint } = cell(r, c);
    const element = h('td', { title: hint }, text);
    if (share !== null) {
      const rgb = viridisAt(share);
      element.style.background = `rgb(${rgb.map(Math.round).join(' ')})`;
      element.style.color = inkOn(rgb);
    }
    return element;
  };
  return h(
    'div',
    { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': label },
    h(
      'table',
      { class: 'shares' },
      h(
        'thead',
        {},
        h(
          'tr',
          {},
          h('th', { scope: 'col' }, corner),
          columns.map((name) => h('th', { scope: 'col', class: 'number' }, name)),
        ),
      ),
      h(
        'tbody',
        {},
        rows.map((name, r) =>
          h(
            'tr',
            {},
            h('th', { scope: 'row' }, name),
            columns.map((_, c) => td(r, c)),
          ),
        ),
      ),
    ),
  );
}
