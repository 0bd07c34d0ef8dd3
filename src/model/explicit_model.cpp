#include "posewright/model/explicit_model.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "posewright/model/closed_chain.hpp"
#include "posewright/support/dense.hpp"
#include "repeatability.hpp"

namespace posewright {
namespace {

/// Spatial twists about the origin of M become coefficients of the unit twists about p.
void about_tip_origin(const Eigen::Vector3d& p, Twists& twists) {
  for (Eigen::Index c = 0; c < twists.cols(); ++c)
    twists.col(c).head<3>() -= p.cross(Eigen::Vector3d(twists.col(c).tail<3>()));
}

}  // namespace

/// A point cut into the robot's and the instrument's.
struct ExplicitModel::Parts {
  Point tip;
  std::span<const double> own_correction;
  int station;
};

ExplicitModel::ExplicitModel(std::unique_ptr<TipModel> tip, std::unique_ptr<MeasurementModel> measurement,
                             const Repeatability& repeatability)
    : tip_(std::move(tip)), measurement_(std::move(measurement)), repeatability_(repeatability) {
  const auto is_tool = [](const Parameter& p) { return p.name.starts_with("tool."); };
  parameters_ = tip_->parameters();
  if (measurement_->replaces_tool()) std::erase_if(parameters_, is_tool);
  tip_parameters_ = int(parameters_.size());
  for (const Preference& preference : tip_->geometric_parameters())
    if (preference.parameter < tip_parameters_) geometric_.push_back(preference);
  for (const Preference& preference : measurement_->preferences())
    geometric_.push_back({tip_parameters_ + preference.parameter, preference.tier});
  parameters_.insert(parameters_.end(), measurement_->parameters().begin(), measurement_->parameters().end());
  coordinates_ = tip_->coordinates();
  actuators_ = tip_->actuators();
  if (!measurement_->stations().empty()) coordinates_.push_back(make_choice("station", measurement_->stations()));
  const Eigen::Isometry3d anywhere = Eigen::Isometry3d::Identity();
  for (int i = 0; i < int(parameters_.size()); ++i)
    is_own_column_.push_back(i >= tip_parameters_ &&
                             !measurement_->motion({anywhere, {}, 0}, i - tip_parameters_, nullptr));
  is_own_column_.resize(parameters_.size() + 6, 0);  // of the tip's own unit twists, none
  tips_ = 1;
  tip_coordinates_ = tip_->coordinates().size();
  unmeasurable_reason_ = measurement_->unseen_reason();
  if (!actuators_.empty()) unmeasurable_reason_ += (unmeasurable_reason_.empty() ? "" : " or ") + near_singularity();
  readings_ = measurement_->readings();
  rows_ = measurement_->rows();
  rows_per_target_ = measurement_->rows_per_target();
  reading_noise_ =
      std::any_of(tip_->reading_noise().begin(), tip_->reading_noise().end(), [](double s) { return s > 0; });
}

ExplicitModel::Parts ExplicitModel::parts(const Point& at) const {
  const std::size_t tip = at.correction.empty() ? 0 : std::size_t(tip_parameters_);
  return {{at.q.first(tip_->coordinates().size()), at.correction.first(tip), at.chosen},
          at.correction.subspan(tip),
          at.chosen.station};
}

/// Twists of the selected parameters (zero for the instrument's own columns) and of what moves the tip at random, 1σ
/// each (joint readings, the visit's displacement); the instrument's own covariance.
bool ExplicitModel::twists_and_noise(const Parts& p, std::span<const int> selected, Eigen::Isometry3d& X,
                                     Linearisation& out) const {
  if (!tip_->linearise(p.tip, selected, X, out.twists, reading_noise_ ? &out.reading_twists : nullptr)) return false;
  const MeasurementModel::Sighting sighting{X, p.own_correction, p.station};
  for (std::size_t c = 0; c < selected.size(); ++c) {
    // Without its tool the tip's catalogue ends earlier than the tip knows: what follows is the instrument's.
    if (selected[c] < tip_parameters_) continue;
    if (const int k = selected[c] - tip_column(0, 0); k >= 0) {
      out.twists.col(Eigen::Index(c)) = unit_displacement(X.translation(), k);
      continue;
    }
    Twist twist = Twist::Zero();
    measurement_->motion(sighting, selected[c] - tip_parameters_, &twist);
    out.twists.col(Eigen::Index(c)) = twist;
  }
  out.covariance.resize(rows_, rows_);
  measurement_->covariance(sighting, out.covariance);
  out.share_readings();
  if (repeatability_.independent > 0) displace_alone(sighting, out);
  const Eigen::Index readings = reading_noise_ ? out.reading_twists.cols() : 0;
  const int displacement = displacement_size(repeatability_);
  out.random_twists.resize(6, readings + displacement);
  for (Eigen::Index j = 0; j < readings; ++j)
    out.random_twists.col(j) = tip_->reading_noise()[std::size_t(j)] * out.reading_twists.col(j);
  displacement_of_a_visit(repeatability_, X.translation(), out.random_twists.rightCols(displacement));
  return true;
}

/// Each target, or each reading if there are none, moves on its own.
void ExplicitModel::displace_alone(const MeasurementModel::Sighting& sighting, Linearisation& out) const {
  out.rows.resize(rows_, 3);
  measurement_->rows_of_twists(sighting, repeatability_.independent * Twists::Identity(6, 3), out.rows);
  const Eigen::Index each = std::max(1, rows_per_target_);
  for (Eigen::Index first = 0; first + each <= rows_; first += each) {
    const auto own = out.rows.middleRows(first, each);
    out.covariance.block(first, first, each, each) += own * own.transpose();
  }
}

void ExplicitModel::do_take_loads_at(std::span<const double> correction) {
  tip_->take_loads_at(correction.empty() ? correction : correction.first(std::size_t(tip_parameters_)));
}

bool ExplicitModel::do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const {
  const Parts p = parts(at);
  Eigen::Isometry3d X;
  if (!twists_and_noise(p, selected, X, out)) return false;
  const MeasurementModel::Sighting sighting{X, p.own_correction, p.station};
  if (out.random_twists.cols() > 0) {
    out.rows.resize(rows_, out.random_twists.cols());
    measurement_->rows_of_twists(sighting, out.random_twists, out.rows);
    out.covariance.noalias() += out.rows * out.rows.transpose();
  }
  out.G.resize(rows_, Eigen::Index(selected.size()));
  measurement_->rows_of_twists(sighting, out.twists, out.G);
  for (std::size_t c = 0; c < selected.size(); ++c)
    if (is_own_column_[std::size_t(selected[c])] != 0)
      measurement_->own_column(sighting, selected[c] - tip_parameters_, out.G.col(Eigen::Index(c)));
  return true;
}

/// Rows Y along unit twists and twists T make Y T, so that f's derivatives go to Y, to T, and from these to the robot
/// and the instrument; the covariance has D Dᵀ in it, D = Y N of what moves the tip at random.
bool ExplicitModel::do_pull_back(const Point& at, std::span<const int> selected, const Eigen::MatrixXd& by_G,
                                 const Eigen::MatrixXd& by_covariance, std::span<double> gradient) const {
  static thread_local Linearisation l;
  static thread_local Eigen::MatrixXd Y, by_random_rows;
  static thread_local Twists by_random;
  static thread_local TipAdjoint by_tip;
  static thread_local MeasurementModel::Adjoint by_readings;
  const Parts p = parts(at);
  Eigen::Isometry3d X;
  if (!twists_and_noise(p, selected, X, l)) return false;
  const MeasurementModel::Sighting sighting{X, p.own_correction, p.station};
  Y.resize(rows_, 6);
  measurement_->rows_of_twists(sighting, Twists::Identity(6, 6), Y);
  by_readings.twist_rows.noalias() = by_G * l.twists.transpose();
  by_tip.twists.noalias() = Y.transpose() * by_G;
  by_random_rows.noalias() = 2 * by_covariance * (Y * l.random_twists);
  by_readings.twist_rows.noalias() += by_random_rows * l.random_twists.transpose();
  by_random.noalias() = Y.transpose() * by_random_rows;
  if (repeatability_.independent > 0) displacements_pulled_back(by_covariance, Y, by_readings.twist_rows);

  // Turns about the tip's origin move it by p × axis.
  Eigen::Vector3d by_origin = Eigen::Vector3d::Zero();
  const auto turned = [&](int k, double size, const Eigen::Ref<const Twist>& slope) {
    if (k >= 3) by_origin += size * Eigen::Vector3d::Unit(k - 3).cross(Eigen::Vector3d(slope.head<3>()));
  };
  by_readings.own.clear();
  by_readings.own_columns.resize(rows_, Eigen::Index(selected.size()));
  by_readings.own_motions.resize(6, Eigen::Index(selected.size()));
  for (std::size_t c = 0; c < selected.size(); ++c) {
    if (selected[c] < tip_parameters_) continue;
    auto slope = by_tip.twists.col(Eigen::Index(c));
    if (const int k = selected[c] - tip_column(0, 0); k >= 0) {
      turned(k, 1.0, slope);
    } else {
      const auto i = Eigen::Index(by_readings.own.size());
      by_readings.own.push_back(selected[c] - tip_parameters_);
      by_readings.own_columns.col(i) = by_G.col(Eigen::Index(c));
      by_readings.own_motions.col(i) = slope;
    }
    slope.setZero();  // the robot counts its tool's parameters here
  }
  const Eigen::Index readings = reading_noise_ ? l.reading_twists.cols() : 0;
  for (Eigen::Index k = readings; k < by_random.cols(); ++k)
    turned(int(k - readings), repeatability_.rotation, by_random.col(k));
  by_tip.reading_twists = by_random.leftCols(readings);
  for (Eigen::Index j = 0; j < readings; ++j) by_tip.reading_twists.col(j) *= tip_->reading_noise()[std::size_t(j)];
  by_readings.covariance = by_covariance;
  by_tip.tip = measurement_->pull_back(sighting, by_readings) +
               change_by_motion(X.translation(), by_origin, Eigen::Vector3d::Zero());
  return tip_->pull_back(p.tip, selected, by_tip, gradient.first(tip_->coordinates().size()));
}

void ExplicitModel::displacements_pulled_back(const Eigen::MatrixXd& by_covariance, const Eigen::MatrixXd& unit_rows,
                                              Eigen::MatrixXd& by_unit_rows) const {
  const double variance = repeatability_.independent * repeatability_.independent;
  const Eigen::Index each = std::max(1, rows_per_target_);
  for (Eigen::Index first = 0; first + each <= rows_; first += each)
    by_unit_rows.block(first, 0, each, 3).noalias() +=
        2 * variance * by_covariance.block(first, first, each, each) * unit_rows.block(first, 0, each, 3);
}

bool ExplicitModel::do_read(const Point& at, Eigen::VectorXd& y) const {
  const Parts p = parts(at);
  static thread_local Twists none;
  Eigen::Isometry3d X;
  if (!tip_->linearise(p.tip, {}, X, none, nullptr)) return false;
  MeasurementModel::Sighting sighting{X, p.own_correction, p.station};
  Eigen::Isometry3d nominal;
  if (measurement_->reads_from_nominal()) {
    if (!tip_->linearise({p.tip.q, {}, p.tip.chosen}, {}, nominal, none, nullptr)) return false;
    sighting.X_MeasureTipNominal = &nominal;
  }
  measurement_->read(sighting, y);
  return true;
}

void ExplicitModel::do_difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                                  Eigen::VectorXd& out) const {
  measurement_->difference(measured, predicted, out);
}

