#include "posewright/model/six_legs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "displacement.hpp"
#include "posewright/model/placement.hpp"

namespace posewright {
namespace {

constexpr int leg_count = 6;
constexpr double default_length_tolerance = 0.5e-3;     // m
constexpr double default_direction_tolerance = 1e-3;    // rad, as components of a unit vector
constexpr double default_deformation_tolerance = 0.01;  // m of platform per m of actuator

// The deformation contracts the fixed point of inverse kinematics by about its own size, so this is far more than
// enough.
constexpr int most_iterations = 200;

// A deformation is enclosed where its rows' absolute sums are below this, in so many steps at most.
constexpr double most_contraction = 0.5;
constexpr int tube_iterations = 30;

// Parameters of the deformation: kappa, kappa_1 … kappa_6, K_11 … K_66.
constexpr int first_of_matrix = 1 + leg_count;

enum Entry { ax, ay, az, bx, by, bz, ux, uy, length };

/// Meaning of the columns of leg parameters, in the order of the catalogue.
constexpr std::array<Entry, 9> slide_entries = {ax, ay, az, bx, by, bz, ux, uy, length};
constexpr std::array<Entry, 7> extend_entries = {ax, ay, az, bx, by, bz, length};
constexpr std::array<const char*, 9> entry_names = {"ax", "ay", "az", "bx", "by", "bz", "ux", "uy", "l"};

using BoxValues = TaylorModel::Values;

/// Nothing, so many times.
std::vector<TaylorModel> unknown_models(std::size_t count) {
  TaylorModel unknown;
  for (std::size_t box = 0; box < TaylorModel::boxes; ++box) unknown.put_unknown(box);
  return std::vector<TaylorModel>(count, unknown);
}

/// The larger of the two on each box.
void take_larger(BoxValues& largest, const BoxValues& other) {
  for (std::size_t box = 0; box < largest.size(); ++box) largest[box] = std::max(largest[box], other[box]);
}

/// Boxes on which each image is inside its tube about a middle, and the tube narrow enough to say something.
std::array<bool, TaylorModel::boxes> are_inside(const std::vector<TaylorModel>& images,
                                                const std::vector<TaylorModel>& middles,
                                                const std::vector<TaylorModel>& tubes) {
  std::array<bool, TaylorModel::boxes> inside;
  inside.fill(true);
  for (std::size_t i = 0; i < images.size(); ++i) {
    // The farthest of the image from the middle of the tube.
    const BoxValues away = (images[i] - middles[i].with_radius(0.0)).farthest();
    for (std::size_t box = 0; box < inside.size(); ++box)
      inside[box] = inside[box] && tubes[i].known(box) && away[box] <= tubes[i].radius(box);
  }
  return inside;
}

/// One leg with its corrections applied.
struct PlacedLeg {
  Eigen::Vector3d a, b, u;
  double l;

  PlacedLeg(const LegSpec& spec, std::span<const Entry> entries, std::span<const double> correction)
      : a(spec.a), b(spec.b), u(spec.u), l(spec.l) {
    for (std::size_t k = 0; k < correction.size(); ++k) {
      const Entry entry = entries[k];
      if (entry <= az) a[entry] += correction[k];
      else if (entry <= bz) b[entry - bx] += correction[k];
      else if (entry <= uy) u[entry - ux] += correction[k];
      else l += correction[k];
    }
    if (!correction.empty())
      u.z() = std::copysign(std::sqrt(std::max(0.0, 1 - u.x() * u.x() - u.y() * u.y())), spec.u.z());
  }
};

/// Deformation of the platform: lift of leg i's joint by how far the actuators stand from the reference.
struct Deformation {
  std::array<double, 36> K{};  // of all kinds together, row by row
  bool none = true;

