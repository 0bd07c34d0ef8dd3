import { h, section } from '../dom.js';
import { commonFacts, repeatSection } from '../parts/repeat.js';
import { CellViewer } from '../view/cell_viewer.js';

/** @param {any} report @returns {HTMLElement|null} */
function faultsSection(report) {
  const all = [...report.faults, ...report.notes];
  if (all.length === 0) return null;
  return section('faults', 'What is wrong', null, h('div', { class: 'warnings' }, h('ul', {}, all.map((text) => h('li', {}, text)))));
}

/** A problem before any plan. @param {any} report schema posewright/report-of-problem/1 @returns {import('../page.js').Page} */
export function problemPage(report) {
  const viewer = new CellViewer();
  const lead = `Robot and cell at home and at ${report.keyframes.length - 1} configurations: ${report.evenly} drawn evenly within the limits, the others feasible. Shares are of the even ones.`;
  const page = {
    kind: 'Problem, before a plan',
    heading: report.title,
    title: `Problem: ${report.title}`,
    sections: /** @type {[string, HTMLElement|null][]} */ ([
      ['What is wrong', faultsSection(report)],
      ['Cell', section('cell', 'Cell', lead, viewer.element)],
      ['Repeat', repeatSection(commonFacts(report, {}), [`posewright report ${report.problem.file}`], 'Configurations depend on the seed alone.')],
    ]),
  };
  viewer.show(report);
  return page;
}
