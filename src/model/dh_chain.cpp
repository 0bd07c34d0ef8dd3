#include "posewright/model/dh_chain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "displacement.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Axes closer than this (sine of their angle) count as parallel: rounded URDFs (3.1416) are 1e-5 off, calibrated axes a
// tenth of a degree, and a common normal of almost parallel axes lies anywhere, hundreds of metres away. Lines closer
// than this (m) coincide.
constexpr double parallel = 2e-2, coincident = 1e-7;

struct Axis {
  Eigen::Vector3d point, direction;
  bool prismatic;
};

/// Axes of the joints at zero position in the measurement frame, and the pose of the tip.
std::vector<Axis> axes_of(const ChainDescription& chain, Eigen::Isometry3d& X_MeasureTip) {
  std::vector<Axis> axes;
  Eigen::Isometry3d X = chain.X_MeasureBase;
  for (const ChainJoint& joint : chain.joints) {
    if (joint.mimic || joint.multiplier != 1 || joint.offset != 0)
      throw CannotDo("variant: Denavit–Hartenberg parameters are not defined for the mimic joint '" + joint.name + "'");
    X = X * joint.X_ParentJoint;
    axes.push_back({X.translation(), X.linear() * joint.axis, joint.prismatic});
  }
  X_MeasureTip = X * chain.X_LastTip;
  return axes;
}

Eigen::Isometry3d frame_along(const Eigen::Vector3d& origin, const Eigen::Vector3d& z, const Eigen::Vector3d& x_hint) {
  Eigen::Vector3d x = x_hint - z * z.dot(x_hint);
  if (x.norm() < 1e-6) x = z.unitOrthogonal();
  x.normalize();
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() << x, z.cross(x), z;
  X.translation() = origin;
  return X;
}

/// The four (or, with Hayati's β, other four) numbers from a frame on one axis to the next axis.
struct Link {
  double theta = 0, d = 0, a = 0, alpha = 0, beta = 0;
  bool hayati = false;
};

Link link_to(const Eigen::Isometry3d& X, Axis next) {
  const Eigen::Vector3d o = X.translation(), z = X.linear().col(2);
  // A prismatic joint has a direction but no place: its line goes through where we are.
  if (next.prismatic) next.point = o;
  Link link;
  Eigen::Vector3d normal = z.cross(next.direction), foot = o, next_foot = next.point;
  link.hayati = normal.norm() < parallel;
  if (link.hayati) {
    // Where the next axis meets the plane through o across this one; α and β take up what the axes lack of parallel.
    next_foot = next.point + next.direction * (z.dot(o - next.point) / z.dot(next.direction));
    normal = next_foot - o;
    if (normal.norm() < coincident) normal = X.linear().col(0);
  } else {
    // Feet of the common normal: o + z·t and next.point + direction·u.
    const Eigen::Vector3d between = next.point - o;
    const double c = z.dot(next.direction), det = 1 - c * c;
    const double t = (between.dot(z) - c * between.dot(next.direction)) / det;
    const double u = (c * between.dot(z) - between.dot(next.direction)) / det;
    foot = o + t * z;
    next_foot = next.point + u * next.direction;
    link.d = t;
    // Of both directions of the normal the one that leads to the next axis, or that turns x least.
    const double ahead = normal.dot(next_foot - foot);
    if (ahead < -coincident || (std::abs(ahead) <= coincident && normal.dot(X.linear().col(0)) < 0)) normal = -normal;
  }
  const Eigen::Vector3d x = normal.normalized();
  link.theta = std::atan2(x.dot(X.linear().col(1)), x.dot(X.linear().col(0)));
  link.a = x.dot(next_foot - foot);
  link.alpha = std::atan2(z.cross(next.direction).dot(x), z.dot(next.direction));
  if (link.hayati) link.beta = std::asin(std::clamp(next.direction.dot(x), -1.0, 1.0));
  return link;
}

Eigen::Isometry3d after(const Eigen::Isometry3d& X, const Link& link) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return X * AngleAxisd(link.theta, Vector3d::UnitZ()) * Eigen::Translation3d(link.a, 0, link.d) *
         AngleAxisd(link.alpha, Vector3d::UnitX()) * AngleAxisd(link.beta, Vector3d::UnitY());
}

}  // namespace

DhDescription denavit_hartenberg(const ChainDescription& chain, DhConvention convention) {
  DhDescription dh;
  Eigen::Isometry3d X_MeasureTip;
  const std::vector<Axis> axes = axes_of(chain, X_MeasureTip);
  dh.coordinates = chain.coordinates;
  dh.encoder_noise = chain.encoder_noise;
  dh.base = frame_along(axes.front().point, axes.front().direction, chain.X_MeasureBase.linear().col(0));
  Eigen::Isometry3d X = dh.base;
  const bool proximal = convention == DhConvention::proximal;
  const auto add = [&](const std::string& name, bool rotation, int axis, double value, int coordinate = -1) {
    dh.motions.push_back({rotation, axis, value, coordinate, name});
  };
  if (proximal) {
    add(chain.joints.front().name + ".alpha", true, 0, 0);
    add(chain.joints.front().name + ".a", false, 0, 0);
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const bool last = i + 1 == axes.size();
    const Link link = last ? Link{} : link_to(X, axes[i + 1]);
    const std::string& own = chain.joints[i].name;
    const int coordinate = chain.joints[i].coordinate;
    add(own + ".theta", true, 2, link.theta, axes[i].prismatic ? -1 : coordinate);
    if (!link.hayati) add(own + ".d", false, 2, link.d, axes[i].prismatic ? coordinate : -1);
    else if (axes[i].prismatic) dh.motions.push_back({false, 2, 0.0, coordinate, ""});
    X = after(X, link);
    if (last && proximal) continue;
    const std::string& holder = proximal ? chain.joints[i + 1].name : own;
    add(holder + ".a", false, 0, link.a);
    add(holder + ".alpha", true, 0, link.alpha);
    if (link.hayati) add(holder + ".beta", true, 1, link.beta);
  }
  dh.tool = X.inverse() * X_MeasureTip;
  return dh;
}

