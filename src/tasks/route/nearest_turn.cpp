#include "nearest_turn.hpp"

#include <cmath>
#include <numbers>

namespace posewright {
namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr double same = 1e-9;  // m, rad, and of columns relative to the largest entry

/// Joint by joint the value within the proposed limits that is nearest to home.
std::vector<double> turned(const std::vector<Coordinate>& limits, std::span<const double> home, std::vector<double> q) {
  for (std::size_t i = 0; i < q.size(); ++i) {
    const Coordinate& c = limits[i];
    if (c.unit != "rad" || c.discrete() || c.periodic) continue;
    const double nearest = q[i] - turn * std::round((q[i] - home[i]) / turn);
    if (nearest >= c.lower && nearest <= c.upper) q[i] = nearest;
  }
  return q;
}

bool is_same(const IdentificationModel& model, const std::vector<int>& columns, std::span<const double> a,
             std::span<const double> b) {
  if (!model.tool_pose(a).isApprox(model.tool_pose(b), same)) return false;
  Linearisation at_a, at_b;
  return model.linearise(a, {}, columns, at_a) && model.linearise(b, {}, columns, at_b) &&
         (at_a.G - at_b.G).cwiseAbs().maxCoeff() <= same * (1 + at_a.G.cwiseAbs().maxCoeff());
}

}  // namespace

std::vector<double> nearest_turn(const Variant& variant, std::span<const double> home, std::vector<double> q) {
  if (!std::holds_alternative<SerialArmSpec>(variant.problem->robot)) return q;
  std::vector<double> other = turned(variant.workspace->proposed(), home, q);
  if (other == q) return q;
  const std::vector<int> columns = all_columns(variant).selected;
  return is_same(*variant.model, columns, q, other) ? other : q;
}

}  // namespace posewright
