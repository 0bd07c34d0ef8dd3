import { list, number, percent, percentDown, plural, quantity } from './units.js';

/** What the plan says, in plain sentences. Each function returns text, or nothing where there is nothing to say. */

/** @param {any} plan */
export const newPoses = (plan) => plan.poses.filter((p) => !p.measured);

/** Whether the plan is bounded by the determinant of the information. @param {any} plan */
export const isDeterminant = (plan) => plan.certificate.candidates?.log_det_bound !== undefined;

/** @param {any} plan */
export function what(plan) {
  const kept = plan.parameters.filter((p) => p.identifiable);
  const nuisance = kept.filter((p) => p.role === 'nuisance').length;
  const measured = plan.poses.length - newPoses(plan).length;
  const variants = (plan.variants ?? []).length;
  return (
    `${plural(newPoses(plan).length, 'pose')} to measure${measured > 0 ? `, beside ${measured} that are measured already,` : ''} ` +
    `so that ${plural(kept.length - nuisance, 'parameter')} of the robot can be identified` +
    (plan.variant ? ` (${variants > 1 ? 'model variants' : 'model variant'} ${plan.variant})` : '') +
    '.' +
    (nuisance > 0
      ? ` ${nuisance} more are estimated along with them, such as the pose of the base; their values are of no interest.`
      : '')
  );
}

/** @param {any} plan */
export function accuracy(plan) {
  const expected = plan.expected_error;
  if (!expected) return '';
  const frames = expected.taken_out.length > 0 ? `, with the best ${expected.taken_out.join(' and ')}` : '';
  const required = expected.required === null ? '' : ` Required: ${quantity(expected.required, 'm')}.`;
  return (
    `After calibration the tip is expected to be off by ${withEffect(expected)} (root mean square at ${expected.places} ${expected.at}${frames}); ` +
    `measurement noise alone makes ${quantity(expected.by_noise, 'm')} of it.${required}`
  );
}

/** Error with the effect that a model lacks. @param {any} expected */
export function withEffect(expected) {
  const shown = expected.with.map((w) => quantity(w.error, 'm'));
  return shown.length === 1 ? shown[0] : `${shown[1]} (${shown[0]} to ${shown[2]})`;
}

/** @param {any} plan */
export function worth(plan) {
  const known = plan.parameters.filter((p) => p.identifiable && p.role === 'interest');
  if (known.length === 0) return '';
  const ratio = (p) => p.sigma / p.tolerance;
  const worst = known.reduce((a, b) => (ratio(b) > ratio(a) ? b : a));
  const useless = known.filter((p) => !p.worth_identifying);
  const start =
    useless.length === 0
      ? `All ${known.length} are determined better than their manufacturing tolerance`
      : `${known.length - useless.length} of ${known.length} are determined better than their manufacturing tolerance`;
  return (
    `${start}; the one known least, ${worst.name}, at ${number(ratio(worst), 3)} of it.` +
    (useless.length > 0
      ? ` Not worth identifying, because their tolerance is smaller than σ: ${list(useless.map((p) => p.name))}.`
      : '')
  );
}

/** What a predicted σ contains. @param {any} plan */
export function sigmaOf(plan) {
  const effect = plan.unmodelled ? ' and the unmodelled effect leave' : ' alone leaves';
  const prior = plan.criterion.prior === 'tolerance' ? ', with tolerances as prior knowledge' : '';
  return `σ is the standard deviation that the measurement noise${effect} in a parameter${prior}`;
}

/** What each instrument of a list gives. @param {any} plan */
export function instruments(plan) {
  const each = (plan.instruments ?? []).map(
    (entry) =>
      `Instrument ${entry.name} reads ${plural(entry.poses, 'pose')} and gives ${percent(entry.share)} of the information; ` +
      (entry.efficiency_without > 0
        ? `without it ${percentDown(entry.efficiency_without)} would be left.`
        : 'without it not all parameters can be identified.'),
  );
  return each.join(' ');
}

/** What is proved over the candidates. @param {any} plan */
export function proof(plan) {
  const c = plan.certificate.candidates;
  if (!c)
    return `For criterion ${plan.criterion.name} no bound is computed: the distance to the best plan is not proved.`;
  const as = isDeterminant(plan) ? 'as informative as' : `as good by criterion ${plan.criterion.name} as`;
  const repeats =
    c.repeats === 'forbid'
      ? ', none measured twice'
      : c.repeats === 'allow'
        ? ', repeats allowed'
        : `, each at most ${c.repeats} times`;
  const fixed = newPoses(plan).filter((p) => p.fixed).length;
  const others = fixed > 0 ? `any plan of ${newPoses(plan).length} that has the ${fixed} fixed, all others` : `any other ${newPoses(plan).length}`;
  const best = plan.criterion.reserve
    ? 'keeps more when its worst pose is lost: all others are ruled out'
    : 'is better: every other one is ruled out';
  return (
    `Proved: the plan is at least ${percentDown(c.efficiency)} ${as} ${others} of the ${c.count.toLocaleString('en')} candidate poses${repeats}${c.apart ? ', with poses as far apart' : ''}${c.limited ? ', with no more poses of an instrument than its most' : ''}.` +
    (c.optimal
      ? ` No plan of these candidates${fixed > 0 ? ' and the fixed poses' : ''}${c.minimum_distance ? ' that keeps its poses apart' : ''} ${best}.`
      : '')
  );
}

