#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "posewright/blocks/parameter.hpp"
#include "posewright/blocks/pose_choices.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {

/// One entry of a configuration (or one actuator that follows from it).
struct Coordinate {
  std::string name;
  std::string unit;  ///< "rad" or "m"; empty for a choice
  double lower = 0.0;
  double upper = 0.0;
  bool periodic = false;              ///< a full turn: both ends are the same pose and no boundary
  std::vector<double> values{};       ///< the only values allowed, ascending; empty: all between the limits
  std::vector<std::string> labels{};  ///< of a choice (load case, station): names of the values 0, 1, …
  double speed = 0.0;                 ///< largest, per second; 0: not known
  std::string limited_by{};           ///< cause of narrower limits of the joint; empty: none
  /// Choice between `rising` and `falling`: the arriving coordinate, and its distance, rad or m.
  std::string arrives{};
  double overrun = 0.0;
  bool measurable = false;  ///< a choice (of a temperature) that data may hold any number of; values are the numbers

  bool discrete() const { return !values.empty(); }
  bool choice() const { return !labels.empty(); }
  /// Name of a choice's value; for a measured value outside the list, the number.
  std::string label_at(double value) const;
};

/// InputError for a name that is none of them; says which are allowed (the second ones of pairs go without saying).
[[noreturn]] void throw_unknown_coordinate(const SourcePlace& place, const std::string& name,
                                           const std::vector<Coordinate>& coordinates);

/// A choice among named things as a coordinate: values 0, 1, … with these labels.
Coordinate make_choice(const std::string& name, const std::vector<std::string>& labels);
/// The side from which a coordinate with backlash arrives: `rising` (0) or `falling` (1), named JOINT.approach.
Coordinate make_approach(const std::string& joint, double overrun);

/// Labels of the choices at q; a condition that has one value alone is left out.
PoseChoices choices_at(const std::vector<Coordinate>& coordinates, std::span<const double> q);

/// Choices that a model computes with, as indices.
struct Chosen {
  int station = 0;    ///< among the instrument's
  int load_case = 0;  ///< among the robot's
};
Chosen chosen_at(const std::vector<Coordinate>& coordinates, std::span<const double> q);

/// One value that an instrument delivers at a configuration.
struct Reading {
  std::string name;  ///< "P1.x"
  std::string unit;  ///< "m", "rad", "px"
};

/// Pose and parameters of a robot, station of the instrument, load.
struct Point {
  std::span<const double> q;           ///< configuration, SI
  std::span<const double> correction;  ///< ξ − nominal of every parameter; empty: all zero
  Chosen chosen{};
  std::span<const double> read{};  ///< readings of the joints if they differ; empty: q

  std::span<const double> readings() const { return read.empty() ? q : read; }
};

/// Result and work space of one linearisation; reuse it, so that a loop over configurations does not allocate.
struct Linearisation {
  /// Input, r × r; empty: all one. Factors of the covariance of the readings alone (without repeatability),
  /// where they are means of other numbers of readings than the model's repeats.
  Eigen::MatrixXd reading_share;
  Eigen::MatrixXd G;           ///< r × selected: ∂g/∂ξ up to the sign of g, not yet whitened
  Eigen::MatrixXd covariance;  ///< r × r: G_y Σ_y G_yᵀ + G_ρ Σ_ρ G_ρᵀ, symmetric positive definite
  Eigen::MatrixXd basis;       ///< r × c, c < r, where the model offers G = basis · coefficients
  /// c × selected
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> coefficients;
  /// Factored form only: `covariance` is then the instrument's alone, and what moves the tip at random with these
  /// columns N (1σ each) adds basis · N Nᵀ · basisᵀ.
  Eigen::MatrixXd random_coefficients;
  Eigen::Matrix<double, 6, Eigen::Dynamic> twists;          ///< scratch: tip twist per selected parameter
  Eigen::Matrix<double, 6, Eigen::Dynamic> reading_twists;  ///< scratch: tip twist per joint or actuator reading
  Eigen::Matrix<double, 6, Eigen::Dynamic> random_twists;   ///< scratch: random motions of the tip, 1σ
  Eigen::MatrixXd rows, small;                              ///< scratch
  std::vector<char> seen;                                   ///< scratch: per target
  std::vector<double> correction, settled;                  ///< scratch
  Eigen::LLT<Eigen::MatrixXd> factor, small_factor;         ///< scratch of the whitening
  Eigen::HouseholderQR<Eigen::MatrixXd> compression;        ///< scratch of the whitening

  /// For models, once `covariance` holds the readings' own and nothing else.
  void share_readings() {
    if (reading_share.size() > 0) covariance.array() *= reading_share.array();
  }
};

/// Visible targets of an instrument. Const and callable from several threads.
class Visibility {
 public:
  virtual ~Visibility() = default;
  virtual int targets() const = 0;
  /// seen[t] = 1 for each target that can be seen at q, else 0; size targets().
  virtual void visible(std::span<const double> q, std::span<char> seen) const = 0;
};

