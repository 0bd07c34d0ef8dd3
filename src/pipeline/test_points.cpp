#include "test_points.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/model/model_factory.hpp"
#include "posewright/support/error.hpp"
#include "posewright/workspace/candidates.hpp"
#include "posewright/workspace/workspace.hpp"

namespace posewright {
namespace {

// Test poses must not be candidates of the same draw.
constexpr std::uint64_t other_stream = 0x7e57;

/// The same robot, seen by an instrument that reads the pose of its tip: no targets, so the tool counts.
Problem with_pose_seen(Problem problem) {
  PoseMeasurement pose;
  pose.covariance.setIdentity();
  problem.measurement = {};
  problem.measurement.instrument = pose;
  return problem;
}

std::vector<double> configuration_of(const std::vector<Measured>& written, const std::vector<Coordinate>& coordinates,
                                     const SourcePlace& place) {
  std::vector<double> q;
  for (const Coordinate& c : coordinates) {
    if (c.choice()) {
      q.push_back(c.values.front());
      continue;
    }
    if (q.size() == written.size())
      throw InputError(place, "a test pose has " + std::to_string(written.size()) + " values",
                       "one for each coordinate of the robot is needed");
    const Measured& value = written[q.size()];
    const Quantity own = c.unit == "m" ? Quantity::length : Quantity::angle;
    if (value.quantity != Quantity::number && value.quantity != own)
      throw InputError(place, "a test pose has the wrong unit for '" + c.name + "'",
                       "allowed: " + allowed_units({own}));
    q.push_back(value.value);
  }
  const auto choices = std::count_if(coordinates.begin(), coordinates.end(), [](const auto& c) { return c.choice(); });
  if (written.size() != coordinates.size() - std::size_t(choices))
    throw InputError(place, "a test pose has " + std::to_string(written.size()) + " values",
                     std::to_string(coordinates.size() - std::size_t(choices)) + " coordinates are needed");
  return q;
}

/// Where the test poses are: as written, or evenly through the workspace.
std::vector<std::vector<double>> configurations(const Problem& seen, const IdentificationModel& model,
                                                std::uint64_t seed) {
  const TestPosesSpec& spec = *seen.design.test_poses;
  std::vector<std::vector<double>> result;
  for (const auto& written : spec.at)
    result.push_back(configuration_of(written, model.coordinates(), seen.at(spec.line)));
  if (spec.random == 0) return result;
  const Workspace workspace(model, seen);
  SamplingOptions options;
  options.count = 2 * std::size_t(spec.random);  // the first half are interior points
  options.seed = seed ^ other_stream;
  const Configurations drawn = sample_configurations(workspace, options, Monitor{});
  for (std::size_t i = 0; i < std::min(drawn.count(), std::size_t(spec.random)); ++i)
    result.emplace_back(drawn[i].begin(), drawn[i].end());
  return result;
}

}  // namespace

std::vector<TestPoint> test_points_of(const Problem& problem, const VariantSpec& variant,
                                      const IdentificationModel& model, const VariantColumns& columns,
                                      std::uint64_t seed) {
  std::vector<TestPoint> points;
  if (!problem.design.test_poses) return points;
  if (std::holds_alternative<CompensatorGeometrySpec>(problem.robot))
    throw CannotDo("design: test_poses are those of a robot with a tip; a compensator alone has none");
  const TestPosesSpec& spec = *problem.design.test_poses;
  const Problem seen = with_pose_seen(problem);
  const auto position = make_model(seen, variant);
  // Columns by name: the instrument's own (targets, stations, a lens) do not move the robot.
  std::vector<int> selected, where;
  for (std::size_t j = std::size_t(columns.nuisance); j < columns.selected.size(); ++j) {
    const std::string& name = model.parameters()[std::size_t(columns.selected[j])].name;
    for (int i = 0; i < int(position->parameters().size()); ++i)
      if (position->parameters()[std::size_t(i)].name == name) {
        selected.push_back(i);
        where.push_back(int(j));
      }
  }
  Linearisation scratch;
  for (const std::vector<double>& q : configurations(seen, *position, seed)) {
    if (!position->linearise(q, {}, selected, scratch))
      throw InputError(problem.at(spec.line), "a test pose is out of reach", "configurations that the robot can take");
    TestPoint point{Eigen::MatrixXd::Zero(3, Eigen::Index(columns.selected.size())), 1.0};
    const Eigen::Vector3d from_tip = position->tool_pose(q).linear() * spec.point;
    for (std::size_t c = 0; c < where.size(); ++c) {
      const auto column = scratch.G.col(Eigen::Index(c));
      point.A.col(where[c]) = column.head<3>() + Eigen::Vector3d(column.tail<3>()).cross(from_tip);
    }
    if (!spec.weights.empty()) point.weight = spec.weights[points.size()];
    points.push_back(std::move(point));
  }
  return points;
}

double predicted_error(const std::vector<TestPoint>& points, const Eigen::MatrixXd& covariance,
                       std::vector<double>& each) {
  double sum = 0, total = 0;
  each.clear();
  for (const TestPoint& t : points) {
    const double variance = (t.A * covariance * t.A.transpose()).trace();
    each.push_back(std::sqrt(variance));
    sum += t.weight * variance;
    total += t.weight;
  }
  return std::sqrt(sum / total);
}

}  // namespace posewright