  explicit Deformation(std::span<const double> correction) {
    if (correction.empty()) return;
    std::copy_n(correction.begin() + first_of_matrix, 36, K.begin());
    for (int i = 0; i < leg_count; ++i) K[std::size_t(7 * i)] += correction[0] + correction[std::size_t(1 + i)];
    none = std::all_of(correction.begin(), correction.end(), [](double x) { return x == 0; });
  }
  template <class S>
  S lift(int leg, std::span<const S> rho, const std::array<double, 6>& reference) const {
    S sum(0);
    for (std::size_t j = 0; j < leg_count; ++j) sum += S(K[std::size_t(6 * leg) + j]) * (rho[j] - S(reference[j]));
    return sum;
  }
};

/// Actuator that lifts leg i's joint by parameter `index` of the deformation; −1: none.
int lifting_actuator(int index, int leg) {
  if (index == 0) return leg;
  if (index < first_of_matrix) return index - 1 == leg ? leg : -1;
  return (index - first_of_matrix) / leg_count == leg ? (index - first_of_matrix) % leg_count : -1;
}

template <class S>
using Vector3 = Eigen::Matrix<S, 3, 1>;

/// Slide that gives the leg its length: ‖q − ρu‖ = l, q = p + R b − a. It is `along` less the root of `under_root`.
template <class S>
struct Slide {
  S along, under_root;

  Slide(const PlacedLeg& leg, const Vector3<S>& joint) {
    const Vector3<S> q = joint - leg.a.cast<S>();
    along = leg.u.cast<S>().dot(q);
    under_root = along * along - (q.dot(q) - S(leg.l * leg.l));
  }
};

bool slide_of(const PlacedLeg& leg, const Eigen::Vector3d& joint, double& rho) {
  const Slide<double> slide(leg, joint);
  if (!(slide.under_root > 0)) return false;
  rho = slide.along - std::sqrt(slide.under_root);
  return true;
}

/// A leg that slides by ρ or is longer by it, its upper joint lifted.
template <class S>
struct LegAt {
  Vector3<S> joint, e, e_platform;  ///< base frame; along the leg; the same in the platform's axes
  S value;                          ///< of the loop equation

