#include "posewright/model/closed_chain.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "displacement.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

constexpr int newton_steps = 50;
// Newton's method ends after a step this small (m, rad): it squares the error, so what is left is rounding.
constexpr double newton_tolerance = 1e-12;
// Smallest pivot of F_x, relative to its largest, that is not a singularity: nearer to one the linear model would not
// hold over the tolerances.
constexpr double singular_pivot = 1e-4;

// Of the central differences of twists along the coordinates, m or rad: their error is about its square.
constexpr double freedom_step = 1e-5;

/// At most six coordinates, so nothing here touches the heap.
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using Factor = Eigen::FullPivLU<Square>;

bool is_singular(const Factor& factor) {
  const auto pivots = factor.matrixLU().diagonal().cwiseAbs();
  return !(pivots.minCoeff() > singular_pivot * pivots.maxCoeff());
}

/// f's derivatives by twists expressed in A become those by the same twists expressed in B.
void slopes_to_frame(const Eigen::Isometry3d& X_AB, Eigen::Ref<Twists> slopes) {
  const Eigen::Matrix3d& R = X_AB.linear();
  for (Eigen::Index j = 0; j < slopes.cols(); ++j) {
    const Eigen::Vector3d a = slopes.col(j).head<3>(), b = slopes.col(j).tail<3>();
    slopes.col(j).head<3>() = R.transpose() * a;
    slopes.col(j).tail<3>() = R.transpose() * (b + a.cross(X_AB.translation()));
  }
}

}  // namespace

/// Work space of one thread, so that a loop over configurations does not allocate.
struct ClosedChain::Scratch {
  Loops loops, sensors;
  std::vector<int> own;
  std::vector<double> actuators;
  LoopState state;
  Eigen::Isometry3d X_BasePlatform;
  Twists freedoms;
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> response;  ///< −B F_x⁻¹: twist of the platform per loop residual
  Factor factor;
};

ClosedChain::Scratch& ClosedChain::scratch_of_this_thread() {
  static thread_local Scratch scratch;
  return scratch;
}

bool ClosedChain::respond(const Point& at, std::span<const int> selected, Scratch& s) const {
  const auto own = own_part(at.correction);
  s.actuators.resize(actuators_.size());
  if (!do_inverse_kinematics(at.q, own, s.actuators)) return false;
  own_selection(selected, s.own);
  s.state = {at.q, s.actuators, own, s.own};
  s.X_BasePlatform = do_platform(at.q, s.freedoms);
  loops(s.state, s.loops);
  // A product of its own type: whether Eigen's temporary of any size meets the heap is up to the compiler.
  const Square along_freedoms = s.loops.platform.lazyProduct(s.freedoms);
  s.factor.compute(along_freedoms.transpose());
  if (is_singular(s.factor)) return false;
  const Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 6, 6> freedoms = s.freedoms.transpose();
  s.response = -s.factor.solve(freedoms).transpose();
  return true;
}

ClosedChain::ClosedChain(const Placement& placement) : X_MeasureBase_(isometry(placement)) {
  append_displacement(parameters_, "base", X_MeasureBase_, 10e-3, 1 * degree);
}

void ClosedChain::finish(const std::vector<Parameter>& own, double actuator_noise) {
  own_count_ = int(own.size());
  parameters_.insert(parameters_.end(), own.begin(), own.end());
  append_displacement(parameters_, "tool", Eigen::Isometry3d::Identity(), 5e-3, 1 * degree);
  const int count = int(parameters_.size());
  for (int i = 0; i < count; ++i) geometric_.push_back({i, i < 6 ? 0 : i >= count - 6 ? 1 : 2});
  reading_noise_.assign(actuators_.size(), actuator_noise);
}

std::span<const double> ClosedChain::own_part(std::span<const double> correction) const {
  return correction.empty() ? correction : correction.subspan(std::size_t(first_own()), std::size_t(own_count_));
}

void ClosedChain::own_selection(std::span<const int> selected, std::vector<int>& own) const {
  own.clear();
  for (const int index : selected) {
    const int i = index - first_own();
    own.push_back(i >= 0 && i < own_count_ ? i : -1);
  }
}

bool ClosedChain::actuator_values(const Point& at, std::span<double> values) const {
  return do_inverse_kinematics(at.q, own_part(at.correction), values);
}

