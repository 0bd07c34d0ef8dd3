import { h } from '../../dom.js';
import { thingsPanel } from '../things_panel.js';

const kinds = [
  ['tracker', 'Laser tracker, three reflectors on the flange'],
  ['hand', 'Camera on the hand, board in the cell'],
  ['fixed', 'Camera in the cell, board on the hand'],
];

/** @param {import('../main.js').Live} live */
export function instrumentStep(live) {
  const kind = h('select', { 'aria-label': 'Instrument', onchange: () => show() }, kinds.map(([value, title]) => h('option', { value }, title)));
  const camera = h('select', { 'aria-label': 'Camera' });
  const board = h('input', { value: '6x9x25mm', 'aria-label': 'Board: rows x columns x spacing' });
  const accuracy = h('input', { placeholder: 'none', size: 8, 'aria-label': 'Required accuracy, such as 0.1mm' });
  const lens = h('div', { class: 'fields', hidden: true }, h('label', {}, 'Camera ', camera), h('label', {}, 'Board ', board));
  const show = () => {
    lens.hidden = kind.value === 'tracker';
    if (!lens.hidden && camera.childElementCount === 0) fillCameras();
  };
  const fillCameras = async () => {
    const { cameras } = (await live.list(['init', '--camera', 'list'])) ?? { cameras: [] };
    camera.replaceChildren(...cameras.map((c) => h('option', { value: c.name }, `${c.name} (${c.width} × ${c.height})`)));
  };
  const words = () => [
    ...(kind.value === 'tracker' ? ['--tracker'] : ['--camera', camera.value, '--board', board.value.trim()]),
    ...(kind.value === 'fixed' ? ['--fixed-camera'] : []),
    ...(accuracy.value.trim() ? ['--accuracy', accuracy.value.trim()] : []),
  ];
  live.instrumentWords = words;
  return h(
    'div',
    {},
    h('div', { class: 'fields' }, h('label', {}, 'Instrument ', kind), h('label', {}, 'Required accuracy ', accuracy)),
    lens,
    h('button', { class: 'main', onclick: () => live.begin(live.project.given) }, 'Write the problem anew'),
    h('p', { class: 'note' }, 'This replaces the problem file; "Undo" at the text brings the old one back. Drag the instrument in the picture, or type where it stands:'),
    thingsPanel(live.project, 'instrument'),
  );
}
