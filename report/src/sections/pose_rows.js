import { h, svg } from '../dom.js';
import { choiceTexts } from '../text/choices.js';
import { percent } from '../text/units.js';

/**
 * The list: tick off, preview, reorder by buttons, keys or dragging the handle.
 * @param {import('../pose_list.js').PoseList} list @param {(id: number) => void} preview
 */
export function poseRows(list, preview) {
  const rows = h('ol', { class: 'rows', 'aria-label': 'Poses in measuring order' });
  const build = () => {
    const focus = focusOf(rows);
    rows.replaceChildren(...list.entries.map((entry, place) => row(list, entry, place, preview)));
    rows.querySelector(focus)?.focus();
    mark();
  };
  const mark = () => {
    for (const element of rows.children) {
      const shown = Number(element.dataset.id) === list.current;
      element.classList.toggle('shown', shown);
      element.querySelector('.preview').setAttribute('aria-pressed', String(shown));
      if (shown) scrollInside(rows, element);
    }
  };
  list.addEventListener('list', build);
  list.addEventListener('current', mark);
  dragging(rows, list);
  build();
  return rows;
}

/** The button that had the focus before the rows were made anew. @param {HTMLElement} rows */
function focusOf(rows) {
  const active = document.activeElement;
  if (!active || !rows.contains(active)) return 'nothing';
  return `li[data-id="${active.closest('li')?.dataset.id}"] .${active.classList[0]}`;
}

/** Scrolls the list, never the page. @param {HTMLElement} rows @param {HTMLElement} element */
function scrollInside(rows, element) {
  const top = element.offsetTop - rows.offsetTop;
  if (top < rows.scrollTop) rows.scrollTop = top;
  else if (top + element.offsetHeight > rows.scrollTop + rows.clientHeight)
    rows.scrollTop = top + element.offsetHeight - rows.clientHeight;
}

/** @param {import('../pose_list.js').PoseList} list @param {{id: number, on: boolean}} entry @param {number} place @param {(id: number) => void} preview */
function row(list, entry, place, preview) {
  const pose = list.poses.get(entry.id);
  const box = h('input', {
    class: 'tick',
    type: 'checkbox',
    checked: entry.on,
    'aria-label': `Measure pose ${entry.id}`,
    onchange: () => list.tick(entry.id, box.checked),
  });
  const move = (name, step, text, allowed) =>
    h(
      'button',
      {
        class: `${name} bare`,
        disabled: !allowed,
        'aria-label': `Move pose ${entry.id} ${name === 'up' ? 'earlier' : 'later'}`,
        onclick: () => list.move(place, place + step),
      },
      text,
    );
  const locked = list.locked.has(entry.id);
  const lock = h(
    'button',
    {
      class: 'lock bare',
      'aria-pressed': String(locked),
      'aria-label': `Keep pose ${entry.id} in the next plan`,
      title: locked ? 'Locked: plan --fixed keeps it' : 'Lock: plan --fixed is to keep it',
      onclick: () => list.lock(entry.id, !locked),
    },
    padlock(locked),
  );
  const notes = [
    pose.moved && 'moved',
    ...choiceTexts(pose),
    list.unreachable.has(entry.id) && 'not reachable',
  ]
    .filter(Boolean)
    .join(', ');
  const loss =
    pose.efficiency_without === undefined
      ? ''
      : pose.efficiency_without <= 0
        ? 'indispensable'
        : `costs ${percent(1 - pose.efficiency_without)}`;
  return h(
    'li',
    { 'data-id': entry.id, class: entry.on ? '' : 'off' },
    h('span', { class: 'handle', title: 'Drag to reorder', 'aria-hidden': 'true' }, '⠿'),
    box,
    h(
      'button',
      {
        class: 'preview bare',
        'aria-pressed': 'false',
        title: list.unreachable.get(entry.id) ?? 'Show in the picture',
        onclick: () => preview(entry.id),
      },
      h('b', {}, `Pose ${entry.id}`),
      notes ? h('span', { class: 'notes' }, notes) : null,
    ),
    lock,
    h('span', { class: 'loss', title: 'Loss of efficiency if this pose alone is missing' }, loss),
    move('up', -1, '↑', place > 0),
    move('down', 1, '↓', place < list.entries.length - 1),
  );
}

/** @param {boolean} closed */
const padlock = (closed) =>
  svg(
    'svg',
    { viewBox: '0 0 16 16', width: 16, height: 16, 'aria-hidden': 'true' },
    svg('rect', { x: 3, y: 7, width: 10, height: 7, rx: 1.5 }),
    svg('path', { d: closed ? 'M5 7V5a3 3 0 0 1 6 0v2' : 'M5 7V4a3 3 0 0 1 5.6-1.5' }),
  );

/** Nearer than this to the end of the list, dragging scrolls it, px. */
const edge = 20;

/** By pointer, so that fingers can do it, too. @param {HTMLElement} rows @param {import('../pose_list.js').PoseList} list */
function dragging(rows, list) {
  rows.addEventListener('pointerdown', (event) => {
    const handle = /** @type {HTMLElement} */ (event.target).closest('.handle');
    const dragged = handle?.closest('li');
    if (!handle || !dragged) return;
    event.preventDefault();
    rows.setPointerCapture(event.pointerId);
    dragged.classList.add('dragged');
    const follow = (move) => {
      const { top, bottom } = rows.getBoundingClientRect();
      if (move.clientY < top + edge) rows.scrollTop -= edge / 2;
      if (move.clientY > bottom - edge) rows.scrollTop += edge / 2;
      const others = [...rows.children].filter((r) => r !== dragged);
      const next = others.find((r) => move.clientY < r.getBoundingClientRect().top + r.offsetHeight / 2);
      if (next ? next.previousElementSibling !== dragged : rows.lastElementChild !== dragged)
        rows.insertBefore(dragged, next ?? null);
    };
    const over = new AbortController();
    const drop = () => {
      over.abort();
      const id = Number(dragged.dataset.id);
      const from = list.entries.findIndex((e) => e.id === id),
        to = [...rows.children].indexOf(dragged);
      dragged.classList.remove('dragged');
      list.move(from, to);
    };
    rows.addEventListener('pointermove', follow, { signal: over.signal });
    for (const end of ['pointerup', 'pointercancel']) rows.addEventListener(end, drop, { signal: over.signal });
  });
}
