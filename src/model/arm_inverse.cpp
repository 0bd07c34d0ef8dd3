#include "posewright/model/arm_inverse.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "posewright/model/rotation_vector.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// What URDFs round: 1.5708 for a right angle, tenths of a millimetre.
constexpr double angle_rounding = 1e-4, length_rounding = 2e-4;
// Newton's method squares what rounding left.
constexpr int most_polishing = 8;
constexpr double polished = 1e-12, most_left = 1e-9;

double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

Vector3d turned(const Vector3d& v, const Vector3d& axis, double angle) {
  return v * std::cos(angle) + axis.cross(v) * std::sin(angle) + axis * (axis.dot(v) * (1 - std::cos(angle)));
}

/// Angle about the axis that brings a's part across it to that of b.
double angle_between(const Vector3d& a, const Vector3d& b, const Vector3d& axis) {
  const Vector3d u = a - axis * axis.dot(a), v = b - axis * axis.dot(b);
  return std::atan2(axis.dot(u.cross(v)), u.dot(v));
}

/// A cos q + B sin q = C: two solutions, or none.
int solutions_of(double A, double B, double C, std::array<double, 2>& q) {
  const double size = std::hypot(A, B);
  if (size < 1e-12 || std::abs(C) > size * (1 + 1e-9)) return 0;
  const double middle = std::atan2(B, A), half = std::acos(std::clamp(C / size, -1.0, 1.0));
  q = {middle + half, middle - half};
  return 2;
}

}  // namespace

ArmInverse::ArmInverse(const ChainDescription& chain) : X_LastTip_(chain.X_LastTip) {
  const auto refuse = [](const char* why) {
    throw CannotDo(std::string("this arm has no inverse in closed form: ") + why);
  };
  if (chain.joints.size() != 6 || chain.coordinates.size() < 6) refuse("it has not six joints");
  Isometry3d X = Isometry3d::Identity();
  for (std::size_t i = 0; i < 6; ++i) {
    const ChainJoint& joint = chain.joints[i];
    if (joint.prismatic) refuse("a joint slides");
    if (joint.mimic || joint.coordinate != int(i) || joint.multiplier != 1 || joint.offset != 0)
      refuse("a joint follows another");
    origins_[i] = joint.X_ParentJoint;
    axes_[i] = joint.axis;
    X = X * joint.X_ParentJoint;
    lines_[i] = {X.linear() * joint.axis, X.translation()};
  }
  zero_ = X * X_LastTip_;
  three_parallel_ = lines_[1].w.cross(lines_[3].w).norm() <= angle_rounding;
  require_shape();
  // Where one axis is nearest to the next.
  const Axis &before = lines_[three_parallel_ ? 4 : 3], &behind = lines_[three_parallel_ ? 5 : 4];
  const Vector3d n = before.w.cross(behind.w);
  const double along = (behind.p - before.p).cross(behind.w).dot(n) / n.squaredNorm();
  centre_ = before.p + along * before.w;
  const auto misses = [&](const Axis& line) { return (centre_ - line.p).cross(line.w).norm() > length_rounding; };
  if (misses(lines_[4]) || misses(lines_[5]))
    refuse(three_parallel_ ? "the last two axes do not meet in a point" : "the last three axes do not meet in a point");
  const Vector3d a = lines_[0].w, b = lines_[1].w, out = centre_ - lines_[0].p;
  forward_ = b.cross(a);
  const double side = out.dot(forward_);
  if (std::abs(side) < 1e-3 && !three_parallel_) refuse("its wrist is on the first axis at zero joints");
  if (side < 0) forward_ = -forward_;
}

void ArmInverse::require_shape() const {
  const auto refuse = [](const char* why) {
    throw CannotDo(std::string("this arm has no inverse in closed form: ") + why);
  };
  if (lines_[1].w.cross(lines_[2].w).norm() > angle_rounding) refuse("second and third axis are not parallel");
  if (std::abs(lines_[0].w.dot(lines_[1].w)) > angle_rounding) refuse("first and second axis are not perpendicular");
  if (lines_[3].w.cross(lines_[4].w).norm() < 0.1 || lines_[4].w.cross(lines_[5].w).norm() < 0.1)
    refuse("two axes of the wrist are parallel");
}

