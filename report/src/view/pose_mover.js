import { h } from '../dom.js';
import { posesCsv } from '../save_csv.js';
import { nearestText } from '../text/sentences.js';
import { coordinate, shownUnit } from '../text/units.js';

/** The program of the page around this one, which judges poses: posewright.html puts it at the frame. */
const judge = /** @type {((csv: string) => Promise<any>)|undefined} */ (/** @type {any} */ (window.frameElement)?.judge);

/**
 * Sliders that move the pose shown. Everything that a moved pose changes is what the program computes there.
 * @param {import('../pose_list.js').PoseList} list
 */
export function poseMover(list) {
  if (!judge)
    return h('p', { class: 'note' }, 'Poses are moved in posewright.html: drop the problem file, its robot and plan.json there. The program in that page judges each place.');
  const rows = h('div', { class: 'sliders' });
  const verdict = h('p', { class: 'verdict', 'aria-live': 'polite' });
  const back = h('button', { class: 'small', onclick: () => putBack(list.current) }, 'Put it back');
  const title = h('summary', {});
  const note = h('p', { class: 'note' }, 'Feasibility, clearance, sights and the figures of the list are those that posewright computes where the pose is. A pose that is moved is locked.');
  const element = h('details', { class: 'mover', ontoggle: () => fill() }, title, rows, verdict, h('p', {}, back), note);
  let shown = /** @type {number|null} */ (null);
  let wanted = /** @type {{id: number, configuration: number[]}|null} */ (null);
  let asking = false;

  const putBack = (id) => {
    wanted = null;
    list.putBack(id);
    shown = null;
    fill();
  };
  /** Asks of the last place wanted; those before it are passed over. */
  const ask = async (id, configuration) => {
    wanted = { id, configuration };
    if (asking) return;
    asking = true;
    while (wanted) {
      const now = wanted;
      wanted = null;
      verdict.dataset.asked = 'yes';
      const pose = { ...list.poses.get(now.id), configuration: now.configuration, actuators: undefined };
      const answer = await judge(posesCsv([pose]));
      if (now.id === list.current && element.open && !(wanted && wanted.id !== now.id)) take(now, answer);
    }
    delete verdict.dataset.asked;
    asking = false;
  };
  const take = ({ id, configuration }, answer) => {
    if (answer.failed) return verdict.replaceChildren(answer.failed);
    const [judged] = answer.poses;
    if (shown !== id) build(id, answer.ranges);
    if (configuration !== list.poses.get(id).configuration) list.place(id, judged);
    verdict.replaceChildren(...verdictOf(judged));
    back.disabled = !list.moves.has(id);
  };
  const build = (id, ranges) => {
    const { names, units, configuration } = list.poses.get(id);
    const values = [...configuration];
    rows.replaceChildren(
      ...ranges.map(({ index, lower, upper }) => {
        const { factor } = shownUnit(units[index]);
        const value = h('output', {}, coordinate(values[index], units[index]));
        const input = h('input', {
          type: 'range',
          min: tenths(Math.ceil(lower * factor * 10 - 1e-6)),
          max: tenths(Math.floor(upper * factor * 10 + 1e-6)),
          step: 0.1,
          'aria-label': `${names[index]} of pose ${id}`,
          oninput: () => {
            values[index] = Math.min(upper, Math.max(lower, input.valueAsNumber / factor));
            value.textContent = coordinate(values[index], units[index]);
            input.setAttribute('aria-valuetext', value.textContent);
            ask(id, [...values]);
          },
        });
        input.value = String(values[index] * factor);
        input.setAttribute('aria-valuetext', value.textContent);
        return h('label', {}, h('span', {}, names[index]), input, value);
      }),
    );
    shown = id;
  };
  const fill = () => {
    const id = list.current;
    element.hidden = id === null || !list.poses.has(id) || list.poses.get(id).measured === true;
    if (element.hidden) return;
    title.textContent = `Move pose ${id}`;
    if (!element.open || shown === id) return;
    rows.replaceChildren();
    verdict.replaceChildren('The program looks at this pose…');
    back.disabled = true;
    ask(id, list.poses.get(id).configuration);
  };
  list.addEventListener('current', () => {
    shown = null;
    fill();
  });
  list.addEventListener('list', () => {
    // Reset puts all poses back.
    if (shown !== null && !list.moves.has(shown) && !back.disabled) {
      shown = null;
      fill();
    }
  });
  fill();
  return element;
}

/** @param {number} count */
const tenths = (count) => (count / 10).toFixed(1);

/** @param {import('../types.js').JudgedPose} judged */
function verdictOf({ reason, pose }) {
  const words = reason === null ? [h('b', { class: 'allowed' }, 'Feasible here')] : [h('b', { class: 'forbidden' }, 'Not feasible here'), `: ${reason}`];
  if (pose.nearest) words.push(`; ${nearestText(pose.nearest)}`);
  return [...words, '.'];
}