/// Robot and instrument together: everything that planning needs to know of them.
///
/// A model is a catalogue of all its parameters (more than can be identified); a variant selects columns.
/// Identification function g(y, ρ, ξ): zero for exact model and data. Members are const and
/// may be called from several threads at once, each with a Linearisation of its own.
class IdentificationModel {
 public:
  virtual ~IdentificationModel() = default;

  const std::vector<Parameter>& parameters() const { return parameters_; }
  const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  /// Coordinates that follow from the configuration and have limits of their own (actuators of a parallel robot).
  const std::vector<Coordinate>& actuators() const { return actuators_; }
  /// Rows r of one configuration: the readings.
  int rows() const { return rows_; }
  /// Readings at q: the rows of visible targets of the instrument that reads there.
  int visible_rows(std::span<const double> q) const;
  /// Readings of targets that are hidden at q, and of instruments that do not read there, become NaN.
  void blank_hidden(std::span<const double> q, Eigen::VectorXd& y) const;
  /// Rows of one whitened block: fewer than rows() where many readings tell of few motions (a board in an image).
  int block_rows(std::span<const int> selected) const { return do_block_rows(selected); }

  void set_nominal(int index, double value);  ///< of parameter `index`: later linearisations are there
  /// From now on loads bend an elastic robot as they do with these corrections (of all parameters): what parameters
  /// change of the torques is of second order while corrections are small, but a base may be found to stand anywhere.
  void take_loads_at(std::span<const double> correction);

  /// Fills out.G (columns in the order of `selected`, indices into parameters()) and out.covariance.
  /// @param q           configuration, size coordinates()
  /// @param correction  ξ − nominal for every parameter, or empty for all zero
  /// @return false if q has no solution (unreachable) or cannot be measured; `out` is then unspecified
  bool linearise(std::span<const double> q, std::span<const double> correction, std::span<const int> selected,
                 Linearisation& out) const;
  /// Variant with G factored into out.basis and out.coefficients, random motions of the tip into
  /// out.random_coefficients; only where block_rows() < rows().
  bool linearise_factored(std::span<const double> q, std::span<const double> correction, std::span<const int> selected,
                          Linearisation& out) const;

  /// Gradient of a number f of linearise() along every continuous coordinate, from its derivatives by G and
  /// by the covariance (symmetric), nominal parameters: ∂f/∂q_k = ⟨∂f/∂G, ∂G/∂q_k⟩ + ⟨∂f/∂Σ, ∂Σ/∂q_k⟩ (theory.md eq.
  /// (48)).
  /// @param gradient  size coordinates(); undefined for choices
  /// @return false if this model does not know its derivatives, or has none at q
  bool pull_back(std::span<const double> q, std::span<const int> selected, const Eigen::MatrixXd& by_G,
                 const Eigen::MatrixXd& by_covariance, std::span<double> gradient) const;

  /// Configuration of the robot with the parameters nominal + correction and the actuators at q with
  /// nominal ones; q itself for a robot with its joint readings as coordinates.
  /// @param settled  size coordinates(); may be q
  /// @return false if q is out of reach or a closed chain does not settle near q
  bool settled(std::span<const double> q, std::span<const double> correction, std::span<double> settled) const;