  LegAt(const PlacedLeg& leg, const Frame<S>& platform, const S& lift, const S& slide, const S& extension) {
    using std::sqrt;
    Vector3<S> b = leg.b.cast<S>();
    b.z() += lift;
    joint = platform.p + platform.R * b;
    const Vector3<S> h = joint - leg.a.cast<S>() - leg.u.cast<S>() * slide;
    const S length = sqrt(h.dot(h));
    for (Eigen::Index k = 0; k < 3; ++k) e[k] = h[k] / length;
    e_platform = platform.R.transpose() * e;
    value = S(leg.l) + extension - length;
  }
};

std::span<const Entry> entries_of(LegActuation actuation) {
  if (actuation == LegActuation::slide) return slide_entries;
  return extend_entries;
}

std::span<const double> leg_part(std::span<const double> own, int leg, int per_leg) {
  return own.empty() ? own : own.subspan(std::size_t(leg * per_leg), std::size_t(per_leg));
}

std::vector<Parameter> catalogue(const SixLegsSpec& spec) {
  std::vector<Parameter> parameters;
  for (int i = 0; i < leg_count; ++i) {
    const LegSpec& leg = spec.legs[std::size_t(i)];
    const std::array<double, 9> nominal = {leg.a.x(), leg.a.y(), leg.a.z(), leg.b.x(), leg.b.y(),
                                           leg.b.z(), leg.u.x(), leg.u.y(), leg.l};
    for (const Entry entry : entries_of(spec.actuation)) {
      const bool direction = entry == ux || entry == uy;
      parameters.push_back({"leg_" + std::to_string(i + 1) + "." + entry_names[entry], direction ? "1" : "m",
                            nominal[entry], direction ? default_direction_tolerance : default_length_tolerance,
                            Role::interest});
    }
  }
  if (spec.actuation == LegActuation::extend) return parameters;
  const auto deformation = [&](const std::string& name) {
    parameters.push_back({name, "1", 0.0, default_deformation_tolerance, Role::interest});
  };
  deformation("kappa");
  for (int i = 1; i <= leg_count; ++i) deformation("kappa_" + std::to_string(i));
  for (int i = 1; i <= leg_count; ++i)
    for (int j = 1; j <= leg_count; ++j) deformation("K_" + std::to_string(i) + std::to_string(j));
  return parameters;
}

}  // namespace

SixLegs::SixLegs(const SixLegsSpec& spec, const std::vector<CoordinateLimits>& pose_limits)
    : ClosedChain(spec.placement),
      spec_(spec),
      X_BaseReference_(isometry(spec.reference)),
      per_leg_(int(entries_of(spec.actuation).size())) {
  for (int i = 0; i < leg_count; ++i)
    actuators_.push_back({"leg_" + std::to_string(i + 1) + ".rho", "m", spec.travel_lower, spec.travel_upper});
  for (std::size_t k = 0; k < 6; ++k) {
    // Without limits from the problem file, a platform moves as far as its actuators let it: anything larger serves.
    const double reach = k < 3 ? spec.legs.front().l + spec.travel_upper : std::numbers::pi / 2;
    coordinates_.push_back(pose_coordinate(displacement_names[k], k, reach, pose_limits));
  }
  finish(catalogue(spec), spec.actuator_noise);
  // A deforming platform is a model of its own, not a part of the geometry that `auto` chooses from.
  std::erase_if(geometric_, [&](const IdentificationModel::Preference& p) {
    const std::string& name = parameters_[std::size_t(p.parameter)].name;
    return name.starts_with("kappa") || name.starts_with("K_");
  });
  // A problem whose reference its actuators do not reach has no pose to plan; that is said where poses are drawn.
  if (spec.actuation == LegActuation::slide &&
      !SixLegs::do_inverse_kinematics(std::array<double, 6>{}, {}, reference_rho_))
    reference_rho_.fill(0.0);
}

Eigen::Isometry3d SixLegs::platform_pose(std::span<const double> q) const {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = rotation_of_rpy({q[3], q[4], q[5]}) * X_BaseReference_.linear();
  X.translation() = X_BaseReference_.translation() + Eigen::Vector3d(q[0], q[1], q[2]);
  return X;
}

Eigen::Isometry3d SixLegs::do_platform(std::span<const double> q, Twists& freedoms) const {
  const Eigen::Isometry3d X = platform_pose(q);
  freedoms.resize(6, 6);
  for (int k = 0; k < 3; ++k) freedoms.col(k) = prismatic(Eigen::Vector3d::Unit(k));
  const Eigen::Matrix3d yaw = rotation_of_rpy({0, 0, q[5]}), yaw_pitch = rotation_of_rpy({0, q[4], q[5]});
  freedoms.col(3) = revolute(yaw_pitch.col(0), X.translation());
  freedoms.col(4) = revolute(yaw.col(1), X.translation());
  freedoms.col(5) = revolute(Eigen::Vector3d::UnitZ(), X.translation());
  return X;
}

bool SixLegs::do_inverse_kinematics(std::span<const double> q, std::span<const double> own,
                                    std::span<double> rho) const {
  const Eigen::Isometry3d X = platform_pose(q);
  const auto entries = entries_of(spec_.actuation);
  const bool slides = spec_.actuation == LegActuation::slide;
  const Deformation deformation(slides && !own.empty() ? own.subspan(std::size_t(leg_count * per_leg_)) : own.first(0));
  std::array<double, 6> lift{}, before{};
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    for (int i = 0; i < leg_count; ++i) {
      const auto k = std::size_t(i);
      const PlacedLeg leg(spec_.legs[k], entries, leg_part(own, i, per_leg_));
      const Eigen::Vector3d joint = X * Eigen::Vector3d(leg.b + lift[k] * Eigen::Vector3d::UnitZ());
      if (!slides) rho[k] = (joint - leg.a).norm() - leg.l;
      else if (!slide_of(leg, joint, rho[k])) return false;
    }
    if (deformation.none || std::equal(rho.begin(), rho.end(), before.begin())) return true;
    std::copy(rho.begin(), rho.end(), before.begin());
    for (int i = 0; i < leg_count; ++i) lift[std::size_t(i)] = deformation.lift<double>(i, rho, reference_rho_);
  }
  return true;  // alternates between neighbouring doubles
}

std::vector<Polyline> SixLegs::do_skeleton(std::span<const double> q, std::span<const double> rho) const {
  const Eigen::Isometry3d X = platform_pose(q);
  std::vector<Polyline> lines;
  Polyline base, platform;
  for (std::size_t i = 0; i < leg_count; ++i) {
    const LegSpec& leg = spec_.legs[i];
    const Eigen::Vector3d joint = X * leg.b;
    if (spec_.actuation == LegActuation::slide) lines.push_back({leg.a, leg.a + rho[i] * leg.u, joint});
    else lines.push_back({leg.a, joint});
    base.push_back(leg.a);
    platform.push_back(joint);
  }
  for (Polyline* rim : {&base, &platform}) {
    rim->push_back(rim->front());
    lines.push_back(std::move(*rim));
  }
  return lines;
}

