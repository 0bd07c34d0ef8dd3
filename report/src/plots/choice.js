import { h } from '../dom.js';

/**
 * Several figures of which one is seen, chosen by its name.
 * @param {string} title before the choice
 * @param {string} label of the choice, for who does not see it
 * @param {[string, HTMLElement][]} figures names and figures, the first is seen; without a heading of their own
 */
export function choice(title, label, figures) {
  const select = h(
    'select',
    { 'aria-label': label, onchange: () => show() },
    figures.map(([name], k) => h('option', { value: k }, name)),
  );
  const show = () => figures.forEach(([, element], k) => (element.hidden = k !== Number(select.value)));
  show();
  return h(
    'div',
    { class: 'choice' },
    h('h3', {}, `${title} `, figures.length > 1 ? select : figures[0][0]),
    figures.map(([, element]) => element),
  );
}
