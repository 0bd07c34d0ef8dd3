import { h, section, table } from '../dom.js';
import { inShort, tile } from '../parts/tiles.js';
import { efficiencyOf, inCommon, whyNotComparable } from '../numerics/two_plans.js';
import { PoseList } from '../pose_list.js';
import { growingPlot, sigmaPairsPlot } from '../plots/two_plans.js';
import { shellFile } from '../sections/reproduce.js';
import { isSettled, newPoses } from '../text/sentences.js';
import { coordinate, number, percent, percentDown, plural, quantity } from '../text/units.js';
import { viewer } from '../view/viewer.js';

const letters = ['A', 'B'];
const worst = (plan) => interestOf(plan).reduce((a, b) => (b.sigma / b.tolerance > a.sigma / a.tolerance ? b : a));
const interestOf = (plan) => plan.parameters.filter((p) => p.identifiable && p.role === 'interest');

/** @param {PoseList[]} lists @param {[any, any][]} common */
function tiles(lists, common, why) {
  const [a, b] = lists.map((l) => l.report);
  const errors = [a, b].map((r) => r.plan.accuracy.rho0);
  const efficiency = why ? null : efficiencyOf(a, b);
  return [
    tile(`${newPoses(a.plan).length} and ${newPoses(b.plan).length}`, 'poses', `of A and B; ${common.length} in common`),
    efficiency === null
      ? tile('–', 'no efficiency', why || 'a plan does not determine its parameters')
      : tile(percent(efficiency), 'information of B', 'per parameter, compared with A'),
    tile(
      [a, b].map((r) => number(worst(r.plan).sigma / worst(r.plan).tolerance, 3)).join(' and '),
      'largest σ/tolerance',
      `${worst(a.plan).name} of A, ${worst(b.plan).name} of B`,
    ),
    errors.every((e) => e !== null)
      ? tile(errors.map((e) => quantity(e, 'm', 3)).join(' and '), 'position error', 'predicted, of A and B')
      : null,
  ];
}

/** Both robots, each with its poses; a pose that both have is shown in both. */
function posesSection(report, lists, common) {
  const views = lists.map((list) => viewer(list, false));
  const partner = [new Map(common.map(([p, q]) => [p.id, q.id])), new Map(common.map(([p, q]) => [q.id, p.id]))];
  lists.forEach((list, k) =>
    list.addEventListener('current', () => {
      const other = partner[k].get(list.current);
      if (other !== undefined && lists[1 - k].current !== other) views[1 - k].show(other);
    }),
  );
  return section(
    'poses',
    'Poses',
    'Every dot is the tip at one pose. A pose that both plans have is shown in both pictures at once.',
    h(
      'div',
      { class: 'beside' },
      views.map(({ element }, k) => h('div', {}, h('h3', {}, `${letters[k]}: ${report.files[k]}`), element)),
    ),
    commonTable(common),
  );
}

/** @param {[any, any][]} common */
function commonTable(common) {
  if (common.length === 0) return h('p', { class: 'note' }, 'No pose is in both plans.');
  const names = common[0][0].names;
  return h(
    'details',
    { class: 'printed common' },
    h('summary', {}, `${plural(common.length, 'pose')} in both plans`),
    table(
      ['pose of A', 'pose of B', ...names.map((n) => `#${n}`)],
      common.map(([p, q]) => [String(p.id), String(q.id), ...p.configuration.map((v, k) => coordinate(v, p.units[k]))]),
      'Poses in both plans',
    ),
  );
}

