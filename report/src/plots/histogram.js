import { bars, curve, figure, uprights } from './figure.js';
import { number } from '../text/units.js';

/**
 * Counts by bins, beside what is expected of them.
 * @param {object} what
 * @param {string} what.id
 * @param {string} what.title
 * @param {boolean} [what.headed]
 * @param {string} what.caption
 * @param {{from: number, bin_width: number, counts: number[]}} what.histogram in the unit of the axis
 * @param {string} what.axis
 * @param {string} what.counted what is counted: "residuals"
 * @param {number[]} [what.expected] one a bin
 * @param {{value: number, label: string, tint: string}[]} [what.marks] upright lines
 * @param {boolean} [what.open] the ends hold what is beyond too
 */
export function histogram({ id, title, headed, caption, histogram: h, axis, counted, expected, marks = [], open = false }) {
  const centres = h.counts.map((_, k) => h.from + (k + 0.5) * h.bin_width);
  const last = h.counts.length - 1;
  const bin = (k) =>
    `${open && k === 0 ? 'below' : number(h.from + k * h.bin_width, 3)} to ${open && k === last ? 'above' : number(h.from + (k + 1) * h.bin_width, 3)}`;
  const ends = [h.from, h.from + h.counts.length * h.bin_width];
  return figure({
    id,
    title,
    headed,
    caption,
    options: {
      series: [
        { label: axis },
        bars(counted, 'bar', 0.94),
        ...(expected ? [curve('expected', 'accent')] : []),
        ...marks.map(({ label, tint }) => ({ ...curve(label, tint), value: () => '' })),
      ],
      scales: {
        x: {
          time: false,
          range: () => [Math.min(ends[0], ...marks.map((m) => m.value)), Math.max(ends[1], ...marks.map((m) => 1.02 * m.value))],
        },
        y: { range: (u, low, high) => [0, 1.1 * Math.max(1, high)] },
      },
      axes: [{ label: axis }, { label: counted, size: 58 }],
      plugins: marks.length > 0 ? [uprights(marks)] : [],
    },
    data: [centres, h.counts, ...(expected ? [expected] : []), ...marks.map(() => centres.map(() => null))],
    numbers: () => ({
      header: [axis, `#${counted}`, ...(expected ? ['#expected'] : [])],
      rows: h.counts.map((count, k) => [bin(k), count, ...(expected ? [number(expected[k], 3)] : [])]),
    }),
  }).element;
}
