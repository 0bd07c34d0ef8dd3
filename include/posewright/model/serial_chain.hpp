#pragma once

#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/model/tip_model.hpp"

namespace posewright {

/// Serial arm: base.{x,y,z,rx,ry,rz}; per joint NAME.{x,y,z,rx,ry,rz} (displacement of its frame before it moves),
/// NAME.offset and NAME.gear (not for mimic joints); tool.{x,…,rz}. Pose of the tip in the measurement frame:
///   X_MeasureBase D(base) · Π_k [X_ParentJoint,k D_k Motion_k(multiplier ((1 + gear) q + offset) + mimic offset)] ·
///   X_LastTip D(tool).
/// A joint that is passed backward has the factor X_ParentJoint,k Motion_k D_k⁻¹.
/// More than can be identified on purpose: the irreducible subset comes out of the identifiability analysis.
class SerialChain : public TipModel {
 public:
  /// Throws std::invalid_argument for a chain without joints or with more than 64.
  explicit SerialChain(ChainDescription chain);

  /// Columns are spatial twists (theory.md eq. (5)): rotation about axis ω through o gives (o × ω, ω), translation
  /// (axis, 0). Selected indices beyond the chain's own parameters give zero columns.
  bool linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X_MeasureTip, Twists& twists,
                 Twists* reading_twists) const override;

  /// A twist that joint j carries along changes by the Lie bracket [ξ_j, ξ] per radian or metre of it.
  bool pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                 std::span<double> gradient) const override;

  /// Degree 1 in each joint; in one that others follow, the sum of their whole ratios. A gear's column is that of the
  /// offset times the joint's own reading.
  HarmonicColumns harmonic_columns(std::span<const int> selected, const Point& at) const override;

  int offset_of(int coordinate) const override { return layout_.offset[std::size_t(coordinate)]; }

  /// Variant with every joint turned beyond its reading by `deflection` (rad or m per coordinate; empty: zero).
  void linearise_deflected(std::span<const double> q, std::span<const double> deflection,
                           std::span<const double> correction, std::span<const int> selected,
                           Eigen::Isometry3d& X_MeasureTip, Twists& twists, Twists* reading_twists) const;

  /// pull_back() with the joints deflected so, the deflection held; unless it is empty, f's change by each coordinate's
  /// deflection is added to `by_deflection`.
  void pull_back_deflected(std::span<const double> q, std::span<const double> deflection,
                           std::span<const double> correction, std::span<const int> selected, const TipAdjoint& f,
                           std::span<double> gradient, std::span<double> by_deflection = {}) const;

  const ChainDescription& description() const { return chain_; }
  const ChainLayout& layout() const { return layout_; }

 private:
  /// Source of a column: the n-th stored axis, as rotation or translation, times a factor.
  struct Column {
    int joint;  ///< −1 base, joints() tool
    int kind;   ///< 0–2 translation, 3–5 rotation, 6 offset, 7 gear
  };

  /// Of −1 for the base and joints() for the tool: false.
  bool is_backward(int joint) const;

  ChainDescription chain_;
  ChainLayout layout_;
  std::vector<Column> columns_;  ///< per parameter
  std::vector<std::vector<int>> joints_of_coordinate_;
};

}  // namespace posewright