/** One row a figure. @param {import('../types.js').Report[]} reports */
function figuresTable(reports) {
  const plans = reports.map((r) => r.plan);
  const smallest = (plan) => {
    const near = plan.poses.filter((p) => p.nearest).map((p) => p.nearest.distance);
    return near.length > 0 ? quantity(Math.min(...near), 'm') : '–';
  };
  const certificate = (plan) => plan.certificate;
  const rows = [
    ['variant', (p) => p.variant],
    ['poses to measure', (p) => String(newPoses(p).length)],
    ['measured before', (p) => String(p.poses.length - newPoses(p).length)],
    ['parameters of interest', (p) => String(interestOf(p).length)],
    ['nuisance parameters', (p) => String(p.parameters.filter((q) => q.identifiable && q.role === 'nuisance').length)],
    ['criterion', (p) => p.criterion.name],
    ['log det', (p) => number(p.criterion.log_det, 8)],
    [
      'of the best among its candidates',
      (p) =>
        certificate(p).candidates
          ? `≥ ${percentDown(certificate(p).candidates.efficiency)} of ${certificate(p).candidates.count.toLocaleString('en')}`
          : 'no bound',
    ],
    [
      'of the best over the workspace',
      (p) =>
        certificate(p).workspace && isSettled(certificate(p).workspace)
          ? `${certificate(p).workspace.proved ? '≥ ' : 'about '}${percentDown(certificate(p).workspace.efficiency, 1)}`
          : '–',
    ],
    ['largest σ/tolerance', (p) => `${number(worst(p).sigma / worst(p).tolerance, 3)} (${worst(p).name})`],
    ['position error at the test poses', (p) => quantity(p.accuracy.rho0, 'm')],
    ['left if the most needed pose is lost', (p) => percentDown(Math.min(...newPoses(p).map((q) => q.efficiency_without)))],
    ['smallest clearance', smallest],
  ];
  // What each of them keeps of the best for a variant, where it was made for several.
  for (const name of new Set(plans.flatMap((p) => (p.variants ?? []).map((v) => v.name))))
    rows.push([`efficiency for variant ${name}`, (p) => percentDown(p.variants?.find((v) => v.name === name)?.efficiency ?? null)]);
  const told = rows.map(([title, of]) => [title, ...plans.map(of)]).filter(([, ...values]) => values.some((v) => v !== '–' && v !== '0'));
  return table(['figure', '#A', '#B'], told, 'Figures of both plans');
}

/** @param {import('../types.js').Report[]} reports */
function efficiencyText([a, b], why) {
  if (why)
    return `${why[0].toUpperCase()}${why.slice(1)}, so their log det cannot be compared; what each is worth to the other’s variant: posewright compare ${shellFile(a.plan.problem.file)} with both plans.`;
  const efficiency = efficiencyOf(a, b);
  return efficiency === null
    ? ''
    : `For the parameters of both, B has ${percent(efficiency, 2)} of the information per parameter that A has, and A ${percent(1 / efficiency, 2)} of that of B; over all poses of each, recomputed from their information matrices.`;
}

/** σ of what both estimate. @param {import('../types.js').Report[]} reports */
function sigmaSection([a, b]) {
  const other = new Map(b.plan.parameters.filter((p) => p.identifiable).map((p) => [p.name, p]));
  const pairs = a.plan.parameters.filter((p) => p.identifiable && other.has(p.name)).map((p) => [p, other.get(p.name)]);
  const only = (plan, names) => plan.parameters.filter((p) => p.identifiable && !names.has(p.name)).map((p) => p.name);
  const shared = new Set(pairs.map(([p]) => p.name));
  const rows = pairs.map(([p, q], k) => [
    String(k + 1),
    p.name,
    p.role === 'nuisance' ? 'nuisance' : '',
    quantity(p.tolerance, p.unit, 3),
    quantity(p.sigma, p.unit, 3),
    quantity(q.sigma, q.unit, 3),
    number(q.sigma / p.sigma, 3),
  ]);
  const alone = [a, b].map((r, k) => [letters[k], only(r.plan, shared)]).filter(([, names]) => names.length > 0);
  return section(
    'parameters',
    'σ of the parameters',
    'Predicted standard deviation; B / A below 1: plan B tells more of it.',
    h('div', { class: 'plots' }, [sigmaPairsPlot(pairs), growingPlot([a, b])].filter(Boolean)),
    table(['##', 'parameter', '', '#tolerance', '#σ of A', '#σ of B', '#B / A'], rows, 'σ of both plans'),
    alone.map(([letter, names]) => h('p', { class: 'note' }, `In ${letter} alone: ${names.join(', ')}.`)),
  );
}

/** @param {any} report @returns {import('../page.js').Page} */
export function twoPlansPage(report) {
  const lists = report.plans.map((plan) => new PoseList(plan));
  const plans = report.plans.map((r) => r.plan);
  const common = inCommon(newPoses(plans[0]), newPoses(plans[1]));
  const why = whyNotComparable(...report.plans);
  const notes = report.plans.flatMap((r, k) => (r.notes ?? []).map((note) => `${letters[k]}: ${note}`));
  return {
    kind: `Two measurement plans: A ${report.files[0]}, B ${report.files[1]}`,
    heading: report.title,
    title: `Two plans: ${report.title}`,
    sections: [
      ['In short', inShort(tiles(lists, common, why), notes)],
      ['Poses', posesSection(report, lists, common)],
      ['Figures', section('figures', 'Figures', efficiencyText(report.plans, why), figuresTable(report.plans))],
      ['Parameters', sigmaSection(report.plans)],
      [
        'Repeat',
        section(
          'reproduce',
          'Each plan alone',
          'Lists that can be ticked, moved and saved are on the page of one plan.',
          h('pre', { tabindex: '0' }, report.files.map((f) => `posewright report ${shellFile(f)}`).join('\n')),
        ),
      ],
    ],
  };
}
