#include "body_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "posewright/model/pair_names.hpp"
#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/model/urdf_ways.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

/// Adds what one joint moves.
/// @param X    frame of the joint after its motion
/// @param way  change of its coordinate, less than 0 on the way to frame a
void add_joint(BodyFrames::Rate& rate, const ChainJoint& joint, const Eigen::Isometry3d& X, double way) {
  const double change = joint.multiplier * way;
  const Eigen::Vector3d axis = change * (X.linear() * joint.axis);
  if (joint.prismatic) {
    rate.v += axis;
    rate.least_turn = 0;
    return;
  }
  rate.omega += axis;
  rate.v += X.translation().cross(axis);
  rate.turn += std::abs(change);
  rate.least_turn = std::min(rate.least_turn, std::abs(change));
}

/// How far points are from a place, and from the line through it along an axis, m: at most.
struct Extent {
  double from_origin = 0.0, from_axis = 0.0;
};
Extent extent_of(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& origin, const Eigen::Vector3d& axis) {
  Extent extent;
  for (const Eigen::Vector3d& p : points) {
    extent.from_origin = std::max(extent.from_origin, (p - origin).norm());
    extent.from_axis = std::max(extent.from_axis, (p - origin).cross(axis).norm());
  }
  return extent;
}

/// Points of frame b on the way down from it: how far the joints that carry others move them.
class WayDown {
 public:
  explicit WayDown(std::span<const Eigen::Vector3d> points) : points_(points) {}
  /// Variant for points of which only the distance from the frame's origin is known, m.
  explicit WayDown(double from_origin) : first_(false), from_origin_(from_origin) {}
  /// To the next joint. @return how far points are from its axis, m
  double pass(const Eigen::Isometry3d& X_ParentJoint, const Eigen::Vector3d& axis_in_joint) {
    const Eigen::Vector3d way = X_ParentJoint.translation(), axis = X_ParentJoint.linear() * axis_in_joint;
    if (!std::exchange(first_, false)) {
      const double from_axis = from_origin_ + way.cross(axis).norm();
      from_origin_ += way.norm();
      return from_axis;
    }
    const Extent extent = extent_of(points_, way, axis);
    from_origin_ = extent.from_origin;
    return extent.from_axis;
  }
  /// A joint may push its frame out so far, m.
  void push(double pushed) { from_origin_ += pushed; }

 private:
  std::span<const Eigen::Vector3d> points_;
  bool first_ = true;
  double from_origin_ = 0.0;
};

/// Serial arm: frame k is that of the k-th joint after its motion.
class ChainFrames : public BodyFrames {
 public:
  ChainFrames(ChainDescription chain, const IdentificationModel& model) : chain_(std::move(chain)) {
    count_ = 1 + int(chain_.joints.size());
    X_FrameTip_ = chain_.X_LastTip;
    dimension_ = model.coordinates().size();
    places_.push_back(places_of("", model));
    if (std::vector<std::size_t> second = places_of(second_suffix, model); !second.empty()) places_.push_back(second);
    poses_ = int(places_.size());
  }

  void poses(std::span<const double> q, int pose, std::span<Eigen::Isometry3d> X) const override {
    Frame<double> frame;
    frame.then(chain_.X_MeasureBase);
    X[0].setIdentity();
    for (std::size_t k = 0; k < chain_.joints.size(); ++k) {
      frame.then_joint(chain_.joints[k], q[place(pose, k)]);
      X[k + 1].setIdentity();
      X[k + 1].linear() = frame.R;
      X[k + 1].translation() = frame.p;
    }
  }

  Eigen::Vector3d axis(int b) const override { return chain_.joints[std::size_t(b - 1)].axis; }

  Eigen::VectorXd travel(int pose, int a, int b, std::span<const Eigen::Vector3d> points) const override {
    Eigen::VectorXd bound = Eigen::VectorXd::Zero(Eigen::Index(dimension_));
    const auto moved_by = [&](int k, double from_axis) {
      const ChainJoint& joint = chain_.joints[std::size_t(k - 1)];
      bound[Eigen::Index(place(pose, std::size_t(k - 1)))] +=
          std::abs(joint.multiplier) * (joint.prismatic ? 1.0 : from_axis);
    };
    // Of frame k's points: from its own axis, and from its origin.
    Extent extent = b > a ? extent_of(points, Eigen::Vector3d::Zero(), axis(b)) : Extent{};
    for (int k = b; k > a; --k) {
      moved_by(k, extent.from_axis);
      if (k - 1 == a) break;
      const Eigen::Vector3d way = chain_.joints[std::size_t(k - 1)].X_ParentJoint.translation();
      extent.from_axis = way.cross(axis(k - 1)).norm() + pushed_by(k) + extent.from_origin;
      extent.from_origin += way.norm() + pushed_by(k);
    }
    WayDown down(points);
    for (int k = b + 1; k <= a; ++k) {
      const ChainJoint& joint = chain_.joints[std::size_t(k - 1)];
      moved_by(k, down.pass(k == 1 ? chain_.X_MeasureBase * joint.X_ParentJoint : joint.X_ParentJoint, joint.axis));
      down.push(pushed_by(k));
    }
    return bound;
  }

