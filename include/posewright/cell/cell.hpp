#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "posewright/cell/collision.hpp"
#include "posewright/cell/line_of_sight.hpp"

namespace posewright {

/// The cell around the robot: bodies and lines of sight. Made once for a problem, shared by all
/// variants: bodies and sights follow the nominal model, whose errors are far below any clearance.
struct Cell {
  std::shared_ptr<const IdentificationModel> model;  ///< nominal one of the planned variant
  std::unique_ptr<const Collision> collision;        ///< null: nothing is checked
  /// Of the instrument, or of each in a list; null: it has no place.
  std::vector<std::unique_ptr<const LineOfSight>> sights;
  /// Those that look where each instrument of a list reads: its own, or of all that read together.
  std::vector<std::vector<const LineOfSight*>> looking;
  std::optional<std::size_t> instrument;  ///< coordinate that chooses among those of a list
  /// Deviation of an uncalibrated robot from its readings, per coordinate's name (rad or m): kept from
  /// its limits beside the margin.
  std::map<std::string, double> joint_margin;
  /// The same for two cells only if all that they are made of is, with the contents of files; empty: not known.
  std::string identity;

  /// Index of the instrument that reads at q.
  std::size_t instrument_at(std::span<const double> q) const { return instrument ? std::size_t(q[*instrument]) : 0; }
  const std::vector<const LineOfSight*>& sights_at(std::span<const double> q) const {
    return looking[instrument_at(q)];
  }
  /// Of the problem's one instrument; null for a list.
  const LineOfSight* sight() const { return instrument ? nullptr : sights.front().get(); }
  /// True if lines of sight constrain configurations, and of one instrument alone the blocks.
  bool sight_is_asked() const {
    return std::ranges::any_of(sights, [](const auto& sight) { return sight != nullptr && sight->judges(); });
  }
};

/// A station stands inside an obstacle or, at home, inside the robot.
class StationInside : public InputError {
 public:
  using InputError::InputError;
};

/// @param same_robot  see Collision; null: none
/// Throws InputError as Collision and LineOfSight, StationInside.
std::shared_ptr<const Cell> make_cell(const Problem& problem, const Cell* same_robot = nullptr);

/// Home of the robot: motion.home; where it says nothing, zero or the limit nearest to it; first of every choice.
/// @param coordinates  with the limits in force
/// Throws InputError for names that are not coordinates and values beyond the limits.
std::vector<double> home_configuration(const MotionSpec& motion, const ProblemFile& file,
                                       const std::vector<Coordinate>& coordinates);

}  // namespace posewright
