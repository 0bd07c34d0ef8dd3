import { headingOf } from '../page.js';
import { h } from '../dom.js';
import { PoseList } from '../pose_list.js';
import { percent } from '../text/units.js';
import { summarySection, wordsSection } from '../sections/summary.js';
import { posesSection } from '../sections/poses.js';
import { parametersSection } from '../sections/parameters.js';
import { accuracySection, informationSection } from '../sections/plots.js';
import { robotsSection } from '../sections/robots.js';
import { correlationSection } from '../sections/correlation.js';
import { certificateSection, searchSection } from '../sections/certificate.js';
import { reproduceSection } from '../sections/reproduce.js';

/** That the reader has changed the list, wherever on the page they are. @param {PoseList} list */
function reminder(list) {
  const link = h('a', { class: 'reminder', href: '#poses', hidden: true });
  list.addEventListener('list', () => {
    link.hidden = !list.changed;
    link.textContent = `Your list: ${list.ids.length} of ${list.entries.length} poses, ${list.figures.identifiable ? percent(list.efficiency) : 'not identifiable'}`;
  });
  return link;
}

/** @param {import('../types.js').Report} report @returns {import('../page.js').Page} */
export function planPage(report) {
  const list = new PoseList(report);
  return {
    kind: `Measurement plan for calibration, from ${report.plan.problem.file}`,
    heading: headingOf(report.title, report.plan.variant),
    title: `Measurement plan: ${report.title}`,
    sections: [
      ['In short', summarySection(list)],
      ['Poses', posesSection(list)],
      ['In words', wordsSection(list)],
      ['Parameters', parametersSection(list)],
      ['Accuracy', accuracySection(list)],
      ['Robots', robotsSection(report.plan)],
      ['Information', informationSection(list)],
      ['Correlation', correlationSection(list)],
      ['Certificate', certificateSection(report.plan)],
      ['Search', searchSection(report.plan)],
      ['Repeat', reproduceSection(report)],
    ],
    mark: reminder(list),
  };
}
