#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "documents.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

/// The points of a program.
class ProgramPoses : public PoseDocument {
 public:
  ProgramPoses(std::unique_ptr<ProgramDocument> program, const std::vector<Coordinate>& coordinates,
               const DocumentOptions& options)
      : moving_(moving(coordinates)),
        coordinates_(coordinates),
        inverse_(options.inverse),
        near_(options.near),
        program_(std::move(program)),
        account_(program_->account()) {
    const std::string& name = account_.file;
    for (const Coordinate& c : coordinates)
      if (c.choice() && c.labels.size() > 1)
        throw InputError({name, 0}, "has no place for the " + c.name + " of a pose",
                         "a plan, route or list with it; its result can be exported");
    poses_.name = name;
    std::vector<int> pose_of_point(program_->points().size(), -1);
    std::vector<Stood> stood(program_->points().size());
    if (program_->motions() != nullptr) stand_in_order(stood);
    else parallel_for(stood.size(), thread_count(options.threads), [&](std::size_t p, int) { stood[p] = stood_at(p); });
    for (std::size_t p = 0; p < stood.size(); ++p) {
      if (!stood[p].why_not.empty()) continue;
      add(program_->points()[p], std::move(stood[p].stand));
      pose_of_point[p] = int(of_pose_.size());
      of_pose_.push_back(p);
    }
    for (ProgramEntry& entry : account_.entries) {
      if (entry.point < 0) continue;
      const auto p = std::size_t(entry.point);
      entry.point = pose_of_point[p];
      if (entry.point >= 0) continue;
      entry.treatment = Treatment::not_compensated;
      entry.why = stood[p].why_not;
    }
    if (of_pose_.empty()) poses_.notes.push_back(name + " has no point that is compensated");
  }

  const ProgramAccount* account() const override { return &account_; }

  std::string text(const OtherValues& values, const std::string& remark) const override {
    std::vector<std::optional<ProgramDocument::Values>> points(program_->points().size());
    for (std::size_t k = 0; k < of_pose_.size(); ++k) {
      std::vector<double> q;
      for (const std::size_t m : moving_) q.push_back(values.configurations[k * coordinates_.size() + m]);
      // What is listed stays to its last digit.
      if (same(q, k)) continue;
      points[of_pose_[k]] = ProgramDocument::Values{};
      points[of_pose_[k]]->stand = branches_[k];
      points[of_pose_[k]]->stand.joints = q;
      if (program_->points()[of_pose_[k]].is_pose()) points[of_pose_[k]]->X_BaseTip = inverse_->tip(six(q));
    }
    return program_->text(points, remark);
  }

 private:
  static ArmInverse::Joints six(const std::vector<double>& q) {
    ArmInverse::Joints joints{};
    std::copy_n(q.begin(), joints.size(), joints.begin());
    return joints;
  }

  /// Joints of a point, or why a pose has none.
  struct Stood {
    ArmStand stand;
    std::string why_not;
  };

  static constexpr const char* not_known = "the joints before it are not known: --near states joints near it";

