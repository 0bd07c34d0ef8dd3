#include "posewright/study/accuracy_points.hpp"

#include <cmath>

#include "posewright/model/model_factory.hpp"
#include "posewright/study/accuracy_configurations.hpp"
#include "posewright/support/error.hpp"

namespace posewright {

Problem with_pose_seen(Problem problem) {
  PoseMeasurement pose;
  pose.covariance.setIdentity();
  problem.measurement = {};
  problem.measurement.instrument = pose;
  return problem;
}

std::unique_ptr<IdentificationModel> make_pose_seen(const Problem& problem, const VariantSpec& variant,
                                                    const IdentificationModel& model) {
  Problem seen = with_pose_seen(problem);
  seen.parameters.reset();
  if (auto* arm = std::get_if<SerialArmSpec>(&seen.robot)) arm->parameter_names.clear();
  VariantSpec plain = variant;
  plain.nominal.clear();
  std::unique_ptr<IdentificationModel> result = make_model(seen, plain);
  for (int i = 0; i < int(result->parameters().size()); ++i) {
    const Parameter& own = result->parameters()[std::size_t(i)];
    for (const Parameter& p : model.parameters())
      if (p.name == own.name && p.nominal != own.nominal) {
        result->set_nominal(i, p.nominal);
        break;
      }
  }
  return result;
}

std::vector<TestPoint> test_points_of(const Problem& problem, const VariantSpec& variant,
                                      const IdentificationModel& model, const VariantColumns& columns,
                                      std::uint64_t seed) {
  std::vector<TestPoint> points;
  if (!problem.design.test_poses) return points;
  if (std::holds_alternative<CompensatorGeometrySpec>(problem.robot))
    throw CannotDo("design: test_poses are those of a robot with a tip; a compensator alone has none");
  const TestPosesSpec& spec = *problem.design.test_poses;
  const Problem seen = with_pose_seen(problem);
  const auto position = make_pose_seen(problem, variant, model);
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
  const TestConfigurations places = test_configurations(seen, *position, seed);
  for (const std::vector<double>& q : places.configurations) {
    if (!position->linearise(q, {}, selected, scratch))
      throw InputError(problem.at(spec.line), "a test pose is out of reach", "configurations that the robot can take");
    const auto m = Eigen::Index(columns.selected.size());
    TestPoint point{Eigen::MatrixXd::Zero(3, m), 1.0, Eigen::MatrixXd::Zero(3, m)};
    const Eigen::Vector3d from_tip = position->tool_pose(q).linear() * spec.point;
    for (std::size_t c = 0; c < where.size(); ++c) {
      const auto column = scratch.G.col(Eigen::Index(c));
      point.A.col(where[c]) = column.head<3>() + Eigen::Vector3d(column.tail<3>()).cross(from_tip);
      point.turn.col(where[c]) = column.tail<3>();
    }
    if (!places.weights.empty()) point.weight = places.weights[points.size()];
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

double predicted_turn(const std::vector<TestPoint>& points, const Eigen::MatrixXd& covariance,
                      std::vector<std::array<double, 6>>& axes) {
  double sum = 0, total = 0;
  axes.clear();
  for (const TestPoint& t : points) {
    const Eigen::Vector3d moved = (t.A * covariance * t.A.transpose()).diagonal();
    const Eigen::Vector3d turned = (t.turn * covariance * t.turn.transpose()).diagonal();
    std::array<double, 6> sigma{};
    for (std::size_t k = 0; k < 3; ++k) {
      sigma[k] = std::sqrt(moved[Eigen::Index(k)]);
      sigma[k + 3] = std::sqrt(turned[Eigen::Index(k)]);
    }
    axes.push_back(sigma);
    sum += t.weight * turned.sum();
    total += t.weight;
  }
  return std::sqrt(sum / total);
}

}  // namespace posewright
