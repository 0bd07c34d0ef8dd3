#include "posewright/study/accuracy_configurations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "posewright/formats/pose_formats.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/study/accuracy_points.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/text_file.hpp"
#include "posewright/workspace/candidates.hpp"
#include "posewright/workspace/workspace.hpp"

namespace posewright {
namespace {

// Test poses must not be candidates of the same draw.
constexpr std::uint64_t other_stream = 0x7e57;
// Configurations that a point's own is searched from, nearest first.
constexpr std::size_t drawn_starts = 2000, starts_per_point = 20;
constexpr double reached = 1e-7;  // m
constexpr int newton_steps = 60;

bool loads_the_arm(const LoadCaseSpec& load) { return !load.force.isZero() || !load.moment.isZero() || load.mass > 0; }

/// Its place among the coordinates and its value; nothing if there is no choice.
using Load = std::optional<std::pair<std::size_t, double>>;

/// The load case under which the robot works at the test poses: what is asked for, or the first that loads it.
Load load_case_of(const Variant& variant, const std::vector<Coordinate>& coordinates) {
  const Problem& problem = *variant.problem;
  const TestPosesSpec& spec = *problem.design.test_poses;
  const auto found = std::ranges::find(coordinates, "load_case", &Coordinate::name);
  const auto* arm = std::get_if<SerialArmSpec>(&problem.robot);
  if (found == coordinates.end() || arm == nullptr || !arm->elastostatic) {
    if (!spec.load_case) return std::nullopt;
    throw InputError(problem.at(spec.load_case->line), "design.test_poses.load_case: there is no choice of load cases",
                     "robot.elastostatic with at least two loads");
  }
  const std::vector<LoadCaseSpec>& loads = arm->elastostatic->loads;
  const auto load = std::ranges::find_if(loads, [&](const LoadCaseSpec& l) {
    return spec.load_case ? l.name == spec.load_case->value : loads_the_arm(l);
  });
  if (load == loads.end() && spec.load_case)
    throw InputError(problem.at(spec.load_case->line), "'" + spec.load_case->value + "' is not a load case",
                     fmt::format("allowed: {}", fmt::join(found->labels, ", ")));
  return std::pair(std::size_t(found - coordinates.begin()), load == loads.end() ? 0.0 : double(load - loads.begin()));
}

std::vector<double> configuration_of(const std::vector<Measured>& written, const std::vector<Coordinate>& coordinates,
                                     const SourcePlace& place) {
  std::vector<double> q;
  std::size_t next = 0;
  for (const Coordinate& c : coordinates) {
    if (c.choice()) {
      q.push_back(c.values.front());
      continue;
    }
    if (next == written.size())
      throw InputError(place, "a test pose has " + std::to_string(written.size()) + " values",
                       "one for each coordinate of the robot is needed");
    const Measured& value = written[next++];
    const Quantity own = c.unit == "m" ? Quantity::length : Quantity::angle;
    if (value.quantity != Quantity::number && value.quantity != own)
      throw InputError(place, "a test pose has the wrong unit for '" + c.name + "'",
                       "allowed: " + allowed_units({own}));
    q.push_back(value.value);
  }
  if (next != written.size())
    throw InputError(place, "a test pose has " + std::to_string(written.size()) + " values",
                     std::to_string(next) + " coordinates are needed");
  return q;
}

Configurations draw(const Workspace& workspace, std::size_t count, std::uint64_t seed) {
  SamplingOptions options;
  options.count = 2 * count;  // the first half are interior points
  options.seed = seed ^ other_stream;
  return sample_configurations(workspace, options, Monitor{});
}

/// Configurations whose point of interest is at a given place: damped Gauss–Newton (Levenberg 1944) on the nominal
/// kinematics from the nearest of many feasible configurations; what lies beyond the limits is drawn back.
class Reach {
 public:
  Reach(const IdentificationModel& model, const Workspace& workspace, const Eigen::Vector3d& point, const Load& load,
        std::uint64_t seed)
      : model_(model), workspace_(workspace), point_(point), starts_(draw(workspace, drawn_starts, seed)) {
    for (std::size_t i = 0; load && i < starts_.count(); ++i)
      starts_.values[i * starts_.dimension + load->first] = load->second;
    for (std::size_t i = 0; i < starts_.count(); ++i) places_.push_back(place({starts_[i].begin(), starts_[i].end()}));
  }