Isometry3d ArmInverse::tip(const Joints& q) const {
  Isometry3d X = Isometry3d::Identity();
  for (std::size_t i = 0; i < 6; ++i) X = X * origins_[i] * Eigen::AngleAxisd(q[i], axes_[i]);
  return X * X_LastTip_;
}

bool ArmInverse::is_behind_arm(double third) const {
  const Vector3d arm = lines_[2].p - lines_[1].p, wrist = turned(centre_ - lines_[2].p, lines_[1].w, third);
  // The first axis may point down.
  const Vector3d up = lines_[0].w.z() < 0 ? Vector3d(-lines_[0].w) : lines_[0].w;
  const double side = arm.cross(wrist).dot(lines_[1].w), front = up.cross(forward_).dot(lines_[1].w);
  return side * front < 0;
}

void ArmInverse::solve(const Isometry3d& target, std::vector<ArmBranch>& branches) const {
  branches.clear();
  const auto& [one, two, three, four, five, six] = lines_;
  const Vector3d c = target * (zero_.inverse() * centre_);
  const Vector3d b = two.w, e = b.cross(one.w);
  const double level = (centre_ - one.p).dot(b);
  std::array<double, 2> first{}, third{};
  // Turned back by q1 the centre is in the arm's plane: its part along b is that at zero joints.
  if (solutions_of((c - one.p).dot(b), -(c - one.p).dot(e), level, first) == 0) return;
  const auto across = [&](const Vector3d& v) { return Vector3d(v - b * b.dot(v)); };
  const Vector3d upper = across(three.p - two.p), fore = across(centre_ - three.p);
  for (const double q1 : first) {
    const Vector3d back = one.p + turned(c - one.p, one.w, -q1);
    if (three_parallel_) {
      add_parallel(target, q1, back, branches);
      continue;
    }
    const Vector3d reach = across(back - two.p);
    // |upper + R(q3) fore|² = |reach|²
    const double C = 0.5 * (reach.squaredNorm() - upper.squaredNorm() - fore.squaredNorm());
    if (solutions_of(upper.dot(fore), upper.dot(b.cross(fore)), C, third) == 0) continue;
    for (const double q3 : third) {
      ArmBranch branch;
      branch.behind_base = (back - one.p).dot(forward_) < 0;
      branch.behind_arm = is_behind_arm(q3);
      const double q2 = angle_between(upper + turned(fore, b, q3), reach, b);
      // The third axis may point against the second one.
      add_wrists(target, {q1, q2, three.w.dot(b) < 0 ? -q3 : q3}, branch, branches);
    }
  }
}

void ArmInverse::add_wrists(const Isometry3d& target, const Joints& arm, ArmBranch branch,
                            std::vector<ArmBranch>& branches) const {
  const auto& [one, two, three, four, five, six] = lines_;
  const Eigen::Matrix3d shoulder =
      (Eigen::AngleAxisd(arm[0], one.w) * Eigen::AngleAxisd(arm[1], two.w) * Eigen::AngleAxisd(arm[2], three.w))
          .toRotationMatrix();
  const Eigen::Matrix3d R = shoulder.transpose() * target.linear() * zero_.linear().transpose();
  const Vector3d v = R * six.w;
  std::array<double, 2> fifth{};
  // w4 · R5 w6 = w4 · v
  const double along = four.w.dot(five.w) * five.w.dot(six.w);
  if (solutions_of(four.w.dot(six.w) - along, four.w.dot(five.w.cross(six.w)), four.w.dot(v) - along, fifth) == 0)
    return;
  for (const double q5 : fifth) {
    const Vector3d bent = turned(six.w, five.w, q5);
    if (four.w.cross(v).norm() < 1e-6) continue;
    const double q4 = angle_between(bent, v, four.w);
    const Eigen::Matrix3d before = (Eigen::AngleAxisd(q4, four.w) * Eigen::AngleAxisd(q5, five.w)).toRotationMatrix();
    const Vector3d across = six.w.unitOrthogonal();
    const double q6 = angle_between(across, before.transpose() * R * across, six.w);
    branch.q = {arm[0], arm[1], arm[2], q4, q5, q6};
    if (!polish(target, branch.q)) continue;
    for (double& q : branch.q) q = wrapped(q);
    branches.push_back(branch);
  }
}

