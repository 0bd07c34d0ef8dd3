// What the page recomputes, against known answers: node --test tests/report
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import test from 'node:test';
import {
  add,
  cholesky,
  correlation,
  inverse,
  logDet,
  rowsOf,
  traceOfProduct,
} from '../../report/src/numerics/packed.js';
import { matricesOf, whitenedRows } from '../../report/src/numerics/information.js';
import { PlanFigures } from '../../report/src/numerics/plan_figures.js';
import { cameraOf } from '../../report/src/view/camera_lines.js';
import { movement } from '../../report/src/view/extent.js';
import { composed } from '../../report/src/view/kinematics.js';
import { between, exaggerated } from '../../report/src/view/interpolate.js';
import { amplification, amplified, largestDeviation } from '../../report/src/numerics/leg_points.js';
import { counts, valuesOf } from '../../report/src/numerics/stations.js';
import { posesCsv } from '../../report/src/save_csv.js';
import { leftOut } from '../../report/src/sections/calibration_tests.js';
import { commands, shell, shellFile } from '../../report/src/sections/reproduce.js';
import { instruments, proof, sigmaOf } from '../../report/src/text/sentences.js';
import { coordinate, number, percentDown, quantity } from '../../report/src/text/units.js';

const near = (value, expected, tolerance = 1e-12) =>
  assert.ok(
    Math.abs(value - expected) <= tolerance * Math.max(1, Math.abs(expected)),
    `${value}, expected ${expected}`,
  );
const packed = (rows) => Float64Array.from(rows.flatMap((row, i) => row.slice(0, i + 1)));

test('determinant, inverse and correlation of a 2 by 2 matrix', () => {
  const { factor, rank } = cholesky(packed([[4], [2, 3]]));
  assert.equal(rank, 2);
  near(logDet(factor), Math.log(8));
  near(logDet(factor, 1), Math.log(2)); // Schur complement 3 − 2·2/4
  inverse(factor).forEach((value, k) => near(value, [3 / 8, -2 / 8, 4 / 8][k]));
  near(correlation(inverse(factor), 0, 1), -2 / Math.sqrt(12));
});

test('the Hilbert matrix of order 5 has its known determinant and inverse', () => {
  const hilbert = packed(Array.from({ length: 5 }, (_, i) => Array.from({ length: 5 }, (_, j) => 1 / (i + j + 1))));
  const { factor } = cholesky(hilbert);
  near(logDet(factor), -Math.log(266716800000), 1e-10);
  const inverted = inverse(factor);
  near(inverted[0], 25, 1e-9);
  near(inverted[14], 44100, 1e-9);
  near(inverted[9], 179200, 1e-9);
  near(traceOfProduct(hilbert, inverted), 5, 1e-9);
});

test('eliminating rows gives the Schur complement of any matrix', () => {
  const rows = [[5], [1, 4], [2, -1, 6], [0.5, 1, 1, 3]];
  const whole = logDet(cholesky(packed(rows)).factor);
  const block = logDet(cholesky(packed(rows.slice(0, 2))).factor);
  near(logDet(cholesky(packed(rows)).factor, 2), whole - block);
});

test('a singular matrix says where', () => {
  assert.equal(cholesky(packed([[1], [1, 2], [2, 3, 5]])).rank, 2);
  assert.equal(cholesky(new Float64Array(6)).rank, 0);
  assert.equal(rowsOf(6), 3);
});

test('placements are composed as their turns and shifts', () => {
  const [a, b] = [0.3, -1.1];
  const turned = (angle, x) => [x, 0, 0, 0, 0, Math.sin(angle / 2), Math.cos(angle / 2)];
  const tip = composed(composed(turned(a, 0), turned(b, 1.2)), turned(0, 0.8));
  near(tip[0], 1.2 * Math.cos(a) + 0.8 * Math.cos(a + b));
  near(tip[1], 1.2 * Math.sin(a) + 0.8 * Math.sin(a + b));
  near(2 * Math.atan2(tip[5], tip[6]), a + b);
});

