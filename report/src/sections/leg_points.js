import { section } from '../dom.js';
import { amplification, largestDeviation } from '../numerics/leg_points.js';
import { legPointsPlot } from '../plots/leg_points.js';
import { list, quantity } from '../text/units.js';

/** Where the legs' points are by the estimate; null without legs, and where no model moves a point in the plane.
 * @param {any[]} models calibration.json of each */
export function legPointsSection(models) {
  const shown = models.filter((c) => c.leg_points.length > 0).map((c) => ({ name: c.variant, points: c.leg_points }));
  if (amplification(shown.flatMap((m) => m.points)) === 0) return null;
  const most = shown.map((m) => `${quantity(largestDeviation(m.points), 'm', 3)} by ${m.name}`);
  return section(
    'leg-points',
    'Points of the legs',
    `Farthest from nominal: ${list(most)}.`,
    legPointsPlot(shown),
  );
}
