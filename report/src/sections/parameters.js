import { h, section } from '../dom.js';
import { sigmaOf } from '../text/sentences.js';
import { number, quantity } from '../text/units.js';

const keyOf = (variant, name) => `${variant ?? ''}\n${name}`;

/** @typedef {{name: string, variant: string, role: string, nominal: number, tolerance: number, unit: string, sigma: number|null, changed: boolean}} Row */

/** @param {import('../pose_list.js').PoseList} list @returns {Row[]} σ from the list where it is known, else from the plan */
function rowsOf(list) {
  const live = new Map();
  list.report.columns.forEach((column, j) =>
    live.set(keyOf(column.variant, column.name), list.figures.identifiable ? list.figures.sigma[j] : null),
  );
  return list.report.plan.parameters
    .filter((p) => p.identifiable)
    .map((p) => {
      const key = live.has(keyOf(p.variant, p.name)) ? keyOf(p.variant, p.name) : keyOf('', p.name);
      const follows = list.changed && live.has(key);
      return { ...p, variant: p.variant ?? '', sigma: follows ? live.get(key) : p.sigma, changed: follows };
    });
}

const ratio = (row) => (row.sigma === null ? Infinity : row.sigma / row.tolerance);

/** @type {[string, string, (row: Row) => any][]} */
const orders = [
  ['Parameter', 'name', (r) => r.name],
  ['Role', 'role', (r) => r.role],
  ['Nominal', 'nominal', (r) => Math.abs(r.nominal)],
  ['Tolerance', 'tolerance', (r) => r.tolerance],
  ['Predicted σ', 'sigma', (r) => r.sigma ?? Infinity],
  ['σ / tolerance', 'ratio', ratio],
];

/** @param {Row} row */
function bar(row) {
  const share = ratio(row);
  const full = h('span', { class: `fill ${share >= 1 ? 'over' : ''}` });
  full.style.width = `${Math.min(100, 100 * share)}%`;
  return h(
    'span',
    { class: 'ratio' },
    h('span', { class: 'bar', 'aria-hidden': 'true' }, full),
    h('span', { class: 'ratio-value' }, row.sigma === null ? 'lost' : number(share, 3)),
  );
}

/** @param {Row} row */
const line = (row) =>
  h(
    'tr',
    { class: row.role },
    h('th', { scope: 'row' }, row.variant ? `${row.variant}: ${row.name}` : row.name),
    h(
      'td',
      { class: 'role' },
      row.role === 'nuisance' ? 'nuisance' : ratio(row) >= 1 ? 'not worth identifying' : 'interest',
    ),
    h('td', { class: 'number nominal' }, quantity(row.nominal, row.unit)),
    h('td', { class: 'number tolerance' }, quantity(row.tolerance, row.unit)),
    h('td', { class: `number sigma ${row.changed ? 'live' : ''}` }, quantity(row.sigma, row.unit)),
    h('td', {}, bar(row)),
  );

/** @param {import('../pose_list.js').PoseList} list */
export function parametersSection(list) {
  let sorted = { by: 'plan', down: false };
  const body = h('tbody');
  const heads = orders.map(([title, by]) =>
    h(
      'th',
      { scope: 'col', class: `${by === 'name' || by === 'role' || by === 'ratio' ? '' : 'number'} ${by}` },
      h(
        'button',
        {
          class: 'sort bare',
          onclick: () => {
            sorted = { by, down: sorted.by === by ? !sorted.down : by === 'ratio' || by === 'sigma' };
            fill();
          },
        },
        title,
      ),
    ),
  );
  const state = h('p', { class: 'note', 'aria-live': 'polite' });
  const fill = () => {
    const order = orders.find(([, by]) => by === sorted.by)?.[2];
    const rows = rowsOf(list);
    if (order) rows.sort((a, b) => (order(a) < order(b) ? -1 : order(a) > order(b) ? 1 : 0) * (sorted.down ? -1 : 1));
    body.replaceChildren(...rows.map(line));
    heads.forEach((head, k) => {
      if (orders[k][1] === sorted.by) head.setAttribute('aria-sort', sorted.down ? 'descending' : 'ascending');
      else head.removeAttribute('aria-sort');
    });
    state.textContent = list.changed ? `σ of your list of ${list.ids.length} poses, not of the plan.` : '';
  };
  list.addEventListener('list', fill);
  fill();
  return section(
    'parameters',
    'Parameters and how well they will be known',
    `${sigmaOf(list.report.plan)}; tolerance is how far it may be off before calibration (1σ). A full bar means that measuring tells no more than the tolerance did.`,
    h(
      'div',
      { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': 'Parameters' },
      h('table', { class: 'parameters' }, h('thead', {}, h('tr', {}, heads)), body),
    ),
    state,
    droppedList(list.report.plan),
  );
}

/** @param {any} plan */
function droppedList(plan) {
  const dropped = plan.parameters.filter((p) => !p.identifiable);
  if (dropped.length === 0) return null;
  return h(
    'details',
    { class: 'printed', open: dropped.length <= 8 },
    h('summary', {}, `Left out: ${dropped.length} that cannot be identified separately`),
    h(
      'p',
      { class: 'note' },
      'A change of the parameter on the left has the same effect on every measurement as changes of those on the right; the robot is described as well without it.',
    ),
    h(
      'ul',
      { class: 'equations' },
      dropped.map((p) => h('li', {}, p.dropped_because ?? p.name)),
    ),
  );
}