/** Two links, parameters Δl1, l1 Δθ1, Δl2, l2 Δθ2 of absolute angles: det M = (N² − |Σ exp(i q2)|²)². */
function twoLinks(angles) {
  const blocks = angles.map((q, k) => {
    const [c, s] = [Math.cos(q), Math.sin(q)];
    return { id: k + 1, packed: [1, 0, 1, c, s, 1, -s, c, 0, 1] };
  });
  const columns = ['l1', 't1', 'l2', 't2'].map((name) => ({
    name,
    unit: 'm',
    tolerance: 1,
    role: 'interest',
    variant: '',
  }));
  const weight = [1, 0, 1, 1, 0, 1, 0, 1, 0, 1]; // stretched arm: the tip moves by the sum of both links
  return new PlanFigures(columns, { poses: blocks, prior: null, test: [{ weight: 2, packed: weight }] });
}

test('a two-link arm has the determinant and the error of theory', () => {
  for (const degrees of [
    [0, 120, 240],
    [0, 90],
    [10, 75, 200, 310],
  ]) {
    const angles = degrees.map((d) => (d * Math.PI) / 180);
    const n = angles.length;
    const [re, im] = [Math.cos, Math.sin].map((f) => angles.reduce((sum, q) => sum + f(q), 0));
    const figures = twoLinks(angles).of(angles.map((_, k) => k + 1));
    near(figures.logDet, 2 * Math.log(n * n - re * re - im * im), 1e-10);
    near(figures.rho0 ** 2, (4 * (n - re)) / (n * n - re * re - im * im), 1e-10); // ρ0² = 4σ²(N − Re z)/(N² − |z|²) at q2 = 0
  }
});

test('too few poses are not identifiable, and the parameter is named', () => {
  const figures = twoLinks([0, 1, 2]).of([1]);
  assert.equal(figures.identifiable, false);
  assert.equal(figures.stuck, 'l2');
  assert.equal(figures.sigma, null);
});

test('measuring everything twice doubles the efficiency and halves variances; tolerances are units', () => {
  const engine = twoLinks([0.1, 1.7, 4]);
  const once = engine.of([1, 2, 3]),
    twice = engine.of([1, 2, 3, 1, 2, 3]);
  near(engine.efficiency(twice, once), 2);
  near(twice.sigma[2] ** 2, once.sigma[2] ** 2 / 2);
  const scaled = twoLinks([0.1, 1.7, 4]);
  const millimetres = new PlanFigures(
    scaled.columns.map((c) => ({ ...c, tolerance: 1e-3 })),
    { poses: [1, 2, 3].map((id) => ({ id, packed: scaled.blocks.get(id) })), prior: null, test: [] },
  ).of([1, 2, 3]);
  near(millimetres.sigma[0], 1e-3 * once.sigma[0]);
  near(millimetres.logDet, once.logDet - 8 * Math.log(1e-3)); // log det of D⁻¹ M D⁻¹
});

test('growing lists end where the whole list is', () => {
  const engine = twoLinks([0, 1, 2, 3]);
  const steps = engine.growing([4, 2, 1, 3]);
  assert.deepEqual(
    steps.map((s) => s.identifiable),
    [false, true, true, true],
  );
  near(steps[3].logDet, engine.of([1, 2, 3, 4]).logDet);
});

test('a prior makes identifiable what poses alone do not tell', () => {
  const { columns, blocks } = twoLinks([0]);
  const prior = packed([[1], [0, 1], [0, 0, 1], [0, 0, 0, 1]]);
  const figures = new PlanFigures(columns, { poses: [{ id: 1, packed: blocks.get(1) }], prior, test: [] }).of([1]);
  near(figures.logDet, 2 * Math.log(3)); // eigenvalues 1 and 3, twice
  assert.equal(figures.rho0, null);
});

