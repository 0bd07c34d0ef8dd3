import { around, curve, dots, figure, logGrid, logValues, namedAxis } from './figure.js';
import { choice } from './choice.js';
import { number } from '../text/units.js';

const mm = (value) => (value === null || value === undefined ? null : 1e3 * value);
const tints = ['plan', 'accent', 'yours', 'good', 'station', 'bad'];

/** Position error if the variant is not complete, of every plan. @param {any} c comparison.json */
export function expectedPlots(c) {
  const figures = c.variants.flatMap(({ name }, k) => {
    const scores = c.scores.filter((s) => s.variant === name && s.expected_error).slice(0, tints.length);
    if (scores.length === 0) return [];
    const times = [0, ...scores[0].expected_error.with.map((w) => w.times)];
    const error = (s, t) => mm(t === 0 ? s.expected_error.by_noise : s.expected_error.with.find((w) => w.times === t)?.error);
    const { noise, places, at } = scores[0].expected_error;
    return [
      [
        name,
        figure({
          id: `plot-expected-${k}`,
          headed: false,
          title: `If ${name} is not complete`,
          caption: `Position error at ${places} ${at}, if a smooth effect that ${name} lacks moves the tip by so many times ${number(mm(noise))} mm, the noise of a pose. A line that rises slowly relies less on the model.`,
          options: {
            series: [{ label: 'times the noise' }, ...scores.map((s, i) => curve(`${s.plan}, mm`, tints[i], true))],
            scales: { x: { time: false }, y: { range: (u, low, high) => [0, 1.1 * high] } },
            axes: [
              { label: 'effect, times the noise of a pose', incrs: [0.5, 1] },
              { label: 'position error, mm', size: 66 },
            ],
          },
          data: [times, ...scores.map((s) => times.map((t) => error(s, t)))],
          numbers: () => ({
            header: ['plan', ...times.map((t) => `#${t} ×, mm`)],
            rows: scores.map((s) => [s.plan, ...times.map((t) => number(error(s, t)))]),
          }),
        }).element,
      ],
    ];
  });
  return figures.length > 0 ? [choice('If the variant is not complete:', 'Which variant', figures)] : [];
}

/** With and without the parameters of the larger variant. @param {any} c */
export function worthPlot(c) {
  const known = c.worth.filter((w) => w.error_with !== null && w.error_without !== null);
  if (known.length === 0) return null;
  const places = known[0].measure === 'test_poses';
  const factor = places ? 1e3 : 1;
  const unit = places ? 'mm' : 'tolerances';
  return figure({
    id: 'plot-worth',
    title: `Error with and without, ${unit}`,
    caption: `${places ? 'Position error at the test poses' : 'Root mean square over the parameters that both estimate, in units of tolerance'}, on a logarithmic scale: each pair is one line below, in its order.`,
    options: {
      series: [
        {
          label: 'pair',
          value: (u, v) => (v === null ? '' : `${known[Math.round(v) - 1]?.with} over ${known[Math.round(v) - 1]?.without}`),
        },
        dots(`with, ${unit}`, 'plan', 10),
        dots(`without, ${unit}`, 'accent', 10),
      ],
      scales: { x: { time: false, range: around }, y: { distr: 3 } },
      axes: [
        namedAxis(
          known.map((_, k) => k + 1),
          'pair',
        ),
        { label: `error, ${unit}`, size: 66, values: logValues, grid: logGrid },
      ],
    },
    data: [known.map((_, k) => k + 1), known.map((w) => factor * w.error_with), known.map((w) => factor * w.error_without)],
    numbers: () => ({
      header: ['with', 'without', `#error with, ${unit}`, '#error without', '#of it noise', '#of it bias'],
      rows: known.map((w) => [
        w.with,
        w.without,
        ...[w.error_with, w.error_without, w.noise_without, w.bias_without].map((v) => number(factor * v)),
      ]),
    }),
  }).element;
}
