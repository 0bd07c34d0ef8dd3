#include "pose_form.hpp"

#include <cmath>
#include <numbers>

namespace posewright::programs {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double rad_per_deg = std::numbers::pi / 180, millimetre = 1e-3;

/// Turns about x, then y, then z of the frame that stays.
Isometry3d fixed_turns(const std::vector<double>& v, std::size_t x, std::size_t y, std::size_t z) {
  return Eigen::Translation3d(Vector3d(v[0], v[1], v[2]) * millimetre) *
         AngleAxisd(v[z] * rad_per_deg, Vector3d::UnitZ()) * AngleAxisd(v[y] * rad_per_deg, Vector3d::UnitY()) *
         AngleAxisd(v[x] * rad_per_deg, Vector3d::UnitX());
}

/// Turns about x, then the y that turned with it, then the z that turned with both.
Isometry3d moved_turns(const std::vector<double>& v) {
  return Eigen::Translation3d(Vector3d(v[0], v[1], v[2]) * millimetre) *
         AngleAxisd(v[3] * rad_per_deg, Vector3d::UnitX()) * AngleAxisd(v[4] * rad_per_deg, Vector3d::UnitY()) *
         AngleAxisd(v[5] * rad_per_deg, Vector3d::UnitZ());
}

Eigen::Quaterniond turn_of(const Vector3d& r) {
  const double angle = r.norm();
  return angle < 1e-300 ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(AngleAxisd(angle, r / angle));
}

/// mm, then those turns, deg, about x, y, z.
std::array<double, 6> with_fixed_turns(const Isometry3d& X) {
  const Eigen::Matrix3d R = X.linear();
  const Vector3d p = X.translation() / millimetre;
  const double level = std::hypot(R(0, 0), R(1, 0));
  // Upright, turns about x and z are one.
  const bool upright = level < 1e-9;
  const double x = upright ? 0 : std::atan2(R(2, 1), R(2, 2)), y = std::atan2(-R(2, 0), level),
               z = upright ? std::atan2(-R(0, 1), R(1, 1)) : std::atan2(R(1, 0), R(0, 0));
  return {p.x(), p.y(), p.z(), x / rad_per_deg, y / rad_per_deg, z / rad_per_deg};
}

/// mm, then the turns of moved_turns(), deg: the transpose has them about fixed axes, backwards.
std::array<double, 6> with_moved_turns(const Isometry3d& X) {
  Isometry3d back = Isometry3d::Identity();
  back.linear() = X.linear().transpose();
  const auto v = with_fixed_turns(back);
  const Vector3d p = X.translation() / millimetre;
  return {p.x(), p.y(), p.z(), -v[3], -v[4], -v[5]};
}

Status krl_status(const ArmStand& stand, const std::array<double, 6>& axes) {
  long turns = 0;
  for (std::size_t i = 0; i < 6; ++i) turns |= axes[i] < 0 ? 1L << i : 0;
  const bool fifth = (axes[4] >= -180 && axes[4] < 0) || axes[4] >= 180;
  return {(stand.behind_base ? 1 : 0) | (stand.behind_arm ? 0 : 2) | (fifth ? 4 : 0), turns};
}

Status rapid_status(const ArmStand& stand, const std::array<double, 6>& axes) {
  const auto quadrant = [&](std::size_t i) { return long(std::floor(axes[i] / 90)); };
  return {quadrant(0), quadrant(3), quadrant(5),
          (stand.behind_base ? 4 : 0) + (stand.behind_arm ? 2 : 0) + (axes[4] < 0 ? 1 : 0)};
}

Status tp_status(const ArmStand& stand, const std::array<double, 6>& axes) {
  const auto turn = [&](std::size_t i) { return long(std::floor((axes[i] + 180) / 360)); };
  return {axes[4] < 0 ? 0 : 1, stand.behind_arm ? 1 : 0, stand.behind_base ? 1 : 0, turn(0), turn(3), turn(5)};
}

/// No flip where the fourth axis is turned over; front and above are 0.
Status inform_status(const ArmStand& stand, const std::array<double, 6>& axes) {
  const auto beyond = [&](std::size_t i) { return axes[i] > 180 || axes[i] <= -180 ? 1L : 0L; };
  const double fourth = std::remainder(axes[3], 360);
  return {fourth > 90 || fourth <= -90 ? 1 : 0,
          stand.behind_arm ? 1 : 0,
          stand.behind_base ? 1 : 0,
          beyond(3),
          beyond(5),
          beyond(0)};
}

Status val3_status(const ArmStand& stand, const std::array<double, 6>& axes) {
  return {stand.behind_base ? 1 : 0, stand.behind_arm ? 1 : 0, axes[4] < 0 ? 1 : 0};
}

std::string val3_status_text(std::size_t which, long value) {
  return std::string(val3_status_words()[which][std::size_t(value)]);
}

std::string number_text(std::size_t, long value) { return std::to_string(value); }

std::string tp_status_text(std::size_t which, long value) {
  static constexpr std::array<const char*, 3> usual = {"N", "U", "T"}, other = {"F", "D", "B"};
  return which >= 3 ? std::to_string(value) : value == 0 ? usual[which] : other[which];
}

}  // namespace

