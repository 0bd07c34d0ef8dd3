#include "body_frames.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "posewright/model/pair_names.hpp"
#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

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

  Eigen::VectorXd travel(int pose, int a, int b, double radius, double axis_radius) const override {
    Eigen::VectorXd bound = Eigen::VectorXd::Zero(Eigen::Index(dimension_));
    const auto moved_by = [&](int k, double from_axis) {
      const ChainJoint& joint = chain_.joints[std::size_t(k - 1)];
      bound[Eigen::Index(place(pose, std::size_t(k - 1)))] +=
          std::abs(joint.multiplier) * (joint.prismatic ? 1.0 : from_axis);
    };
    // Of frame k's points: from its own axis, and from its origin.
    double from_axis = axis_radius, from_origin = radius;
    for (int k = b; k > a; --k) {
      moved_by(k, from_axis);
      if (k - 1 == a) break;
      const Eigen::Vector3d way = chain_.joints[std::size_t(k - 1)].X_ParentJoint.translation();
      from_axis = way.cross(chain_.joints[std::size_t(k - 2)].axis).norm() + pushed_by(k) + from_origin;
      from_origin += way.norm() + pushed_by(k);
    }
    // Frame b before a: the axis of joint k goes through the end of the fixed way to it.
    for (int k = b + 1; k <= a; ++k) {
      from_origin += chain_.joints[std::size_t(k - 1)].X_ParentJoint.translation().norm();
      moved_by(k, from_origin);
      from_origin += pushed_by(k);
    }
    return bound;
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

/// Parallel robot: one frame, its platform.
class PlatformFrames : public BodyFrames {
 public:
  explicit PlatformFrames(const IdentificationModel& model) : model_(model) { count_ = 2; }

  void poses(std::span<const double> q, int, std::span<Eigen::Isometry3d> X) const override {
    X[0].setIdentity();
    X[1] = model_.tool_pose(q);
  }

  Eigen::Vector3d axis(int) const override { return Eigen::Vector3d::UnitZ(); }

  Eigen::VectorXd travel(int, int, int, double radius, double) const override {
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

std::unique_ptr<BodyFrames> make_body_frames(const Problem& problem, const IdentificationModel& model) {
  if (const auto* arm = std::get_if<SerialArmSpec>(&problem.robot))
    return std::make_unique<ChainFrames>(read_urdf_chain(*arm, problem.at(arm->line)), model);
  for (const Coordinate& c : model.coordinates())
    if (is_second(c.name))
      throw CannotDo("workspace: collision and sight of a parallel robot are not checked for pairs of configurations");
  return std::make_unique<PlatformFrames>(model);
}

}  // namespace posewright
