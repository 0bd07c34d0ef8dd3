import { h, table } from '../dom.js';
import { fixed, list as joined, number, percent, quantity, shownUnit } from '../text/units.js';
import { choicesOf } from '../text/choices.js';
import { download, posesCsv } from '../save_csv.js';
import { measuringTable } from './measuring_table.js';
import { poseRows } from './pose_rows.js';
import { poseCard } from '../view/pose_card.js';
import { poseMover } from '../view/pose_mover.js';
import { viewer } from '../view/viewer.js';
import { newPoses } from '../text/sentences.js';
import { shell, shellFile } from './reproduce.js';

/** The robot in 3-D beside the list of poses, and what the list is worth.
 * @param {import('../pose_list.js').PoseList} list */
export function posesSection(list) {
  const { element, show } = list.report.keyframes.length > 0 ? viewer(list) : noPicture(list);
  const rows = poseRows(list, show);
  const worth = h('dl', { class: 'worth', 'aria-live': 'polite' });
  const warning = h('p', { class: 'note warn', hidden: true });
  const keep = h('p', { class: 'note', hidden: true });
  const reset = h('button', { onclick: () => list.reset() }, 'Reset');
  const save = h('button', { class: 'main', onclick: () => saveList(list) }, 'Save as poses.csv');
  const update = () => {
    worth.replaceChildren(...worthOf(list));
    reset.disabled = !list.touched;
    save.disabled = list.ids.length === 0;
    const words = warningsOf(list);
    warning.hidden = words.length === 0;
    warning.textContent = words.join(' ');
    keep.hidden = list.locked.size === 0;
    keep.replaceChildren(...keepText(list));
  };
  list.addEventListener('list', update);
  update();
  return h(
    'section',
    { id: 'poses', 'aria-labelledby': 'poses-title' },
    h('h2', { id: 'poses-title' }, 'Poses to measure'),
    h(
      'p',
      { class: 'lead' },
      'Every dot is the tip at one pose. Click a dot or a row to see the robot there. Untick a pose that cannot be measured, and see at once what that costs.',
    ),
    h(
      'div',
      { class: 'bench' },
      element,
      h(
        'div',
        { class: 'side' },
        worth,
        rows,
        warning,
        h('div', { class: 'buttons' }, save, reset),
        keep,
        h(
          'p',
          { class: 'note' },
          'Efficiency: information per parameter compared with the whole plan; 90 % means that errors grow by 1/√0.9 = 1.05 on average. ' +
            'The saved file is what posewright evaluate reads.',
        ),
      ),
    ),
    ...[measuringTable(list), allValues(list)].filter(Boolean),
  );
}

/** What the reader must know of a changed list. @param {import('../pose_list.js').PoseList} list */
function warningsOf(list) {
  const refused = list.ids.filter((id) => list.moves.get(id));
  return [
    refused.length > 0 && `Pose ${joined(refused.map(String))}: not feasible where it is now.`,
    Boolean(list.report.route) &&
      list.changed &&
      'Your list differs from the route: motions between its poses are not checked. Run posewright route again.',
  ].filter(Boolean);
}

/** How a new plan keeps the locked poses. @param {import('../pose_list.js').PoseList} list */
function keepText(list) {
  const locked = list.ids.filter((id) => list.locked.has(id));
  const { plan } = list.report;
  const variant = plan.variant && !(plan.variants?.length > 1) ? ` --variant ${shell(plan.variant)}` : '';
  const command = `posewright plan ${shellFile(plan.problem.file)}${variant} --poses ${newPoses(plan).length} --fixed poses.csv -o new-plan.json --poses-csv new-poses.csv`;
  return [
    `Locked: ${joined(locked.map(String)) || 'none that is ticked'}. The saved list marks them; this keeps them and searches the others: `,
    h('code', {}, command),
  ];
}

