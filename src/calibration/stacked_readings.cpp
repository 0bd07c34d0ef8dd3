#include "stacked_readings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "posewright/model/whitening.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
std::vector<int> indices_read(const Eigen::VectorXd& y) {
  std::vector<int> read;
  for (int i = 0; i < int(y.size()); ++i)
    if (std::isfinite(y[i])) read.push_back(i);
  return read;
}

std::vector<int> judging(const IdentificationModel& model, const Eigen::VectorXd& y) {
  std::vector<int> read = indices_read(y), lengths;
  for (const int i : read)
    if (model.readings()[std::size_t(i)].unit == "m") lengths.push_back(i);
  return lengths.empty() ? read : lengths;
}

bool linearise_at(const IdentificationModel& model, const MeasuredPose& pose, const std::vector<double>& correction,
                  std::span<const int> selected, Linearisation& out, Eigen::VectorXd& y) {
  out.reading_share = pose.reading_share;
  if (!model.predict_and_linearise(pose.q, correction, selected, out, y)) return false;
  if (pose.noise_factor != 1.0) out.covariance *= pose.noise_factor * pose.noise_factor;
  return true;
}

Eigen::VectorXd spreads_of(const VariantColumns& columns, const std::vector<double>& spreads) {
  Eigen::VectorXd own = Eigen::VectorXd::Ones(Eigen::Index(columns.selected.size()));
  for (std::size_t j = 0; j < columns.selected.size() && !spreads.empty(); ++j)
    own[Eigen::Index(j)] = spreads[std::size_t(columns.selected[j])];
  return own;
}

Eigen::VectorXd tolerance_precision(const VariantColumns& columns, const std::vector<double>& spreads, Prior prior,
                                    const Eigen::VectorXd& length) {
  Eigen::VectorXd precision = Eigen::VectorXd::Zero(length.size());
  for (Eigen::Index j = 0; j < length.size(); ++j) {
    const Parameter& p = columns.parameters[std::size_t(j)];
    if (!counts(p, prior)) continue;
    const double spread = spreads[std::size_t(columns.selected[std::size_t(j)])];
    precision[j] = 1 / std::pow(p.tolerance * spread * length[j], 2);
  }
  return precision;
}

FittedRows whitened_rows(const IdentificationModel& model, const std::vector<int>& selected,
                         const std::vector<MeasuredPose>& poses, const std::vector<double>& correction,
                         const std::vector<Eigen::VectorXd>& residuals) {
  FittedRows rows{{}, {}, {0}};
  for (const MeasuredPose& pose : poses) rows.first.push_back(rows.first.back() + int(indices_read(pose.y).size()));
  rows.J.resize(rows.first.back(), Eigen::Index(selected.size()));
  if (!residuals.empty()) rows.r.resize(rows.first.back());
  Linearisation at;
  Eigen::VectorXd y;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (!linearise_at(model, poses[k], correction, selected, at, y))
      throw CannotDo("pose " + std::to_string(poses[k].id) + " is out of reach with the current parameters");
    const std::vector<int> read = indices_read(poses[k].y);
    factorise_covariance(at.covariance(read, read), at.factor);
    const auto own = Eigen::seqN(rows.first[k], Eigen::Index(read.size()));
    rows.J(own, Eigen::all) = at.factor.matrixL().solve(Eigen::MatrixXd(at.G(read, Eigen::all)));
    if (!residuals.empty()) rows.r(own) = at.factor.matrixL().solve(Eigen::VectorXd(residuals[k](read)));
  }
  return rows;
}

FittedRows fitted_rows(const IdentificationModel& model, const std::vector<int>& selected,
                       const std::vector<MeasuredPose>& poses, const std::vector<double>& correction, const Fit& fit) {
  FittedRows rows = whitened_rows(model, selected, poses, correction);
  rows.r.resize(rows.J.rows());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::vector<int> read = indices_read(poses[k].y);
    rows.r.segment(rows.first[k], Eigen::Index(read.size())) = fit.whitened[k](read);
  }
  return rows;
}

Eigen::MatrixXd places_of(const UnmodelledEffect& effect, const std::vector<MeasuredPose>& poses) {
  Eigen::MatrixXd places;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Eigen::MatrixXd f = effect.places(poses[k].q);
    if (k == 0) places.resize(f.rows(), Eigen::Index(poses.size()) * f.cols());
    places.middleCols(Eigen::Index(k) * f.cols(), f.cols()) = f;
  }
  return places;
}

ResidualProjector::ResidualProjector(const Eigen::MatrixXd& fitted) {
  const Eigen::VectorXd length = fitted.colwise().norm().cwiseMax(1e-300);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(fitted * length.cwiseInverse().asDiagonal());
  Q_ = qr.householderQ() * Eigen::MatrixXd::Identity(fitted.rows(), fitted.cols());
}

