import { h } from '../dom.js';

/** The page that the program writes, as it is, in a frame that is as high as what it shows. */
export function resultFrame() {
  const title = h('h2', { id: 'result-title' }, 'Result');
  const holder = h('div', {});
  const element = h('section', { id: 'result', class: 'result', hidden: true, 'aria-labelledby': 'result-title' }, title, holder);
  return {
    element,
    /** @param {string} what @param {string} html */
    show(what, html) {
      title.textContent = what;
      const frame = h('iframe', { title: what, srcdoc: html });
      frame.addEventListener('load', () => {
        const { documentElement } = frame.contentDocument;
        new ResizeObserver(() => (frame.style.height = `${documentElement.offsetHeight + 4}px`)).observe(documentElement);
      });
      holder.replaceChildren(frame);
      element.hidden = false;
      element.scrollIntoView({ block: 'start' });
    },
  };
}