  /// Joints of poses that state none, motion by motion.
  void stand_in_order(std::vector<Stood>& stood) const {
    const std::vector<ProgramDocument::Point>& points = program_->points();
    std::vector<std::string> fault(points.size());
    for (std::size_t p = 0; p < points.size(); ++p)
      if (!points[p].is_pose()) stood[p].stand.joints = points[p].joints;
    const auto arrive = [&](std::size_t p, const Stood& at) {
      std::vector<double>& joints = stood[p].stand.joints;
      if (!fault[p].empty()) return;
      if (!at.why_not.empty()) fault[p] = at.why_not;
      else if (joints.empty()) joints = at.stand.joints;
      else if (farthest(joints, at.stand.joints) > 1e-6) fault[p] = "motions lead to it with several joints";
    };
    for (const PointMotion& motion : *program_->motions())
      if (motion.to >= 0 && points[std::size_t(motion.to)].is_pose())
        arrive(std::size_t(motion.to),
               after(motion, motion.from < 0 ? motion.joints : stood[std::size_t(motion.from)].stand.joints));
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (stood[p].stand.joints.empty() && fault[p].empty()) arrive(p, after({0, -1, int(p)}, {}));
      stood[p].why_not = fault[p];
    }
  }

  static double farthest(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
  }

  /// The joints behind a motion to a pose.
  Stood after(const PointMotion& motion, const std::vector<double>& from) const {
    const Eigen::Isometry3d& X = program_->points()[std::size_t(motion.to)].X_BaseTip;
    if (from.size() == 6) return motion.along ? along(motion, from, X) : nearest(from, X);
    if (near_) return nearest(*near_, X);
    return {{}, not_known};
  }

  /// Where the tool ends on a straight way to a pose; short steps, so that no joint jumps.
  Stood along(const PointMotion& motion, const std::vector<double>& start, const Eigen::Isometry3d& to) const {
    constexpr double length_step = 0.01, turn_step = 0.03;
    ArmInverse::Joints q = six(start);
    const Eigen::Isometry3d A = inverse_->tip(q) * motion.X_TipTool, B = to * motion.X_TipTool;
    const Eigen::Quaterniond from_turn(A.linear()), to_turn(B.linear());
    const double length = (B.translation() - A.translation()).norm(), turn = from_turn.angularDistance(to_turn);
    if (length > 100) return {{}, "the nominal robot does not reach it"};
    const int steps = std::max(1, int(std::ceil(std::max(length / length_step, turn / turn_step))));
    const Eigen::Isometry3d X_ToolTip = motion.X_TipTool.inverse();
    for (int k = 1; k <= steps; ++k) {
      const double s = double(k) / steps;
      const Eigen::Vector3d p = A.translation() + s * (B.translation() - A.translation());
      const Eigen::Isometry3d X = Eigen::Translation3d(p) * from_turn.slerp(s, to_turn) * X_ToolTip;
      if (!inverse_->polish(k == steps ? to : X, q))
        return {{}, "the way to it leads beyond the reach of the nominal robot, or through a singularity"};
    }
    for (std::size_t i = 0; i < q.size(); ++i)
      if (!inside(q[i], coordinates_[moving_[i]])) return {{}, "the way to it ends beyond the joint limits"};
    return {{{q.begin(), q.end()}}, ""};
  }

  /// The joints at a pose with the least sum of squared differences to those before.
  Stood nearest(const std::vector<double>& before, const Eigen::Isometry3d& X) const {
    constexpr double clear = 0.1;  // rad
    std::vector<std::pair<double, std::size_t>> order;
    const std::vector<ArmStand> stands = stands_at(X);
    for (std::size_t k = 0; k < stands.size(); ++k) {
      double sum = 0;
      for (std::size_t i = 0; i < before.size(); ++i) sum += std::pow(stands[k].joints[i] - before[i], 2);
      order.emplace_back(std::sqrt(sum), k);
    }
    if (order.empty()) return {{}, no_joints};
    std::ranges::sort(order);
    if (order.size() > 1 && order[1].first - order[0].first < clear)
      return {{}, "two sets of joints are about as near to those before"};
    return {stands[order[0].second], ""};
  }

  static constexpr const char* no_joints =
      "the nominal robot does not reach it within its limits, or its wrist is stretched";

  Stood stood_at(std::size_t p) const {
    const ProgramDocument::Point& point = program_->points()[p];
    if (!point.is_pose()) return {{point.joints}, ""};
    const std::vector<ArmStand> stands = stands_at(point.X_BaseTip);
    const std::vector<std::size_t> meant = program_->meant(p, stands);
    if (meant.size() == 1) return {stands[meant.front()], ""};
    return {{},
            stands.empty()  ? no_joints
            : meant.empty() ? "no joints within the limits have the status that it states"
                            : "its status does not decide between several joints"};
  }

  void add(const ProgramDocument::Point& point, ArmStand stand) {
    std::vector<double> q;
    for (const Coordinate& c : coordinates_) q.push_back(c.choice() ? c.values.front() : 0.0);
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      require_inside(stand.joints[i], coordinates_[moving_[i]], {poses_.name, point.line});
      q[moving_[i]] = as_allowed(stand.joints[i], coordinates_[moving_[i]]);
    }
    poses_.configurations.push_back(std::move(q));
    poses_.ids.push_back(int(poses_.configurations.size()));
    poses_.lines.push_back(point.line);
    poses_.own_ids.push_back(point.measured);
    branches_.push_back(std::move(stand));
  }

  /// All joints within the limits, on any turn, that the nominal robot has at a pose.
  std::vector<ArmStand> stands_at(const Eigen::Isometry3d& X_BaseTip) const {
    std::vector<ArmBranch> branches;
    inverse_->solve(X_BaseTip, branches);
    std::vector<ArmStand> all;
    for (const ArmBranch& branch : branches) {
      std::array<double, 6> joints{};
      add_turns(branch, 0, joints, all);
    }
    return all;
  }

  /// The branch with its joints from i on, on any turns within the limits.
  void add_turns(const ArmBranch& branch, std::size_t i, std::array<double, 6>& joints,
                 std::vector<ArmStand>& stands) const {
    if (i == joints.size()) {
      stands.push_back({{joints.begin(), joints.end()}, branch.behind_base, branch.behind_arm});
      return;
    }
    for (const int turn : {0, -1, 1}) {
      joints[i] = branch.q[i] + turn * 2 * std::numbers::pi;
      if (inside(joints[i], coordinates_[moving_[i]])) add_turns(branch, i + 1, joints, stands);
    }
  }

  bool same(const std::vector<double>& q, std::size_t pose) const {
    for (std::size_t i = 0; i < moving_.size(); ++i)
      if (q[i] != poses_.configurations[pose][moving_[i]]) return false;
    return true;
  }

  std::vector<std::size_t> moving_;
  std::vector<Coordinate> coordinates_;
  std::optional<ArmInverse> inverse_;
  std::optional<std::vector<double>> near_;
  std::unique_ptr<ProgramDocument> program_;
  ProgramAccount account_;
  std::vector<std::size_t> of_pose_;  ///< point of each pose
  std::vector<ArmStand> branches_;    ///< of each pose, as it is listed
};

}  // namespace

std::unique_ptr<PoseDocument> program_document(std::unique_ptr<ProgramDocument> program,
                                               const std::vector<Coordinate>& coordinates,
                                               const DocumentOptions& options) {
  return std::make_unique<ProgramPoses>(std::move(program), coordinates, options);
}

}  // namespace posewright