  bool solve(const Eigen::Vector3d& target, std::vector<double>& q) const {
    std::vector<std::size_t> order(places_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const std::size_t tries = std::min(order.size(), starts_per_point);
    const auto distance = [&](std::size_t i) { return (places_[i] - target).squaredNorm(); };
    std::partial_sort(order.begin(), order.begin() + std::ptrdiff_t(tries), order.end(),
                      [&](auto a, auto b) { return distance(a) < distance(b); });
    for (std::size_t i = 0; i < tries; ++i) {
      q.assign(starts_[order[i]].begin(), starts_[order[i]].end());
      if (approach(target, q) && workspace_.violation(q) < 0) return true;
    }
    return false;
  }

 private:
  Eigen::Vector3d place(const std::vector<double>& q) const { return model_.tool_pose(q) * point_; }

  bool approach(const Eigen::Vector3d& target, std::vector<double>& q) const {
    double damping = 1e-3;
    Eigen::Vector3d error = target - place(q);
    for (int step = 0; step < newton_steps && error.norm() > reached; ++step) {
      const Eigen::MatrixXd J = jacobian(q);
      const Eigen::MatrixXd normal = J * J.transpose() + damping * Eigen::Matrix3d::Identity();
      const Eigen::VectorXd dq = J.transpose() * normal.ldlt().solve(error);
      std::vector<double> next = q;
      for (std::size_t k = 0; k < q.size(); ++k) {
        const Coordinate& c = workspace_.coordinates()[k];
        if (!c.discrete()) next[k] = std::clamp(q[k] + dq[Eigen::Index(k)], c.lower, c.upper);
      }
      const Eigen::Vector3d left = target - place(next);
      const bool better = left.norm() < error.norm();
      damping = better ? 0.3 * damping : 10 * damping;
      if (!better && damping > 1e6) return false;
      if (better) {
        q = std::move(next);
        error = left;
      }
    }
    return error.norm() <= reached;
  }

  Eigen::MatrixXd jacobian(const std::vector<double>& q) const {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, Eigen::Index(q.size()));
    constexpr double step = 1e-6;
    std::vector<double> near = q;
    for (std::size_t k = 0; k < q.size(); ++k) {
      if (workspace_.coordinates()[k].discrete()) continue;
      near[k] = q[k] + step;
      const Eigen::Vector3d up = place(near);
      near[k] = q[k] - step;
      J.col(Eigen::Index(k)) = (up - place(near)) / (2 * step);
      near[k] = q[k];
    }
    return J;
  }