StackedReadings::StackedReadings(const IdentificationModel& model, const VariantColumns& columns,
                                 const std::vector<MeasuredPose>& poses, Prior prior, const std::vector<double>& start)
    : model_(model), columns_(columns), poses_(poses), correction_(start) {
  correction_.resize(model.parameters().size(), 0.0);
  tolerances_ = tolerances_of(columns);
  spreads_.setOnes(tolerances_.size());
  for (std::size_t j = 0; j < columns.parameters.size(); ++j)
    if (counts(columns.parameters[j], prior)) known_.push_back(int(j));
  const int per_target = model.rows_per_target();
  int group = -1;
  for (const MeasuredPose& pose : poses) {
    read_.push_back(indices_read(pose.y));
    int target = -1;
    for (const int i : read_.back()) {
      const int own = per_target > 0 ? i / per_target : 0;
      if (own != target) ++group;
      target = own;
      group_of_.push_back(group);
    }
    readings_ += int(read_.back().size());
  }
  root_.resize(poses.size());
}

void StackedReadings::limit(const std::vector<WeakLimit>& limits) {
  for (const WeakLimit& limit : limits) {
    const auto at = std::find(columns_.selected.begin(), columns_.selected.end(), limit.parameter);
    if (at == columns_.selected.end()) continue;
    const int column = int(at - columns_.selected.begin());
    limits_.push_back({column, limit.about / tolerances_[column], tolerances_[column] / limit.width});
  }
}

Eigen::MatrixXd StackedReadings::prior_rows() const {
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(rows() - readings_, columns());
  Eigen::Index row = 0;
  for (const int j : known_) prior(row++, j) = -1.0 / spreads_[j];
  for (const Limit& limit : limits_) prior(row++, limit.column) = -limit.weight;
  return prior;
}

bool StackedReadings::components_at(const Eigen::VectorXd& x, ComponentProblem& problem) {
  Eigen::VectorXd f;
  Eigen::MatrixXd J;
  if (!residual(x, f) || !jacobian(x, J)) return false;
  problem.J = -J.topRows(readings_);
  problem.y = f.head(readings_) + problem.J * x;
  problem.precision = problem.about = Eigen::VectorXd::Zero(columns());
  problem.group.assign(std::size_t(columns()), -1);
  std::map<std::pair<std::string, bool>, int> groups;
  for (const int j : known_) {
    const Parameter& p = columns_.parameters[std::size_t(j)];
    problem.precision[j] = 1.0;
    if (p.tolerance_stated) continue;
    const bool zero = model_.parameters()[std::size_t(columns_.selected[std::size_t(j)])].name.ends_with(".offset");
    problem.group[std::size_t(j)] = groups.emplace(std::pair(p.unit, zero), int(groups.size())).first->second;
  }
  for (const Limit& limit : limits_) {
    problem.precision[limit.column] += limit.weight * limit.weight;
    problem.about[limit.column] = limit.about;
  }
  return true;
}

Eigen::VectorXd StackedReadings::start() const {
  Eigen::VectorXd x(columns());
  for (Eigen::Index j = 0; j < x.size(); ++j)
    x[j] = correction_[std::size_t(columns_.selected[std::size_t(j)])] / tolerances_[j];
  return x;
}

void StackedReadings::refuse(std::size_t pose) const {
  throw CannotDo("pose " + std::to_string(poses_[pose].id) +
                 " is out of reach with the current parameters: check its units and the nominal robot");
}

const std::vector<double>& StackedReadings::correction_of(const Eigen::VectorXd& x) {
  for (std::size_t j = 0; j < columns_.selected.size(); ++j)
    correction_[std::size_t(columns_.selected[j])] = x[Eigen::Index(j)] * tolerances_[Eigen::Index(j)];
  return correction_;
}

void StackedReadings::weigh(const Eigen::VectorXd& x, Weighting weighting) {
  correction_of(x);
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (!linearise_at(model_, poses_[k], correction_, {}, linearisation_, y_)) refuse(k);
    const std::vector<int>& read = read_[k];
    const Eigen::MatrixXd covariance = linearisation_.covariance(read, read);
    root_[k].compute(covariance);
    if (root_[k].info() != Eigen::Success)
      throw CannotDo("the fit puts pose " + std::to_string(poses_[k].id) +
                     " where its readings have no noise covariance: check units, signs, zeros and order of the joints, "
                     "and the order of rows");
  }
  if (weighting == Weighting::ordinary) use_one_variance_per_unit();
  if (effect_ != nullptr) find_features();
}

void StackedReadings::correlate(std::shared_ptr<const UnmodelledEffect> effect) {
  effect_ = std::move(effect);
  if (effect_ != nullptr) features_.emplace(effect_, places_of(*effect_, poses_), features_of_a_fit);
}