  std::optional<Rate> rate(int pose, int a, int b, std::span<const double> change,
                           std::span<const Eigen::Isometry3d> X) const override {
    Rate result;
    result.least_turn = std::numeric_limits<double>::infinity();
    for (int k = std::min(a, b) + 1; k <= std::max(a, b); ++k) {
      const double way = change[place(pose, std::size_t(k - 1))];
      add_joint(result, chain_.joints[std::size_t(k - 1)], X[std::size_t(k)], a < b ? way : -way);
    }
    return result;
  }

  double period(std::size_t coordinate) const override {
    for (std::size_t k = 0; k < chain_.joints.size(); ++k)
      if (place(0, k) == coordinate && (chain_.joints[k].prismatic || std::abs(chain_.joints[k].multiplier) != 1.0))
        return 0.0;
    return 2 * std::numbers::pi;
  }

  int acts_from(const std::string& parameter) const override {
    const std::string owner = parameter.substr(0, parameter.rfind('.'));
    if (owner.starts_with("target") || owner.starts_with("station") || owner == "camera" || owner == "board")
      return count_;
    for (std::size_t k = 0; k < chain_.joints.size(); ++k)
      if (const std::string& name = chain_.joints[k].name; name == owner || parameter.starts_with(name + ".coupling."))
        return int(k) + 1;
    if (owner == "base") return 0;
    return owner == "tool" ? count_ : 1;
  }

 private:
  /// How far the joint of frame k may push it out, m: that comes to the fixed way from the frame before.
  double pushed_by(int k) const {
    const ChainJoint& joint = chain_.joints[std::size_t(k - 1)];
    if (!joint.prismatic) return 0.0;
    const Coordinate& c = chain_.coordinates[std::size_t(joint.coordinate)];
    return std::abs(joint.multiplier) * std::max(std::abs(c.lower), std::abs(c.upper)) + std::abs(joint.offset);
  }

  std::size_t place(int pose, std::size_t joint) const {
    return places_[std::size_t(pose)][std::size_t(chain_.joints[joint].coordinate)];
  }

  /// Index of each of the chain's coordinates in a configuration; empty if one is missing.
  std::vector<std::size_t> places_of(const std::string& suffix, const IdentificationModel& model) const {
    std::vector<std::size_t> places;
    for (const Coordinate& own : chain_.coordinates)
      for (std::size_t i = 0; i < model.coordinates().size(); ++i)
        if (model.coordinates()[i].name == own.name + suffix) places.push_back(i);
    return places.size() == chain_.coordinates.size() ? places : std::vector<std::size_t>{};
  }

  ChainDescription chain_;
  std::vector<std::vector<std::size_t>> places_;
  std::size_t dimension_ = 0;
};

/// Arm with several tips: frame k is that of the k-th joint of its tree after its motion.
class TreeFrames : public BodyFrames {
 public:
  TreeFrames(UrdfFrames tree, const IdentificationModel& model) : tree_(std::move(tree)) {
    count_ = 1 + int(tree_.joints.size());
    dimension_ = model.coordinates().size();
    for (const Coordinate& own : tree_.coordinates)
      for (std::size_t i = 0; i < dimension_; ++i)
        if (model.coordinates()[i].name == own.name) places_.push_back(i);
  }

  Tip tip(const std::string& name) const override {
    const auto found = std::ranges::find(tree_.tips, name, &UrdfFrames::Tip::name);
    return {found->frame, found->X_FrameTip};
  }

  Tip measurement_frame(const std::string& in) const override {
    return in.empty() ? Tip{tree_.base.frame, tree_.base.X_FrameTip} : tip(in);
  }

  std::vector<Branch> branches() const override {
    std::vector<Branch> all;
    for (const UrdfFrames::Tip& tip : tree_.tips) {
      std::vector<int> way = way_to(tip.frame);
      way.pop_back();
      all.push_back({{way.rbegin(), way.rend()}, {tip.frame, tip.X_FrameTip}});
    }
    return all;
  }

