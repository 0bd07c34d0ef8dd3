#include "posewright/model/independent_rows.hpp"

#include <utility>

#include "posewright/model/unmodelled_effect.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {

EffectRows::EffectRows(Eigen::MatrixXd phi, Eigen::MatrixXd along, std::vector<int> first)
    : phi_(std::move(phi)),
      along_(std::move(along)),
      first_(std::move(first)),
      tips_(first_.size() > 1 ? phi_.cols() / Eigen::Index(first_.size() - 1) : 1),
      twists_(along_.cols() / tips_) {}

EffectRows EffectRows::beginning(std::size_t poses) const {
  EffectRows part = *this;
  part.phi_ = phi_.leftCols(Eigen::Index(poses) * tips_);
  part.along_ = along_.topRows(first_[poses]);
  part.first_.resize(poses + 1);
  return part;
}

Eigen::MatrixXd EffectRows::dense() const {
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(rows(), columns());
  for (std::size_t k = 0; k + 1 < first_.size(); ++k)
    add_feature_columns(phi_.middleCols(Eigen::Index(k) * tips_, tips_), derivatives(k),
                        F.middleRows(first_[k], first_[k + 1] - first_[k]));
  return F;
}

Eigen::MatrixXd EffectRows::products() const {
  const Eigen::Index features = phi_.rows();
  std::vector<Eigen::MatrixXd> squares;  // AᵀA of each pose
  for (std::size_t k = 0; k + 1 < first_.size(); ++k) squares.emplace_back(derivatives(k).transpose() * derivatives(k));
  Eigen::MatrixXd result(columns(), columns()), weighted(features, phi_.cols()), of_twists;
  for (Eigen::Index a = 0; a < twists_; ++a)
    for (Eigen::Index b = 0; b <= a; ++b) {
      for (std::size_t k = 0; k < squares.size(); ++k) {
        of_twists = squares[k](Eigen::seqN(a, tips_, twists_), Eigen::seqN(b, tips_, twists_));
        weighted.middleCols(Eigen::Index(k) * tips_, tips_) =
            phi_.middleCols(Eigen::Index(k) * tips_, tips_).lazyProduct(of_twists);
      }
      const Eigen::MatrixXd product = weighted * phi_.transpose();
      result(Eigen::seqN(a, features, twists_), Eigen::seqN(b, features, twists_)) = product;
      if (a != b) result(Eigen::seqN(b, features, twists_), Eigen::seqN(a, features, twists_)) = product.transpose();
    }
  return result;
}

Eigen::MatrixXd EffectRows::transposed_times(const Eigen::Ref<const Eigen::MatrixXd>& X) const {
  const Eigen::Index features = phi_.rows(), m = X.cols();
  // A twist's rows of AᵀX beside the others', one for each tip of each pose.
  Eigen::MatrixXd beside(phi_.cols(), twists_ * m), of_pose;
  for (std::size_t k = 0; k + 1 < first_.size(); ++k) {
    of_pose = derivatives(k).transpose().lazyProduct(X.middleRows(first_[k], first_[k + 1] - first_[k]));
    for (Eigen::Index a = 0; a < twists_; ++a)
      beside.block(Eigen::Index(k) * tips_, a * m, tips_, m) = of_pose(Eigen::seqN(a, tips_, twists_), Eigen::all);
  }
  const Eigen::MatrixXd products = phi_ * beside;
  Eigen::MatrixXd result(columns(), m);
  for (Eigen::Index a = 0; a < twists_; ++a)
    result(Eigen::seqN(a, features, twists_), Eigen::all) = products.middleCols(a * m, m);
  return result;
}

Eigen::MatrixXd EffectRows::times(const Eigen::MatrixXd& Y) const {
  const Eigen::Index features = phi_.rows(), m = Y.cols();
  Eigen::MatrixXd beside(features, twists_ * m), of_pose(tips_ * twists_, m), result(rows(), m);
  for (Eigen::Index a = 0; a < twists_; ++a)
    beside.middleCols(a * m, m) = Y(Eigen::seqN(a, features, twists_), Eigen::all);
  const Eigen::MatrixXd products = phi_.transpose() * beside;
  for (std::size_t k = 0; k + 1 < first_.size(); ++k) {
    for (Eigen::Index a = 0; a < twists_; ++a)
      of_pose(Eigen::seqN(a, tips_, twists_), Eigen::all) = products.block(Eigen::Index(k) * tips_, a * m, tips_, m);
    result.middleRows(first_[k], first_[k + 1] - first_[k]) = derivatives(k).lazyProduct(of_pose);
  }
  return result;
}

namespace {

Eigen::MatrixXd products(const Eigen::MatrixXd& F) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(F.cols(), F.cols());
  result.selfadjointView<Eigen::Lower>().rankUpdate(F.transpose());
  return result;
}

}  // namespace

IndependentRows::IndependentRows(Eigen::MatrixXd F) : F_(std::move(F)) {
  factorise(products(std::get<Eigen::MatrixXd>(F_)));
}
IndependentRows::IndependentRows(EffectRows F) : F_(std::move(F)) { factorise(std::get<EffectRows>(F_).products()); }

void IndependentRows::factorise(Eigen::MatrixXd products) {
  products.diagonal().array() += 1.0;
  L_ = products.llt().matrixL();
  L_and_one_ = L_;
  L_and_one_.diagonal().array() += 1.0;
}

Eigen::MatrixXd IndependentRows::taken(const Eigen::Ref<const Eigen::MatrixXd>& rows) const {
  if (const auto* effect = std::get_if<EffectRows>(&F_)) return effect->transposed_times(rows);
  return std::get<Eigen::MatrixXd>(F_).transpose() * rows;
}

void IndependentRows::leave(const Eigen::MatrixXd& taken, Eigen::Ref<Eigen::MatrixXd> rows) const {
  if (const auto* effect = std::get_if<EffectRows>(&F_)) rows -= effect->times(taken);
  else rows.noalias() -= std::get<Eigen::MatrixXd>(F_) * taken;
}

void IndependentRows::apply(Eigen::Ref<Eigen::MatrixXd> rows) const {
  Eigen::MatrixXd part = taken(rows);
  L_.triangularView<Eigen::Lower>().solveInPlace(part);
  L_and_one_.transpose().triangularView<Eigen::Upper>().solveInPlace(part);
  leave(part, rows);
}

void IndependentRows::apply_transposed(Eigen::Ref<Eigen::MatrixXd> rows) const {
  Eigen::MatrixXd part = taken(rows);
  L_and_one_.triangularView<Eigen::Lower>().solveInPlace(part);
  L_.transpose().triangularView<Eigen::Upper>().solveInPlace(part);
  leave(part, rows);
}

BlockArray without_features(const BlockArray& blocks, int features, Eigen::MatrixXd* also) {
  const IndependentRows independent{Eigen::MatrixXd(blocks.all().leftCols(features))};
  Eigen::MatrixXd rows = blocks.all().rightCols(blocks.columns() - features);
  independent.apply(rows);
  if (also != nullptr) independent.apply(*also);
  BlockArray result(blocks.count(), blocks.rows(), int(rows.cols()));
  result.all() = rows;
  return result;
}

}  // namespace posewright