template <class S>
void SixLegs::loops_at(const Frame<S>& platform, std::span<const S> rho, std::span<const double> own,
                       std::span<const int> selected, LoopsOf<S>& out) const {
  const auto entries = entries_of(spec_.actuation);
  const bool slides = spec_.actuation == LegActuation::slide;
  const int first_deformation = leg_count * per_leg_;
  const Deformation deformation(slides && !own.empty() ? own.subspan(std::size_t(first_deformation)) : own.first(0));
  for (int i = 0; i < leg_count; ++i) {
    const S slide = slides ? rho[std::size_t(i)] : S(0), extension = slides ? S(0) : rho[std::size_t(i)];
    const PlacedLeg leg(spec_.legs[std::size_t(i)], entries, leg_part(own, i, per_leg_));
    const LegAt<S> at(leg, platform, deformation.none ? S(0) : deformation.lift<S>(i, rho, reference_rho_), slide,
                      extension);
    out.value[i] = at.value;
    const auto column_entry = [&](Entry entry) -> S {
      if (entry <= az) return at.e[entry];
      if (entry <= bz) return -at.e_platform[entry - bx];
      if (entry <= uy) return slide * (at.e[entry - ux] - at.e.z() * S(leg.u[entry - ux] / leg.u.z()));
      return S(1);
    };
    for (std::size_t c = 0; c < selected.size(); ++c) {
      const int j = selected[c];
      S& value = out.parameter(i, Eigen::Index(c));
      if (j < 0) continue;
      if (j < first_deformation) value = j / per_leg_ == i ? column_entry(entries[std::size_t(j % per_leg_)]) : S(0);
      else if (const int by = lifting_actuator(j - first_deformation, i); by >= 0)
        value = -at.e_platform.z() * (rho[std::size_t(by)] - S(reference_rho_[std::size_t(by)]));
    }
    // A twist (v, ω) moves the platform joint by v + ω × joint.
    const Vector3<S> moment = at.joint.cross(at.e);
    for (Eigen::Index k = 0; k < 3; ++k) {
      out.platform(i, k) = -at.e[k];
      out.platform(i, 3 + k) = -moment[k];
    }
    out.actuator(i, i) = slides ? leg.u.cast<S>().dot(at.e) : S(1);
    if (deformation.none) continue;
    for (int j = 0; j < leg_count; ++j)
      out.actuator(i, j) -= S(deformation.K[std::size_t(6 * i + j)]) * at.e_platform.z();
  }
}

