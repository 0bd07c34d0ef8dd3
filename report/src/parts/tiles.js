import { h } from '../dom.js';

/** A figure, what it is, and what to know of it. @param {string} value @param {string} title @param {string} hint */
export const tile = (value, title, hint) => h('div', { class: 'tile' }, h('b', {}, value), h('span', {}, title), h('small', {}, hint));

/** What the reader must know before anything else. @param {string[]} warnings */
export const warningBox = (warnings) =>
  warnings.length === 0
    ? null
    : h(
        'div',
        { class: 'warnings', role: 'note' },
        h('h3', {}, 'Please note'),
        h(
          'ul',
          {},
          warnings.map((w) => h('li', {}, w)),
        ),
      );

/** The first part of every page: figures and warnings. @param {(HTMLElement|null)[]} tiles @param {string[]} warnings */
export const inShort = (tiles, warnings = []) =>
  h(
    'section',
    { id: 'summary', class: 'plain', 'aria-label': 'In short' },
    h('div', { class: 'tiles' }, tiles.filter(Boolean)),
    warningBox(warnings),
  );

/** Sentences as a section of their own. @param {(string|false|null|undefined)[]} sentences */
export function inWords(sentences) {
  const said = sentences.filter(Boolean);
  if (said.length === 0) return null;
  return h(
    'section',
    { id: 'words', 'aria-labelledby': 'words-title' },
    h('h2', { id: 'words-title' }, 'In words'),
    h(
      'ul',
      { class: 'sentences' },
      said.map((s) => h('li', {}, s)),
    ),
  );
}
