#pragma once

#include <Eigen/Core>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/model/identification_model.hpp"

namespace posewright {

/// Size and length of a smooth effect that the model lacks.
struct UnmodelledSize {
  double translation = 0.0;  ///< 1σ along each axis, m
  double rotation = 0.0;     ///< 1σ about each axis through the tip, rad
  double length = 0.0;       ///< over which it changes, in angles of joints, rad
  /// What readings of each instrument of a list are off by for themselves, 1σ along each axis, m (about the axes in the
  /// ratio of the above); empty: by nothing. It does not move the robot.
  std::vector<double> own{};
  /// False: the robot has no effect, readings are off by `own` alone; the above are its units then.
  bool of_robot = true;
  /// Default length: joint differences over which an unmodelled effect stays about equal.
  static constexpr double assumed_length = std::numbers::pi / 3;
};

/// Every model lacks something: the tip stands off by a twist δ(q) that changes smoothly with the configuration,
/// δ ~ GP(0, diag(τ² I, τ_r² I) ⊗ k), k(q, q') = exp(−‖f(q) − f(q')‖²/2ℓ²), f = (cos q_j, sin q_j) of angles,
/// π q_j/range of lengths, 0 of joints that do not move the tip that is read; load cases and stations do not change it.
/// Readings of an instrument k with an effect of its own have τ² + τ_k² in place of τ² among themselves.
/// Repeatability is the same without smoothness: a twist that is drawn anew at every visit (docs/theory.md).
class UnmodelledEffect {
 public:
  /// Throws CannotDo if the readings tell of no tip: joint sensors, differences between loads, a compensator's linkage.
  UnmodelledEffect(const IdentificationModel& model, const UnmodelledSize& size);

  const UnmodelledSize& size() const { return size_; }
  int tips() const { return tips_; }
  /// Components of the twist: 3, with a rotation 6.
  int twists() const { return size_.rotation > 0 ? 6 : 3; }
  /// τ or τ_r of a component.
  double size_of(int twist) const { return twist < 3 ? size_.translation : size_.rotation; }
  /// The readings' derivatives along the twists as indices for IdentificationModel::linearise, one tip after the other.
  const std::vector<int>& columns() const { return columns_; }

  /// Derivatives along unit twists become those along twists of their size.
  /// @param along  rows × columns().size()
  template <class Matrix>
  void take_sizes(Eigen::MatrixBase<Matrix>& along) const {
    for (Eigen::Index c = 0; c < along.cols(); ++c) along.col(c) *= size_of(int(c) % twists());
  }

  /// f of every tip whose place is read, one a column.
  Eigen::MatrixXd places(std::span<const double> q) const;
  /// f of a robot that nobody reads at q, its own coordinates alone; where instruments see different tips, all of them.
  Eigen::VectorXd place(std::span<const double> q) const;
  /// k of two places.
  double correlation(Eigen::Ref<const Eigen::VectorXd> a, Eigen::Ref<const Eigen::VectorXd> b) const;

 private:
  struct Axis {
    std::size_t coordinate;
    bool turns;
    double unit;  // of lengths: π/range
  };
  UnmodelledSize size_;
  int tips_;
  std::size_t coordinates_;  // of one tip
  std::vector<std::vector<char>> moving_;
  std::vector<double> own_;  // (τ_k/τ)² of each instrument
  std::vector<Axis> axes_;
  std::vector<int> columns_;
};

/// Columns of the u of features at one configuration: out += Σ φ_j(tip) ∂y/∂δ_tip.
/// @param phi    EffectFeatures::at() of its tips, features × tips
/// @param along  readings' derivatives along the twists, their sizes taken, rows × (tips × twists)
/// @param out    rows × (features × twists)
template <class Along, class Out>
void add_feature_columns(const Eigen::Ref<const Eigen::MatrixXd>& phi, const Eigen::MatrixBase<Along>& along,
                         Eigen::MatrixBase<Out>&& out) {
  const Eigen::Index each = along.cols() / phi.cols();
  for (Eigen::Index j = 0; j < phi.rows(); ++j)
    for (Eigen::Index tip = 0; tip < phi.cols(); ++tip)
      out.middleCols(j * each, each) += phi(j, tip) * along.middleCols(tip * each, each);
}

/// The effect as columns of a linear model: δ(q) = Σ_j φ_j(q) u_j + what is left, u_j ~ N(0, diag(τ², τ_r²)) and the
/// rest independent from pose to pose, so that the variance at every pose is right. φ by pivoted Cholesky (Nyström) of
/// the correlations between given places.
class EffectFeatures {
 public:
  /// Whole between the given places, but for 1e-10 of the variance, if `most` allows.
  /// @param places  f of given poses, one a column
  /// @param most    places that φ is made of
  EffectFeatures(std::shared_ptr<const UnmodelledEffect> effect, const Eigen::MatrixXd& places, int most);
  /// The `count` that hold most of the variance at the given places: φ turned to the directions in which it differs
  /// most.
  EffectFeatures first(int count) const;

  const UnmodelledEffect& effect() const { return *effect_; }
  int count() const { return int(weights_.rows()); }
  /// Columns of a block that the features take: twists of the first feature, of the second, …
  int columns() const { return count() * effect_->twists(); }
  /// φ of every tip at these places, count() × tips.
  Eigen::MatrixXd at(const Eigen::MatrixXd& places) const;

  /// A whitened block J and the same of the twists' derivatives become the block of features and J, in this order, with
  /// unit variance of every u; what the features leave at q counts as noise of this pose.
  /// @param block  rows × (columns of J, then effect().columns())
  /// @param out    rows × (columns() + columns of J)
  void expand(std::span<const double> q, Eigen::Ref<const BlockArray::RowMatrix> block,
              Eigen::Ref<BlockArray::RowMatrix> out) const;
  /// Coefficients of the u, unit variance each, in the error of a tip's position and turn (6 × columns()); what the
  /// features leave of the variance is 1 − ‖φ‖².
  /// @param twists  6 × 6: unit twists as they move what is judged
  Eigen::MatrixXd columns_at(const Eigen::VectorXd& phi, const Eigen::MatrixXd& twists) const;

 private:
  std::shared_ptr<const UnmodelledEffect> effect_;
  Eigen::MatrixXd pivots_;   // their places
  Eigen::MatrixXd weights_;  // φ = weights · correlations with the pivots
  Eigen::MatrixXd squares_;  // φ φᵀ of the given places
};

}  // namespace posewright
