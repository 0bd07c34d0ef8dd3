import { h, section } from '../dom.js';

/**
 * How a result is made once more.
 * @param {[string, string|undefined|null][]} facts what it is and its value; those without a value are left out
 * @param {string[]} commands
 * @param {string} note
 */
export function repeatSection(facts, commands, note) {
  return section(
    'reproduce',
    'How to repeat this',
    null,
    h(
      'dl',
      { class: 'facts' },
      facts
        .filter(([, value]) => value !== undefined && value !== null && value !== '')
        .map(([title, value]) => h('div', {}, h('dt', {}, title), h('dd', {}, h('code', {}, String(value))))),
    ),
    h('pre', { tabindex: '0' }, commands.join('\n')),
    h('p', { class: 'note' }, note),
  );
}

/** Facts that every result has. @param {any} result @param {{file: string}} report */
export const commonFacts = (result, report) => [
  ['result', report.file],
  ['problem file', result.problem.file],
  ['its sha256', result.problem.sha256],
  ['parameters at', result.problem.parameters?.file],
  ['posewright', result.version],
  ['seed', result.seed],
];