/** Models without a single tip are not drawn; their poses can be read all the same. @param {import('../pose_list.js').PoseList} list */
function noPicture(list) {
  const card = h('div', { class: 'pose-card' });
  const title = h('output', { class: 'stop', 'aria-live': 'polite' });
  const fill = () => {
    title.textContent = list.current ? `Pose ${list.current}` : 'Choose a pose to read its values.';
    card.replaceChildren(...(list.current ? poseCard(list) : []));
  };
  list.addEventListener('current', fill);
  fill();
  return {
    element: h('div', { class: 'viewer' }, h('p', { class: 'note' }, 'This kind of robot is not drawn.'), title, card, poseMover(list)),
    show: (id) => list.show(id),
  };
}

/** Every coordinate of every pose, as the list has them now. @param {import('../pose_list.js').PoseList} list */
function allValues(list) {
  const details = h('details', { class: 'printed' }, h('summary', {}, 'All poses in numbers'));
  const fill = () => {
    if (!details.open) return;
    const poses = list.ids.map((id) => list.poses.get(id));
    const { names = [], units = [] } = poses[0] ?? {};
    const shown = units.map((unit) => shownUnit(unit));
    const header = [
      'pose',
      ...choicesOf(poses[0] ?? {}).map(([, name]) => name),
      ...names.map((name, k) => `#${name}${shown[k].name ? `, ${shown[k].name}` : ''}`),
    ];
    details.replaceChildren(
      details.firstElementChild,
      table(
        header,
        poses.map((p) => [
          `${p.id}`,
          ...choicesOf(p).map(([, , label]) => label),
          ...p.configuration.map((v, k) => fixed(v * shown[k].factor, 3)),
        ]),
        'All poses in numbers',
      ),
    );
  };
  details.addEventListener('toggle', fill);
  list.addEventListener('list', fill);
  addEventListener('beforeprint', fill);
  return details;
}

/** @param {import('../pose_list.js').PoseList} list */
function saveList(list) {
  const poses = list.ids.map((id) => list.poses.get(id));
  download('poses.csv', posesCsv(poses, list.report.actuator_units, list.locked), 'text/csv');
}

/** Figures of the list beside the plan's. @param {import('../pose_list.js').PoseList} list */
function worthOf(list) {
  const { figures, planned } = list;
  const entry = (id, title, exact, value, before, hint) =>
    h(
      'div',
      { title: hint },
      h('dt', {}, title),
      h('dd', { id: `list-${id}`, 'data-value': exact }, value),
      h('dd', { class: 'before' }, before),
    );
  const total = list.entries.length;
  const efficiency = entry(
    'efficiency',
    'Efficiency',
    list.efficiency,
    figures.identifiable ? percent(list.efficiency, 2) : 'not identifiable',
    figures.identifiable ? `${list.ids.length} of ${total} poses` : `${figures.stuck} cannot be told`,
    'Information per parameter compared with the whole plan',
  );
  if (!figures.identifiable) efficiency.classList.add('bad');
  const parts = [
    efficiency,
    entry(
      'sigma',
      'Largest σ/tolerance',
      figures.worst?.ratio,
      number(figures.worst?.ratio, 3),
      figures.worst
        ? `${figures.worst.name}; plan ${number(planned.worst?.ratio, 3)}`
        : `plan ${number(planned.worst?.ratio, 3)}`,
      'Predicted standard deviation of the parameter that is known worst, compared with its tolerance',
    ),
    entry(
      'logdet',
      'log det',
      figures.logDet,
      figures.logDet === null ? '–' : number(figures.logDet, 6),
      `plan ${number(planned.logDet, 6)}`,
      'Logarithm of the determinant of the information on the parameters of interest, SI units',
    ),
  ];
  if (planned.rho0 !== null)
    parts.push(
      entry(
        'rho0',
        'Position error',
        figures.rho0,
        quantity(figures.rho0, 'm', 4),
        `plan ${quantity(planned.rho0, 'm', 4)}`,
        'Predicted root mean square of the tip’s position error at the test poses',
      ),
    );
  return parts;
}
