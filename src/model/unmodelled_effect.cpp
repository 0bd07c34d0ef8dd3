#include "posewright/model/unmodelled_effect.hpp"

#include <cmath>
#include <numbers>

#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Variance that features leave: below this it is rounding, and no noise.
constexpr double rounding = 1e-9;
// The same of features that hold the whole effect.
constexpr double whole = 1e-10;

}  // namespace

UnmodelledEffect::UnmodelledEffect(const IdentificationModel& model, const UnmodelledSize& size)
    : size_(size), tips_(model.tips()), coordinates_(model.tip_coordinates()), moving_(model.moving_coordinates()) {
  if (tips_ == 0)
    throw CannotDo(
        "an unmodelled effect moves the tip, but these readings contain no tip position (joint sensors, differences "
        "between loads, a linkage): leave out `unmodelled`");
  for (std::size_t i = 0; i < coordinates_; ++i) {
    const Coordinate& c = model.coordinates()[i];
    if (c.choice()) continue;
    const bool turns = c.unit == "rad";
    if (turns || c.upper > c.lower) axes_.push_back({i, turns, turns ? 1.0 : std::numbers::pi / (c.upper - c.lower)});
  }
  for (const double own : size.own) own_.push_back(std::pow(own / size.translation, 2));
  for (int tip = 0; tip < tips_; ++tip)
    for (int k = 0; k < twists(); ++k) columns_.push_back(model.tip_column(tip, k));
}

Eigen::VectorXd UnmodelledEffect::place(std::span<const double> q) const {
  // With effects of instruments the last one is the instrument, −1 for none.
  Eigen::VectorXd f = Eigen::VectorXd::Zero(2 * Eigen::Index(axes_.size()) + (own_.empty() ? 0 : 1));
  if (!own_.empty()) f.tail<1>()[0] = -1;
  const std::vector<char>* moving = moving_.empty() ? nullptr : &moving_[std::size_t(q.back())];
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    if (moving != nullptr && (*moving)[axes_[a].coordinate] == 0) continue;
    const double x = q[axes_[a].coordinate];
    f[2 * Eigen::Index(a)] = axes_[a].turns ? std::cos(x) : axes_[a].unit * x;
    if (axes_[a].turns) f[2 * Eigen::Index(a) + 1] = std::sin(x);
  }
  return f;
}

Eigen::MatrixXd UnmodelledEffect::places(std::span<const double> q) const {
  Eigen::MatrixXd f(2 * Eigen::Index(axes_.size()) + (own_.empty() ? 0 : 1), tips_);
  for (int tip = 0; tip < tips_; ++tip)
    f.col(tip) = place(moving_.empty() ? q.subspan(std::size_t(tip) * coordinates_, coordinates_) : q);
  if (!own_.empty()) f.bottomRows<1>().setConstant(q.back());
  return f;
}

double UnmodelledEffect::correlation(Eigen::Ref<const Eigen::VectorXd> a, Eigen::Ref<const Eigen::VectorXd> b) const {
  const auto smooth = [&](Eigen::Index rows) {
    return std::exp(-0.5 * (a - b).head(rows).squaredNorm() / (size_.length * size_.length));
  };
  if (own_.empty()) return smooth(a.size());
  const double reads = a[a.size() - 1];
  const double own = reads >= 0 && reads == b[b.size() - 1] ? own_[std::size_t(reads)] : 0.0;
  return ((size_.of_robot ? 1.0 : 0.0) + own) * smooth(a.size() - 1);
}