test('sums are of lower triangles', () => {
  const sum = packed([[1], [2, 3]]);
  add(sum, [1, 1, 1]);
  assert.deepEqual([...sum], [2, 3, 4]);
});

test('between two keyframes a frame turns at even speed and points go straight', () => {
  const at = (angle, x) => ({
    frames: [[x, 0, 0, 0, 0, Math.sin(angle / 2), Math.cos(angle / 2)]],
    lines: [
      [
        [0, 0, 0],
        [x, 0, 0],
      ],
    ],
    tip: [x, 0, 0, 0, 0, 0, 1],
    targets: [[x, 0, 0], null],
  });
  const half = between(at(0, 0), at(Math.PI / 2, 2), 0.5);
  near(2 * Math.atan2(half.frames[0][5], half.frames[0][6]), Math.PI / 4);
  assert.deepEqual(half.lines[0][1], [1, 0, 0]);
  assert.deepEqual(half.targets, [[1, 0, 0], null]);
  const larger = exaggerated(at(0.01, 0.1), at(0, 0), 10);
  near(2 * Math.atan2(larger.frames[0][5], larger.frames[0][6]), 0.1);
  near(larger.tip[0], 1);
});

test('the saved list has the header of poses.csv, quotes names and keeps all digits', () => {
  const pose = (id, station) => ({
    id,
    names: ['x', 'rz'],
    units: ['m', 'rad'],
    configuration: [0.1 + 0.2, -1e-7],
    actuators: { 'leg.rho': 0.25 },
    load_case: null,
    station,
  });
  assert.equal(
    posesCsv([pose(7, 'A'), pose(3, 'B, "left"')], { 'leg.rho': 'm' }),
    'pose,x [m],rz [rad],leg.rho [m],station\n7,0.30000000000000004,-1e-7,0.25,A\n3,0.30000000000000004,-1e-7,0.25,"B, ""left"""\n',
  );
});

test('a place that was not looked at is none that gives no plan', () => {
  const ranking = [{ looked_at: true, phi: 3 }, { looked_at: true, why_not: 'stands inside a body' }, { looked_at: false, why_not: 'ended' }];
  assert.deepEqual(counts(ranking), { looked: 2, all: 3, planned: 1 });
  assert.deepEqual(counts([{ phi: 3 }, { why_not: 'stands inside a body' }]), { looked: 2, all: 2, planned: 1 });
});

test('places are compared by σ where the program states a ratio, else by the criterion', () => {
  const rank = { in_full: true, parameters: 5, phi: 3, feasible_share: 1, expected_error: null };
  const worse = { ...rank, phi: 3 - 10 * Math.log(2) };
  const nameOf = (ratios) => valuesOf({ criterion: 'ds', ranking: [rank, worse].map((r, k) => ({ ...r, sigma_ratio: ratios[k] })) })[0];
  assert.match(nameOf([1, 2]).name, /^σ/);
  assert.equal(nameOf([1, 2]).shown(nameOf([1, 2]).of({ ...worse, sigma_ratio: 2 })).endsWith('×'), true);
  assert.equal(nameOf([null, null]).name, 'criterion ds');
});

test('numbers are shown in mm and deg, and proofs are rounded down', () => {
  assert.equal(quantity(-0.0123456, 'm'), '−12.35 mm');
  assert.equal(quantity(Math.PI, 'rad'), '180 deg');
  assert.equal(quantity(null, 'm'), '–');
  assert.equal(coordinate(-1e-9, 'm'), '0.000 mm');
  assert.equal(percentDown(0.99999), '99.99 %');
  assert.equal(number(1.5e-9), '1.5 · 10^−9');
});

