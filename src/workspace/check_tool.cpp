#include <algorithm>

#include "checks.hpp"
#include "posewright/model/readable.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

/// Reach and range of the instrument for the nominal robot and for drawn ones.
class MeasurableCheck : public ValidityCheck {
 public:
  MeasurableCheck(const IdentificationModel& model, std::span<const std::vector<double>> robots)
      : model_(model), robots_(robots.begin(), robots.end()) {}

  std::vector<std::string> reasons() const override {
    std::vector<std::string> reasons = {model_.unmeasurable_reason()};
    if (!robots_.empty()) reasons.push_back(reasons.front() + " within the tolerances");
    return reasons;
  }
  int violation(std::span<const double> q) const override {
    if (!model_.measurable(q)) return 0;
    static thread_local std::vector<double> stands;
    stands.resize(q.size());
    for (const std::vector<double>& robot : robots_)
      if (!readable(model_, q, robot, stands)) return 1;
    return -1;
  }
  std::optional<int> margins() const override { return robots_.empty() ? model_.measurable_margins() : std::nullopt; }
  bool margins_at(std::span<const double> q, std::span<double> out) const override {
    return model_.measurable_margins_at(q, out);
  }

 private:
  const IdentificationModel& model_;
  std::vector<std::vector<double>> robots_;
};

class ToolBoxCheck : public SingleCheck {
 public:
  ToolBoxCheck(const IdentificationModel& model, ToolBoxSpec box)
      : SingleCheck("tool outside its box"), model_(model), box_(std::move(box)) {}

  NecessaryLimits necessary_limits() const override {
    NecessaryLimits limits;
    limits.names = {"tool box"};
    limits.values = 3;
    const ToolBoxSpec everywhere;
    for (int i = 0; i < limits.values; ++i) {
      if (box_.lower[i] > everywhere.lower[i]) limits.of_points.push_back({i, 1.0, -box_.lower[i]});
      if (box_.upper[i] < everywhere.upper[i]) limits.of_points.push_back({i, -1.0, box_.upper[i]});
    }
    return limits;
  }
  void necessary_values(std::span<const double> q, std::span<double> values) const override {
    const Eigen::Vector3d p = model_.tool_pose(q) * box_.point;
    std::copy_n(p.data(), 3, values.begin());
  }

 private:
  bool holds(std::span<const double> q) const override {
    const Eigen::Vector3d p = model_.tool_pose(q) * box_.point;
    return (p.array() >= box_.lower.array()).all() && (p.array() <= box_.upper.array()).all();
  }
  const IdentificationModel& model_;
  ToolBoxSpec box_;
};

/// The smallest singular value of the tip's Jacobian about its own origin: how far the slowest direction moves per
/// radian (or metre) of the joints.
class SingularityCheck : public SingleCheck {
 public:
  SingularityCheck(const IdentificationModel& model, SingularitySpec spec)
      : SingleCheck("near a singularity"), model_(model), spec_(spec) {}

 private:
  bool holds(std::span<const double> q) const override {
    Eigen::Matrix<double, 6, Eigen::Dynamic> J;
    if (!model_.reading_twists(q, J)) return false;
    const Eigen::Vector3d p = model_.tool_pose(q).translation();
    for (Eigen::Index c = 0; c < J.cols(); ++c) {
      J.col(c).head<3>() += Eigen::Vector3d(J.col(c).tail<3>()).cross(p);
      J.col(c).head<3>() /= spec_.length;
    }
    const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(J).singularValues();
    return singular[std::min<Eigen::Index>(6, J.cols()) - 1] >= spec_.smallest;
  }
  const IdentificationModel& model_;
  SingularitySpec spec_;
};

}  // namespace

void add_measurable_check(const CheckContext& context, Checks& checks) {
  if (!context.model.unmeasurable_reason().empty())
    checks.push_back(std::make_unique<MeasurableCheck>(context.model, context.robots));
}

void add_tool_check(const CheckContext& context, Checks& checks) {
  if (context.problem.workspace.tool)
    checks.push_back(std::make_unique<ToolBoxCheck>(context.model, *context.problem.workspace.tool));
}

void add_singularity_check(const CheckContext& context, Checks& checks) {
  const auto& spec = context.problem.workspace.singularity;
  if (!spec) return;
  std::vector<double> q;
  for (const Coordinate& c : context.coordinates)
    q.push_back(c.discrete() ? c.values.front() : 0.5 * (c.lower + c.upper));
  Eigen::Matrix<double, 6, Eigen::Dynamic> J;
  J.resize(6, 0);
  context.model.reading_twists(q, J);
  if (J.cols() == 0)
    throw InputError(context.problem.at(spec->line), "workspace.singularity: this instrument sees no single tip",
                     "leave it out");
  checks.push_back(std::make_unique<SingularityCheck>(context.model, *spec));
}

}  // namespace posewright
