import { h } from '../dom.js';
import { added, moved, removed, resized, thingsOf } from './things.js';

const axes = ['x', 'y', 'z'];

/** Three lengths in mm. @param {string} label @param {(values: number[]) => void} set */
function threeFields(label, set) {
  const inputs = axes.map((axis) =>
    h('input', {
      type: 'number',
      step: 10,
      'aria-label': `${label}, ${axis}, mm`,
      onchange: () => inputs.every((i) => Number.isFinite(i.valueAsNumber)) && set(inputs.map((i) => i.valueAsNumber / 1000)),
    }),
  );
  const element = h('div', { class: 'three' }, inputs.map((input, k) => h('label', {}, `${axes[k]} `, input)));
  /** @param {number[]} values m */
  const show = (values) => inputs.forEach((input, k) => (input.value = String(Math.round(values[k] * 1e4) / 10)));
  return { element, show };
}

/**
 * What stands in the cell, with its place in numbers.
 * @param {import('./project.js').Project} project @param {'instrument'|'cell'} step
 */
export function thingsPanel(project, step) {
  const list = h('ul', { class: 'things' });
  const change = (key, edit) => {
    const thing = thingsOf(project.text).find((t) => t.key === key);
    if (thing) project.write(edit(project.text, thing));
  };
  const row = ({ key, label, entry, size }) => {
    const place = threeFields(label, (values) => change(key, (text, thing) => moved(text, thing, values)));
    const edges = size && threeFields(`${label}, edges`, (values) => change(key, (text, thing) => resized(text, thing, values)));
    const remove = entry && h('button', { class: 'small', 'aria-label': `Remove ${label}`, onclick: () => change(key, removed) }, 'Remove');
    const element = h(
      'li',
      {},
      h('div', { class: 'thing-head' }, h('b', {}, label), remove),
      h('div', { class: 'note' }, 'position, mm'),
      place.element,
      edges ? [h('div', { class: 'note' }, 'edges, mm'), edges.element] : null,
    );
    return { element, show: (thing) => (place.show(thing.position), edges?.show(thing.size.values)) };
  };
  let rows = [];
  let shown = '';
  project.addEventListener('text', () => {
    const things = thingsOf(project.text).filter((t) => t.step === step);
    // Fields that stay keep the reader's place in them.
    const names = JSON.stringify(things.map((t) => [t.key, t.label, Boolean(t.size)]));
    if (names !== shown) {
      shown = names;
      rows = things.map(row);
      list.replaceChildren(...rows.map((r) => r.element));
    }
    rows.forEach((r, k) => r.show(things[k]));
  });
  return list;
}

/** @param {import('./project.js').Project} project */
export function addButtons(project) {
  const kinds = { box: [1, 0, 0.3], cylinder: [1, 0.5, 0.5], floor: [0, 0, 0], wall: [0, 2, 0] };
  return h(
    'div',
    { class: 'buttons' },
    Object.entries(kinds).map(([kind, at]) => h('button', { class: 'small', onclick: () => project.write(added(project.text, kind, at)) }, `Add a ${kind}`)),
  );
}
