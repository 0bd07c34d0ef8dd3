#include "posewright/model/calibrated_values.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "displacement.hpp"
#include "posewright/model/dh_chain.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/serial_chain.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

using Convention = VariantSpec::Convention;

/// Values put to the parameters of a robot by name; what is not found is the instrument's or a spring's.
class Corrections {
 public:
  Corrections(const std::vector<Parameter>& parameters, const std::vector<CalibratedValue>& values)
      : given_(parameters.size()) {
    for (const CalibratedValue& value : values) {
      if (value.correction() == 0.0) continue;
      // A target may be called as a joint is: the robot's parameters come first.
      for (std::size_t i = 0; i < parameters.size(); ++i)
        if (parameters[i].name == value.name && given_[i] == nullptr) {
          given_[i] = &value;
          break;
        }
      if (std::find(given_.begin(), given_.end(), &value) == given_.end()) others.push_back(value);
    }
  }

  double at(int index) const {
    const CalibratedValue* value = given_[std::size_t(index)];
    return value == nullptr ? 0.0 : value->correction();
  }
  void name(int first, int count, std::vector<CalibratedValue>& by) const {
    for (int i = first; i < first + count; ++i)
      if (given_[std::size_t(i)] != nullptr) by.push_back(*given_[std::size_t(i)]);
  }
  /// Displacement by the six parameters from `first`.
  FrameCorrection displacement(int first) const {
    FrameCorrection result;
    name(first, 6, result.by);
    std::array<double, 6> d;
    for (int k = 0; k < 6; ++k) d[std::size_t(k)] = at(first + k);
    Frame<double> frame;
    frame.then_displace(d.data());
    result.X = isometry_of(frame);
    return result;
  }

  std::vector<CalibratedValue> others;

 private:
  std::vector<const CalibratedValue*> given_;
};

Eigen::Isometry3d motion(bool rotation, const Eigen::Vector3d& axis, double value) {
  Frame<double> frame;
  if (rotation) frame.then_rotate(axis, value);
  else frame.then_translate(axis * value);
  return isometry_of(frame);
}

ChainCorrection of_frames(const ChainDescription& chain, const std::vector<CalibratedValue>& values) {
  const SerialChain arm(chain);
  const ChainLayout& layout = arm.layout();
  Corrections given(arm.parameters(), values);
  ChainCorrection result;
  result.base = given.displacement(0);
  for (std::size_t k = 0; k < chain.joints.size(); ++k) {
    const ChainJoint& joint = chain.joints[k];
    FrameCorrection frame = given.displacement(layout.displacement[k]);
    const int offset = layout.offset[std::size_t(joint.coordinate)];
    given.name(offset, 1, frame.by);
    const Eigen::Vector3d axis = joint.backward() ? Eigen::Vector3d(-joint.axis) : joint.axis;
    frame.X = frame.X * motion(!joint.prismatic, axis, joint.multiplier * given.at(offset));
    result.joints.push_back(std::move(frame));
    if (!joint.mimic) given.name(offset + 1, 1, result.left_out);
  }
  result.tip = given.displacement(layout.tool);
  result.left_out.insert(result.left_out.end(), given.others.begin(), given.others.end());
  return result;
}

/// The part of X that any motion of a joint lets pass, as its offset: about and along the axis of one that turns, a
/// translation of one that slides.
Eigen::Isometry3d passing_part(const Eigen::Isometry3d& X, const ChainJoint& joint) {
  Eigen::Isometry3d part = Eigen::Isometry3d::Identity();
  if (joint.prismatic) {
    part.translation() = X.linear().transpose() * X.translation();
    return part;
  }
  const Eigen::Quaterniond rotation(X.linear());
  part.translation() = joint.axis.dot(X.translation()) * joint.axis;
  part.linear() =
      Eigen::AngleAxisd(2 * std::atan2(joint.axis.dot(rotation.vec()), rotation.w()), joint.axis).toRotationMatrix();
  return part;
}

/// Displacements behind the frames of all joints, written as ChainCorrection has those of joints that are passed
/// backward: what the motion lets pass is the joint's own, the rest that of the joint before it, or of the base.
void turn_backward(const ChainDescription& chain, ChainCorrection& correction) {
  FrameCorrection behind;  // of the joint at hand, by the joint after it
  for (std::size_t k = chain.joints.size(); k-- > 0;) {
    if (!chain.joints[k].backward()) continue;
    FrameCorrection& own = correction.joints[k];
    FrameCorrection rest;
    Eigen::Isometry3d passing = Eigen::Isometry3d::Identity();
    if (!own.by.empty()) {
      const Eigen::Isometry3d& P = chain.joints[k].X_ParentJoint;
      passing = passing_part(own.X, chain.joints[k]);
      rest.X = P * own.X * passing.inverse() * P.inverse();
      if (!rest.X.isApprox(Eigen::Isometry3d::Identity(), 1e-15)) rest.by = own.by;
    }
    own.X = (passing * behind.X).inverse();
    own.by.insert(own.by.end(), behind.by.begin(), behind.by.end());
    behind = std::move(rest);
  }
  correction.base.X = correction.base.X * behind.X;
  correction.base.by.insert(correction.base.by.end(), behind.by.begin(), behind.by.end());
}