Eigen::Isometry3d ClosedChain::platform(std::span<const double> q) const {
  Twists freedoms;
  return do_platform(q, freedoms);
}

std::vector<Polyline> ClosedChain::skeleton(std::span<const double> q) const {
  std::vector<double> actuators(actuators_.size());
  if (!do_inverse_kinematics(q, {}, actuators)) return {};
  std::vector<Polyline> lines = do_skeleton(q, actuators);
  for (Polyline& line : lines)
    for (Eigen::Vector3d& point : line) point = X_MeasureBase_ * point;
  return lines;
}

void ClosedChain::loops(const LoopState& at, Loops& out) const {
  const auto d = Eigen::Index(coordinates_.size());
  out.value.setZero(d);
  out.parameter.setZero(d, Eigen::Index(at.selected.size()));
  out.platform.setZero(d, 6);
  out.actuator.setZero(d, Eigen::Index(at.actuators.size()));
  do_loops(at, out);
}

bool ClosedChain::linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X_MeasureTip,
                            Twists& twists, Twists* reading_twists) const {
  Scratch& s = scratch_of_this_thread();
  if (!respond(at, selected, s)) return false;

  Frame<double> frame = frame_of(X_MeasureBase_);
  const DisplacementAxes base = displace(frame, at.correction.empty() ? nullptr : at.correction.data());
  const Eigen::Isometry3d X_MeasureBase = isometry_of(frame);
  frame.then(s.X_BasePlatform);
  const std::size_t first_tool = std::size_t(first_own() + own_count_);
  const DisplacementAxes tool =
      displace(frame, at.correction.size() > first_tool ? at.correction.data() + first_tool : nullptr);
  X_MeasureTip = isometry_of(frame);

  twists.resize(6, Eigen::Index(selected.size()));
  twists.noalias() = s.response.lazyProduct(s.loops.parameter);
  change_frame(X_MeasureBase, twists);
  for (std::size_t c = 0; c < selected.size(); ++c) {
    const int index = selected[c];
    if (index < 6) twists.col(Eigen::Index(c)) = base.twist(index);
    else if (index >= int(first_tool) && index < int(first_tool) + 6)
      twists.col(Eigen::Index(c)) = tool.twist(index - int(first_tool));
  }
  if (reading_twists != nullptr) {
    reading_twists->resize(6, s.loops.actuator.cols());
    reading_twists->noalias() = s.response.lazyProduct(s.loops.actuator);
    change_frame(X_MeasureBase, *reading_twists);
  }
  return true;
}

bool ClosedChain::do_loops_change(const LoopState&, const Loops&, Twist&, Eigen::VectorXd&) const { return false; }

bool ClosedChain::pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                            std::span<double> gradient) const {
  Scratch& s = scratch_of_this_thread();
  static thread_local Loops slope;
  static thread_local Twists twists, readings;
  if (!respond(at, selected, s)) return false;

  Frame<double> frame = frame_of(X_MeasureBase_);
  displace(frame, at.correction.empty() ? nullptr : at.correction.data());
  const Eigen::Isometry3d X_MeasureBase = isometry_of(frame);
  frame.then(s.X_BasePlatform);
  const int first_tool = first_own() + own_count_;
  const DisplacementAxes tool =
      displace(frame, at.correction.size() > std::size_t(first_tool) ? at.correction.data() + first_tool : nullptr);
  twists = f.twists;
  readings = f.reading_twists;
  // The tool's axes ride on the platform, the base's stay.
  Twist by_platform = f.tip;
  for (std::size_t c = 0; c < selected.size(); ++c) {
    if (s.own[c] >= 0) continue;
    auto column = twists.col(Eigen::Index(c));
    if (const int k = selected[c] - first_tool; k >= 0 && k < 6) by_platform += carried_change(tool.twist(k), column);
    column.setZero();
  }
  slopes_to_frame(X_MeasureBase, twists);
  slopes_to_frame(X_MeasureBase, readings);
  slopes_to_frame(X_MeasureBase, by_platform);

  // Of the response R = −B F_x⁻¹, F_x = F_X B: dR = −(dB + R (dF_X B + F_X dB)) F_x⁻¹.
  using Response = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;
  Response by_response = twists * s.loops.parameter.transpose();
  if (readings.cols() > 0) by_response += readings * s.loops.actuator.transpose();
  const Square by_coordinates = s.loops.platform * s.freedoms;
  const Response Z = by_coordinates.partialPivLu().solve(by_response.transpose()).transpose();
  const Square Q = s.response.transpose() * Z;
  const Response by_freedoms = -Z - s.loops.platform.transpose() * Q;
  slope.parameter.noalias() = s.response.transpose() * twists;
  slope.platform.noalias() = -Q * s.freedoms.transpose();
  if (readings.cols() > 0) slope.actuator.noalias() = s.response.transpose() * readings;
  else slope.actuator.setZero(s.loops.actuator.rows(), s.loops.actuator.cols());
  Eigen::VectorXd by_actuators = Eigen::VectorXd::Zero(s.loops.actuator.cols());
  if (!do_loops_change(s.state, slope, by_platform, by_actuators))
    return TipModel::pull_back(at, selected, f, gradient);
  // The loops stay closed: F_ρ dρ = −F_X B dq.
  by_platform -= s.loops.platform.transpose() * s.loops.actuator.transpose().partialPivLu().solve(by_actuators);
  for (Eigen::Index k = 0; k < s.freedoms.cols(); ++k) gradient[std::size_t(k)] += s.freedoms.col(k).dot(by_platform);
  add_turned_freedoms(at.q, by_freedoms, gradient);
  return true;
}