bool SixLegs::do_loops_change(const LoopState& at, const Loops& slope, Twist& by_platform,
                              Eigen::VectorXd& by_actuators) const {
  const auto& [q, rho, own, selected] = at;
  const Eigen::Isometry3d X = platform_pose(q);
  const Eigen::Matrix3d& R = X.linear();
  const auto entries = entries_of(spec_.actuation);
  const bool slides = spec_.actuation == LegActuation::slide;
  const int first_deformation = leg_count * per_leg_;
  const Deformation deformation(slides && !own.empty() ? own.subspan(std::size_t(first_deformation)) : own.first(0));
  for (int i = 0; i < leg_count; ++i) {
    const double slide = slides ? rho[std::size_t(i)] : 0.0;
    const PlacedLeg leg(spec_.legs[std::size_t(i)], entries, leg_part(own, i, per_leg_));
    const double lift = deformation.none ? 0.0 : deformation.lift<double>(i, rho, reference_rho_);
    const Eigen::Vector3d joint = X * Eigen::Vector3d(leg.b + lift * Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d h = joint - leg.a - slide * leg.u;
    const double length_now = h.norm();
    const Eigen::Vector3d e = h / length_now, up = R.col(2);
    // h of the loops by the leg's direction e, and by e in the platform's axes; see do_loops() for what they are in.
    Eigen::Vector3d by_e = Eigen::Vector3d::Zero(), by_e_platform = Eigen::Vector3d::Zero();
    for (std::size_t c = 0; c < selected.size(); ++c) {
      const int j = selected[c];
      const double a = slope.parameter(i, Eigen::Index(c));
      if (j < 0) continue;
      if (j >= first_deformation) {
        const int by = lifting_actuator(j - first_deformation, i);
        if (by < 0) continue;
        by_e_platform.z() -= a * (rho[std::size_t(by)] - reference_rho_[std::size_t(by)]);
        by_actuators[by] -= a * up.dot(e);
        continue;
      }
      if (j / per_leg_ != i) continue;
      const Entry entry = entries[std::size_t(j % per_leg_)];
      if (entry <= az) by_e[entry] += a;
      else if (entry <= bz) by_e_platform[entry - bx] -= a;
      else if (entry <= uy) {
        const Eigen::Vector3d along =
            Eigen::Vector3d::Unit(entry - ux) - leg.u[entry - ux] / leg.u.z() * Eigen::Vector3d::UnitZ();
        by_e += a * slide * along;
        by_actuators[i] += a * along.dot(e);
      }
    }
    if (slides) by_e += slope.actuator(i, i) * leg.u;
    for (int j = 0; j < leg_count && !deformation.none; ++j)
      by_e_platform.z() -= slope.actuator(i, j) * deformation.K[std::size_t(6 * i + j)];
    const Eigen::Vector3d force = slope.platform.row(i).head<3>(), moment = slope.platform.row(i).tail<3>();
    const Eigen::Vector3d in_base = R * by_e_platform;
    by_e += in_base - force - moment.cross(joint);
    const Eigen::Vector3d by_h = (by_e - e.dot(by_e) * e) / length_now, by_joint = by_h - e.cross(moment);
    if (slides) by_actuators[i] -= by_h.dot(leg.u);
    for (int j = 0; j < leg_count && !deformation.none; ++j)
      by_actuators[j] += deformation.K[std::size_t(6 * i + j)] * by_joint.dot(up);
    by_platform.head<3>() += by_joint;
    by_platform.tail<3>() += joint.cross(by_joint) + in_base.cross(e);
  }
  return true;
}

void SixLegs::do_loops(const LoopState& at, Loops& out) const {
  loops_at<double>(frame_of(platform_pose(at.q)), at.actuators, at.own, at.selected, out);
}

/// Slides of all legs where the platform is not lifted by what they were before; `allowed` as Enclosed has it.
std::vector<TaylorModel> SixLegs::enclosed_actuators(const Frame<TaylorModel>& platform, std::span<const double> own,
                                                     std::span<const TaylorModel> lifts,
                                                     std::vector<TaylorModel>& allowed) const {
  std::vector<TaylorModel> rho;
  for (int i = 0; i < leg_count; ++i) {
    const auto k = std::size_t(i);
    const PlacedLeg leg(spec_.legs[k], entries_of(spec_.actuation), leg_part(own, i, per_leg_));
    Vector3<TaylorModel> b = leg.b.cast<TaylorModel>();
    if (!lifts.empty()) b.z() += lifts[k];
    const Vector3<TaylorModel> joint = platform.p + platform.R * b;
    if (spec_.actuation == LegActuation::extend) {
      const Vector3<TaylorModel> h = joint - leg.a.cast<TaylorModel>();
      rho.push_back(sqrt(h.dot(h)) - TaylorModel(leg.l));
      continue;
    }
    const Slide<TaylorModel> slide(leg, joint);
    rho.push_back(slide.along - sqrt(slide.under_root));
    allowed.push_back(slide.under_root);
  }
  return rho;
}

/// ρ = slides(lift(ρ)): a tube that this map takes into itself has a solution at every pose of the box (Brouwer), and
/// where the deformation shrinks distances there is no other.
bool SixLegs::enclose_lifted(const Frame<TaylorModel>& platform, std::span<const double> own, Enclosed& out) const {
  const Deformation deformation(own.subspan(std::size_t(leg_count * per_leg_)));
  for (int i = 0; i < leg_count; ++i) {
    double sum = 0;
    for (int j = 0; j < leg_count; ++j) sum += std::abs(deformation.K[std::size_t(6 * i + j)]);
    if (!(sum < most_contraction)) return false;
  }
  const auto next = [&](const std::vector<TaylorModel>& rho) {
    std::vector<TaylorModel> lifts;
    for (int i = 0; i < leg_count; ++i) lifts.push_back(deformation.lift<TaylorModel>(i, rho, reference_rho_));
    out.allowed.clear();
    return enclosed_actuators(platform, own, lifts, out.allowed);
  };
  std::vector<TaylorModel> rho = enclosed_actuators(platform, own, {}, out.allowed);
  std::vector<TaylorModel> found = unknown_models(rho.size()), allowed = unknown_models(out.allowed.size());
  BoxValues before;
  before.fill(std::numeric_limits<double>::infinity());
  std::array<bool, TaylorModel::boxes> done{};
  const auto all_done = [&] { return std::all_of(done.begin(), done.end(), [](bool one) { return one; }); };
  for (int iteration = 0; iteration < tube_iterations && !all_done(); ++iteration) {
    for (TaylorModel& r : rho) r = r.with_radius(0.0);
    // Twice what the last step still moved is more than all that follow.
    std::vector<TaylorModel> moved = next(rho), tubes;
    BoxValues change{}, twice;
    for (std::size_t i = 0; i < rho.size(); ++i) take_larger(change, (moved[i] - rho[i]).farthest());
    for (std::size_t box = 0; box < change.size(); ++box) twice[box] = 2 * change[box];
    for (const TaylorModel& m : moved) tubes.push_back(m.widened(twice));
    const std::vector<TaylorModel> images = next(tubes);
    const auto inside = are_inside(images, moved, tubes);
    for (std::size_t box = 0; box < done.size(); ++box) {
      // Narrower than what it encloses no tube gets.
      if (done[box] || !inside[box] || !(change[box] > 0.5 * before[box])) continue;
      done[box] = true;
      for (std::size_t i = 0; i < found.size(); ++i) found[i].take_box(box, images[i]);
      for (std::size_t i = 0; i < allowed.size(); ++i) allowed[i].take_box(box, out.allowed[i]);
    }
    before = change;
    rho = std::move(moved);
  }
  out.actuators = std::move(found);
  out.allowed = std::move(allowed);
  return std::any_of(done.begin(), done.end(), [](bool one) { return one; });
}

namespace {

/// R ← R · (rotation about a coordinate axis): two columns, without products of what does not move.
void rotate_about(int axis, const TaylorModel& angle, Eigen::Matrix<TaylorModel, 3, 3>& R) {
  const TaylorModel c = cos(angle), s = sin(angle);
  auto u = R.col((axis + 1) % 3), v = R.col((axis + 2) % 3);
  for (int i = 0; i < 3; ++i) {
    TaylorModel turned = c * u[i] + s * v[i];
    v[i] = c * v[i] - s * u[i];
    u[i] = std::move(turned);
  }
}

}  // namespace

bool SixLegs::do_enclose(std::span<const TaylorModel> q, std::span<const double> own, std::span<const int> selected,
                         Enclosed& out) const {
  out.X_BasePlatform = {};
  Frame<TaylorModel>& platform = out.X_BasePlatform;
  platform.p = X_BaseReference_.translation().cast<TaylorModel>() + Vector3<TaylorModel>(q[0], q[1], q[2]);
  for (const int axis : {2, 1, 0}) rotate_about(axis, q[std::size_t(3 + axis)], platform.R);
  platform.R = (platform.R * X_BaseReference_.linear().cast<TaylorModel>()).eval();
  out.allowed.clear();
  const bool lifted = spec_.actuation == LegActuation::slide && !own.empty() &&
                      !Deformation(own.subspan(std::size_t(leg_count * per_leg_))).none;
  if (!lifted) out.actuators = enclosed_actuators(platform, own, {}, out.allowed);
  else if (!enclose_lifted(platform, own, out)) return false;
  for (std::size_t i = 0; i < out.actuators.size(); ++i) {
    out.allowed.push_back(out.actuators[i] - TaylorModel(actuators_[i].lower));
    out.allowed.push_back(TaylorModel(actuators_[i].upper) - out.actuators[i]);
  }
  if (!selected.empty()) loops_at<TaylorModel>(platform, out.actuators, own, selected, out.loops);
  return true;
}

}  // namespace posewright
