import { h } from './dom.js';
import { PoseList } from './pose_list.js';
import { watchTheme } from './theme.js';
import { percent } from './text/units.js';
import { summarySection, wordsSection } from './sections/summary.js';
import { posesSection } from './sections/poses.js';
import { parametersSection } from './sections/parameters.js';
import { accuracySection, informationSection } from './sections/plots.js';
import { correlationSection } from './sections/correlation.js';
import { certificateSection, searchSection } from './sections/certificate.js';
import { reproduceSection } from './sections/reproduce.js';

/** @returns {import('./types.js').Report} */
function readReport() {
  const report = JSON.parse(document.getElementById('report-data').textContent);
  if (report.schema !== 'posewright/report/1')
    throw new Error(`schema ${report.schema}; posewright/report/1 is expected`);
  return report;
}

/** That the reader has changed the list, wherever on the page they are. @param {PoseList} list */
function reminder(list) {
  const link = h('a', { class: 'reminder', href: '#poses', hidden: true });
  list.addEventListener('list', () => {
    link.hidden = !list.changed;
    link.textContent = `Your list: ${list.ids.length} of ${list.entries.length} poses, ${list.figures.identifiable ? percent(list.efficiency) : 'not identifiable'}`;
  });
  return link;
}

/** @param {import('./types.js').Report} report */
function build(report) {
  document.getElementById('kind').append(`, from ${report.plan.problem.file}`);
  document.title = `Measurement plan: ${report.title}`;
  const list = new PoseList(report);
  const sections = [
    summarySection(list),
    posesSection(list),
    wordsSection(list),
    parametersSection(list),
    accuracySection(list),
    informationSection(list),
    correlationSection(list),
    certificateSection(report.plan),
    searchSection(report.plan),
    reproduceSection(report),
  ].filter((s) => s !== null);
  const titles = {
    summary: 'In short',
    poses: 'Poses',
    words: 'In words',
    parameters: 'Parameters',
    accuracy: 'Accuracy',
    information: 'Information',
    correlation: 'Correlation',
    certificate: 'Certificate',
    search: 'Search',
    reproduce: 'Repeat',
  };
  // A long path may break after its slashes.
  document
    .getElementById('title')
    .replaceChildren(...report.title.split(/(?<=\/)/).flatMap((part) => [part, h('wbr')]));
  document
    .getElementById('contents')
    .append(...sections.map((s) => h('a', { href: `#${s.id}` }, titles[s.id])), reminder(list));
  document.getElementById('page').append(...sections);
  document.getElementById('version').textContent = `posewright ${report.version}`;
}

watchTheme();
try {
  build(readReport());
} catch (error) {
  document
    .getElementById('page')
    .append(h('p', { class: 'warnings' }, `This report cannot be shown: ${error.message}.`));
  throw error;
}
