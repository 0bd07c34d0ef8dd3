import { curve, dots, figure, level, logGrid, logValues } from './figure.js';
import { h } from '../dom.js';
import { number, quantity } from '../text/units.js';

const mm = (value) => (value === null || value === undefined ? null : value * 1e3);

/** Predicted position error at each test pose. @param {import('../pose_list.js').PoseList} list */
export function testPosePlot(list) {
  const planned = list.report.plan.accuracy.test_poses.map(mm);
  const x = planned.map((_, k) => k + 1);
  const data = () => [
    x,
    planned,
    list.changed && list.figures.testErrors?.length === x.length ? list.figures.testErrors.map(mm) : x.map(() => null),
    x.map(() => mm(list.report.plan.accuracy.rho0)),
  ];
  const plot = figure({
    id: 'plot-test-poses',
    title: 'Position error at the test poses',
    caption:
      'Each dot is how far off (1σ) the tip is expected to be at one test pose after calibration; the dashed line is the root mean square of all.',
    options: {
      series: [
        { label: 'test pose' },
        dots('plan, mm', 'plan'),
        { ...dots('your list, mm', 'yours', 5), show: false, optional: true },
        level('plan, root mean square, mm', 'ink-soft'),
      ],
      scales: {
        x: { time: false, range: (u, low, high) => [low - 0.5, high + 0.5] },
        y: { range: (u, low, high) => [0, 1.1 * high] },
      },
      axes: [
        { label: 'test pose', incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500] },
        { label: 'error, mm', size: 62 },
      ],
    },
    data: data(),
    numbers: () => ({
      header: ['test pose', '#plan, mm', '#your list, mm'],
      rows: data()[0].map((k, i) => [k, number(data()[1][i]), number(data()[2][i])]),
    }),
  });
  list.addEventListener('list', () => plot.setData(data()));
  return plot.element;
}

/** Position error over the size of an effect that the model lacks. @param {any} expected expected_error of plan.json */
export function expectedPlot(expected) {
  const { by_noise: byNoise, noise, places, at, amplification } = expected;
  const squared = 3 * (amplification * noise) ** 2;
  const error = (t) => mm(Math.sqrt(byNoise ** 2 + squared * t * t));
  const given = new Map([[0, byNoise], ...expected.with.map((w) => [w.times, w.error])]);
  const most = Math.max(1, ...given.keys());
  const steps = 40;
  const even = Array.from({ length: steps + 1 }, (_, k) => (most * k) / steps);
  const x = [...new Set([...even, ...given.keys()])].sort((a, b) => a - b);
  const plot = figure({
    id: 'plot-expected',
    title: 'If the model is not complete',
    caption:
      `Every model lacks something. The line shows the position error to expect at ${places} ${at} if a smooth ` +
      `effect that no parameter describes moves the tip: by so many times ${number(mm(noise))} mm, the noise of one pose. ` +
      'Where it rises steeply, the accuracy relies on the model being complete.',
    options: {
      series: [{ label: 'times the noise' }, curve('position error, mm', 'plan'), dots('as stated in the plan, mm', 'accent')],
      scales: { x: { time: false }, y: { range: (u, low, high) => [0, 1.1 * high] } },
      axes: [
        { label: 'effect, times the noise of one pose', incrs: [0.5, 1, 2, 5, 10] },
        { label: 'position error, mm', size: 62 },
      ],
    },
    data: [x, x.map(error), x.map((t) => mm(given.get(t)))],
    numbers: () => ({
      header: ['#effect, times the noise', '#position error, mm'],
      rows: [...given].map(([times, value]) => [number(times), number(mm(value))]),
    }),
  });
  return plot.element;
}

/** @type {Object<string, {title: string, axis: string, of: (p: any) => number|null, log: boolean}>} */
const quantities = {
  rho0: { title: 'position error', axis: 'position error, mm', of: (p) => mm(p.rho0), log: true },
  sigma: { title: 'largest σ/tolerance', axis: 'largest σ / tolerance', of: (p) => p.largest_sigma_ratio, log: true },
  log_det: { title: 'log det', axis: 'log det', of: (p) => p.log_det, log: false },
};

/** @param {import('../types.js').Report} report @returns {import('../types.js').CurvePoint[]} */
const prefixOf = (report) =>
  report.prefix.map((point, k) => point ?? { poses: k + 1, log_det: null, rho0: null, largest_sigma_ratio: null });

