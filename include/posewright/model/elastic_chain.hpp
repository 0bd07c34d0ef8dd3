#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "posewright/model/serial_chain.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// "joint_a2.compliance_3" or a glob of such: how compliances at listed positions were named before. Those numbers
/// followed the sorted positions and not the file's, so they cannot be taken for anything.
bool is_numbered_place(std::string_view name);

/// Deflection of the unloaded joint by the torque of its compensator (`effect: torque`), if that is not a small
/// angle in which springs are linear: one line for the user. Empty if nothing is to be said.
std::string compensator_warning(const RobotSpec& robot, const std::vector<Coordinate>& coordinates);

/// Serial arm whose joints give way (virtual joint springs, theory.md eq. (11)): each joint stands deflected by δ =
/// k·τ, with the torque τ = J_qᵀ w of the load case and, where asked, of the links' weight. τ is that of the
/// undeflected arm with its nominal parameters (take_loads_at()): the difference is of second order.
///
/// Configuration: the chain's, then the load case. Parameters: the chain's without tool.*; for each coordinate
/// NAME.compliance (rad/(N·m) or m/N), or NAME.compliance@-25.2deg, … for listed positions (in the order in which they
/// are listed), or with a gravity compensator NAME.stiffness K2⁰ (N·m/rad), compensator.stiffness Kc (N/m) and
/// compensator.preload s0·Kc (N), where
///   δ = τ_load / (K2⁰ + M'(q)), M the spring's torque (eq. (13)–(14) of the KR 270's study), τ_load that of the load
/// case alone: the effect of spring and links on the unloaded arm is in the controller's zero. Where the problem says
/// `effect: torque`, δ = (τ − M(q)) / (K2⁰ + M'(q)). Then tool.*.
class ElasticChain : public TipModel {
 public:
  /// Throws InputError for joints that the chain has not.
  ElasticChain(ChainDescription chain, const ElastostaticSpec& spec, const SourcePlace& place);

  bool linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X_MeasureTip, Twists& twists,
                 Twists* reading_twists) const override;

  /// Gradient of the chain; changes of deflections with the torques by central differences of these alone.
  bool pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                 std::span<double> gradient) const override;

  void take_loads_at(std::span<const double> correction) override;

  /// Columns to the first order in the deflections, and how far these may be from the columns: where compliances are
  /// constant (no compensator), joints turn, and geometry is nominal.
  HarmonicColumns harmonic_columns(std::span<const int> selected, const Point& at) const override;
  bool linearise_bent(const Point& at, double share, std::span<const int> selected, Eigen::Isometry3d& X,
                      Twists& twists) const override;

  /// Torque (N·m or N) at every coordinate under load case `load`; with the links' weight where it counts.
  void torques(std::span<const double> q, int load, std::span<double> out) const {
    torques(q, load, spec_.link_gravity, out);
  }

 private:
  std::string why_not_expanded(const Point& at) const;
  /// No torque under the point's load case is larger, whatever the joints that move stand at.
  std::vector<double> largest_torques(const Point& at) const;
  std::vector<HarmonicColumns::Remainder> remainders_of(std::span<const int> selected,
                                                        std::span<const double> deflection,
                                                        std::span<const double> torque,
                                                        std::span<const ColumnFactor> factors, const Point& at) const;
  void torques(std::span<const double> q, int load, bool link_weights, std::span<double> out) const;
  /// One elastostatic parameter and the coordinate it acts on.
  struct Spring {
    enum class Kind { compliance, listed, joint_stiffness, spring_stiffness, preload } kind;
    int coordinate;
    int listed = 0;  ///< which of the listed positions
  };
  void add_springs(const SourcePlace& place);
  /// True if a compliance acts at these joints: a listed one acts only at its own position.
  bool acts(const Spring& spring, std::span<const double> q) const;
  /// Torque at one coordinate by the load case, without the weight of links.
  double load_alone(const Point& at, std::size_t coordinate) const;
  /// One configuration as the chain without springs takes it; held by this thread.
  struct Bent;
  Bent& bent(const Point& at, std::span<const int> selected) const;
  void linearise_as(const Bent& b, const Point& at, std::span<const int> selected, Eigen::Isometry3d& X, Twists& twists,
                    Twists& readings) const;
  /// Deflection of every coordinate and its derivative by every elastostatic parameter.
  void deflect(const Point& at, std::span<double> deflection, std::span<double> derivative) const;
  /// Adds the change of f by that of torques with q, given its derivatives by deflections and by their derivatives.
  void add_bending(const Point& at, std::span<const double> by_deflection, std::span<const double> by_derivative,
                   std::span<double> gradient) const;

  SerialChain chain_;
  ElastostaticSpec spec_;
  std::vector<Spring> springs_;
  int first_ = 0;                  ///< index of the first elastostatic parameter
  std::vector<double> loaded_at_;  ///< corrections of the chain's parameters for the torques; empty: zero
};

}  // namespace posewright
