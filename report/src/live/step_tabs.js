import { h } from '../dom.js';

/**
 * Steps of the work from left to right, one shown at a time.
 * @param {[string, HTMLElement][]} steps an element may have `shown`, called when it appears @param {(title: string) => void} chosen
 */
export function stepTabs(steps, chosen) {
  const id = (k) => `step-${k}`;
  const tabs = steps.map(([title], k) =>
    h('button', { role: 'tab', id: `${id(k)}-tab`, 'aria-controls': id(k), onclick: () => show(k) }, h('span', { class: 'step-number' }, String(k + 1)), ` ${title}`),
  );
  const panels = steps.map(([title, element], k) =>
    h('section', { id: id(k), role: 'tabpanel', 'aria-labelledby': `${id(k)}-tab` }, h('h2', {}, title), element),
  );
  const show = (at) => {
    tabs.forEach((tab, k) => {
      tab.setAttribute('aria-selected', String(k === at));
      tab.tabIndex = k === at ? 0 : -1;
      panels[k].hidden = k !== at;
    });
    tabs[at].scrollIntoView({ block: 'nearest', inline: 'nearest' });
    /** @type {any} */ (steps[at][1]).shown?.();
    chosen(steps[at][0]);
  };
  const bar = h('div', { class: 'steps', role: 'tablist', 'aria-label': 'Steps' }, tabs);
  bar.addEventListener('keydown', (event) => {
    const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!by) return;
    const at = (tabs.findIndex((tab) => tab.tabIndex === 0) + by + tabs.length) % tabs.length;
    show(at);
    tabs[at].focus();
  });
  queueMicrotask(() => show(0));
  return { tabs: bar, panels: h('div', {}, panels) };
}