/// Twists along the coordinates turn with them: central differences of these alone.
void ClosedChain::add_turned_freedoms(std::span<const double> q, const Eigen::Ref<const Twists>& by_freedoms,
                                      std::span<double> gradient) const {
  static thread_local Twists ahead, behind;
  std::array<double, 6> near{};
  std::copy(q.begin(), q.end(), near.begin());
  const auto there = std::span<const double>(near).first(q.size());
  for (std::size_t k = 0; k < q.size(); ++k) {
    near[k] = q[k] + freedom_step;
    do_platform(there, ahead);
    near[k] = q[k] - freedom_step;
    do_platform(there, behind);
    near[k] = q[k];
    gradient[k] += by_freedoms.cwiseProduct(ahead - behind).sum() / (2 * freedom_step);
  }
}

bool ClosedChain::sensor_rows(const Point& at, std::span<const int> selected, Eigen::MatrixXd& rows,
                              Eigen::MatrixXd& reading_rows) const {
  Scratch& s = scratch_of_this_thread();
  if (!respond(at, selected, s)) return false;
  read_sensors(s.state, s.sensors);
  rows = s.sensors.parameter + s.sensors.platform * s.response * s.loops.parameter;
  reading_rows = s.sensors.actuator + s.sensors.platform * s.response * s.loops.actuator;
  return true;
}

void ClosedChain::read_sensors(const LoopState& at, Loops& out) const {
  const auto count = Eigen::Index(sensors_.size());
  out.value.setZero(count);
  out.parameter.setZero(count, Eigen::Index(at.selected.size()));
  out.platform.setZero(count, 6);
  out.actuator.setZero(count, Eigen::Index(actuators_.size()));
  do_sensors(at, out);
}

bool ClosedChain::sensor_values(const Point& at, Eigen::VectorXd& values) const {
  Scratch& s = scratch_of_this_thread();
  const auto own = own_part(at.correction);
  s.actuators.resize(actuators_.size());
  if (!do_inverse_kinematics(at.q, own, s.actuators)) return false;
  read_sensors({at.q, s.actuators, own, {}}, s.sensors);
  values = s.sensors.value;
  return true;
}

bool ClosedChain::configuration_at(std::span<const double> actuators, const Point& start, std::span<double> q) const {
  const auto found = forward_kinematics(actuators, start);
  if (!found) return false;
  std::copy(found->begin(), found->end(), q.begin());
  return true;
}

void ClosedChain::do_sensors(const LoopState&, Loops&) const {
  throw std::logic_error("this robot has no redundant joint sensors");
}

std::optional<std::vector<double>> ClosedChain::forward_kinematics(std::span<const double> actuators,
                                                                   const Point& start) const {
  Scratch& s = scratch_of_this_thread();
  std::vector<double> q(start.q.begin(), start.q.end());
  for (int step = 0; step < newton_steps; ++step) {
    do_platform(q, s.freedoms);
    loops({q, actuators, own_part(start.correction), {}}, s.loops);
    s.factor.compute(s.loops.platform * s.freedoms);
    if (!s.loops.value.allFinite() || is_singular(s.factor)) return std::nullopt;
    const Eigen::VectorXd change = s.factor.solve(s.loops.value);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] -= change[Eigen::Index(i)];
    if (change.cwiseAbs().maxCoeff() < newton_tolerance) return q;
  }
  return std::nullopt;
}

