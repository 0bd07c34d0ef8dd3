import { curve, figure, level } from './figure.js';
import { percentDown } from '../text/units.js';

const ascending = (values) => [...values].sort((a, b) => a - b);

/** Efficiency of a plan on each drawn robot, worst first, beside that of the plan for the nominal robot. @param {any} robust of plan.json */
export function robotsPlot(robust) {
  const own = ascending(robust.efficiency);
  const nominal = robust.nominal_plan ? ascending(robust.nominal_plan.efficiency) : null;
  const shares = (values) => values.map((v) => 100 * v);
  const x = own.map((_, k) => k + 1);
  return figure({
    id: 'plot-robots',
    title: 'What the plan is worth on each drawn robot',
    caption: `D-efficiency against the best plan for that robot, ${own.length} robots drawn from the tolerances, each curve worst first${nominal ? '; grey: the plan for the nominal robot' : ''}. Dashed: no plan of these candidates has more (${robust.measure}).`,
    options: {
      series: [
        { label: 'robot' },
        curve('this plan, %', 'plan'),
        ...(nominal ? [curve('nominal plan, %', 'ink-soft')] : []),
        level('bound, %', 'accent'),
      ],
      scales: { x: { time: false }, y: { range: (u, low, high) => [Math.max(0, low - 0.5), Math.min(100, high) + 0.5] } },
      axes: [{ label: 'drawn robots, worst first' }, { label: 'D-efficiency, %', size: 58 }],
    },
    data: [x, shares(own), ...(nominal ? [shares(nominal)] : []), x.map(() => 100 * Math.min(1, robust.bound))],
    numbers: () => ({
      header: ['robot', '#this plan', ...(nominal ? ['#nominal plan'] : [])],
      rows: own.map((v, k) => [k + 1, percentDown(v), ...(nominal ? [percentDown(nominal[k])] : [])]),
    }),
  }).element;
}
