#pragma once

#include <Eigen/Core>
#include <variant>
#include <vector>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

/// Columns F of an effect's features in the readings of many poses, one pose's rows below the other's. A pose's rows
/// are F_k = Σ_tip φ_k,tip ⊗ A_k,tip: products with F take φ and A for themselves, and F is not stored.
class EffectRows {
 public:
  /// @param phi  EffectFeatures::at() of the poses' places, features × (poses · tips)
  /// @param along  whitened derivatives along the effect's columns(), their sizes taken, rows × (tips · twists)
  /// @param first  row of each pose; one more at the end
  EffectRows(Eigen::MatrixXd phi, Eigen::MatrixXd along, std::vector<int> first);

  Eigen::Index rows() const { return along_.rows(); }
  /// Twists of the first feature, of the second, …
  Eigen::Index columns() const { return phi_.rows() * twists_; }
  /// Those of the first poses.
  EffectRows beginning(std::size_t poses) const;
  /// F itself.
  Eigen::MatrixXd dense() const;
  /// FᵀF.
  Eigen::MatrixXd products() const;
  /// Fᵀ X.
  Eigen::MatrixXd transposed_times(const Eigen::Ref<const Eigen::MatrixXd>& X) const;
  /// F Y.
  Eigen::MatrixXd times(const Eigen::MatrixXd& Y) const;

 private:
  auto derivatives(std::size_t pose) const { return along_.middleRows(first_[pose], first_[pose + 1] - first_[pose]); }

  Eigen::MatrixXd phi_, along_;
  std::vector<int> first_;
  Eigen::Index tips_, twists_;
};

/// Whitened rows of correlated readings as those of independent ones, X' = W X with WᵀW = (I + F Fᵀ)⁻¹:
/// W = I − F (I + L)⁻ᵀ L⁻¹ Fᵀ, L Lᵀ = I + FᵀF by Cholesky.
class IndependentRows {
 public:
  IndependentRows() = default;
  explicit IndependentRows(Eigen::MatrixXd F);
  explicit IndependentRows(EffectRows F);
  /// No correlation.
  bool empty() const { return L_.size() == 0; }
  /// W X in the place of X.
  void apply(Eigen::Ref<Eigen::MatrixXd> rows) const;
  /// Wᵀ X in the place of X.
  void apply_transposed(Eigen::Ref<Eigen::MatrixXd> rows) const;

 private:
  void factorise(Eigen::MatrixXd products);
  Eigen::MatrixXd taken(const Eigen::Ref<const Eigen::MatrixXd>& rows) const;
  void leave(const Eigen::MatrixXd& taken, Eigen::Ref<Eigen::MatrixXd> rows) const;

  std::variant<Eigen::MatrixXd, EffectRows> F_;
  Eigen::MatrixXd L_, L_and_one_;
};

/// Blocks of features and parameters as blocks of the parameters alone whose rows are whitened by the covariance of all
/// readings, J' = W J: what evaluates a list needs to know of no effect.
/// @param features  leading columns that are features
/// @param also  rows × any, whitened in place likewise if not null
BlockArray without_features(const BlockArray& blocks, int features, Eigen::MatrixXd* also = nullptr);

}  // namespace posewright