void ExplicitModel::do_shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change,
                               Eigen::VectorXd& out) const {
  measurement_->shifted(predicted, change, out);
}

bool ExplicitModel::do_configuration_at(std::span<const double> actuators, const Point& start,
                                        std::span<double> q) const {
  std::copy(start.q.begin(), start.q.end(), q.begin());
  const Parts p = parts(start);
  return tip_->configuration_at(actuators, p.tip, q.first(p.tip.q.size()));
}

int ExplicitModel::do_block_rows(std::span<const int> selected) const {
  const auto own =
      std::count_if(selected.begin(), selected.end(), [&](int i) { return is_own_column_[std::size_t(i)] != 0; });
  return std::min(rows_, 6 + int(own));
}

bool ExplicitModel::do_linearise_factored(const Point& at, std::span<const int> selected, Linearisation& out) const {
  const Parts p = parts(at);
  Eigen::Isometry3d X;
  if (!twists_and_noise(p, selected, X, out)) return false;
  const MeasurementModel::Sighting sighting{X, p.own_correction, p.station};
  const int width = do_block_rows(selected);
  // Unit twists about the tip's origin: about the origin of M they would be ill-scaled far away.
  Eigen::Matrix<double, 6, 6> about_tip = Eigen::Matrix<double, 6, 6>::Identity();
  for (int k = 0; k < 3; ++k) about_tip.block<3, 1>(0, 3 + k) = X.translation().cross(Eigen::Vector3d::Unit(k));
  out.basis.resize(rows_, width);
  measurement_->rows_of_twists(sighting, about_tip, out.basis.leftCols<6>());
  out.coefficients.setZero(width, Eigen::Index(selected.size()));
  about_tip_origin(X.translation(), out.twists);
  about_tip_origin(X.translation(), out.random_twists);
  out.coefficients.topRows<6>() = out.twists;
  out.random_coefficients.setZero(width, out.random_twists.cols());
  out.random_coefficients.topRows<6>() = out.random_twists;
  Eigen::Index next = 6;
  for (std::size_t c = 0; c < selected.size(); ++c) {
    if (is_own_column_[std::size_t(selected[c])] == 0) continue;
    measurement_->own_column(sighting, selected[c] - tip_parameters_, out.basis.col(next));
    out.coefficients(next++, Eigen::Index(c)) = 1.0;
  }
  return true;
}

