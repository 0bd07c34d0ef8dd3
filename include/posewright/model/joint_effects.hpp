#pragma once

#include <memory>
#include <vector>

#include "posewright/model/tip_model.hpp"
#include "posewright/problem/robot_specs.hpp"

namespace posewright {

/// Effects of the same joints, each by its name, with eccentricity of every joint that turns beside them.
/// @param coordinates  of the arm; choices and second configurations are passed over
std::vector<JointEffectsSpec> with_eccentricity(const std::vector<JointEffectsSpec>& effects,
                                                const std::vector<Coordinate>& coordinates);

/// Serial arm whose joints stand elsewhere than they read, by functions of the readings (theory.md eq. (32)):
///   q' = q + c₁ cos q + s₁ sin q + c₂ cos 2q + s₂ sin 2q   (eccentricity: encoder or gear wheel off its axis, and
///   oval)
///          + c cos Nq + s sin Nq                           (gear: N periods a turn of the joint)
///          + Σ k q_other                                   (coupling with another joint)
///          ∓ b/2 where it arrived rising, falling          (backlash: b is the play)
///          + t (T − T_reference)                           (temperature).
/// Parameters NAME.{cos1, sin1, cos2, sin2}, NAME.{cos_g, sin_g} (rad), NAME.coupling.OTHER (own unit per other's),
/// NAME.backlash (own unit), NAME.temperature (own unit/K), as the problem lists them, before tool.*; nominal 0. Joints
/// with backlash add a choice NAME.approach to the configuration, temperature one `temperature` (°C). Loads bend the
/// arm as it reads. Twists of the parameters are those of the joints' readings times the function.
class JointEffects : public TipModel {
 public:
  /// @param arm  the chain whose coordinates are the joints' readings
  /// Revolute joints among those that a pattern names have eccentricity and gear_ratio. Throws InputError for names
  /// that match no joint or one twice, for angles of a joint that slides and is named itself, and for one that drifts
  /// with a temperature that nobody states.
  JointEffects(std::unique_ptr<TipModel> arm, const SerialArmSpec& spec, const std::string& file);

  bool linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X_MeasureTip, Twists& twists,
                 Twists* reading_twists) const override;
  bool pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                 std::span<double> gradient) const override;
  /// The offset's columns times the effects' functions, as long as no effect is known to be there.
  HarmonicColumns harmonic_columns(std::span<const int> selected, const Point& at) const override;
  void take_loads_at(std::span<const double> correction) override;

 private:
  enum class Kind { cosine, sine, linear, side };
  /// One parameter: its addition to the reading of `joint` is its value times the function of coordinate `of`.
  struct Effect {
    int joint, of;
    Kind kind;
    double constant;  ///< periods in a turn; where a linear one is zero
    double value(double q) const;
    double derivative(double q) const;
    double second_derivative(double q) const;
  };

  void add(const JointEffectsSpec& spec, int joint, const std::string& file);
  void add_temperature(const TemperatureSpec& spec);
  double coefficient(const Point& at, std::size_t effect) const;
  /// Joint values, selection and corrections in the arm's order; all held by this thread.
  struct Inside;
  Inside& inside(const Point& at, std::span<const int> selected) const;

  std::unique_ptr<TipModel> arm_;
  std::vector<Effect> effects_;
  int first_ = 0;  ///< index of the first effect's parameter
  bool is_elastic_ = false;
  int temperature_ = -1;  ///< coordinate; −1: there is none
  double reference_temperature_ = 0.0;
};

}  // namespace posewright