EffectFeatures::EffectFeatures(std::shared_ptr<const UnmodelledEffect> effect, const Eigen::MatrixXd& places, int most)
    : effect_(std::move(effect)) {
  const Eigen::Index n = places.cols();
  Eigen::VectorXd rest(n);
  for (Eigen::Index i = 0; i < n; ++i) rest[i] = effect_->correlation(places.col(i), places.col(i));
  Eigen::MatrixXd rows(std::min<Eigen::Index>(most, n), n);  // φ of every place
  std::vector<Eigen::Index> chosen;
  while (Eigen::Index(chosen.size()) < rows.rows()) {
    Eigen::Index next = 0;
    if (!(rest.maxCoeff(&next) > whole)) break;
    const auto k = Eigen::Index(chosen.size());
    for (Eigen::Index i = 0; i < n; ++i)
      rows(k, i) =
          effect_->correlation(places.col(next), places.col(i)) - rows.col(next).head(k).dot(rows.col(i).head(k));
    rows.row(k) /= std::sqrt(rest[next]);
    rest -= rows.row(k).transpose().cwiseAbs2();
    rest[next] = 0.0;
    chosen.push_back(next);
  }
  const auto count = Eigen::Index(chosen.size());
  pivots_ = places(Eigen::all, chosen);
  // φ of the pivots is L of their correlations: φ = L⁻¹ k.
  const Eigen::MatrixXd phi = rows.topRows(count);
  const Eigen::MatrixXd L = phi(Eigen::all, chosen).transpose();
  weights_ = L.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(count, count));
  squares_ = phi * phi.transpose();
}

EffectFeatures EffectFeatures::first(int count) const {
  const auto kept = std::min<Eigen::Index>(count, weights_.rows());
  EffectFeatures fewer = *this;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(squares_);
  fewer.weights_ = (weights_.transpose() * eigen.eigenvectors().rightCols(kept).rowwise().reverse()).transpose();
  fewer.squares_ = eigen.eigenvalues().tail(kept).reverse().asDiagonal();
  return fewer;
}

Eigen::MatrixXd EffectFeatures::at(const Eigen::MatrixXd& places) const {
  Eigen::MatrixXd correlations(pivots_.cols(), places.cols());
  for (Eigen::Index tip = 0; tip < places.cols(); ++tip)
    for (Eigen::Index j = 0; j < pivots_.cols(); ++j)
      correlations(j, tip) = effect_->correlation(pivots_.col(j), places.col(tip));
  return weights_ * correlations;
}

void EffectFeatures::expand(std::span<const double> q, Eigen::Ref<const BlockArray::RowMatrix> block,
                            Eigen::Ref<BlockArray::RowMatrix> out) const {
  const Eigen::MatrixXd places = effect_->places(q), phi = at(places);
  const int twists = effect_->twists(), tips = effect_->tips();
  const Eigen::Index own = block.cols() - Eigen::Index(tips) * twists;
  Eigen::MatrixXd Y = block.rightCols(Eigen::Index(tips) * twists);
  effect_->take_sizes(Y);
  out.rightCols(own) = block.leftCols(own);
  out.leftCols(columns()).setZero();
  add_feature_columns(phi, Y, out.leftCols(columns()));
  Eigen::MatrixXd rest = -phi.transpose() * phi;
  for (Eigen::Index a = 0; a < tips; ++a)
    for (Eigen::Index b = 0; b < tips; ++b) rest(a, b) += effect_->correlation(places.col(a), places.col(b));
  if (!(rest.diagonal().maxCoeff() > rounding)) return;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(block.rows(), block.rows());
  for (Eigen::Index a = 0; a < tips; ++a)
    for (Eigen::Index b = 0; b < tips; ++b)
      covariance.noalias() +=
          rest(a, b) * Y.middleCols(a * twists, twists) * Y.middleCols(b * twists, twists).transpose();
  covariance.llt().matrixL().solveInPlace(out);
}

Eigen::MatrixXd EffectFeatures::columns_at(const Eigen::VectorXd& phi, const Eigen::MatrixXd& twists) const {
  const int each = effect_->twists();
  Eigen::MatrixXd result(twists.rows(), columns());
  for (Eigen::Index j = 0; j < phi.size(); ++j)
    for (int k = 0; k < each; ++k) result.col(j * each + k) = phi[j] * effect_->size_of(k) * twists.col(k);
  return result;
}

}  // namespace posewright
