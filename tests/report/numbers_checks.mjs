// The page's own numerics on the data of real reports agree with what the program wrote.
import { matricesOf } from '../../report/src/numerics/information.js';
import { PlanFigures } from '../../report/src/numerics/plan_figures.js';
import { check, near } from './checks.mjs';

/** @param {import('./make_reports.mjs').Case} c */
export function checkNumbers({ plan, data }) {
  const engine = new PlanFigures(data.columns, matricesOf(data.information, data.columns.length));
  const ids = plan.poses.map((p) => p.id);
  const whole = engine.of(ids);
  check(whole.identifiable, 'all parameters are identifiable from the data');
  near(whole.logDet, plan.criterion.log_det, 1e-8, 'log det is the plan’s');
  const sigma = new Map(plan.parameters.map((p) => [p.name, p.sigma]));
  data.columns.forEach((column, j) =>
    near(whole.sigma[j], sigma.get(column.name), 1e-6, `σ of ${column.name} is the plan’s`),
  );
  if (plan.accuracy.rho0 !== null) {
    near(whole.rho0, plan.accuracy.rho0, 1e-6, 'the position error is the plan’s');
    whole.testErrors.forEach((error, t) =>
      near(error, plan.accuracy.test_poses[t], 1e-6, `the error at test pose ${t + 1} is the plan’s`),
    );
  }
  for (const pose of plan.poses) {
    const without = engine.efficiency(engine.of(ids.filter((id) => id !== pose.id)), whole);
    near(without, pose.efficiency_without, 1e-6, `what is left without pose ${pose.id} is as the plan says`);
  }
  checkPrefix(engine, data);
}

/** @param {PlanFigures} engine @param {any} data */
function checkPrefix(engine, data) {
  const order = data.route ? data.route.order : data.plan.poses.map((p) => p.id);
  engine.growing(order).forEach((figures, k) => {
    const said = data.prefix[k];
    check(
      (said?.log_det ?? null) === null ? !figures.identifiable : figures.identifiable,
      `after ${k + 1} poses both agree on what is identifiable`,
    );
    if (!said || said.log_det === null || !figures.identifiable) return;
    near(figures.logDet, said.log_det, 1e-6, `log det after ${k + 1} poses`);
    // Rounded blocks of few poses: the worst-known parameter has the fewest digits.
    near(figures.worst.ratio, said.largest_sigma_ratio, 1e-4, `largest σ/tolerance after ${k + 1} poses`);
    if (said.rho0 !== null) near(figures.rho0, said.rho0, 1e-5, `position error after ${k + 1} poses`);
  });
}
