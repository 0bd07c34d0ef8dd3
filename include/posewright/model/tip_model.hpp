#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "posewright/model/harmonic_parts.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/support/taylor_model.hpp"

namespace posewright {

using Twist = Eigen::Matrix<double, 6, 1>;
using Twists = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using Polyline = std::vector<Eigen::Vector3d>;

/// Derivatives of a number f by the tip's pose and twists: TipModel::pull_back() takes them to the
/// configuration.
struct TipAdjoint {
  Twists twists;              ///< 6 × selected: ∂f/∂(each entry of a parameter's twist)
  Twists reading_twists;      ///< 6 × readings, or without columns: the same of the joints' or actuators' readings
  Twist tip = Twist::Zero();  ///< f changes by tip · ξ where the tip moves along the spatial twist ξ
};

/// Columns as polynomials of the joints' cosines and sines (and lengths), times factors that are none.
struct HarmonicColumns {
  std::string why_not;        ///< for messages; empty: the rest holds
  std::vector<int> selected;  ///< columns that are polynomials, in place of those that were selected
  std::vector<int> degrees;   ///< of pose and columns in each coordinate; 0 for a choice
  std::vector<ColumnFactor> factors;

  /// Columns of an elastic robot, expanded to the first order in its deflections (theory.md eq. (54)): their
  /// degree in an angle of degree 1, whether deflections are not zero, and the remainder of the expansion.
  int order = 1;
  bool bends = false;
  /// The change of a point that the tip carries at a distance l of its origin by a column's parameter is off by at most
  /// constant + lever l.
  struct Remainder {
    double constant = 0.0, lever = 0.0;
  };
  std::vector<Remainder> remainders{};  ///< one a column; empty: none
};

/// A robot that carries one tip frame: where the tip is and how each parameter moves it.
///
/// Twists are spatial and in the measurement frame M: rows 0–2 the velocity of the tip-fixed point that
/// passes the origin of M, rows 3–5 the angular velocity; a tip-fixed point at p moves with v + ω × p.
/// Parameters tool.* come last. Corrections may end before them (an instrument with targets has no tool).
class TipModel {
 public:
  virtual ~TipModel() = default;

  const std::vector<Parameter>& parameters() const { return parameters_; }
  const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  /// Coordinates that follow from the configuration (actuators of a parallel robot).
  const std::vector<Coordinate>& actuators() const { return actuators_; }
  const std::vector<IdentificationModel::Preference>& geometric_parameters() const { return geometric_; }
  /// 1σ of each reading that enters the model as if exact (rad or m): a joint's of a serial arm, an actuator's of a
  /// parallel robot.
  const std::vector<double>& reading_noise() const { return reading_noise_; }
  /// Redundant joint sensors: coordinates that the robot measures beyond those it needs.
  const std::vector<Coordinate>& sensors() const { return sensors_; }

  /// Pose of the tip in M, at configuration q and corrections (all parameters, or empty for zero).
  /// Fills twists (6 × selected; zero for indices beyond the own parameters) and, unless null, reading_twists
  /// (6 × readings); both are resized if needed. False if q is unreachable or singular.
  virtual bool linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X_MeasureTip,
                         Twists& twists, Twists* reading_twists) const = 0;

  /// Adds to `gradient` (size coordinates()) how f changes with every continuous coordinate, where the tip's pose and
  /// twists are those of linearise() (theory.md eqs. (49) and (50)). A robot that does not say gets central differences
  /// of linearise(). False if q or its neighbourhood is unreachable or singular.
  virtual bool pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                         std::span<double> gradient) const;

  /// Dependence of the tip's pose and these columns on the joints, with the choices and corrections (all parameters, or
  /// empty) of this point; theory.md eq. (37). Twists of zero columns are polynomials.
  virtual HarmonicColumns harmonic_columns(std::span<const int> selected, const Point& at) const;

  /// linearise() of a robot that is bent by this share of what bends it; the columns of what gives way count its whole
  /// load. A stiff robot is not bent by any.
  virtual bool linearise_bent(const Point& at, double share, std::span<const int> selected, Eigen::Isometry3d& X,
                              Twists& twists) const;

  /// Index of the parameter that moves the tip as the reading of this coordinate does; −1: there is none.
  virtual int offset_of(int coordinate) const;

  /// From now on loads bend the robot as they do with these corrections (all parameters, maybe without tool.*).
  virtual void take_loads_at(std::span<const double> correction);

  /// Actuators at q; false if q is unreachable.
  virtual bool actuator_values(const Point& at, std::span<double> values) const;

  /// Lines that show a robot whose links have no shapes (legs, rims) at its nominal parameters, measurement frame, m.
  /// Empty if q is unreachable or the robot is an arm.
  virtual std::vector<Polyline> skeleton(std::span<const double> q) const;

  /// Derivatives of the redundant sensors' values: along the selected parameters (sensors × selected) and along the
  /// readings (sensors × readings). False if q is unreachable. Throws std::logic_error if there are no sensors.
  virtual bool sensor_rows(const Point& at, std::span<const int> selected, Eigen::MatrixXd& rows,
                           Eigen::MatrixXd& reading_rows) const;

  /// Values of the redundant sensors (rad or m). False and throws as sensor_rows().
  virtual bool sensor_values(const Point& at, Eigen::VectorXd& values) const;

  /// Configuration with these actuator values, near `start`; without actuators it stays there. False
  /// if a closed chain does not close.
  virtual bool configuration_at(std::span<const double> actuators, const Point& start, std::span<double> q) const;

  /// A closed chain's residual f over a box of configurations: f(X + δ, ρ + δρ, ξ + δξ) changes by the sum of the
  /// three.
  struct EnclosedResidual {
    using Matrix = Eigen::Matrix<TaylorModel, Eigen::Dynamic, Eigen::Dynamic>;
    Matrix platform;                   ///< 6 × 6, along twists of the tip about its origin in its own axes
    Matrix actuator;                   ///< 6 × readings
    Matrix parameter;                  ///< 6 × selected: all that moves the tip
    std::vector<TaylorModel> allowed;  ///< none is negative at a feasible configuration
  };
  /// @param q  each a variable over the box
  /// @return false if the robot has none
  virtual bool enclose_residual(std::span<const TaylorModel> q, std::span<const double> correction,
                                std::span<const int> selected, EnclosedResidual& out) const;

 protected:
  std::vector<Parameter> parameters_;
  std::vector<Coordinate> coordinates_;
  std::vector<Coordinate> actuators_;
  std::vector<Coordinate> sensors_;
  std::vector<IdentificationModel::Preference> geometric_;
  std::vector<double> reading_noise_;
};

}  // namespace posewright