/** What fewer or more poses reach. @param {import('../pose_list.js').PoseList} list */
export function curvePlot(list) {
  const { curve: searched } = list.report;
  const prefix = prefixOf(list.report);
  const offered = Object.entries(quantities).filter(([, q]) => [...searched, ...prefix].some((p) => q.of(p) !== null));
  if (offered.length === 0) return null;
  const figures = offered.map(([key, q]) => one(list, key, q));
  const choice = h(
    'select',
    { 'aria-label': 'What is drawn', onchange: () => show(choice.value) },
    offered.map(([key, q]) => h('option', { value: key }, q.title)),
  );
  const show = (key) => figures.forEach((f, k) => (f.hidden = offered[k][0] !== key));
  show(offered[0][0]);
  return h(
    'div',
    { class: 'choice' },
    h('h3', {}, 'Number of poses and ', figures.length > 1 ? choice : offered[0][1].title),
    ...figures,
  );
}

/** @param {import('../pose_list.js').PoseList} list @param {string} key */
function one(list, key, quantity) {
  const { curve: searched } = list.report;
  const prefix = prefixOf(list.report);
  const grown = () =>
    !list.changed
      ? []
      : list.growing.map((f, k) => ({
          poses: k + 1,
          log_det: f.logDet,
          rho0: f.rho0,
          largest_sigma_ratio: f.worst?.ratio ?? null,
        }));
  const data = () => {
    const parts = [prefix, ...(searched.length > 0 ? [searched] : []), grown()];
    const x = [...new Set(parts.flat().map((p) => p.poses))].sort((a, b) => a - b);
    return [
      x,
      ...parts.map((part) => {
        const at = new Map(part.map((p) => [p.poses, quantity.of(p)]));
        return x.map((n) => at.get(n) ?? null);
      }),
    ];
  };
  const plot = figure({
    id: `plot-curve-${key}`,
    headed: false,
    title: `Number of poses and ${quantity.title}`,
    caption:
      'The line shows what is known after so many poses in measuring order, so what remains if you stop early' +
      (searched.length > 0 ? '; orange dots are the best plans found for other numbers of poses.' : '.') +
      ' It begins where all parameters can be identified.',
    options: {
      series: [
        { label: 'poses' },
        curve('measured so far', 'plan', true),
        ...(searched.length > 0 ? [dots('plans of other sizes', 'accent', 9)] : []),
        { ...curve('your list so far', 'yours', true), show: false, optional: true },
      ],
      scales: {
        x: { time: false, range: (u, low, high) => [low - 0.5, high + 0.5] },
        ...(quantity.log ? { y: { distr: 3 } } : {}),
      },
      axes: [
        { label: 'poses measured', incrs: [1, 2, 5, 10, 20, 50, 100] },
        { label: quantity.axis, size: 62, ...(quantity.log ? { values: logValues, grid: logGrid } : {}) },
      ],
    },
    data: data(),
    numbers: () => {
      const [x, ...parts] = data();
      return {
        header: ['#poses', '#measured so far', ...(searched.length > 0 ? ['#plans of other sizes'] : []), '#your list'],
        rows: x.map((n, k) => [n, ...parts.map((part) => number(part[k]))]),
      };
    },
  });
  let late;
  list.addEventListener('list', () => {
    // Growing lists cost one factorisation a pose: not while someone is still ticking.
    clearTimeout(late);
    late = setTimeout(() => plot.setData(data()), 150);
  });
  return plot.element;
}

/** The predicted position error over the share of the workspace where it is no larger (fraction of design space,
 * Zahran, Anderson-Cook and Myers 2003). @param {import('../types.js').Report} report */
export function workspacePlot(report) {
  const errors = [...(report.position_errors ?? [])].sort((a, b) => a - b);
  if (errors.length < 2) return null;
  const share = errors.map((_, k) => (100 * (k + 1)) / errors.length);
  const shown = errors.map((e) => e * 1e3);
  const at = (percent) => errors[Math.max(0, Math.ceil((percent / 100) * errors.length) - 1)];
  return figure({
    id: 'plot-workspace',
    title: 'Predicted position error over the workspace',
    caption: `At half of ${errors.length} feasible configurations, spread like the candidates, the tip is known to ${quantity(at(50), 'm', 3)} or better after calibration, at 90 % of them to ${quantity(at(90), 'm', 3)}, at the worst to ${quantity(at(100), 'm', 3)} (1σ of all three axes together, from the parameters’ errors alone).`,
    options: {
      series: [{ label: 'share, %' }, curve('position error, mm', 'plan')],
      scales: { x: { time: false, range: [0, 100] }, y: { range: (u, low, high) => [0, 1.08 * high] } },
      axes: [{ label: 'share of the configurations, %' }, { label: 'position error, mm', size: 66 }],
    },
    data: [share, shown],
    numbers: () => ({
      header: ['#share, %', '#position error, mm'],
      rows: [10, 25, 50, 75, 90, 95, 100].map((p) => [p, number(at(p) * 1e3)]),
    }),
  }).element;
}
