import { h } from './dom.js';

/**
 * What stands on a page.
 * @typedef {object} Page
 * @property {string} kind what it is, above the heading
 * @property {string} heading
 * @property {string} title of the window
 * @property {[string, HTMLElement|null][]} sections with what the contents call them
 * @property {HTMLElement} [mark] stands in the contents' bar, to the right
 */

/** @param {Page} page @param {string} version */
export function showPage({ kind, heading, title, sections, mark }, version) {
  document.getElementById('kind').textContent = kind;
  document.title = title;
  const shown = sections.filter(([, element]) => element);
  // A long path may break after its slashes.
  document.getElementById('title').replaceChildren(...heading.split(/(?<=\/)/).flatMap((part) => [part, h('wbr')]));
  document.getElementById('contents').append(...shown.map(([name, element]) => h('a', { href: `#${element.id}` }, name)), mark ?? '');
  document.getElementById('page').append(...shown.map(([, element]) => element));
  document.getElementById('version').textContent = `posewright ${version}`;
}

/** What a result belongs to. @param {string} robot @param {string} [variant] of several, none */
export const headingOf = (robot, variant) => (variant ? `${robot}, variant ${variant}` : robot);
