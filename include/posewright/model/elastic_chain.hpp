#pragma once

#include "posewright/model/serial_chain.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Serial arm whose joints give way (virtual joint springs, design §3.3): each joint stands deflected by δ = k·τ, with
/// the torque τ = J_qᵀ w of the load case and, where asked, of the links' weight. τ is that of the nominal, undeflected
/// arm: the difference is of second order.
///
/// Configuration: the chain's, then the load case. Parameters: the chain's without tool.*; for each coordinate
/// NAME.compliance (rad/(N·m) or m/N), or NAME.compliance@-25.2deg, … for listed positions (in the order in which they
/// are listed), or with a gravity compensator NAME.stiffness K2⁰ (N·m/rad), compensator.stiffness Kc (N/m) and
/// compensator.preload s0·Kc (N), where
///   δ = (τ − M(q)) / (K2⁰ + M'(q)), M the spring's torque; then tool.*.
class ElasticChain : public TipModel {
 public:
  /// Throws InputError for joints that the chain has not.
  ElasticChain(ChainDescription chain, const ElastostaticSpec& spec, const SourcePlace& place);

  bool linearise(std::span<const double> q, std::span<const double> correction, std::span<const int> selected,
                 Eigen::Isometry3d& X_MeasureTip, Twists& twists, Twists* reading_twists) const override;

  /// Torque (N·m or N) at every coordinate under load case `load`, nominal arm.
  void torques(std::span<const double> q, int load, std::span<double> out) const;

 private:
  /// One elastostatic parameter and the coordinate it acts on.
  struct Spring {
    enum class Kind { compliance, listed, joint_stiffness, spring_stiffness, preload } kind;
    int coordinate;
    int listed = 0;  ///< which of the listed positions
  };
  void add_springs(const SourcePlace& place);
  /// Deflection of every coordinate and its derivative by every elastostatic parameter.
  void deflect(std::span<const double> q, std::span<const double> elastic, std::span<double> deflection,
               std::span<double> derivative) const;

  SerialChain chain_;
  ElastostaticSpec spec_;
  std::vector<Spring> springs_;
  int first_ = 0;  ///< index of the first elastostatic parameter
};

}  // namespace posewright
