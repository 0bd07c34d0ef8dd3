import { h, table } from '../dom.js';
import { duration, fixed, missing } from '../text/units.js';

const degrees = 180 / Math.PI;

/** What an operator looks for: how far the instrument has to look, how obliquely, and how near things come, pose by pose
 * and on the way there, in the order of the list. @param {import('../pose_list.js').PoseList} list */
export function measuringTable(list) {
  if (columnsOf(list).length < 2) return null;
  const holder = h('div', { class: 'measuring' });
  const fill = () => {
    const columns = columnsOf(list);
    holder.replaceChildren(
      table(
        columns.map((column) => column.title),
        list.ids.map((id, place) => columns.map((column) => column.text(list.poses.get(id), place) ?? missing)),
        'Pose by pose',
      ),
    );
  };
  list.addEventListener('list', fill);
  fill();
  return h('div', {}, h('h3', {}, 'Pose by pose'), holder, h('p', { class: 'note' }, reading(list)));
}

/** @param {any} pose */
const seen = (pose) => (pose.targets ?? []).filter((t) => t.visible !== false);

/** @param {any} pose @param {(target: any) => number|undefined} of */
function largest(pose, of) {
  const values = seen(pose)
    .map(of)
    .filter((v) => Number.isFinite(v));
  return values.length > 0 ? Math.max(...values) : undefined;
}

const text = (value, factor, decimals) => (value === undefined ? undefined : fixed(value * factor, decimals));

/** @param {{distance: number, between: [string, string]}|undefined} nearest */
const clearance = (nearest) => (nearest ? `${fixed(nearest.distance * 1000, 1)} ${nearest.between.join(' – ')}` : undefined);

/** The motion of the route that leads to a place of the list, to its first from home or from the last; none if the list
 * goes elsewhere. @param {import('../pose_list.js').PoseList} list @param {number} place */
function motionTo(list, place) {
  const { ids } = list;
  if (list.moves.has(ids[place]) || (place > 0 && list.moves.has(ids[place - 1]))) return undefined;
  const before = place > 0 ? [ids[place - 1]] : [0, ids.at(-1)];
  return list.report.route?.motions.find((m) => m.to === ids[place] && before.includes(m.from));
}

/** Columns of which at least one pose has something to say. @param {import('../pose_list.js').PoseList} list */
function columnsOf(list) {
  const poses = [...list.poses.values()];
  const motions = list.report.route?.motions ?? [];
  const looked = (of) => poses.some((p) => largest(p, of) !== undefined);
  const judged = poses.some((p) => (p.targets ?? []).some((t) => t.visible !== null));
  return [
    { title: 'pose', text: (p) => String(p.id), wanted: true },
    { title: 'station', text: (p) => p.station, wanted: poses.some((p) => p.station) },
    {
      title: 'targets seen',
      text: (p) => (p.targets?.length ? `${seen(p).length} of ${p.targets.length}` : undefined),
      wanted: judged,
    },
    {
      title: '#distance, m',
      text: (p) => text(largest(p, (t) => t.distance), 1, 2),
      wanted: looked((t) => t.distance),
    },
    {
      title: '#incidence, deg',
      text: (p) => text(largest(p, (t) => t.incidence), degrees, 0),
      wanted: looked((t) => t.incidence),
    },
    { title: 'clearance, mm', text: (p) => clearance(p.nearest), wanted: poses.some((p) => p.nearest) },
    {
      title: '#way there',
      text: (p, place) => {
        const motion = motionTo(list, place);
        return motion && duration(motion.seconds);
      },
      wanted: motions.length > 0,
    },
    {
      title: 'clearance on the way, mm',
      text: (p, place) => clearance(motionTo(list, place)?.nearest),
      wanted: motions.some((m) => m.nearest),
    },
  ].filter((column) => column.wanted);
}

/** How to read the columns. @param {import('../pose_list.js').PoseList} list */
function reading(list) {
  const titles = columnsOf(list).map((column) => column.title);
  return [
    titles.includes('#distance, m') && 'Distance and incidence: the largest of the targets that are seen.',
    titles.includes('clearance, mm') && 'Clearance: of the two bodies that are nearest; the picture marks them.',
    titles.includes('#way there') && 'No way there: the route has no motion to this pose from the one before it.',
  ]
    .filter(Boolean)
    .join(' ');
}
