/** Lines of sight at a stop. */

/** A beam from every station to the targets of its instrument that are drawn. @param {import('../types.js').Report} report @param {(number[]|null)[]} targets @param {boolean} hidden @returns {Sight[]} */
export const beams = (report, targets, hidden) =>
  report.stations.flatMap(({ instrument, placement }) =>
    targets
      .filter((_, k) => !instrument || report.targets[k].startsWith(`${instrument}.`))
      .flatMap((to) => (to ? [{ from: placement.slice(0, 3), to, hidden, label: '' }] : [])),
  );

/**
 * @typedef {{from: number[], to: number[], hidden: boolean, label: string}} Sight
 * @param {import('../types.js').Report} report
 * @param {any} pose of plan.json
 * @param {(number[]|null)[]} targets where they are now, in the order of report.targets
 * @returns {Sight[]}
 */
export function sightsOf(report, pose, targets) {
  // Of several instruments nobody judges whether something stands between.
  if (pose?.instrument) return beams(report, targets, false);
  const stations = new Map(report.stations.map((s) => [s.name, s.placement.slice(0, 3)]));
  const seen = pose?.targets ?? [];
  const sights = [];
  for (const sight of seen) {
    const from = stations.get(sight.station);
    const to = targets[report.targets.indexOf(sight.target)];
    if (!from || !to) continue;
    const hidden = sight.visible === false;
    sights.push({
      from,
      to,
      hidden,
      label: `${sight.target} from ${sight.station}${hidden ? `: hidden (${sight.hidden_by})` : ''}`,
    });
  }
  return sights;
}
