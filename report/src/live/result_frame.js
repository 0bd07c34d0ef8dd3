import { h } from '../dom.js';

/**
 * The page that the program writes, as it is, in a frame that is as high as what it shows.
 * @param {import('./project.js').Project} project @param {(csv: string) => Promise<any>} judged what the program says of poses
 */
export function resultFrame(project, judged) {
  const title = h('h2', { id: 'result-title' }, 'Result');
  const holder = h('div', {});
  const element = h('section', { id: 'result', class: 'result', hidden: true, 'aria-labelledby': 'result-title' }, title, holder);
  let shown = { what: '', text: '' };
  const tell = () => (title.textContent = project.text === shown.text ? shown.what : `${shown.what}, of the problem before it was changed`);
  project.addEventListener('text', tell);
  return {
    element,
    /** @param {string} what @param {string} html */
    show(what, html) {
      shown = { what, text: project.text };
      tell();
      const frame = h('iframe', { title: what, srcdoc: html });
      const { text } = shown;
      frame.judge = async (csv) => (project.text === text ? judged(csv) : { failed: 'The problem has changed since this plan: undo the change, or plan again.' });
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