  void poses(std::span<const double> q, int, std::span<Eigen::Isometry3d> X) const override {
    X[0].setIdentity();
    for (std::size_t k = 0; k < tree_.joints.size(); ++k) {
      const Eigen::Isometry3d& parent = X[std::size_t(tree_.parents[k])];
      Frame<double> frame;
      frame.R = parent.linear();
      frame.p = parent.translation();
      frame.then_joint(tree_.joints[k], q[place(k)]);
      X[k + 1].setIdentity();
      X[k + 1].linear() = frame.R;
      X[k + 1].translation() = frame.p;
    }
  }

  Eigen::Vector3d axis(int b) const override { return joint(b).axis; }

  Eigen::VectorXd travel(int, int a, int b, std::span<const Eigen::Vector3d> points) const override {
    Eigen::VectorXd bound = Eigen::VectorXd::Zero(Eigen::Index(dimension_));
    const std::vector<int> up = way_to(b), down = way_to(a);
    const auto common = std::ranges::find_if(up, [&](int k) { return std::ranges::count(down, k) > 0; });
    const auto moved_by = [&](int k, double from_axis) {
      bound[Eigen::Index(place(std::size_t(k - 1)))] +=
          std::abs(joint(k).multiplier) * (joint(k).prismatic ? 1.0 : from_axis);
    };
    // Of frame k's points: from its own axis, and from its origin.
    Extent extent = extent_of(points, Eigen::Vector3d::Zero(), b > 0 ? axis(b) : Eigen::Vector3d::UnitZ());
    for (auto k = up.begin(); k != common; ++k) {
      moved_by(*k, extent.from_axis);
      const Eigen::Vector3d way = joint(*k).X_ParentJoint.translation();
      const double pushed = pushed_by(*k);
      if (const int above = tree_.parents[std::size_t(*k - 1)]; above > 0)
        extent.from_axis = way.cross(joint(above).axis).norm() + pushed + extent.from_origin;
      extent.from_origin += way.norm() + pushed;
    }
    // Down to frame a; what came up to another frame first has moved about it.
    WayDown below = common == up.begin() ? WayDown(points) : WayDown(extent.from_origin);
    for (auto k = std::make_reverse_iterator(std::ranges::find(down, *common)); k != down.rend(); ++k) {
      moved_by(*k, below.pass(joint(*k).X_ParentJoint, joint(*k).axis));
      below.push(pushed_by(*k));
    }
    return bound;
  }

  std::optional<Rate> rate(int, int a, int b, std::span<const double> change,
                           std::span<const Eigen::Isometry3d> X) const override {
    Rate result;
    result.least_turn = std::numeric_limits<double>::infinity();
    const std::vector<int> up = way_to(b), down = way_to(a);
    const auto add = [&](const std::vector<int>& way, const std::vector<int>& other, double sense) {
      for (const int k : way) {
        if (std::ranges::count(other, k) > 0) break;
        add_joint(result, joint(k), X[std::size_t(k)], sense * change[place(std::size_t(k - 1))]);
      }
    };
    add(up, down, 1);
    add(down, up, -1);
    return result;
  }

  double period(std::size_t coordinate) const override {
    for (std::size_t k = 0; k < tree_.joints.size(); ++k)
      if (place(k) == coordinate && (tree_.joints[k].prismatic || std::abs(tree_.joints[k].multiplier) != 1.0))
        return 0.0;
    return 2 * std::numbers::pi;
  }

  /// Where a measurement frame is moves no link off another, nor off what stands in the root.
  int acts_from(const std::string& parameter) const override {
    const std::string owner = parameter.substr(0, parameter.rfind('.'));
    for (std::size_t k = 0; k < tree_.joints.size(); ++k)
      if (const std::string& name = tree_.joints[k].name; name == owner || parameter.starts_with(name + ".coupling."))
        return int(k) + 1;
    return count_;
  }

  bool acts_between(int from, int a, int b, bool) const override { return is_on(from, a) != is_on(from, b); }

