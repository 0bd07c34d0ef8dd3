import uPlot from 'uplot';
import { h, table } from '../dom.js';
import { colour, onTheme } from '../theme.js';
import { number } from '../text/units.js';

/** @param {import('uplot').Axis} axis */
const styled = (axis, k) => ({
  stroke: () => colour('ink-soft'),
  font: '12px system-ui, sans-serif',
  labelFont: '12px system-ui, sans-serif',
  labelSize: 18,
  ...(k === 0 ? { size: 30 } : {}),
  ...axis,
  grid: { stroke: () => colour('rule'), width: 1, ...axis.grid },
  ticks: { stroke: () => colour('rule'), width: 1 },
});

/** Bars from zero. @param {string} label @param {string} tint @param {number} width share of the room */
export const bars = (label, tint, width = 0.7) => ({
  label,
  fill: () => colour(tint),
  stroke: () => colour(tint),
  width: 0,
  paths: uPlot.paths.bars({ size: [width, 36, 1] }),
  points: { show: false },
});

/** Dots without a line. @param {string} label @param {string} tint */
export const dots = (label, tint, size = 7) => ({
  label,
  stroke: () => colour(tint),
  fill: () => colour(tint),
  paths: () => null,
  points: { show: true, size, fill: () => colour(tint), stroke: () => colour(tint) },
});

/** @param {string} label @param {string} tint @param {boolean} marked with dots */
export const curve = (label, tint, marked = false) => ({
  label,
  stroke: () => colour(tint),
  width: 2,
  spanGaps: true,
  points: { show: marked, size: 5, fill: () => colour(tint), stroke: () => colour(tint) },
});

/** A level to compare with. @param {string} label @param {string} tint */
export const level = (label, tint) => ({
  label,
  stroke: () => colour(tint),
  width: 1.5,
  dash: [6, 4],
  points: { show: false },
});

/** Upright lines at places of the x axis. @param {{value: number, tint: string}[]} marks */
export const uprights = (marks) => ({
  hooks: {
    draw: (plot) => {
      const { ctx, bbox } = plot;
      ctx.save();
      for (const { value, tint } of marks) {
        const x = plot.valToPos(value, 'x', true);
        ctx.strokeStyle = colour(tint);
        ctx.lineWidth = 2 * devicePixelRatio;
        ctx.beginPath();
        ctx.moveTo(x, bbox.top);
        ctx.lineTo(x, bbox.top + bbox.height);
        ctx.stroke();
      }
      ctx.restore();
    },
  },
});

/** Not named in the legend: the caption says what it is. @param {any} series */
export const unlisted = (series) => ({ ...series, class: 'unlisted' });

/** What the legend shows under the pointer. */
const shownValue = (plot, value) => (value === null || value === undefined ? '' : number(value));

/** Whole numbers that stand for names, such as poses. @param {(string|number)[]} names at 1, 2, … @param {string} label */
export const namedAxis = (names, label) => ({
  label,
  incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500],
  values: (plot, splits) => splits.map((v) => (Number.isInteger(v) ? String(names[v - 1] ?? '') : '')),
});

/** Half a place to either side. */
export const around = (plot, low, high) => [low - 0.5, high + 0.5];

/**
 * A plot with a caption that says how to read it, and its numbers as a table.
 * @param {object} what
 * @param {string} what.id
 * @param {string} what.title
 * @param {boolean} [what.headed] false: the title stands elsewhere
 * @param {string} what.caption
 * @param {any} what.options of uPlot: series, axes, scales
 * @param {any[]} what.data
 * @param {() => {header: string[], rows: any[][]}} what.numbers made when asked for
 */
export function figure({ id, title, headed = true, caption, options, data, numbers }) {
  const holder = h('div', { class: 'plot' });
  const series = options.series.map((s) => ({ value: shownValue, ...s }));
  const details = h('details', { class: 'numbers' }, h('summary', {}, 'Numbers'));
  const fillNumbers = () => {
    const { header, rows } = numbers();
    details.replaceChildren(
      details.firstElementChild,
      table(header, rows.slice(0, 60), `${title}: numbers`),
      rows.length > 60 ? h('p', { class: 'note' }, `The first 60 of ${rows.length.toLocaleString('en')}.`) : '',
    );
  };
  details.addEventListener('toggle', () => details.open && fillNumbers());
  const element = h(
    'figure',
    { id, class: 'figure' },
    headed ? h('h3', {}, title) : null,
    holder,
    h('figcaption', {}, caption),
    details,
  );
  const plot = new uPlot(
    {
      width: 520,
      height: 260,
      cursor: { drag: { x: false, y: false }, y: false },
      ...options,
      series,
      axes: options.axes.map(styled),
    },
    data,
    holder,
  );
  plot.root.setAttribute('role', 'img');
  plot.root.setAttribute('aria-label', `${title}. ${caption}`);
  const fit = () => holder.clientWidth > 0 && plot.setSize({ width: Math.floor(holder.clientWidth), height: 260 });
  new ResizeObserver(fit).observe(holder);
  onTheme(() => plot.redraw());
  element.plot = plot;
  return {
    element,
    setData: (changed) => {
      plot.setData(changed);
      series.forEach((s, k) => s.optional && plot.setSeries(k, { show: changed[k].some((v) => v !== null) }));
      if (details.open) fillNumbers();
    },
  };
}

const isDecade = (v) => v !== null && Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-9;

/** Lines at powers of ten alone, where there are several. */
export const logGrid = {
  filter: (plot, splits) => (splits.filter(isDecade).length < 2 ? splits : splits.map((v) => (isDecade(v) ? v : null))),
};

/** Numbers on a logarithmic axis: powers of ten alone, unless there is hardly one. */
export const logValues = (plot, splits) => {
  const decades = splits.filter(isDecade);
  return splits.map((v) =>
    v === null ? '' : decades.length < 2 || isDecade(v) ? String(Number(v.toPrecision(3))) : '',
  );
};