void ArmInverse::add_parallel(const Isometry3d& target, double q1, const Vector3d& back,
                              std::vector<ArmBranch>& branches) const {
  const auto& [one, two, three, four, five, six] = lines_;
  const Vector3d b = two.w, e = b.unitOrthogonal();
  const auto across = [&](const Vector3d& v) { return Vector3d(v - b * b.dot(v)); };
  const Vector3d upper = across(three.p - two.p), fore = across(four.p - three.p);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(-q1, one.w).toRotationMatrix() * target.linear() * zero_.linear().transpose();
  std::array<double, 2> fifth{}, third{};
  // b · R5 w6 = b · R w6: the turns before are about b.
  const double along = b.dot(five.w) * five.w.dot(six.w);
  if (solutions_of(b.dot(six.w) - along, b.dot(five.w.cross(six.w)), b.dot(R * six.w) - along, fifth) == 0) return;
  const Vector3d seen = R.transpose() * b;
  if (six.w.cross(seen).norm() < 1e-6) return;
  for (const double q5 : fifth) {
    const double q6 = angle_between(seen, turned(b, five.w, -q5), six.w);
    const Eigen::Matrix3d wrist = (Eigen::AngleAxisd(q5, five.w) * Eigen::AngleAxisd(q6, six.w)).toRotationMatrix();
    const Eigen::Matrix3d turn = R * wrist.transpose();
    const double sum = angle_between(e, turn * e, b);
    const Vector3d reach = across(back - turn * (centre_ - four.p) - two.p);
    const double C = 0.5 * (reach.squaredNorm() - upper.squaredNorm() - fore.squaredNorm());
    if (solutions_of(upper.dot(fore), upper.dot(b.cross(fore)), C, third) == 0) continue;
    for (const double q3 : third) {
      const double q2 = angle_between(upper + turned(fore, b, q3), reach, b), q4 = sum - q2 - q3;
      ArmBranch branch;
      branch.q = {q1, q2, three.w.dot(b) < 0 ? -q3 : q3, four.w.dot(b) < 0 ? -q4 : q4, q5, q6};
      if (!polish(target, branch.q)) continue;
      for (double& q : branch.q) q = wrapped(q);
      branches.push_back(branch);
    }
  }
}

bool ArmInverse::polish(const Isometry3d& target, Joints& q) const {
  double error = 0;
  for (int step = 0; step <= most_polishing; ++step) {
    Eigen::Matrix<double, 6, 6> J;
    Isometry3d X = Isometry3d::Identity();
    for (std::size_t i = 0; i < 6; ++i) {
      X = X * origins_[i];
      J.col(int(i)).head<3>() = X.translation();
      J.col(int(i)).tail<3>() = X.linear() * axes_[i];
      X = X * Eigen::AngleAxisd(q[i], axes_[i]);
    }
    X = X * X_LastTip_;
    const Eigen::Matrix3d D = target.linear() * X.linear().transpose();
    Eigen::Matrix<double, 6, 1> e;
    e << target.translation() - X.translation(),
        0.5 * Vector3d(D(2, 1) - D(1, 2), D(0, 2) - D(2, 0), D(1, 0) - D(0, 1));
    error = e.cwiseAbs().maxCoeff();
    if (error < polished || step == most_polishing) break;
    for (int i = 0; i < 6; ++i) {
      const Vector3d p = J.col(i).head<3>(), w = J.col(i).tail<3>();
      J.col(i).head<3>() = w.cross(X.translation() - p);
    }
    const Eigen::Matrix<double, 6, 1> change = J.partialPivLu().solve(e);
    if (!change.allFinite() || change.cwiseAbs().maxCoeff() > 0.1) return false;
    for (std::size_t i = 0; i < 6; ++i) q[i] += change[int(i)];
  }
  return error < most_left;
}

}  // namespace posewright
