import { h, section, table } from '../dom.js';
import { number, percent, percentDown, plural, quantity } from '../text/units.js';
import * as say from '../text/sentences.js';

/** @param {any} plan */
export function certificateSection(plan) {
  const { candidates: c, workspace: w } = plan.certificate;
  const facts = [];
  if (c) {
    facts.push(
      ['at least this share of the best', percentDown(c.efficiency)],
      ['bound that no plan of these candidates exceeds', number(c.bound, 8)],
      [
        'candidates',
        c.count.toLocaleString('en') + (c.found > 0 ? `, ${c.found} of them found by searches beyond those drawn` : ''),
      ],
      ['largest sensitivity at the bound (1: there is no tighter one)', number(c.max_sensitivity_ratio, 8)],
    );
    if (say.isDeterminant(plan)) facts.push(['log det of the plan, in SI units', number(plan.criterion.log_det, 8)]);
  }
  const space = w
    ? [
        w.proved
          ? ['at least this share of the best', percentDown(w.efficiency, 1)]
          : ['share of the best, as far as the search saw', say.isSettled(w) ? say.searchedShare(w) : 'not settled'],
        ['bound', number(w.bound, 8)],
        [`largest sensitivity ${w.proved ? 'that is possible' : 'found'}`, number(w.max_sensitivity_ratio, 6)],
        ['method', w.method],
        ...(w.limits?.length > 0 ? [['counted beside the limits of axes', w.limits.join(', ')]] : []),
        ...(w.proved ? [] : [['no proof because of', w.why_not_proved ?? 'an older program']]),
      ]
    : [];
  return section(
    'certificate',
    'How near the best plan this is',
    null,
    h(
      'div',
      { class: 'split' },
      h(
        'div',
        {},
        h('h3', {}, 'Proved, over the candidates'),
        h('p', {}, `${say.proof(plan)} ${say.proofMeaning(plan)}`),
        facts.length > 0 ? list(facts) : null,
      ),
      h(
        'div',
        {},
        h('h3', {}, w?.proved ? 'Proved, over the whole workspace' : 'Searched, over the whole workspace'),
        h('p', {}, w ? say.searched(plan) : 'Nothing is claimed about poses between the candidates.'),
        space.length > 0 ? list(space) : null,
      ),
    ),
    variants(plan),
    indices(plan),
  );
}

/** @param {[string, string][]} facts */
const list = (facts) =>
  h(
    'dl',
    { class: 'facts' },
    facts.map(([title, value]) => h('div', {}, h('dt', {}, title), h('dd', {}, value))),
  );

/** @param {any} plan */
function variants(plan) {
  if (!plan.variants?.length) return null;
  return h(
    'div',
    {},
    h('h3', {}, 'Each variant'),
    table(
      ['variant', '#weight', '#log det', '#bound', '#efficiency'],
      plan.variants.map((v) => [
        v.name,
        number(v.weight),
        number(v.log_det, 7),
        number(v.log_det_bound, 7),
        percentDown(v.efficiency),
      ]),
      'Variants',
    ),
  );
}

/** @param {any} plan */
function indices(plan) {
  const { indices: o, scaling, name } = plan.criterion;
  const rows = [
    ['O1', o.o1, 'geometric mean of all singular values, per pose: overall information'],
    ['O2', o.o2, 'smallest over largest singular value: balance (1 is best)'],
    ['O3', o.o3, 'smallest singular value: the worst-known combination'],
    ['O4', o.o4, 'noise amplification: smallest squared over largest'],
    ['O5', o.o5, 'one over the sum of reciprocals: mean error'],
  ];
  return h(
    'details',
    {},
    h('summary', {}, 'Observability indices'),
    h(
      'p',
      { class: 'note' },
      `Larger is better. ${scaling === 'none' ? 'Columns are not scaled.' : `Columns are scaled by ${scaling}.`} The plan was made for criterion ${name}.`,
    ),
    table(
      ['index', '#value', 'meaning'],
      rows.map(([title, value, meaning]) => [title, number(value), meaning]),
      'Observability indices',
    ),
  );
}

/** @param {number} part */
const share = (part) => (part > 0 && part < 5e-4 ? '< 0.1 %' : percent(part));

/** @param {any} plan */
export function searchSection(plan) {
  const s = plan.statistics;
  const rejected = Object.entries(s.rejected ?? {}).sort((a, b) => b[1] - a[1]);
  const listed = s.candidates_from;
  const facts = [
    [listed ? 'different candidates listed' : 'candidates drawn', s.candidates_drawn.toLocaleString('en')],
    [
      'of these feasible',
      `${s.candidates_feasible.toLocaleString('en')} (${percent(s.candidates_feasible / s.candidates_drawn)})`,
    ],
    ['method', plan.method],
    ['starts', String(s.restarts)],
    ['exchanges of poses', s.exchanges.toLocaleString('en')],
    ['time', `${number(s.seconds, 3)} s`],
  ];
  if (s.poses_on_boundary !== undefined)
    facts.push(['poses on the boundary of what is feasible', percent(s.poses_on_boundary, 0)]);
  if (s.coordinates_on_limits !== undefined)
    facts.push(['their coordinates on a limit', percent(s.coordinates_on_limits, 0)]);
  return section(
    'search',
    'Candidates and search',
    `Poses are chosen from ${listed ? `the candidates in ${listed}` : 'candidates drawn at random in the workspace'}. Where many are lost to one cause, moving that thing gains room.`,
    h(
      'div',
      { class: 'split' },
      h(
        'div',
        {},
        h('h3', {}, 'Where candidates were lost'),
        rejected.length === 0
          ? h('p', {}, 'None was rejected.')
          : table(
              ['rejected because', listed ? '#candidates' : '#draws', '#share'],
              rejected.map(([reason, count]) => [
                reason,
                count.toLocaleString('en'),
                share(count / s.candidates_drawn),
              ]),
              'Rejected candidates',
            ),
        cell(s.cell),
      ),
      h('div', {}, h('h3', {}, 'Search'), list(facts), stages(s.stages)),
    ),
  );
}

/** @param {any} cell */
function cell(cell) {
  if (!cell) return null;
  const notes = [
    cell.always_touching?.length > 0 &&
      `Not checked for collision, because they touch in every configuration: ${cell.always_touching.join(', ')}.`,
    cell.reduced_clearances?.length > 0 &&
      `Near by design, with a part of the clearance asked for: ${cell.reduced_clearances
        .map((pair) => `${pair.between.join(' and ')} (${quantity(pair.clearance, 'm')})`)
        .join(', ')}.`,
    cell.uncalibrated_margin > 0 &&
      `Until the robot is calibrated, clearances are up to ${quantity(cell.uncalibrated_margin, 'm')} wider.`,
  ].filter(Boolean);
  return notes.map((text) => h('p', { class: 'note' }, text));
}

/** @param {any[]|undefined} stages */
function stages(stages) {
  if (!stages?.length) return null;
  return h(
    'div',
    {},
    h('h4', {}, plural(stages.length, 'stage')),
    table(
      ['stage', '#value', '#of the bound', '#time'],
      stages.map((s) => [
        s.name,
        number(s.value, 7),
        s.efficiency === null ? '–' : percent(s.efficiency, 2),
        `${number(s.seconds, 3)} s`,
      ]),
      'Stages of the search',
    ),
  );
}