void StackedReadings::find_features() {
  Eigen::MatrixXd along(readings_, Eigen::Index(effect_->columns().size()));
  std::vector<int> first{0};
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (!linearise_at(model_, poses_[k], correction_, effect_->columns(), linearisation_, y_)) refuse(k);
    rows_ = linearisation_.G(read_[k], Eigen::all);
    root_[k].matrixL().solveInPlace(rows_);
    along.middleRows(first.back(), rows_.rows()) = rows_;
    first.push_back(first.back() + int(rows_.rows()));
  }
  effect_->take_sizes(along);
  independent_ = IndependentRows(EffectRows(features_->at(places_of(*effect_, poses_)), std::move(along), first));
}

/// The mean over all readings of the unit; what they are worth to each other within it is one.
void StackedReadings::use_one_variance_per_unit() {
  std::map<std::string, std::pair<double, int>> sums;
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const Eigen::MatrixXd covariance = root_[k].reconstructedMatrix();
    for (std::size_t i = 0; i < read_[k].size(); ++i) {
      auto& [sum, count] = sums[model_.readings()[std::size_t(read_[k][i])].unit];
      sum += covariance(Eigen::Index(i), Eigen::Index(i));
      ++count;
    }
  }
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    Eigen::VectorXd variance(Eigen::Index(read_[k].size()));
    for (std::size_t i = 0; i < read_[k].size(); ++i) {
      const auto& [sum, count] = sums[model_.readings()[std::size_t(read_[k][i])].unit];
      variance[Eigen::Index(i)] = sum / count;
    }
    root_[k].compute(Eigen::MatrixXd(variance.asDiagonal()));
  }
}

double StackedReadings::root_weight(int row) const {
  return (group_weights_.size() == 0 ? 1.0 : std::sqrt(group_weights_[group_of_[std::size_t(row)]])) / noise_factor_;
}

bool StackedReadings::residual(const Eigen::VectorXd& x, Eigen::VectorXd& f) {
  correction_of(x);
  f.resize(rows());
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (read_[k].empty()) continue;
    if (!model_.predict(poses_[k].q, correction_, y_)) return false;
    model_.difference(poses_[k].y, y_, difference_);
    part_ = difference_(read_[k]);
    root_[k].matrixL().solveInPlace(part_);
    for (Eigen::Index i = 0; i < part_.size(); ++i, ++row) f[row] = part_[i] * root_weight(int(row));
  }
  if (!independent_.empty()) independent_.apply(f.head(readings_));
  for (const int j : known_) f[row++] = -x[j] / spreads_[j];
  for (const Limit& limit : limits_) f[row++] = -limit.weight * (x[limit.column] - limit.about);
  return f.allFinite();
}

bool StackedReadings::jacobian(const Eigen::VectorXd& x, Eigen::MatrixXd& J) {
  correction_of(x);
  J.resize(rows(), columns());
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (read_[k].empty()) continue;
    if (!linearise_at(model_, poses_[k], correction_, columns_.selected, linearisation_, y_)) return false;
    rows_ = linearisation_.G(read_[k], Eigen::all);
    root_[k].matrixL().solveInPlace(rows_);
    for (Eigen::Index i = 0; i < rows_.rows(); ++i, ++row)
      J.row(row) = -root_weight(int(row)) * rows_.row(i).cwiseProduct(tolerances_.transpose());
  }
  if (!independent_.empty()) independent_.apply(J.topRows(readings_));
  J.bottomRows(rows() - readings_) = prior_rows();
  return true;
}

Eigen::VectorXd StackedReadings::group_sizes() const {
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(groups());
  for (const int group : group_of_) sizes[group] += 1.0;
  return sizes;
}

Eigen::VectorXd StackedReadings::group_squares(const Eigen::VectorXd& x) {
  const Eigen::VectorXd kept = group_weights_;
  const double factor = noise_factor_;
  group_weights_.resize(0);
  noise_factor_ = 1.0;
  Eigen::VectorXd f;
  residual(x, f);
  group_weights_ = kept;
  noise_factor_ = factor;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(groups());
  for (std::size_t row = 0; row < group_of_.size(); ++row)
    squares[group_of_[row]] += f[Eigen::Index(row)] * f[Eigen::Index(row)];
  return squares;
}

void StackedReadings::spread(const Eigen::VectorXd& x, std::vector<Eigen::VectorXd>& raw,
                             std::vector<Eigen::VectorXd>& whitened) {
  raw = residuals_of(model_, correction_of(x), poses_);
  whitened = raw;
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    part_ = raw[k](read_[k]);
    root_[k].matrixL().solveInPlace(part_);
    whitened[k].setConstant(std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < read_[k].size(); ++i) whitened[k][read_[k][i]] = part_[Eigen::Index(i)];
  }
}

}  // namespace posewright
