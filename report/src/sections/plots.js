import { h, section } from '../dom.js';
import { curvePlot, expectedPlot, testPosePlot, workspacePlot } from '../plots/accuracy.js';
import { contributionPlot, sensitivityPlot, spectrumPlot } from '../plots/information.js';

/** @param {import('../pose_list.js').PoseList} list */
export function accuracySection(list) {
  const { plan } = list.report;
  const plots = [
    plan.accuracy.test_poses.length > 0 ? testPosePlot(list) : null,
    curvePlot(list),
    workspacePlot(list.report),
    plan.expected_error ? expectedPlot(plan.expected_error) : null,
  ].filter(Boolean);
  if (plots.length === 0) return null;
  return section(
    'accuracy',
    'Accuracy to expect',
    'What calibration with these poses promises, and how it grows with their number.',
    h('div', { class: 'plots' }, plots),
  );
}

/** @param {import('../pose_list.js').PoseList} list */
export function informationSection(list) {
  const { report } = list;
  return section(
    'information',
    'Where the information comes from',
    null,
    h(
      'div',
      { class: 'plots' },
      [contributionPlot(report), spectrumPlot(report), sensitivityPlot(report)].filter(Boolean),
    ),
  );
}
