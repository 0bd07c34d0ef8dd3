import { h, section } from '../dom.js';
import { robotsPlot } from '../plots/robots.js';
import { percent, percentDown } from '../text/units.js';

/** Robots whose parameters a plan does not determine. @param {number[]} efficiency */
const lost = (efficiency) => efficiency.filter((e) => e === 0).length;

/** A plan for the tolerances: what it is worth on the robots that were drawn. @param {any} plan plan.json */
export function robotsSection(plan) {
  const { robust } = plan;
  if (!robust || robust.efficiency.length === 0) return null;
  const own = lost(robust.efficiency);
  const before = robust.nominal_plan ? lost(robust.nominal_plan.efficiency) : 0;
  const share = robust.nominal_plan && before === 0 ? robust.value / robust.nominal_plan.value - 1 : null;
  const told = [
    `${percentDown(robust.value)} of the best plan for each robot (${robust.measure}), ${percentDown(Math.min(...robust.efficiency))} for the one that is served worst.`,
    own > 0 && `It does not determine all parameters of ${own} of them.`,
    before > 0 && `The plan for the nominal robot does not determine all parameters of ${before} of them.`,
    share !== null &&
      `The plan for the nominal robot has ${percentDown(robust.nominal_plan.value)}: ${share < 0.01 ? 'planning for the tolerances is not worthwhile, it gains' : 'planning for the tolerances gains'} ${percent(share, 2)}.`,
    robust.interrupted && 'The search over drawn robots was ended before it was done.',
  ].filter(Boolean);
  return section(
    'robots',
    'Robots drawn from the tolerances',
    'The real robot is not the nominal one: each curve is one plan over all robots that were drawn.',
    h('p', {}, told.join(' ')),
    h('div', { class: 'plots' }, robotsPlot(robust)),
  );
}
