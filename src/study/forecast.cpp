#include "posewright/study/forecast.hpp"

#include <algorithm>
#include <cmath>

#include "correlated_rows.hpp"
#include "posewright/study/unmodelled.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

// Share of a column's norm; below, the poses do not tell the column from the others.
constexpr double told_at_all = 1e-7;

std::vector<int> with_effect(const Variant& variant) {
  std::vector<int> selected = variant.columns.selected;
  if (variant.effect != nullptr)
    selected.insert(selected.end(), variant.effect->columns().begin(), variant.effect->columns().end());
  return selected;
}

}  // namespace

std::vector<PoseRows> rows_of(const Variant& variant, const std::vector<MeasuredPose>& poses) {
  VariantColumns columns;
  columns.selected = with_effect(variant);
  const BlockArray blocks = blocks_of(*variant.model, columns, poses);
  std::vector<PoseRows> rows;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const auto read = poses[k].y.array().isFinite().count();
    rows.push_back({poses[k].q, blocks.block(k).topRows(read)});
  }
  return rows;
}

std::vector<PoseRows> rows_of(const Variant& variant, const Configurations& configurations, int threads) {
  const BlockArray blocks = build_blocks(*variant.model, with_effect(variant), configurations, threads);
  std::vector<PoseRows> rows;
  for (std::size_t k = 0; k < configurations.count(); ++k)
    rows.push_back({{configurations[k].begin(), configurations[k].end()}, blocks.block(k)});
  return rows;
}

Eigen::MatrixXd known_information(const Variant& variant, const std::vector<PoseRows>& poses, Prior prior,
                                  double noise_factor) {
  const auto m = Eigen::Index(variant.columns.selected.size());
  const Eigen::Index features = variant.features == nullptr ? 0 : variant.features->columns();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(features + m, features + m);
  M.diagonal().head(features).setOnes();
  for (Eigen::Index j = 0; j < m; ++j) {
    const Parameter& p = variant.columns.parameters[std::size_t(j)];
    if (counts(p, prior)) M(features + j, features + j) = std::pow(noise_factor / p.tolerance, 2);
  }
  BlockArray::RowMatrix block;
  for (const PoseRows& pose : poses) {
    if (variant.features == nullptr) {
      M.noalias() += pose.block.transpose() * pose.block;
      continue;
    }
    block.resize(pose.block.rows(), features + m);
    variant.features->expand(pose.q, pose.block, block);
    M.noalias() += block.transpose() * block;
  }
  return M;
}

/// Rows of pose after pose, by what the covariance of all of them leaves independent, and what they say at the test
/// poses.
class ForecastOfError::Sum {
 public:
  /// @param turns  of the orientation at the test poses in place of the position
  Sum(const ForecastOfError& of, const std::vector<PoseRows>& poses, bool turns = false)
      : variant_(of.variant_),
        noise_(of.noise_),
        weights_(of.weights_),
        unit_(tolerances_of(variant_.columns)),
        turns_(turns) {
    m_ = unit_.size();
    for (const PoseRows& pose : poses) first_.push_back(first_.back() + pose.block.rows());
    J_.resize(first_.back(), m_);
    for (std::size_t k = 0; k < poses.size(); ++k)
      J_.middleRows(first_[k], poses[k].block.rows()) = poses[k].block.leftCols(m_) * unit_.asDiagonal();
    A_.resize(3 * weights_.size(), m_);
    for (Eigen::Index t = 0; t < weights_.size(); ++t) {
      const TestPoint& point = variant_.test_points[std::size_t(t)];
      A_.middleRows<3>(3 * t) =
          std::sqrt(weights_[t]) * (turns ? point.turn : point.A).leftCols(m_) * unit_.asDiagonal();
    }
    start();
    if (variant_.effect != nullptr) correlate(poses);
  }

  void add(std::size_t pose) {
    const Eigen::Index rows = first_[pose + 1] - first_[pose];
    const auto J = J_.middleRows(first_[pose], rows);
    Eigen::MatrixXd stacked(R_.rows() + rows, m_);
    stacked << R_, J;
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(stacked);
    R_ = qr.matrixQR().topRows(std::min(stacked.rows(), m_)).triangularView<Eigen::Upper>();
    if (Y_.size() > 0) C_.noalias() += J.transpose() * Y_.middleRows(first_[pose], rows);
  }

  bool determined() const {
    if (R_.rows() < m_) return false;
    const Eigen::VectorXd length = R_.colwise().norm();
    return (R_.diagonal().cwiseAbs().array() > told_at_all * length.array()).all();
  }

