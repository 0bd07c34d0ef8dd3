#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "posewright/cell/necessary_limits.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/model/instrument_view.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

class Collision;
class Random;

/// One target as one station sees it.
struct Sight {
  std::string target;
  Eigen::Vector3d p_StationTarget = Eigen::Vector3d::Zero();  ///< m, station frame
  double distance = 0.0;                                      ///< m
  double azimuth = 0.0, elevation = 0.0;  ///< rad, about z of the station from its x, above its x-y plane
  std::optional<double> incidence;        ///< rad, between the target's normal and the line to the station
  int hidden_by = -1;                     ///< index into LineOfSight::reasons(); −1: visible
};

/// Line of sight from a station to each target, by range, angles, acceptance cone and bodies in between.
/// Const and callable from several threads.
class LineOfSight : public Visibility {
 public:
  /// @param instrument  alone, or one of a list
  /// @param asked       its line_of_sight; none: nothing is judged
  /// @param model       nominal one of the problem; must outlive this
  /// @param collision   bodies that may hide a target; null: nothing does. Must outlive this.
  /// Null for an instrument without stations and targets. Throws InputError if line_of_sight asks for parts that the
  /// instrument lacks.
  static std::unique_ptr<LineOfSight> make(const ProblemFile& file, const MeasurementSpec& instrument,
                                           const std::optional<LineOfSightSpec>& asked,
                                           const IdentificationModel& model, const Collision* collision);

  int targets() const override { return int(targets_.size()); }
  /// Targets seen from the station of q (from every station where a pose is measured from all of them).
  void visible(std::span<const double> q, std::span<char> seen) const override;

  const std::vector<std::string>& stations() const { return station_names_; }
  /// "occluded from station A", "out of range of station A", …, station by station.
  const std::vector<std::string>& reasons() const { return reasons_; }
  /// −1 where as many targets are visible as must be; else the reason that hides the first hidden one.
  int violation(std::span<const double> q, bool past_bodies = true) const;
  /// Functions that are never negative where violation() is −1: ranges, angles and cones of single targets if all must
  /// be visible, else of the targets' mean with room for their distances from it (theory.md eq. (59)).
  NecessaryLimits necessary_limits() const;
  void necessary_values(std::span<const double> q, std::span<double> values) const;
  /// Every target from one station, also where q belongs to another.
  std::vector<Sight> sights(std::span<const double> q, int station) const;
  /// True if the problem limits the line of sight; else every target is visible.
  bool judges() const { return judges_; }
  /// Line of the problem file that limits it.
  int line() const { return spec_.line; }
  /// First and last of the stations that look at q: all of them (photogrammetry) or the one that is chosen.
  std::pair<int, int> stations_of(std::span<const double> q) const;
  /// True if the stations move with the tip (a camera in the hand).
  bool rides_on_tip() const { return station_on_tip_; }
  /// Index of the station that q is measured from.
  int station_of(std::span<const double> q) const;
  /// Reference targets (measurement frame) from one station.
  std::vector<Sight> reference_sights(std::span<const double> q, int station) const;

  Eigen::Isometry3d X_MeasureStation(std::span<const double> q, int station) const;
  /// Its pose in the frame that bodies stand in; only with `collision`.
  Eigen::Isometry3d X_BodiesStation(std::span<const double> q, int station) const;

  /// True if propose_tip() is better than random draws: an instrument with an axis, or targets with a front.
  bool can_propose() const;
  /// A pose of the tip in the measurement frame from which the instrument sees its targets as far as distance, field of
  /// view and incidence go, drawn evenly over them; what they leave open stays as it is at q. For a camera in the hand:
  /// places on a dome before the board. Bodies and the robot's reach are not looked at.
  Eigen::Isometry3d propose_tip(std::span<const double> q, Random& random) const;

 private:
  struct Bundle;
  struct Looked;
  /// A place whose sight is necessary.
  struct Place {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  // frame of the targets
    std::optional<Eigen::Vector3d> normal{};
    double room = 0.0;  // m, to a target that must be seen
  };
  struct Target {
    std::string name;
    Eigen::Vector3d position;
    std::optional<Eigen::Vector3d> normal;
  };

  LineOfSight(const ProblemFile& file, const MeasurementSpec& instrument, const std::optional<LineOfSightSpec>& asked,
              const IdentificationModel& model, const Collision* collision);
  void add_station(const InstrumentView::Place& place);
  void add_points(const InstrumentView& view);
  void add_normals(const ProblemFile& file);
  bool seen_from(std::span<const double> q, Looked& looked, int station, std::span<char> seen, int* reason,
                 bool past_bodies) const;
  /// Cache of this thread for q: a block and the checks use the same q one after the other.
  Looked& looked_at(std::span<const double> q) const;
  Sight sight(std::span<const double> q, const Eigen::Isometry3d& X_MeasureTip, int station, const Target& target,
              bool on_tip, bool past_bodies) const;
  int hidden_by(const Sight& sight) const;
  Eigen::Isometry3d X_BodiesMeasure(std::span<const double> q) const;
  void take_necessary_places();
  void add_limits_of(const Place& place, NecessaryLimits& limits) const;
  Bundle bundle() const;
  double distance_to(const Bundle& bundle, Random& random) const;
  Eigen::Isometry3d station_before_targets(const Eigen::Isometry3d& X_Station, Random& random) const;
  Eigen::Isometry3d targets_before_station(const Eigen::Isometry3d& X_Station, const Eigen::Isometry3d& X_Tip,
                                           Random& random) const;

  LineOfSightSpec spec_;
  std::optional<double> half_angle_;  // rad, of what is in the picture
  const IdentificationModel& model_;
  const Collision* collision_;
  std::vector<std::string> station_names_, reasons_;
  std::vector<Eigen::Isometry3d> X_CarrierStation_;
  std::vector<Target> targets_, references_;
  std::vector<Place> places_;
  std::vector<Eigen::Vector3d> azimuth_sides_;  // station frame
  Eigen::Isometry3d X_CarrierTarget_ = Eigen::Isometry3d::Identity();
  bool judges_ = false;
  bool station_on_tip_ = false, targets_on_tip_ = true, all_stations_ = false;
  int station_coordinate_ = -1;
  std::optional<std::string> in_{};  // tip that carries the measurement frame, of a robot with several
  std::uint64_t number_ = 0;         // among all that the program made
};

/// Lines of sight of the problem's instrument, or of each in its list; null where LineOfSight::make() gives none, and
/// with several tips. Throws InputError as make(), and where a list stands beside workspace.line_of_sight, or its own
/// beside several tips.
std::vector<std::unique_ptr<const LineOfSight>> lines_of_sight(const Problem& problem, const IdentificationModel& model,
                                                               const Collision* collision);

}  // namespace posewright
