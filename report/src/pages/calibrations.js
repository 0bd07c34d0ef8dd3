import { h, section, table } from '../dom.js';
import { modelSections, repeatCalibration } from './calibration.js';
import { legPointsSection } from '../sections/leg_points.js';
import { shell } from '../sections/reproduce.js';
import { chance } from '../text/chances.js';
import { number, quantity } from '../text/units.js';

/** @param {any} all calibrations.json */
function choiceSection(all) {
  const rows = all.choice.map((m) => {
    const c = all.models.find((model) => model.variant === m.variant);
    return [
      m.variant === all.recommended ? h('strong', {}, m.variant) : m.variant,
      String(m.parameters),
      number(c.noise_scale, 3),
      number(m.left_out, 3),
      number(c.left_out.placed, 3),
      number(m.aicc, 5),
      m.f === null ? (m.against ?? '') : `${number(m.f, 3)} against ${m.against}`,
      chance(m.probability),
    ];
  });
  return section(
    'choice',
    'Which model?',
    all.recommended ? `Recommended: ${all.recommended}, which ${all.why}.` : `No model is recommended: ${all.why}.`,
    table(
      ['model', '#parameters', '#residuals / noise', '#new poses / noise', '#uncalibrated', '#AICc', 'F', '#p'],
      rows,
      'Models',
    ),
    h(
      'p',
      { class: 'note' },
      'Left out: each pose predicted from the others, in units of the stated noise. A model that fits better and predicts worse describes the noise.',
    ),
    besideEachOther(all),
  );
}

/** Errors by axis of all models. @param {any} all */
function besideEachOther(all) {
  const held = all.models[0].axes.some((a) => a.poses === 'held back');
  const rows = all.models[0].axes.flatMap((axis, k) =>
    axis.poses !== (held ? 'held back' : 'fitted')
      ? []
      : all.models
          .filter((c) => c.axes[k])
          .map((c) => [
            c.axes[k].axis,
            c.variant,
            quantity(c.axes[k].before.rms, axis.unit),
            quantity(c.axes[k].after.rms, axis.unit),
            quantity(c.axes[k].after.largest, axis.unit),
          ]),
  );
  if (rows.length === 0) return null;
  return h(
    'div',
    {},
    h('h3', {}, `Errors of poses ${held ? 'that were not fitted' : 'fitted'}`),
    table(['error', 'model', '#RMS before', '#after', '#largest after'], rows, 'Errors of all models'),
  );
}

/** @param {any} all @param {any} report @returns {import('../page.js').Page} */
export function calibrationsPage(all, report) {
  const start = all.recommended ?? all.models[0].variant;
  const holder = h('div', { id: 'model' });
  const select = h(
    'select',
    { 'aria-label': 'Model', onchange: () => show(select.value) },
    all.models.map((c) => h('option', { value: c.variant, selected: c.variant === start }, c.variant)),
  );
  const show = (variant) => {
    const parts = modelSections(all.models.find((c) => c.variant === variant));
    holder.replaceChildren(...parts.map(([, element]) => element).filter(Boolean));
  };
  show(start);
  const chosen = h('div', {}, h('p', { class: 'choice' }, h('label', {}, 'What follows is of ', select)), holder);
  chosen.id = 'models';
  return {
    kind: `Calibration of ${all.models.length} models, from ${all.data}`,
    heading: report.title,
    title: `Calibration: ${report.title}`,
    sections: [
      ['Which model?', choiceSection(all)],
      ['Legs', legPointsSection(all.models)],
      ['One model', chosen],
      ['Repeat', repeatCalibration(all, report, `--variant ${all.models.map((c) => shell(c.variant)).join(',')}`)],
    ],
  };
}