  std::optional<Eigen::Matrix<double, 6, 1>> twist(const std::string& parameter, std::span<const double> q,
                                                   std::span<const Eigen::Isometry3d> X) const override {
    Eigen::Matrix<double, 6, 1> result = Eigen::Matrix<double, 6, 1>::Zero();
    const int k = acts_from(parameter);
    if (k == count_) return result;
    const ChainJoint& moved = joint(k);
    const Eigen::Isometry3d origin = X[std::size_t(tree_.parents[std::size_t(k - 1)])] * moved.X_ParentJoint;
    const auto turn = [&](const Eigen::Vector3d& axis) { result << origin.translation().cross(axis), axis; };
    const auto push = [&](const Eigen::Vector3d& axis) { result << axis, Eigen::Vector3d::Zero(); };
    const std::string kind = parameter.substr(parameter.rfind('.') + 1);
    constexpr std::string_view axes = "xyz";
    if (kind.size() == 1 && axes.find(kind) != std::string_view::npos) {
      push(origin.linear().col(Eigen::Index(axes.find(kind))));
    } else if (kind.size() == 2 && kind[0] == 'r' && axes.find(kind[1]) != std::string_view::npos) {
      turn(origin.linear().col(Eigen::Index(axes.find(kind[1]))));
    } else {
      // An offset, or what acts like one, at most as much.
      const Eigen::Vector3d axis = moved.multiplier * (origin.linear() * moved.axis);
      if (moved.prismatic) push(axis);
      else turn(axis);
      if (kind == "gear") result *= q[place(std::size_t(k - 1))];
    }
    return result;
  }

 private:
  const ChainJoint& joint(int frame) const { return tree_.joints[std::size_t(frame - 1)]; }
  std::size_t place(std::size_t joint) const { return places_[std::size_t(tree_.joints[joint].coordinate)]; }

  /// Frames from that one to the root.
  std::vector<int> way_to(int frame) const {
    std::vector<int> way{frame};
    while (way.back() > 0) way.push_back(tree_.parents[std::size_t(way.back() - 1)]);
    return way;
  }
  bool is_on(int frame, int way_end) const { return std::ranges::count(way_to(way_end), frame) > 0; }

  /// How far the joint of frame k may push it out, m.
  double pushed_by(int k) const {
    if (!joint(k).prismatic) return 0.0;
    const Coordinate& c = tree_.coordinates[std::size_t(joint(k).coordinate)];
    return std::abs(joint(k).multiplier) * std::max(std::abs(c.lower), std::abs(c.upper)) + std::abs(joint(k).offset);
  }

  UrdfFrames tree_;
  std::vector<std::size_t> places_;
  std::size_t dimension_ = 0;
};

/// Parallel robot: one frame, its platform.
class PlatformFrames : public BodyFrames {
 public:
  explicit PlatformFrames(const IdentificationModel& model) : model_(model) { count_ = 2; }

  void poses(std::span<const double> q, int, std::span<Eigen::Isometry3d> X) const override {
    X[0].setIdentity();
    X[1] = model_.tool_pose(q);
  }

  Eigen::Vector3d axis(int) const override { return Eigen::Vector3d::UnitZ(); }

  Eigen::VectorXd travel(int, int, int b, std::span<const Eigen::Vector3d> points) const override {
    // What stands still is as far from the platform's origin as that goes.
    const double radius = b > 0 ? extent_of(points, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()).from_origin
                                : std::numeric_limits<double>::infinity();
    Eigen::VectorXd bound = Eigen::VectorXd::Zero(Eigen::Index(model_.coordinates().size()));
    for (std::size_t i = 0; i < model_.coordinates().size(); ++i) {
      const Coordinate& c = model_.coordinates()[i];
      // Rates of roll, pitch, yaw turn about unit axes.
      if (!c.choice()) bound[Eigen::Index(i)] = c.unit == "rad" ? radius : 1.0;
    }
    return bound;
  }

  int acts_from(const std::string& parameter) const override {
    return parameter.starts_with("target") || parameter.starts_with("station") ? count_ : 1;
  }

 private:
  const IdentificationModel& model_;
};

}  // namespace

std::vector<BodyFrames::Branch> BodyFrames::branches() const {
  std::vector<int> moving(std::size_t(count_) - 1);
  std::iota(moving.begin(), moving.end(), 1);
  return {{moving, tip("")}};
}

std::unique_ptr<BodyFrames> make_body_frames(const Problem& problem, const IdentificationModel& model) {
  const auto* arm = std::get_if<SerialArmSpec>(&problem.robot);
  if (arm != nullptr && !arm->ways.empty())
    return std::make_unique<TreeFrames>(read_urdf_frames(*arm, problem.at(arm->line)), model);
  if (arm != nullptr) return std::make_unique<ChainFrames>(read_urdf_chain(*arm, problem.at(arm->line)), model);
  for (const Coordinate& c : model.coordinates())
    if (is_second(c.name))
      throw CannotDo("workspace: collision and sight of a parallel robot are not checked for pairs of configurations");
  return std::make_unique<PlatformFrames>(model);
}

}  // namespace posewright