  const IdentificationModel& model_;
  const Workspace& workspace_;
  Eigen::Vector3d point_;
  Configurations starts_;
  std::vector<Eigen::Vector3d> places_;
};

struct Points {
  std::vector<Eigen::Vector3d> at;
  std::vector<double> weights;
};

Points points_of(const TestPosesSpec::Grid& grid) {
  Points points;
  const auto along = [&](int axis, int i) {
    const int n = grid.counts[std::size_t(axis)];
    const double share = n == 1 ? 0.5 : double(i) / (n - 1);
    return grid.lower[axis] + share * (grid.upper[axis] - grid.lower[axis]);
  };
  for (int i = 0; i < grid.counts[0]; ++i)
    for (int j = 0; j < grid.counts[1]; ++j)
      for (int k = 0; k < grid.counts[2]; ++k) points.at.emplace_back(along(0, i), along(1, j), along(2, k));
  return points;
}

/// First line that is neither empty nor a comment.
std::vector<std::string> header_of(const std::filesystem::path& file) {
  std::istringstream lines(read_text(file, 100'000'000));
  for (std::string line; std::getline(lines, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos && line.front() != '#') return csv_cells(line);
  return {};
}

/// True if the file has columns x, y, z although the robot's coordinates are others: points of a tool path.
bool lists_points(const std::filesystem::path& file, const std::vector<Coordinate>& coordinates) {
  for (const Coordinate& c : coordinates)
    if (c.name == "x") return false;
  for (const std::string& cell : header_of(file))
    if (cell == "x" || cell.starts_with("x [")) return true;
  return false;
}

Points points_from(const std::filesystem::path& file) {
  constexpr double far = 1e6;  // m
  std::vector<Coordinate> axes;
  for (const char* name : {"x", "y", "z"}) {
    Coordinate axis;
    axis.name = name;
    axis.unit = "m";
    axis.lower = -far;
    axis.upper = far;
    axes.push_back(axis);
  }
  PoseList list = read_poses(file, axes);
  Points points;
  for (const auto& p : list.configurations) points.at.emplace_back(p[0], p[1], p[2]);
  points.weights = std::move(list.weights);
  return points;
}

TestConfigurations reach(const Points& points, const Variant& variant, const IdentificationModel& model,
                         const Workspace& workspace, const Load& load, std::uint64_t seed) {
  const TestPosesSpec& spec = *variant.problem->design.test_poses;
  const Reach reach(model, workspace, spec.point, load, seed);
  TestConfigurations result;
  result.weights = points.weights;
  for (const Eigen::Vector3d& target : points.at) {
    result.configurations.emplace_back();
    if (reach.solve(target, result.configurations.back())) continue;
    const SourcePlace place = variant.problem->at(spec.line);
    throw CannotDo(fmt::format(
        "{}{}: the robot does not reach the test point ({:.6g}, {:.6g}, {:.6g}) m within its workspace", place.file,
        place.line > 0 ? fmt::format(":{}", place.line) : "", target.x(), target.y(), target.z()));
  }
  return result;
}

}  // namespace

TestConfigurations test_configurations(const Variant& variant, const IdentificationModel& model, std::uint64_t seed) {
  const Problem seen = with_pose_seen(*variant.problem);
  const TestPosesSpec& spec = *seen.design.test_poses;
  TestConfigurations result;
  result.weights = spec.weights;
  const Load load = load_case_of(variant, model.coordinates());
  for (const auto& written : spec.at) {
    result.configurations.push_back(configuration_of(written, model.coordinates(), seen.at(spec.line)));
    if (load) result.configurations.back()[load->first] = load->second;
  }
  const Workspace workspace(model, seen);
  for (std::size_t i = 0; i < result.configurations.size(); ++i)
    if (const int reason = workspace.violation(result.configurations[i]); reason >= 0)
      throw InputError(seen.at(spec.line),
                       fmt::format("test pose {} is not feasible: {}", i + 1, workspace.reasons()[std::size_t(reason)]),
                       "configurations within the workspace");
  if (!spec.at.empty()) return result;
  if (spec.grid) return reach(points_of(*spec.grid), variant, model, workspace, load, seed);
  if (!spec.file.empty()) {
    if (lists_points(spec.file, workspace.coordinates()))
      return reach(points_from(spec.file), variant, model, workspace, load, seed);
    if (spec.load_case)
      throw InputError(seen.at(spec.load_case->line),
                       "design.test_poses.load_case cannot be combined with a file of configurations",
                       "use the file's column load_case");
    PoseList list = read_poses(spec.file, workspace.coordinates());
    return {std::move(list.configurations), std::move(list.weights)};
  }
  const Configurations drawn = draw(workspace, std::size_t(spec.random), seed);
  for (std::size_t i = 0; i < std::min(drawn.count(), std::size_t(spec.random)); ++i)
    result.configurations.emplace_back(drawn[i].begin(), drawn[i].end());
  if (spec.load_case)
    for (std::vector<double>& q : result.configurations) q[load->first] = load->second;
  return result;
}

}  // namespace posewright