/// Between two joint motions a chain in Denavit–Hartenberg parameters has the constant A, nominally A⁰. Its frame on
/// joint k's axis stands at C from the URDF's, and C carries one motion into the other, so that A changes the URDF's
/// frame by C A⁰⁻¹ A C⁻¹.
ChainCorrection of_dh(const ChainDescription& chain, DhConvention convention,
                      const std::vector<CalibratedValue>& values) {
  const DhChain arm(denavit_hartenberg(chain, convention));
  const DhDescription& dh = arm.description();
  Corrections given(arm.parameters(), values);
  ChainCorrection result;
  const Eigen::Isometry3d X_BaseFirst = chain.X_MeasureBase.inverse() * dh.base;
  result.base = given.displacement(0);
  result.base.X = X_BaseFirst * result.base.X * X_BaseFirst.inverse();

  Eigen::Isometry3d X_urdf = Eigen::Isometry3d::Identity(), X_dh = X_BaseFirst;  // at zero position, nominal
  Eigen::Isometry3d nominal = Eigen::Isometry3d::Identity(), corrected = nominal;
  std::vector<CalibratedValue> by;
  int next = 6;
  for (const ElementaryMotion& m : dh.motions) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(m.axis);
    double value = m.nominal;
    if (!m.name.empty()) {
      given.name(next, 1, by);
      value += given.at(next++);
    }
    nominal = nominal * motion(m.rotation, axis, m.nominal);
    corrected = corrected * motion(m.rotation, axis, value);
    if (m.coordinate < 0) continue;
    X_urdf = X_urdf * chain.joints[result.joints.size()].X_ParentJoint;
    X_dh = X_dh * nominal;
    const Eigen::Isometry3d C = X_urdf.inverse() * X_dh;
    FrameCorrection frame;
    if (!by.empty()) frame.X = C * nominal.inverse() * corrected * C.inverse();
    frame.by = std::move(by);
    by.clear();
    result.joints.push_back(std::move(frame));
    nominal.setIdentity();
    corrected.setIdentity();
  }
  const FrameCorrection tool = given.displacement(next);
  if (!by.empty()) result.tip.X = dh.tool.inverse() * nominal.inverse() * corrected * dh.tool;
  result.tip.X = result.tip.X * tool.X;
  result.tip.by = std::move(by);
  result.tip.by.insert(result.tip.by.end(), tool.by.begin(), tool.by.end());
  result.left_out = std::move(given.others);
  turn_backward(chain, result);
  return result;
}

}  // namespace

std::vector<CalibratedValue> calibrated_values(const ProblemVariant& variant, const IdentificationModel& model,
                                               std::span<const double> correction) {
  VariantSpec plain = variant.spec;
  plain.nominal.clear();
  Problem before = variant.problem;
  before.parameters.reset();
  const auto robot = make_model({before, plain});
  std::vector<CalibratedValue> values;
  for (std::size_t i = 0; i < model.parameters().size(); ++i) {
    const Parameter& p = model.parameters()[i];
    values.push_back(
        {p.name, p.unit, robot->parameters()[i].nominal, correction.empty() ? p.nominal : p.nominal + correction[i]});
  }
  return values;
}

ChainCorrection chain_correction(const ChainDescription& chain, Convention convention,
                                 const std::vector<CalibratedValue>& values) {
  if (convention == Convention::frames) return of_frames(chain, values);
  return of_dh(chain, convention == Convention::dh ? DhConvention::distal : DhConvention::proximal, values);
}

ChainDescription corrected_chain(ChainDescription chain, const ChainCorrection& correction) {
  chain.X_MeasureBase = chain.X_MeasureBase * correction.base.X;
  for (std::size_t k = 0; k < chain.joints.size(); ++k) {
    ChainJoint& joint = chain.joints[k];
    if (k > 0 && chain.joints[k - 1].backward())
      joint.X_ParentJoint = correction.joints[k - 1].X.inverse() * joint.X_ParentJoint;
    if (joint.backward()) joint.X_AboveJoint = *joint.X_AboveJoint * correction.joints[k].X;
    else joint.X_ParentJoint = joint.X_ParentJoint * correction.joints[k].X;
  }
  if (chain.joints.back().backward()) chain.X_LastTip = correction.joints.back().X.inverse() * chain.X_LastTip;
  chain.X_LastTip = chain.X_LastTip * correction.tip.X;
  return chain;
}

std::string left_out_text(const CalibratedValue& value, const std::string& why) {
  const std::string unit = value.unit.empty() || value.unit == "1" ? "" : " " + value.unit;
  return fmt::format("{} = {}{}: {}", value.name, value.value, unit, why);
}

}  // namespace posewright
