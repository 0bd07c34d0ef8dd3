#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "posewright/model/tip_model.hpp"

namespace posewright {

/// Prior 1σ of a target's coordinates if nothing else is said, m.
inline constexpr double default_target_tolerance = 1e-3;

class MeasurementModel;

/// Noise of an instrument whose rows and own columns are linear in the tip's pose and in twists, or would be without a
/// direction: the parts of bounds over boxes (theory.md eq. (39)).
struct HarmonicNoise {
  enum class Kind {
    unknown,
    constant,   ///< the same covariance at every pose
    beams,      ///< of each target's three rows, `along` the line to the station and `across` it
    distances,  ///< rows are distances from fixed places, with variance `along`; times the distance they are linear
  };
  Kind kind = Kind::unknown;
  /// Variances at a distance R: constant + linear R + square R² (weight 1).
  InverseVariance along{}, across{};
  std::vector<int> excluded{};  ///< own parameters for whose columns that does not hold
  /// Another instrument, without parameters of its own, that tells as much: its rows count; null: none.
  const MeasurementModel* instead = nullptr;
  double repeats = 1.0;  ///< of its readings
};

/// Measurement of a tip frame: rows of measured values, their noise, and parameters of its own (targets,
/// stations, lens). Members are const and may run in several threads at once.
class MeasurementModel {
 public:
  virtual ~MeasurementModel() = default;

  /// One measurement: where the tip is, corrections of the own parameters (or empty for zero), which station looks.
  struct Sighting {
    const Eigen::Isometry3d& X_MeasureTip;
    std::span<const double> correction;
    int station = 0;
    const Eigen::Isometry3d* X_MeasureTipNominal = nullptr;  ///< there of readings by reads_from_nominal() alone
  };

  /// Derivatives of a number f by the results of one sighting: pull_back() takes them to the tip's pose.
  struct Adjoint {
    Eigen::MatrixXd twist_rows;   ///< rows × 6: ∂f/∂(rows along unit twists)
    std::vector<int> own;         ///< own parameters that f depends on
    Eigen::MatrixXd own_columns;  ///< rows × own: ∂f/∂(their columns); of motions nothing
    Twists own_motions;           ///< 6 × own: ∂f/∂(their motions); of columns nothing
    Eigen::MatrixXd covariance;   ///< rows × rows, symmetric: ∂f/∂(covariance)
  };

  const std::vector<Parameter>& parameters() const { return parameters_; }
  /// Parameters that `auto` may choose, in tiers (IdentificationModel::Preference; indices into parameters()).
  const std::vector<IdentificationModel::Preference>& preferences() const { return preferences_; }
  int rows() const { return rows_; }
  /// Rows that belong to one target each, target by target; 0: readings are of the pose as a whole.
  int rows_per_target() const { return rows_per_target_; }
  /// Names of the stations that a measurement can be taken from; empty if there is nothing to choose.
  const std::vector<std::string>& stations() const { return stations_; }
  /// True if targets (or a mounted board or camera) stand for the tool, so that tool.* would be said twice.
  bool replaces_tool() const { return replaces_tool_; }

  /// Readings, in the order of the rows.
  const std::vector<Reading>& readings() const { return readings_; }
  /// The readings of one measurement, without noise; `y` has size rows().
  virtual void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const = 0;
  /// True if readings count from the tip's nominal pose at the same configuration.
  virtual bool reads_from_nominal() const { return false; }
  /// Measured less predicted as the rows count it (IdentificationModel::difference).
  virtual void difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                          Eigen::VectorXd& out) const;

  /// Its inverse (IdentificationModel::shifted).
  virtual void shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change, Eigen::VectorXd& out) const;

  /// Measured values' derivative along each tip twist: rows × twists.cols().
  virtual void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                              Eigen::Ref<Eigen::MatrixXd> rows) const = 0;

  /// a where f changes by a · ξ if the tip moves along the spatial twist ξ and its parameters' twists stay. An
  /// instrument that does not say gets central differences in the tip's six motions.
  virtual Twist pull_back(const Sighting& sighting, const Adjoint& f) const;

  /// Dependence of rows and noise on the tip's pose. Default: none that a bound over boxes could use.
  virtual HarmonicNoise harmonic_noise() const { return {}; }

  /// Own parameters that act like a motion of the tip (a station moves one way, the tip seems to move the other):
  /// true, and the twist where `twist` is not null.
  virtual bool motion(const Sighting& sighting, int index, Twist* twist) const;

  /// Column (size rows) of an own parameter that is not a motion. Throws std::logic_error for others.
  virtual void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const;

  /// Covariance of the rows (rows × rows): reading noise over repeats, plus repeatability.
  virtual void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const = 0;

  /// False if the instrument cannot read the tip there; unseen_reason() says why, empty if it always can.
  virtual bool sees(const Sighting& sighting) const;
  const std::string& unseen_reason() const { return unseen_reason_; }
  /// IdentificationModel::measurable_margins() of the instrument alone.
  virtual std::optional<int> margins() const;
  virtual void margins_at(const Sighting& sighting, std::span<double> out) const;

  /// Covariance (6 × 6) of the tip's pose by the linear fit to one measurement, as twists about its origin in its own
  /// axes (m, rad), where that is the same at every pose. Empty: it is not, or the readings do not fix the pose.
  virtual std::optional<Eigen::Matrix<double, 6, 6>> tip_covariance() const { return std::nullopt; }

 protected:
  std::vector<Parameter> parameters_;
  std::vector<IdentificationModel::Preference> preferences_;
  std::vector<std::string> stations_;
  std::vector<Reading> readings_;
  std::string unseen_reason_;
  bool replaces_tool_ = false;
  int rows_ = 0;
  int rows_per_target_ = 0;
};

/// Change by spatial twists of what moves a point at p (a · change of p) and turns vectors (b · small rotation).
inline Twist change_by_motion(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Twist twist;
  twist << a, p.cross(a) + b;
  return twist;
}

/// Covariance (6 × 6) of the pose in spatial twists about the tip's origin, by the linear fit of the pose to an
/// instrument's readings: Σ_X = (Yᵀ Σ_y⁻¹ Y)⁻¹, Y = derivative of the readings along those twists.
/// Throws CannotDo if the readings do not fix all six degrees of freedom.
Eigen::Matrix<double, 6, 6> fitted_pose_covariance(const MeasurementModel& measurement, const Eigen::Isometry3d& X);

}  // namespace posewright