DhChain::DhChain(DhDescription chain) : chain_(std::move(chain)) {
  coordinates_ = chain_.coordinates;
  reading_noise_ = chain_.encoder_noise;
  append_displacement(parameters_, "base", chain_.base, 10e-3, 1 * degree);
  for (const ElementaryMotion& motion : chain_.motions)
    if (!motion.name.empty())
      parameters_.push_back({motion.name, motion.rotation ? "rad" : "m", motion.nominal,
                             motion.rotation ? 0.05 * degree : 0.5e-3, Role::interest});
  tool_ = int(parameters_.size());
  append_displacement(parameters_, "tool", chain_.tool, 5e-3, 1 * degree);
  for (int i = 0; i < int(parameters_.size()); ++i) geometric_.push_back({i, i < 6 ? 0 : i >= tool_ ? 1 : 2});
}

HarmonicColumns DhChain::harmonic_columns(std::span<const int> selected, const Point&) const {
  HarmonicColumns result;
  result.selected.assign(selected.begin(), selected.end());
  result.degrees.assign(coordinates_.size(), 1);
  return result;
}

struct DhChain::State {
  std::vector<Twist> motions;         ///< of every elementary motion
  std::vector<Twist> along;           ///< of base, named motions, tool, as parameters are counted
  std::vector<std::size_t> carriers;  ///< of each of these: how many motions carry it
};

Eigen::Isometry3d DhChain::run(const Point& at, State& state) const {
  state.motions.clear();
  state.along.clear();
  state.carriers.clear();
  const auto add = [&](const Twist& twist) {
    state.along.push_back(twist);
    state.carriers.push_back(state.motions.size());
  };
  const bool corrected = !at.correction.empty();
  Frame<double> frame = frame_of(chain_.base);
  const DisplacementAxes base = displace(frame, corrected ? at.correction.data() : nullptr);
  for (int k = 0; k < 6; ++k) add(base.twist(k));
  for (const ElementaryMotion& motion : chain_.motions) {
    const Eigen::Vector3d axis = frame.R.col(motion.axis);
    const Twist twist = motion.rotation ? revolute(axis, frame.p) : prismatic(axis);
    double value = motion.nominal;
    if (motion.coordinate >= 0) value += at.q[std::size_t(motion.coordinate)];
    if (!motion.name.empty()) {
      if (corrected) value += at.correction[state.along.size()];
      add(twist);
    }
    state.motions.push_back(twist);
    if (motion.rotation) frame.then_rotate(Eigen::Vector3d::Unit(motion.axis), value);
    else frame.p += axis * value;
  }
  frame.then(chain_.tool);
  const bool tool_corrected = at.correction.size() > std::size_t(tool_);
  const DisplacementAxes tool = displace(frame, tool_corrected ? at.correction.data() + tool_ : nullptr);
  for (int k = 0; k < 6; ++k) add(tool.twist(k));
  return isometry_of(frame);
}

bool DhChain::linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X_MeasureTip, Twists& twists,
                        Twists* reading_twists) const {
  static thread_local State state;
  X_MeasureTip = run(at, state);
  twists.resize(6, Eigen::Index(selected.size()));
  for (std::size_t c = 0; c < selected.size(); ++c) {
    if (std::size_t(selected[c]) < state.along.size())
      twists.col(Eigen::Index(c)) = state.along[std::size_t(selected[c])];
    else twists.col(Eigen::Index(c)).setZero();
  }
  if (reading_twists == nullptr) return true;
  reading_twists->resize(6, Eigen::Index(coordinates_.size()));
  for (std::size_t i = 0; i < chain_.motions.size(); ++i)
    if (chain_.motions[i].coordinate >= 0) reading_twists->col(chain_.motions[i].coordinate) = state.motions[i];
  return true;
}

bool DhChain::pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                        std::span<double> gradient) const {
  static thread_local State state;
  static thread_local std::vector<Twist> carried;  // f's change by a twist of what so many motions carry
  run(at, state);
  carried.assign(state.motions.size() + 1, Twist::Zero());
  carried.back() = f.tip;
  for (std::size_t c = 0; c < selected.size(); ++c)
    if (const auto i = std::size_t(selected[c]); i < state.along.size())
      carried[state.carriers[i]] += carried_change(state.along[i], f.twists.col(Eigen::Index(c)));
  for (std::size_t i = 0; f.reading_twists.cols() > 0 && i < state.motions.size(); ++i)
    if (const int k = chain_.motions[i].coordinate; k >= 0)
      carried[i] += carried_change(state.motions[i], f.reading_twists.col(k));
  Twist beyond = Twist::Zero();
  for (std::size_t i = state.motions.size(); i-- > 0;) {
    beyond += carried[i + 1];
    if (const int k = chain_.motions[i].coordinate; k >= 0) gradient[std::size_t(k)] += state.motions[i].dot(beyond);
  }
  return true;
}

}  // namespace posewright
