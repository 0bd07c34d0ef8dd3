import { around, dots, figure, logGrid, logValues, namedAxis } from './figure.js';
import { choice } from './choice.js';
import { axesOf, measuresOf } from '../numerics/residuals.js';
import { number, shownUnit } from '../text/units.js';

/** @param {any} calibration of calibration.json */
const beforeText = ({ before }) => (before === 'placed' ? 'with base, tool, targets and nuisance fitted alone' : 'with nominal parameters');

/** Of each pose, before and after. @param {any} c calibration.json */
export function perPosePlots(c) {
  const measures = measuresOf(c.readings);
  return choice(
    'Error at each pose:',
    'Which error',
    measures.map((measure) => {
      const { factor, name } = shownUnit(measure.unit);
      const of = (list) => {
        const value = measure.of(list);
        return value === null ? null : value * factor;
      };
      const before = c.poses.map((p) => of(p.before));
      const after = c.poses.map((p) => of(p.residuals));
      const part = (held) => after.map((v, k) => (c.poses[k].held_back === held ? v : null));
      const anyHeld = c.poses.some((p) => p.held_back);
      const unit = name ? `, ${name}` : '';
      return [
        measure.title,
        figure({
          id: `plot-per-pose-${measure.key}`,
          headed: false,
          title: `Error at each pose: ${measure.title}`,
          caption:
            `Root mean square over what was read at the pose, on a logarithmic scale. Before: ${beforeText(c)}.` +
            (anyHeld ? ' Held back: calibrated without these poses, which is what to expect elsewhere.' : ''),
          options: {
            series: [
              { label: 'pose', value: (u, v) => (v === null ? '' : String(c.poses[v - 1]?.id ?? '')) },
              dots(`before${unit}`, 'ink-soft', 5),
              dots(`fitted${unit}`, 'plan'),
              ...(anyHeld ? [dots(`held back${unit}`, 'accent', 8)] : []),
            ],
            scales: { x: { time: false, range: around }, y: { distr: 3 } },
            axes: [
              namedAxis(
                c.poses.map((p) => p.id),
                'pose',
              ),
              { label: `error${unit}`, size: 66, values: logValues, grid: logGrid },
            ],
          },
          data: [c.poses.map((_, k) => k + 1), before, part(false), ...(anyHeld ? [part(true)] : [])],
          numbers: () => ({
            header: ['pose', `#before${unit}`, `#after${unit}`, ''],
            rows: c.poses.map((p, k) => [String(p.id), number(before[k]), number(after[k]), p.held_back ? 'held back' : '']),
          }),
        }).element,
      ];
    }),
  );
}

/** Every residual along one axis, spread beside its pose. @param {any} c @param {import('../numerics/residuals.js').Axis} axis */
function alongAxis(c, axis) {
  const { factor, name } = shownUnit(axis.unit);
  const unit = name ? `, ${name}` : '';
  const points = c.poses
    .flatMap((pose, k) =>
      axis.at.map((reading, n) => ({
        pose,
        reading,
        x: k + 1 + (axis.at.length > 1 ? 0.6 * (n / (axis.at.length - 1) - 0.5) : 0),
        value: pose.residuals[reading],
      })),
    )
    .filter((point) => point.value !== null);
  const value = (held) => points.map((p) => (p.pose.held_back === held ? p.value * factor : null));
  const anyHeld = points.some((p) => p.pose.held_back);
  const many = axis.at.length > 1;
  return figure({
    id: `plot-along-${axis.key.replaceAll(' ', '-')}-${axis.unit}`,
    headed: false,
    title: `Residuals along ${axis.key}`,
    caption:
      `Measured less predicted by the calibrated robot${many ? '; dots beside each other are the targets of a pose in the order of the readings' : ''}. ` +
      'Without a missing effect they lie around zero without a pattern.',
    options: {
      series: [
        { label: 'pose', value: (u, v) => (v === null ? '' : String(c.poses[Math.round(v) - 1]?.id ?? '')) },
        dots(`fitted${unit}`, 'plan', 5),
        ...(anyHeld ? [dots(`held back${unit}`, 'accent', 6)] : []),
      ],
      scales: { x: { time: false, range: [0.4, c.poses.length + 0.6] }, y: { range: evenly } },
      axes: [
        namedAxis(
          c.poses.map((p) => p.id),
          'pose',
        ),
        { label: `residual${unit}`, size: 66 },
      ],
    },
    data: [points.map((p) => p.x), value(false), ...(anyHeld ? [value(true)] : [])],
    numbers: () => ({
      header: ['pose', 'reading', `#residual${unit}`],
      rows: points.map((p) => [String(p.pose.id), c.readings[p.reading].name, number(p.value * factor)]),
    }),
  }).element;
}

/** As far below zero as above. */
const evenly = (plot, low, high) => {
  const most = 1.08 * Math.max(Math.abs(low), Math.abs(high), 1e-12);
  return [-most, most];
};

/** @param {any} c calibration.json */
export const perAxisPlots = (c) =>
  choice(
    'Residuals after calibration:',
    'Along which axis',
    axesOf(c.readings).map((axis) => [
      `${axis.key}${axis.key === 'all readings' ? `, ${shownUnit(axis.unit).name}` : ''}`,
      alongAxis(c, axis),
    ]),
  );

/** Poses that were not fitted: what the estimate's covariance lets expect, and what is. @param {any} c */
export function heldBackPlot(c) {
  const poses = c.poses.filter((p) => p.accuracy && p.accuracy.observed.position !== null);
  if (poses.length === 0) return null;
  const mm = (key) => poses.map((p) => (p.accuracy[key].position === null ? null : 1e3 * p.accuracy[key].position));
  const [estimate, noise, observed] = ['by_estimate', 'with_noise', 'observed'].map(mm);
  return figure({
    id: 'plot-held-back',
    title: 'Poses that were not fitted',
    caption:
      'The error that was found, beside what the covariance of the estimate and the noise of the readings let expect (1σ), and the estimate’s share of that. ' +
      'Errors far above what is expected with noise say that the model lacks something.',
    options: {
      series: [
        { label: 'pose', value: (u, v) => (v === null ? '' : String(poses[v - 1]?.id ?? '')) },
        dots('found, mm', 'accent', 8),
        dots('expected with noise, mm', 'plan'),
        dots('by the estimate, mm', 'bar'),
      ],
      scales: { x: { time: false, range: around }, y: { range: (u, low, high) => [0, 1.1 * high] } },
      axes: [
        namedAxis(
          poses.map((p) => p.id),
          'pose',
        ),
        { label: 'error, mm', size: 62 },
      ],
    },
    data: [poses.map((_, k) => k + 1), observed, noise, estimate],
    numbers: () => ({
      header: ['pose', '#by the estimate, mm', '#with noise, mm', '#found, mm'],
      rows: poses.map((p, k) => [String(p.id), number(estimate[k]), number(noise[k]), number(observed[k])]),
    }),
  }).element;
}