bool ExplicitModel::do_measurable(const Point& at) const {
  if (unmeasurable_reason_.empty()) return true;
  const Parts p = parts(at);
  Twists none;
  Eigen::Isometry3d X;
  return tip_->linearise(p.tip, {}, X, none, nullptr) && measurement_->sees({X, p.own_correction, p.station});
}

bool ExplicitModel::do_measurable_margins_at(const Point& at, std::span<double> out) const {
  if (out.empty()) return true;
  const Parts p = parts(at);
  static thread_local Twists none;
  Eigen::Isometry3d X;
  if (!tip_->linearise(p.tip, {}, X, none, nullptr)) return false;
  measurement_->margins_at({X, p.own_correction, p.station}, out);
  return true;
}

bool ExplicitModel::do_reading_twists(const Point& at, Twists& twists) const {
  const Parts p = parts(at);
  Twists none;
  Eigen::Isometry3d X;
  return tip_->linearise(p.tip, {}, X, none, &twists);
}

bool ExplicitModel::do_actuator_values(const Point& at, std::span<double> values) const {
  const Parts p = parts(at);
  return tip_->actuator_values(p.tip, values);
}

Eigen::Isometry3d ExplicitModel::do_tool_pose(const Point& at) const {
  const Parts p = parts(at);
  Twists none;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  tip_->linearise(p.tip, {}, X, none, nullptr);
  return X;
}

}  // namespace posewright
