#pragma once

#include <optional>

#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/model/tip_model.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/taylor_model.hpp"

namespace posewright {

/// Why a configuration is refused where F_x is nearly singular, in the table of rejections.
inline std::string near_singularity() { return "near a singularity"; }

/// Closed-chain robots: loop equations f(x, ρ, ξ) = 0 tie the platform's coordinates x (the configuration) to the
/// actuators ρ; as many equations as coordinates. A robot gives f's derivatives; everything else is done here:
///   twist of the platform along a parameter = −B F_x⁻¹ F_ξ,  along an actuator reading = −B F_x⁻¹ F_ρ,
/// F_x = ∂f/∂x, B = twists along the coordinates (6 × d). So every instrument works with every closed chain, also one
/// that sees only a part of the pose. Where it sees all six values this gives the same information as the residual f
/// itself, weighted by (F_X Σ_X F_Xᵀ + F_ρ Σ_ρ F_ρᵀ)⁻¹ (theory.md eq. (7)): both differ by the regular factor F_x.
///
/// Parameters: base.{x,…,rz} (displacement of the base in M), the robot's own, tool.{x,…,rz} (of the platform).
class ClosedChain : public TipModel {
 public:
  bool linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X_MeasureTip, Twists& twists,
                 Twists* reading_twists) const final;
  /// By theory.md eq. (50) where the robot gives the derivative of its loops, else TipModel's differences.
  bool pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                 std::span<double> gradient) const final;
  /// None: the platform is no polynomial of its actuators. enclose_residual() bounds some of these robots.
  HarmonicColumns harmonic_columns(std::span<const int> selected, const Point& at) const final;
  bool actuator_values(const Point& at, std::span<double> values) const final;

  std::vector<Polyline> skeleton(std::span<const double> q) const final;

  bool sensor_rows(const Point& at, std::span<const int> selected, Eigen::MatrixXd& rows,
                   Eigen::MatrixXd& reading_rows) const final;

  bool sensor_values(const Point& at, Eigen::VectorXd& values) const final;
  bool configuration_at(std::span<const double> actuators, const Point& start, std::span<double> q) const final;
  bool enclose_residual(std::span<const TaylorModel> q, std::span<const double> correction,
                        std::span<const int> selected, EnclosedResidual& out) const final;

  /// Forward kinematics: the platform coordinates at given actuators, by Newton's method from `start`. Empty if it
  /// does not converge in 50 steps or meets a singularity.
  std::optional<std::vector<double>> forward_kinematics(std::span<const double> actuators, const Point& start) const;

  /// Pose of the platform in the base frame, nominal.
  Eigen::Isometry3d platform(std::span<const double> q) const;

  /// Derivatives of the d loop equations at one configuration, in the base frame; of scalars S = TaylorModel, at all of
  /// a box.
  template <class S>
  struct LoopsOf {
    template <int columns>
    using Matrix = Eigen::Matrix<S, Eigen::Dynamic, columns>;
    Matrix<1> value;                   ///< f, d
    Matrix<Eigen::Dynamic> parameter;  ///< d × selected: ∂f/∂ξ
    Matrix<Eigen::Dynamic> platform;   ///< d × 6: along spatial twists of the platform
    Matrix<Eigen::Dynamic> actuator;   ///< d × actuators: ∂f/∂ρ
  };
  using Loops = LoopsOf<double>;
  /// All configurations of a box at once.
  struct Enclosed {
    Frame<TaylorModel> X_BasePlatform;
    std::vector<TaylorModel> actuators;
    LoopsOf<TaylorModel> loops;        ///< without `value`
    std::vector<TaylorModel> allowed;  ///< none is negative at a configuration within reach and the actuators' travel
  };

  struct LoopState {
    std::span<const double> q, actuators;
    std::span<const double> own;  ///< corrections of the robot's own parameters, or empty for zero
    std::span<const int>
        selected;  ///< indices into the robot's own parameters; others (< 0 or beyond) give zero columns
  };
  void loops(const LoopState& at, Loops& out) const;

 protected:
  explicit ClosedChain(const Placement& placement);

  /// Called once by the robot's constructor when its own parameters, coordinates and actuators are there.
  void finish(const std::vector<Parameter>& own, double actuator_noise);
  int first_own() const { return 6; }
  /// Corrections of the own parameters: empty, or as many as there are.
  std::span<const double> own_part(std::span<const double> correction) const;
  void own_selection(std::span<const int> selected, std::vector<int>& own) const;

 private:
  /// Pose of the platform in the base frame, and the twists (6 × d, spatial, base frame) along its coordinates.
  virtual Eigen::Isometry3d do_platform(std::span<const double> q, Twists& freedoms) const = 0;
  /// False if q is out of reach.
  virtual bool do_inverse_kinematics(std::span<const double> q, std::span<const double> own,
                                     std::span<double> actuators) const = 0;
  /// `out` has the right sizes and is all zero.
  virtual void do_loops(const LoopState& at, Loops& out) const = 0;
  /// Derivatives of h = ⟨slope.parameter, F_ξ⟩ + ⟨slope.platform, F_X⟩ + ⟨slope.actuator, F_ρ⟩ of do_loops() along
  /// spatial twists of the platform (base frame), and with the actuators: adds to both, which have the right sizes.
  /// False: the robot does not say.
  virtual bool do_loops_change(const LoopState& at, const Loops& slope, Twist& by_platform,
                               Eigen::VectorXd& by_actuators) const;
  /// Legs and rims in the base frame, nominal.
  virtual std::vector<Polyline> do_skeleton(std::span<const double> q, std::span<const double> actuators) const = 0;
  /// Values of the redundant sensors and their derivatives, for robots with sensors.
  virtual void do_sensors(const LoopState& at, Loops& out) const;
  /// Fills `out`, whose loops have the right sizes and are zero, for all configurations of a box. False if there is no
  /// enclosure.
  virtual bool do_enclose(std::span<const TaylorModel> q, std::span<const double> own, std::span<const int> selected,
                          Enclosed& out) const;

  void read_sensors(const LoopState& at, Loops& out) const;

  void add_turned_freedoms(std::span<const double> q, const Eigen::Ref<const Twists>& by_freedoms,
                           std::span<double> gradient) const;

  struct Scratch;
  static Scratch& scratch_of_this_thread();
  /// Loops and response at a point; false out of reach and at a singularity.
  bool respond(const Point& at, std::span<const int> selected, Scratch& s) const;

  Eigen::Isometry3d X_MeasureBase_;
  int own_count_ = 0;
};

}  // namespace posewright
