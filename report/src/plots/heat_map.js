import { h } from '../dom.js';
import { colour, onTheme } from '../theme.js';
import { fixed } from '../text/units.js';

/** @param {string} text "#rrggbb" @returns {number[]} */
const rgb = (text) => [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16));

/** Symmetric matrix of values from −1 to 1 as coloured cells; pointer, finger and arrow keys name a cell. */
export function heatMap() {
  const canvas = h('canvas', {
    class: 'heat',
    tabindex: 0,
    role: 'img',
    'aria-label': 'Correlation of every pair of parameters; arrow keys walk through the cells',
  });
  const element = h(
    'div',
    { class: 'heat-holder' },
    canvas,
    h('div', { class: 'heat-scale' }, h('span', {}, '−1'), h('span', { class: 'heat-ramp' }), h('span', {}, '+1')),
  );
  const map = {
    element,
    onPoint: (text) => {},
    draw: (names, value) => {
      state = { names, value };
      cursor = null;
      paint();
    },
  };
  let state = { names: /** @type {string[]} */ ([]), value: (i, j) => 0 };
  let cursor = /** @type {[number, number]|null} */ (null);
  let margin = 0,
    cell = 1;

  const paint = () => {
    const n = state.names.length,
      width = Math.floor(element.clientWidth);
    if (n === 0 || width === 0) return;
    const ratio = Math.min(3, devicePixelRatio);
    const context = canvas.getContext('2d');
    context.font = '11px system-ui, sans-serif';
    const widest = Math.min(150, Math.max(...state.names.map((name) => context.measureText(name).width)) + 8);
    // Names only where a line of text fits into a cell.
    margin = (Math.min(width, 620) - widest) / n >= 11 ? widest : 0;
    cell = Math.max(1, (Math.min(width, 620) - margin) / n);
    const size = margin + n * cell;
    [canvas.width, canvas.height] = [Math.round(size * ratio), Math.round(n * cell * ratio)];
    canvas.style.width = `${size}px`;
    canvas.style.height = `${n * cell}px`;
    context.scale(ratio, ratio);
    const [low, middle, high] = ['heat-low', 'heat-middle', 'heat-high'].map((name) => rgb(colour(name)));
    for (let i = 0; i < n; ++i)
      for (let j = 0; j < n; ++j) {
        const v = i === j ? 1 : state.value(i, j);
        const end = v < 0 ? low : high;
        context.fillStyle = `rgb(${middle.map((m, k) => Math.round(m + Math.abs(v) * (end[k] - m))).join(' ')})`;
        context.fillRect(margin + j * cell, i * cell, cell + 0.3, cell + 0.3);
      }
    label(context);
  };
  const label = (context) => {
    context.font = '11px system-ui, sans-serif';
    context.fillStyle = colour('ink-soft');
    context.textAlign = 'right';
    context.textBaseline = 'middle';
    if (margin > 0) state.names.forEach((name, i) => context.fillText(name, margin - 6, (i + 0.5) * cell, margin - 6));
    if (!cursor) return;
    context.strokeStyle = colour('ink');
    context.lineWidth = 2;
    context.strokeRect(margin + cursor[1] * cell, cursor[0] * cell, cell, cell);
  };
  const point = (i, j) => {
    const n = state.names.length;
    cursor = [Math.min(n - 1, Math.max(0, i)), Math.min(n - 1, Math.max(0, j))];
    paint();
    const [a, b] = cursor;
    map.onPoint(
      a === b
        ? `${state.names[a]}: with itself, always 1`
        : `${state.names[a]} and ${state.names[b]}: ${fixed(state.value(a, b), 4)}`,
    );
  };
  const atPointer = (event) => {
    const i = Math.floor(event.offsetY / cell),
      j = Math.floor((event.offsetX - margin) / cell);
    if (j >= 0 && i < state.names.length && j < state.names.length) point(i, j);
  };
  canvas.addEventListener('pointermove', atPointer);
  canvas.addEventListener('pointerdown', atPointer);
  canvas.addEventListener('keydown', (event) => {
    const step = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] }[event.key];
    if (!step) return;
    event.preventDefault();
    const [i, j] = cursor ?? [0, 0];
    point(i + step[0], j + step[1]);
  });
  new ResizeObserver(paint).observe(element);
  onTheme(paint);
  return map;
}