  /// Readings of one configuration, in the order of the rows.
  const std::vector<Reading>& readings() const { return readings_; }
  /// Readings h(ρ, ξ) with the parameters nominal + correction, while the actuators ρ stand as they do at q with
  /// nominal ones: a parallel robot settles in another pose, a serial arm turns its joints as far as it reads.
  /// @param y  resized to readings()
  /// @return false if q is out of reach or a closed chain does not settle near q
  /// Throws CannotDo for an instrument whose readings cannot be told (PoseModel with a part of the orientation).
  bool predict(std::span<const double> q, std::span<const double> correction, Eigen::VectorXd& y) const;
  /// predict() and, where the robot then stands, linearise().
  bool predict_and_linearise(std::span<const double> q, std::span<const double> correction,
                             std::span<const int> selected, Linearisation& out, Eigen::VectorXd& y) const;
  /// Measured less predicted readings as the rows of linearise() count them: orientations by the rotation vector
  /// between them, angles of joints within half a turn; NaN if the measured one is NaN.
  /// @param out  size readings()
  void difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted, Eigen::VectorXd& out) const;
  /// Readings whose difference() to the predicted ones is `change`.
  void shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change, Eigen::VectorXd& out) const;
  /// Configuration of the nominal robot with these actuator values (size actuators()), searched
  /// from `start`; a robot without actuators stays there. False if the closed chain does not close.
  bool configuration_at(std::span<const double> actuators, std::span<const double> start, std::span<double> q) const;

  /// False if the instrument cannot see q; why, in words for the table of rejections.
  /// @param correction  ξ − nominal for every parameter, or empty for all zero
  bool measurable(std::span<const double> q, std::span<const double> correction = {}) const;
  /// Number of smooth functions of q that are ≥ 0 where it can be measured, in units of their ranges; a closed
  /// chain's singularities are left out. None: measurable() alone knows.
  std::optional<int> measurable_margins() const { return do_measurable_margins(); }
  bool measurable_margins_at(std::span<const double> q, std::span<double> out) const;
  /// Empty if every reachable configuration can be measured.
  const std::string& unmeasurable_reason() const { return unmeasurable_reason_; }

  /// Sets the visibility of targets: from now on the rows of hidden ones are zero in every linearisation, so that a
  /// block counts visible targets only. Without rows_per_target() it does nothing.
  void set_visibility(std::shared_ptr<const Visibility> visibility) { visibility_ = std::move(visibility); }
  /// False if targets may be hidden.
  bool sees_all_targets() const { return visibility_ == nullptr; }
  /// Rows that one target has; 0: the instrument sees the pose as a whole.
  int rows_per_target() const { return rows_per_target_; }

  /// Tips whose motion the readings tell of: two where they say how far a target travels between two configurations, 0
  /// where no tip is seen.
  int tips() const { return tips_; }
  /// As an index among `selected`: what the readings do along unit twist k of a tip that is not where its parameters
  /// say, translations along the axes of M (k = 0, 1, 2, per m), rotations about them through the tip's origin (3, 4,
  /// 5, per rad).
  int tip_column(int tip, int k) const { return int(parameters_.size()) + 6 * tip + k; }
  /// Coordinates of one tip: its own, one tip after the other, choices last.
  std::size_t tip_coordinates() const { return tip_coordinates_; }
  /// Where instruments see different tips: per value of the coordinate `instrument`, which of the coordinates of a tip
  /// move what it reads. Empty: all.
  const std::vector<std::vector<char>>& moving_coordinates() const { return moving_coordinates_; }

  /// q with its choices resolved, at the nominal parameters in force. It refers to q and to this.
  Point nominal_point(std::span<const double> q) const;
  /// Nominal parameters in force less those that the model was built with; empty: all zero.
  std::span<const double> nominal_shift() const { return shift_; }

  /// Twists of the tip per unit of each reading (joint or actuator), 6 × readings (see TipModel); false if q is
  /// unreachable or the model has no single tip.
  bool reading_twists(std::span<const double> q, Eigen::Matrix<double, 6, Eigen::Dynamic>& twists) const;

  /// Actuator coordinates at q (size actuators()); false if q is unreachable.
  bool actuator_values(std::span<const double> q, std::span<double> values) const;

  /// Nominal pose of the tip (or platform) in the measurement frame.
  Eigen::Isometry3d tool_pose(std::span<const double> q) const;

  /// Parameters that `auto` chooses among, in order of preference: index into parameters(), tier (smaller first).
  struct Preference {
    int parameter;
    int tier;
  };
  const std::vector<Preference>& geometric_parameters() const { return geometric_; }

 protected:
  std::vector<Parameter> parameters_;
  std::vector<Coordinate> coordinates_;
  std::vector<Coordinate> actuators_;
  std::vector<Preference> geometric_;
  std::vector<Reading> readings_;
  std::string unmeasurable_reason_;
  int rows_ = 0;
  int rows_per_target_ = 0;
  int tips_ = 0;
  std::size_t tip_coordinates_ = 0;
  std::vector<std::vector<char>> moving_coordinates_;

 private:
  virtual bool do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const = 0;
  /// `gradient` is all zero.
  virtual bool do_pull_back(const Point& at, std::span<const int> selected, const Eigen::MatrixXd& by_G,
                            const Eigen::MatrixXd& by_covariance, std::span<double> gradient) const;
  /// Readings of the robot standing at q.
  virtual bool do_read(const Point& at, Eigen::VectorXd& y) const = 0;
  virtual void do_difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                             Eigen::VectorXd& out) const;
  virtual void do_shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change, Eigen::VectorXd& out) const;
  virtual bool do_configuration_at(std::span<const double> actuators, const Point& start, std::span<double> q) const;
  virtual void do_take_loads_at(std::span<const double> correction);
  virtual int do_block_rows(std::span<const int> selected) const;
  virtual bool do_linearise_factored(const Point& at, std::span<const int> selected, Linearisation& out) const;
  virtual bool do_measurable(const Point& at) const;
  virtual std::optional<int> do_measurable_margins() const;
  virtual bool do_measurable_margins_at(const Point& at, std::span<double> out) const;
  virtual bool do_actuator_values(const Point& at, std::span<double> values) const;
  virtual Eigen::Isometry3d do_tool_pose(const Point& at) const = 0;
  virtual bool do_reading_twists(const Point& at, Eigen::Matrix<double, 6, Eigen::Dynamic>& twists) const;
  /// Readings that nobody takes at q become NaN.
  virtual void do_blank_unread(std::span<const double> q, Eigen::VectorXd& y) const;
  void hide(std::span<const double> q, Linearisation& out) const;
  bool settle(Point& at, std::vector<double>& scratch) const;

  /// q as the virtual functions take it, its choices resolved.
  Point point(std::span<const double> q, std::span<const double> total) const;
  std::span<const double> total(std::span<const double> correction, std::vector<double>& scratch) const;

  std::shared_ptr<const Visibility> visibility_;
  std::vector<double> shift_;  // nominal in force − nominal the model was built with; empty: all zero
};

}  // namespace posewright
