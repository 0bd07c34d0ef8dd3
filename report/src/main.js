import { h } from './dom.js';
import { showPage } from './page.js';
import { keepUpToDate } from './refresh.js';
import { watchTheme } from './theme.js';
import { calibrationPage } from './pages/calibration.js';
import { calibrationsPage } from './pages/calibrations.js';
import { comparisonPage } from './pages/comparison.js';
import { nextPage } from './pages/next.js';
import { planPage } from './pages/plan.js';
import { problemPage } from './pages/problem.js';
import { simulationPage } from './pages/simulation.js';
import { stationsPage } from './pages/stations.js';
import { twoPlansPage } from './pages/two_plans.js';

/** One row a result that has a page. @type {Object<string, (result: any, report: any) => import('./page.js').Page>} */
const results = {
  'posewright/calibration/1': calibrationPage,
  'posewright/calibrations/1': calibrationsPage,
  'posewright/comparison/1': comparisonPage,
  'posewright/simulation/1': simulationPage,
  'posewright/next/1': nextPage,
  'posewright/stations/1': stationsPage,
};

/** @type {Object<string, (report: any) => import('./page.js').Page>} */
const pages = {
  'posewright/report/1': planPage,
  'posewright/report-of-problem/1': problemPage,
  'posewright/report-of-result/1': (report) => pageOf(results, report.result.schema)(report.result, report),
  'posewright/report-of-two-plans/1': twoPlansPage,
};

/** @param {Object<string, any>} table @param {string} schema */
function pageOf(table, schema) {
  if (!Object.hasOwn(table, schema)) throw new Error(`schema ${schema}; ${Object.keys(table).join(', ')} are expected`);
  return table[schema];
}

watchTheme();
try {
  const report = JSON.parse(document.getElementById('report-data').textContent);
  showPage(pageOf(pages, report.schema)(report), report.version);
  keepUpToDate(report);
} catch (error) {
  document
    .getElementById('page')
    .append(h('p', { class: 'warnings' }, `This report cannot be shown: ${error.message}.`));
  throw error;
}