test('whatever stands in a file is one word of a shell command and no option', () => {
  const texts = ['plan.json', 'a b', "it's", '$(touch x)', '`id`', 'a;b', 'a\nb', '"', '\\', '*', '-rf', '', '~', 'ü'];
  for (const text of [...texts, 7, null]) {
    const echoed = execFileSync('sh', ['-c', `printf '%s|' ${shell(text)} end`], { encoding: 'utf8' });
    assert.equal(echoed, `${text}|end|`);
  }
  assert.equal(shellFile('-rf'), './-rf');
  assert.equal(shellFile('a b'), "'a b'");
});

test('deviations of points are amplified 1, 2 or 5 times a power of ten, the largest to a sixth of the extent at most', () => {
  const points = (change) => [
    { name: 'leg_1.a', nominal: [0, 0, 0], calibrated: [change, 0, 0] },
    { name: 'leg_2.a', nominal: [0.6, 0.1, 0], calibrated: [0.6, 0.1, 0.004] },
  ];
  // A sixth of 0.6 m is 100 mm.
  assert.equal(amplification(points(0.0999)), 1);
  assert.equal(amplification(points(-0.03)), 2);
  assert.equal(amplification(points(0.011)), 5);
  assert.equal(amplification(points(0.00009)), 1000);
  assert.equal(amplification(points(0.5)), 1);
  assert.equal(amplification(points(0)), 0);
  amplified(points(-0.03)[0], 2).forEach((value, k) => near(value, [-0.06, 0, 0][k]));
  near(largestDeviation(points(0.003)), 0.004);
});

test('a plan says what each instrument of its list gives', () => {
  const tracker = { name: 'tracker', poses: 17, share: 0.9896, efficiency_without: 0 };
  const camera = { name: 'camera', poses: 1, share: 0.0104, efficiency_without: 0.98869 };
  assert.equal(
    instruments({ instruments: [tracker, camera] }),
    'Instrument tracker reads 17 poses and gives 99.0 % of the information; without it not all parameters can be identified. ' +
      'Instrument camera reads 1 pose and gives 1.0 % of the information; without it 98.86 % would be left.',
  );
  assert.equal(instruments({}), '');
});

test('a plan says what it is compared with, and what it keeps more of than all others', () => {
  const poses = (fixed) => Array.from({ length: 6 }, (_, k) => ({ id: k + 1, fixed: k < fixed }));
  const candidates = { efficiency: 0.98765, log_det_bound: 1, count: 300, repeats: 'forbid', optimal: true, minimum_distance: null };
  const plan = (fixed, reserve) => ({ poses: poses(fixed), criterion: { name: 'o1', reserve }, certificate: { candidates } });
  assert.equal(
    proof(plan(0, false)),
    'Proved: the plan is at least 98.76 % as informative as any other 6 of the 300 candidate poses, none measured twice. ' +
      'No plan of these candidates is better: every other one is ruled out.',
  );
  assert.match(proof(plan(2, false)), /as any plan of 6 that has the 2 fixed, all others of the 300 candidate poses,/);
  assert.match(proof(plan(2, false)), /No plan of these candidates and the fixed poses is better/);
  Object.assign(candidates, { apart: true, limited: true });
  assert.match(proof(plan(0, false)), /none measured twice, with poses as far apart, with no more poses of an instrument than its most\. No/);
  assert.match(proof(plan(0, true)), /No plan of these candidates keeps more when its worst pose is lost/);
});

test('commands to repeat a plan name the list that it chose from and every key that an option changed', () => {
  const plan = {
    problem: { file: 'p.yaml', set: [{ key: 'design.robust', value: '10' }, { key: 'design.poses', value: '6' }, { key: 'measurement.device.noise', value: '0.05 mm' }] },
    criterion: { name: 'o1', scaling: 'tolerance', prior: 'none' },
    certificate: {},
    statistics: { candidates_feasible: 40, candidates_from: 'list of poses.csv', restarts: 2 },
    method: 'exchange',
    poses: [{}, {}],
    seed: 3,
  };
  const [, made, judged] = commands(/** @type {any} */ ({ plan, route: null }));
  assert.equal(
    made,
    "posewright plan p.yaml --criterion o1 --method exchange --poses 2 --candidates-from 'list of poses.csv' --restarts 2 " +
      "--set design.robust=10 --set 'measurement.device.noise=0.05 mm' --seed 3 -o plan.json --poses-csv poses.csv",
  );
  assert.match(judged, /^posewright evaluate p.yaml poses.csv --set 'design.candidates_from=list of poses.csv' --set design.robust=10 /);
});