const std::array<std::array<std::string_view, 2>, 3>& val3_status_words() {
  static constexpr std::array<std::array<std::string_view, 2>, 3> words = {
      {{"lefty", "righty"}, {"epositive", "enegative"}, {"wpositive", "wnegative"}}};
  return words;
}

long PoseForm::merged(std::size_t which, long listed, long now) const {
  const long mask = masks.empty() ? 0 : masks[which];
  return mask == 0 ? now : (listed & ~mask) | now;
}

bool PoseForm::meets(std::size_t which, double listed, long now) const {
  if (!(std::abs(listed) < 1e6) || listed != std::floor(listed)) return false;
  return merged(which, long(listed), now) == long(listed);
}

const PoseForm& krl_pose() {
  static const PoseForm form = {{"X", "Y", "Z", "A", "B", "C"},
                                5,
                                [](const std::vector<double>& v) { return fixed_turns(v, 5, 4, 3); },
                                [](const Isometry3d& X) {
                                  const auto v = with_fixed_turns(X);
                                  return std::vector<double>{v[0], v[1], v[2], v[5], v[4], v[3]};
                                },
                                {"S", "T"},
                                {7, 63},
                                2,
                                krl_status,
                                number_text};
  return form;
}

const PoseForm& rapid_pose() {
  static const PoseForm form = {{"x", "y", "z", "q1", "q2", "q3", "q4"},
                                8,
                                [](const std::vector<double>& v) {
                                  return Isometry3d(Eigen::Translation3d(Vector3d(v[0], v[1], v[2]) * millimetre) *
                                                    Eigen::Quaterniond(v[3], v[4], v[5], v[6]).normalized());
                                },
                                [](const Isometry3d& X) {
                                  Eigen::Quaterniond q(X.linear());
                                  if (q.w() < 0) q.coeffs() = -q.coeffs();
                                  const Vector3d p = X.translation() / millimetre;
                                  return std::vector<double>{p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
                                },
                                {"cf1", "cf4", "cf6", "cfx"},
                                {},
                                3,
                                rapid_status,
                                number_text};
  return form;
}

const PoseForm& tp_pose() {
  static const PoseForm form = {{"X", "Y", "Z", "W", "P", "R"},
                                5,
                                [](const std::vector<double>& v) { return fixed_turns(v, 3, 4, 5); },
                                [](const Isometry3d& X) {
                                  const auto v = with_fixed_turns(X);
                                  return std::vector<double>(v.begin(), v.end());
                                },
                                {"flip", "elbow", "side", "turn1", "turn4", "turn6"},
                                {},
                                6,
                                tp_status,
                                tp_status_text};
  return form;
}

const PoseForm& urscript_pose() {
  static const PoseForm form = [] {
    PoseForm f;
    f.values = {"x", "y", "z", "rx", "ry", "rz"};
    f.place = [](const std::vector<double>& v) {
      return Isometry3d(Eigen::Translation3d(v[0], v[1], v[2]) * turn_of(Vector3d(v[3], v[4], v[5])));
    };
    f.written = [](const Isometry3d& X) {
      const AngleAxisd turn(X.linear());
      const Vector3d p = X.translation(), r = turn.angle() * turn.axis();
      return std::vector<double>{p.x(), p.y(), p.z(), r.x(), r.y(), r.z()};
    };
    f.length_decimals = 7;
    f.turn_decimals = 8;
    f.nearest = f.in_robot_base = true;
    return f;
  }();
  return form;
}

const PoseForm& inform_pose() {
  static const PoseForm form = [] {
    PoseForm f = tp_pose();
    f.values = {"X", "Y", "Z", "RX", "RY", "RZ"};
    f.status = {"flip", "lower", "rear", "R", "T", "S"};
    f.status_of = inform_status;
    f.status_text = number_text;
    return f;
  }();
  return form;
}

const PoseForm& val3_pose() {
  static const PoseForm form = [] {
    PoseForm f;
    f.values = {"x", "y", "z", "rx", "ry", "rz"};
    f.place = [](const std::vector<double>& v) { return moved_turns(v); };
    f.written = [](const Isometry3d& X) {
      const auto v = with_moved_turns(X);
      return std::vector<double>(v.begin(), v.end());
    };
    f.status = {"shoulder", "elbow", "wrist"};
    f.required = 3;
    f.status_of = val3_status;
    f.status_text = val3_status_text;
    f.turns_open = true;
    return f;
  }();
  return form;
}

}  // namespace posewright::programs

namespace posewright {

Eigen::Isometry3d place_of_rpy(const std::vector<double>& values) { return programs::fixed_turns(values, 3, 4, 5); }

}  // namespace posewright