  /// Root of the covariance with the stated noise, SI.
  Eigen::MatrixXd spread() const {
    return unit_.asDiagonal() * R_.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(m_, m_));
  }

  /// Largest σ over the test poses along (or about) x, y, z.
  Eigen::Vector3d worst_axes() const {
    const Eigen::MatrixXd X =
        R_.triangularView<Eigen::Upper>().transpose().solve(Eigen::MatrixXd(A_.transpose())).transpose();
    Eigen::VectorXd squares = X.rowwise().squaredNorm();
    if (Y_.size() > 0) {
      const Eigen::MatrixXd follows = R_.triangularView<Eigen::Upper>().transpose().solve(C_);
      squares += K_.diagonal() - 2 * X.cwiseProduct(follows.transpose()).rowwise().sum();
    }
    Eigen::Vector3d most = Eigen::Vector3d::Zero();
    for (Eigen::Index t = 0; t < weights_.size(); ++t) most = most.cwiseMax(squares.segment<3>(3 * t) / weights_[t]);
    return noise_.factor * most.cwiseMax(0.0).cwiseSqrt();
  }

  std::optional<double> error() const {
    if (!determined()) return std::nullopt;
    // A_ M⁻¹ A_ᵀ = X Xᵀ, M = RᵀR.
    const Eigen::MatrixXd X =
        R_.triangularView<Eigen::Upper>().transpose().solve(Eigen::MatrixXd(A_.transpose())).transpose();
    double sum = X.squaredNorm();
    if (Y_.size() > 0) {
      const Eigen::MatrixXd follows = R_.triangularView<Eigen::Upper>().transpose().solve(C_);
      sum += K_.trace() - 2 * X.transpose().cwiseProduct(follows).sum();
    }
    return noise_.factor * std::sqrt(sum);
  }

 private:
  /// Tolerances as they count, against a noise of unit size.
  void start() {
    R_ = Eigen::MatrixXd::Zero(0, m_);
    Eigen::Index known = 0;
    for (const Parameter& p : variant_.columns.parameters) known += counts(p, noise_.prior) ? 1 : 0;
    R_.setZero(known, m_);
    Eigen::Index row = 0;
    for (Eigen::Index j = 0; j < m_; ++j)
      if (counts(variant_.columns.parameters[std::size_t(j)], noise_.prior)) R_(row++, j) = noise_.factor;
  }

  /// Cholesky factor L of I + A K Aᵀ: its leading part is that of the first poses, so L⁻¹ whitens all beginnings at
  /// once.
  void correlate(const std::vector<PoseRows>& poses) {
    const UnmodelledEffect& effect = *variant_.effect;
    std::vector<MovedByEffect> moved;
    for (const PoseRows& pose : poses) {
      moved.push_back({pose.block.rightCols(pose.block.cols() - m_), effect.places(pose.q)});
      effect.take_sizes(moved.back().along);
    }
    const Eigen::LLT<Eigen::MatrixXd> root(Eigen::MatrixXd::Identity(first_.back(), first_.back()) +
                                           covariance_between(effect, moved, moved));
    root.matrixL().solveInPlace(J_);
    fill_places(moved);
    root.matrixL().solveInPlace(Y_);
  }

  /// Y_ = A K_x before whitening, K_ = K_xx, weighted.
  void fill_places(const std::vector<MovedByEffect>& moved) {
    const UnmodelledEffect& effect = *variant_.effect;
    std::vector<MovedByEffect> there;
    for (Eigen::Index t = 0; t < weights_.size(); ++t) {
      const TestPlace& place = variant_.test_places[std::size_t(t)];
      there.push_back(
          {std::sqrt(weights_[t]) * place.twists.block(turns_ ? 3 : 0, 0, 3, effect.twists()), effect.place(place.q)});
      effect.take_sizes(there.back().along);
    }
    Y_ = covariance_between(effect, moved, there);
    K_ = covariance_between(effect, there, there);
    C_ = Eigen::MatrixXd::Zero(m_, Y_.cols());
  }

  const Variant& variant_;
  const ForecastNoise& noise_;
  const Eigen::VectorXd& weights_;
  Eigen::VectorXd unit_;
  bool turns_ = false;
  Eigen::Index m_ = 0;
  std::vector<Eigen::Index> first_{0};
  Eigen::MatrixXd J_, A_, R_;
  Eigen::MatrixXd Y_, K_, C_;  // with an effect alone
};

ForecastOfError::ForecastOfError(const Variant& variant, const ForecastNoise& noise)
    : variant_(variant), noise_(noise), weights_(Eigen::Index(variant.test_points.size())) {
  for (Eigen::Index t = 0; t < weights_.size(); ++t) weights_[t] = variant.test_points[std::size_t(t)].weight;
  if (weights_.size() > 0) weights_ /= weights_.sum();
}

std::optional<ForecastSigmas> ForecastOfError::sigmas(const std::vector<PoseRows>& poses, bool axes) const {
  ForecastSigmas result;
  Sum sum(*this, poses);
  for (std::size_t k = 0; k < poses.size(); ++k) sum.add(k);
  if (!sum.determined()) return std::nullopt;
  result.parameters = noise_.factor * sum.spread().rowwise().norm();
  if (!axes || weights_.size() == 0) return result;
  const Eigen::Vector3d along = sum.worst_axes();
  std::copy(along.begin(), along.end(), result.axes.begin());
  const bool turned = std::all_of(variant_.test_points.begin(), variant_.test_points.end(),
                                  [](const TestPoint& point) { return point.turn.size() > 0; });
  if (!turned) return result;
  Sum turns(*this, poses, true);
  for (std::size_t k = 0; k < poses.size(); ++k) turns.add(k);
  const Eigen::Vector3d about = turns.worst_axes();
  std::copy(about.begin(), about.end(), result.axes.begin() + 3);
  return result;
}

std::vector<Eigen::MatrixXd> ForecastOfError::covariance_after_each(const std::vector<PoseRows>& poses) const {
  std::vector<Eigen::MatrixXd> result;
  Sum sum(*this, poses);
  for (std::size_t n = 0; n <= poses.size(); ++n) {
    if (n > 0) sum.add(n - 1);
    const Eigen::MatrixXd spread = sum.determined() ? sum.spread() : Eigen::MatrixXd();
    result.emplace_back(spread * spread.transpose());
  }
  return result;
}

std::vector<std::optional<double>> ForecastOfError::after_each(const std::vector<PoseRows>& poses,
                                                               std::size_t from) const {
  std::vector<std::optional<double>> result;
  Sum sum(*this, poses);
  if (from == 0) result.push_back(sum.error());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    sum.add(k);
    if (k + 1 >= from) result.push_back(sum.error());
  }
  return result;
}

}  // namespace posewright
