import { h } from '../dom.js';
import { nearestText } from '../text/sentences.js';
import { coordinate, percent } from '../text/units.js';

/**
 * Sliders that move the pose shown, and what is known of it there.
 * @param {import('../pose_list.js').PoseList} list
 */
export function poseMover(list) {
  const rows = h('div', { class: 'sliders' });
  const verdict = h('p', { class: 'verdict', 'aria-live': 'polite' });
  const back = h('button', { class: 'small', onclick: () => list.putBack(list.current) }, 'Put it back');
  const title = h('summary', {});
  const element = h('details', { class: 'mover', open: true }, title, rows, verdict, h('p', {}, back));
  let shown = /** @type {{id: number|null, sliders: any[]}} */ ({ id: null, sliders: [] });

  const build = (id) => {
    const names = list.poses.get(id).names;
    const sliders = list.coordinates(id).map(({ index, least, most }, j) => {
      const value = h('output', {});
      const input = h('input', {
        type: 'range',
        min: least,
        max: most,
        step: 1,
        'aria-label': `${names[index]} of pose ${id}`,
        oninput: () => list.moveTo(id, j, Number(input.value)),
      });
      return { input, value, index, row: h('label', {}, h('span', {}, names[index]), input, value) };
    });
    rows.replaceChildren(...sliders.map((s) => s.row));
    shown = { id, sliders };
  };
  const fill = () => {
    const id = list.current;
    element.hidden = id === null || !list.neighbours.has(id);
    if (element.hidden) return;
    if (shown.id !== id) build(id);
    const pose = list.poses.get(id);
    const steps = list.steps(id);
    shown.sliders.forEach(({ input, value, index }, j) => {
      if (input.value !== String(steps[j])) input.value = String(steps[j]);
      value.textContent = coordinate(pose.configuration[index], pose.units[index]);
      input.setAttribute('aria-valuetext', value.textContent);
    });
    title.textContent = `Move pose ${id}`;
    back.disabled = !list.moves.has(id);
    verdict.replaceChildren(...verdictOf(list, id));
  };
  for (const event of ['list', 'current']) list.addEventListener(event, fill);
  fill();
  return h('div', {}, element, h('p', { class: 'note' }, reading(list)));
}

/** @param {import('../pose_list.js').PoseList} list @param {number} id */
function verdictOf(list, id) {
  if (!list.moves.has(id)) return ['Where the plan has it.'];
  const known = list.known(id);
  if (!known)
    return [
      h('b', { class: 'unknown' }, 'Not known here'),
      `: feasibility, clearance and figures are held for ${within(list, id)}. Save the list; posewright evaluate, or plan --fixed, tells.`,
    ];
  const words =
    known.reason === null ? [h('b', { class: 'allowed' }, 'Feasible here')] : [h('b', { class: 'forbidden' }, 'Not feasible here'), `: ${known.reason}`];
  if (known.nearest) words.push(`; ${nearestText(known.nearest)}`);
  words.push('.');
  if (!known.told) words.push(' The figures of the list leave this pose out: what it tells changes too much on the way here.');
  return words;
}

/** @param {import('../pose_list.js').PoseList} list @param {number} id */
function within(list, id) {
  const { reach } = list.report.neighbours;
  const { names, units } = list.poses.get(id);
  const parts = list.coordinates(id).map(({ index, step }) => ({ name: names[index], text: coordinate(reach * step, units[index]) }));
  const texts = [...new Set(parts.map((p) => p.text))];
  const ranges = texts.length === 1 ? `±${texts[0]}` : parts.map((p) => `${p.name} ±${p.text}`).join(', ');
  return `one or two coordinates moved by at most ${ranges}`;
}

/** What the figures of a moved pose are. @param {import('../pose_list.js').PoseList} list */
function reading(list) {
  const { neighbours, why_no_neighbours: why } = list.report;
  if (!neighbours) return `Poses cannot be moved on this page: ${why ?? 'it holds nothing of what is near to them'}.`;
  const { efficiency, sigma, rho0 } = neighbours.errors;
  return (
    `Feasibility and clearance near a pose, in whole steps of one or two coordinates, are what posewright computed there. ` +
    `Figures of the list are interpolated; at each of these ${neighbours.places.length} places a pose they were compared with the model’s: ` +
    `with one moved pose efficiency is off by at most ${percent(efficiency, 3)}, a σ by ${percent(sigma, 2)}` +
    `${rho0 > 0 ? `, the position error by ${percent(rho0, 2)}` : ''}. A pose that is moved is locked.`
  );
}