HarmonicColumns ClosedChain::harmonic_columns(std::span<const int>, const Point&) const {
  HarmonicColumns none;
  none.why_not =
      "a parallel robot; six legs are bounded where the instrument sees the whole pose with one noise and no target is "
      "estimated";
  return none;
}

bool ClosedChain::do_enclose(std::span<const TaylorModel>, std::span<const double>, std::span<const int>,
                             Enclosed&) const {
  return false;
}

namespace {

using EnclosedMatrix = TipModel::EnclosedResidual::Matrix;

/// Rows along spatial twists in B become rows along spatial twists in A, X_BA the pose of A in B: row · adjoint.
EnclosedMatrix in_frame(const EnclosedMatrix& rows, const Frame<TaylorModel>& X_BA) {
  using Vector = Eigen::Matrix<TaylorModel, 3, 1>;
  EnclosedMatrix result(rows.rows(), 6);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    Vector force, moment;
    for (Eigen::Index k = 0; k < 3; ++k) {
      force[k] = rows(i, k);
      moment[k] = rows(i, 3 + k);
    }
    moment += force.cross(X_BA.p);
    for (Eigen::Index k = 0; k < 3; ++k) {
      result(i, k) = force.dot(X_BA.R.col(k));
      result(i, 3 + k) = moment.dot(X_BA.R.col(k));
    }
  }
  return result;
}

Frame<TaylorModel> constant_frame(const Eigen::Isometry3d& X) {
  Frame<TaylorModel> frame;
  frame.then(X);
  return frame;
}

/// A twist of the tip changes the residual like an opposite motion of the platform: column −rows · twist.
void fill_column(const EnclosedMatrix& rows, const Twist& twist, Eigen::Index c, EnclosedMatrix& parameter) {
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    TaylorModel sum;
    for (Eigen::Index k = 0; k < 6; ++k)
      if (twist[k] != 0) sum.add(-twist[k], rows(i, k));
    parameter(i, c) = std::move(sum);
  }
}

}  // namespace

bool ClosedChain::enclose_residual(std::span<const TaylorModel> q, std::span<const double> correction,
                                   std::span<const int> selected, EnclosedResidual& out) const {
  const auto d = Eigen::Index(coordinates_.size()), columns = Eigen::Index(selected.size());
  if (d != 6 || q.size() != 6) return false;
  Enclosed chain;
  std::vector<int> own;
  own_selection(selected, own);
  chain.loops.parameter.setZero(d, columns);
  chain.loops.platform.setZero(d, 6);
  chain.loops.actuator.setZero(d, Eigen::Index(actuators_.size()));
  chain.loops.value.setZero(d);
  if (!do_enclose(q, own_part(correction), own, chain)) return false;
  out.allowed = std::move(chain.allowed);
  // Whoever selects nothing asks for the limits alone.
  if (selected.empty()) return true;
  out.actuator = std::move(chain.loops.actuator);
  out.parameter = std::move(chain.loops.parameter);

  Frame<double> base_frame = frame_of(X_MeasureBase_), tool_frame;
  const DisplacementAxes base = displace(base_frame, correction.empty() ? nullptr : correction.data());
  const std::size_t first_tool = std::size_t(first_own() + own_count_);
  const DisplacementAxes tool =
      displace(tool_frame, correction.size() > first_tool ? correction.data() + first_tool : nullptr);
  EnclosedMatrix along_base;
  if (std::any_of(selected.begin(), selected.end(), [](int index) { return index < 6; }))
    along_base = in_frame(chain.loops.platform, constant_frame(isometry_of(base_frame).inverse()));
  const EnclosedMatrix along_platform = in_frame(chain.loops.platform, chain.X_BasePlatform);
  out.platform = in_frame(along_platform, constant_frame(isometry_of(tool_frame)));
  for (Eigen::Index c = 0; c < columns; ++c) {
    const int index = selected[std::size_t(c)];
    if (index < 6) fill_column(along_base, base.twist(index), c, out.parameter);
    else if (index >= int(first_tool))
      fill_column(along_platform, tool.twist(index - int(first_tool)), c, out.parameter);
  }
  return true;
}

}  // namespace posewright