/** What that means for errors. @param {any} plan */
export function proofMeaning(plan) {
  const c = plan.certificate.candidates;
  if (!c || !isDeterminant(plan) || c.efficiency >= 1) return '';
  return `So no choice among them can shrink the parameters’ joint confidence region (geometric mean of its axes) by more than ${percent(Math.ceil((1 - Math.sqrt(c.efficiency)) * 1e3) / 1e3)}.`;
}

/** @param {any} plan */
export function searched(plan) {
  const w = plan.certificate.workspace;
  const limits = w?.limits?.length > 0 ? ` and the limits of ${list(w.limits)}` : '';
  if (w?.proved)
    return `Proved ${w.within}${limits}: between the candidates too, it reaches at least ${percentDown(w.efficiency, 1)} of the best.`;
  return w
    ? `Searched, not proved: over the whole workspace, between the candidates too, ${isSettled(w) ? `it reaches ${searchedShare(w)} of the best` : 'no figure: the search for better poses was not finished'}.`
    : '';
}

/** Whether a search came to its end (older files do not say). @param {any} workspace */
export const isSettled = (workspace) => workspace.settled !== false;

/** @param {any} workspace */
export const searchedShare = (workspace) => percentDown(Math.min(1, workspace.efficiency + 5e-4), 0);

/** @param {any} plan */
export function loss(plan) {
  const poses = newPoses(plan);
  if (poses.length === 0) return '';
  const worst = poses.reduce((a, b) => (b.efficiency_without < a.efficiency_without ? b : a));
  return worst.efficiency_without <= 0
    ? `Without pose ${worst.id} not all parameters can be identified: it must not be lost.`
    : `If one pose cannot be measured, at least ${percentDown(worst.efficiency_without)} of the plan remains (worst: pose ${worst.id}).`;
}

/** Two bodies and how far they are apart. @param {{distance: number, between: [string, string]}} nearest */
export function nearestText(nearest) {
  return `${nearest.between.join(' and ')} are ${quantity(nearest.distance, 'm')} apart, nearer than all others`;
}

/** The smallest clearance of all poses and, of a route, motions. @param {any} plan @param {any} route */
export function clearance(plan, route) {
  const smallest = (entries) =>
    entries.filter((e) => e.nearest).reduce((a, b) => (a && a.nearest.distance <= b.nearest.distance ? a : b), null);
  const place = (id) => (id === 0 ? 'home' : `pose ${id}`);
  const told = (entry, where) =>
    `${entry.nearest.between.join(' and ')} come within ${quantity(entry.nearest.distance, 'm')} ${where}`;
  const pose = smallest(plan.poses);
  const motion = smallest(route?.motions ?? []);
  const parts = [
    pose && told(pose, `at ${place(pose.id)}`),
    motion && told(motion, `between ${place(motion.from)} and ${place(motion.to)}`),
  ].filter(Boolean);
  return parts.length > 0 ? `Nearest to each other: ${parts.join('; ')}.` : '';
}

/** @param {any} plan */
export function dropped(plan) {
  const names = plan.parameters.filter((p) => !p.identifiable).map((p) => p.name);
  return names.length > 0
    ? `${plural(names.length, 'parameter')} cannot be identified separately by this measurement and ${names.length === 1 ? 'is' : 'are'} left out: ${list(names)}.`
    : '';
}

/** @param {import('../types.js').Report} report @returns {string[]} */
export function warnings(report) {
  const { plan, route } = report;
  const s = report.singular_values;
  const condition = s.length > 0 ? s[0] / s[s.length - 1] : 1;
  return [
    plan.interrupted &&
      'The search was ended early: this is the best plan found until then. Plan again without a time limit for a better one.',
    condition > 1e6 &&
      `Ill-conditioned: the best-known combination of parameters is measured ${number(condition, 2)} times better than the worst-known (both in units of tolerance). Some combinations are hardly measured at all.`,
    plan.criterion.name.startsWith('test_pose') &&
      plan.accuracy.test_poses.length === 1 &&
      'There is a single test pose: the plan crowds around it and tells little of other places. Give several.',
    route?.problem_changed &&
      'The problem file has changed since the plan was made; the route belongs to the new one. Plan again.',
    ...(report.notes ?? []),
    ...(route?.unreachable ?? []).map((u) => `Pose ${u.pose} is left out of the route: ${u.reason}.`),
    route?.worth && `The poses of the route have ${percentDown(route.worth.efficiency, 1)} of the plan's information.`,
    plan.criterion.prior === 'tolerance' &&
      'Tolerances count as prior knowledge: σ is what is known after the measurement together with them.',
  ].filter((text) => typeof text === 'string');
}
