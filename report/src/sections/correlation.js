import { h, section, table } from '../dom.js';
import { correlation } from '../numerics/packed.js';
import { fixed } from '../text/units.js';
import { heatMap } from '../plots/heat_map.js';

/** @param {import('../pose_list.js').PoseList} list */
export function correlationSection(list) {
  const { columns } = list.report;
  const map = heatMap();
  const strongest = h('div');
  const readout = h('p', { class: 'note readout', 'aria-live': 'polite' });
  const all = h('input', { type: 'checkbox', onchange: () => fill() });
  const hasNuisance = list.engine.nuisance > 0;
  map.onPoint = (text) => (readout.textContent = text);
  const fill = () => {
    const first = all.checked ? 0 : list.engine.nuisance;
    const names = columns.slice(first).map((c) => c.name);
    const { covariance } = list.figures;
    readout.textContent = covariance
      ? 'Point at a cell, or walk with the arrow keys, to see the pair.'
      : 'Not identifiable: there are no correlations to show.';
    const value = (i, j) => (covariance ? correlation(covariance, first + i, first + j) : 0);
    map.draw(names, value);
    strongest.replaceChildren(
      table(
        ['parameters', '', '#correlation'],
        covariance ? strongestPairs(names, value).map((p) => [p.a, p.b, fixed(p.value, 4)]) : [],
        'Strongest pairs',
      ),
    );
  };
  list.addEventListener('list', fill);
  fill();
  return section(
    'correlation',
    'Which parameters are hard to tell apart',
    'Correlation of the errors that calibration will leave in two parameters. Near +1 or −1 the poses hardly tell the two apart: their errors come together, although their joint effect may be known well. Near 0 they are independent.',
    hasNuisance ? h('label', {}, all, ' with the nuisance parameters (base, targets)') : null,
    h(
      'div',
      { class: 'split' },
      h('div', {}, map.element, readout),
      h('div', {}, h('h3', {}, 'Strongest pairs'), strongest),
    ),
  );
}

/** @param {string[]} names @param {(i: number, j: number) => number} value */
function strongestPairs(names, value) {
  const pairs = [];
  for (let i = 0; i < names.length; ++i)
    for (let j = 0; j < i; ++j) pairs.push({ a: names[i], b: names[j], value: value(i, j) });
  return pairs.sort((p, q) => Math.abs(q.value) - Math.abs(p.value)).slice(0, 12);
}