test('poses left out say whether the estimate is better, no better or worse than base and tool alone', () => {
  const said = (gain, range = null) => leftOut({ gain, gains: gain > 2, gain_in_range: range });
  assert.deepEqual([said(3).holds, said(3, 4).holds, said(1).holds, said(-3).holds], [true, true, false, false]);
  assert.match(said(1).text, /^no better than/);
  assert.match(said(-1).text, /^no better than/);
  assert.match(said(-3).text, /^worse than/);
  assert.match(said(null).text, /^worse than/); // it cannot predict at all
  assert.match(said(3, 1).text, /not beyond chance over the range/);
});

test('a predicted σ has what the plan counts', () => {
  const criterion = (prior) => ({ criterion: { prior } });
  assert.equal(sigmaOf(criterion('none')), 'σ is the standard deviation that the measurement noise alone leaves in a parameter');
  assert.match(sigmaOf({ ...criterion('tolerance'), unmodelled: {} }), /noise and the unmodelled effect leave in a parameter, with tolerances as prior/);
});

test('a camera reads where it is named and where it reads with others', () => {
  const [one, other] = /** @type {any[]} */ ([{ instrument: 'left', with: ['both'] }, { instrument: 'right' }]);
  assert.equal(cameraOf([one, other], 'both'), one);
  assert.equal(cameraOf([one, other], 'right'), other);
  assert.equal(cameraOf([one, other], 'tracker'), undefined);
  const alone = /** @type {any} */ ({});
  assert.equal(cameraOf([alone], undefined), alone);
});

test('joints count as movement where the tip stands still', () => {
  const stop = (x) => ({ tip: [0, 0, 0, 0, 0, 0, 1], lines: [[[0, 0, 0], [x, 0, 0]], [[0, 0, x / 2]]] });
  near(movement([stop(-1), stop(3)]), 2);
  near(movement([stop(1), stop(1)]), 1e-6);
});

test('rows of a pose are whitened integers: their matrix is that of the rows that they came from', () => {
  // J = W Lᵀ with entries that 2⁻³⁰ divides, so that nothing is rounded.
  const L = packed([[2], [1, 3], [-1, 0.5, 4]]);
  const W = [
    [0.5, -0.25, 0.125],
    [-1, 0.75, 2 ** -30],
  ];
  const bytes = new Uint8Array(24);
  const view = new DataView(bytes.buffer);
  W.flat().forEach((w, k) => view.setInt32(4 * k, w * 2 ** 30, true));
  const rows = btoa(String.fromCharCode(...bytes));
  assert.deepEqual([...whitenedRows(rows, 3)], W.flat());
  const full = (i, j) => (j <= i ? L[(i * (i + 1)) / 2 + j] : 0);
  const J = W.map((w) => [0, 1, 2].map((j) => w.reduce((sum, x, k) => sum + x * full(j, k), 0)));
  const { poses, prior, test: tested } = matricesOf(
    { factor: [...L], poses: [{ id: 7, rows }], prior: null, test: [{ weight: 2, rows: J }] },
    3,
  );
  assert.equal(poses[0].id, 7);
  assert.equal(prior, null);
  let k = 0;
  for (let i = 0; i < 3; ++i)
    for (let j = 0; j <= i; ++j, ++k) {
      const entry = J[0][i] * J[0][j] + J[1][i] * J[1][j];
      near(poses[0].packed[k], entry, 1e-12);
      near(tested[0].packed[k], entry, 1e-12);
    }
  assert.throws(() => whitenedRows(rows, 4));
});
