#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "posewright/cell/cell.hpp"
#include "posewright/cell/necessary_limits.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/monitor.hpp"

namespace ompl::base {
class SpaceInformation;
}

namespace posewright {

class Closure;
class ViewSampler;

/// The one definition of a feasible configuration: an OMPL state space whose bounds are the robot's limits, narrowed
/// by the problem file and the margin, and an OMPL validity checker that runs a list of checks and knows which one
/// failed.
class Workspace {
 public:
  /// @param model  must outlive the workspace
  /// Throws InputError for limits that name no coordinate, have the wrong unit, lie outside the robot's own, or are
  /// empty once the margin is taken off.
  /// @param cell     bodies and sights; null: neither constrains
  /// @param monitor  of the roadmap from home; where it says stop, CannotDo is thrown
  /// @param robots   ξ − nominal of robots that the instrument must be able to read wherever it reads the nominal one
  Workspace(const IdentificationModel& model, const Problem& problem, std::shared_ptr<const Cell> cell = nullptr,
            const Monitor& monitor = Monitor(), const std::vector<std::vector<double>>& robots = {});
  ~Workspace();

  /// Limits in force, in the order of a configuration: those of the robot, narrowed by the problem.
  const std::vector<Coordinate>& coordinates() const;
  /// Coordinates less the margin, for proposed configurations. Given ones may lie outside.
  const std::vector<Coordinate>& proposed() const;
  /// Names of the coordinates of q that are nearer to a limit than the margin: "j2, j4"; empty: none.
  std::string within_margin(std::span<const double> q) const;
  /// Reasons of all checks; violation() returns an index into them.
  const std::vector<std::string>& reasons() const;
  /// Index of the first reason that forbids q, or −1.
  int violation(std::span<const double> q) const;
  /// True if all checks but those of motions allow q, as wherever violation() is −1.
  bool is_free_at(std::span<const double> q) const;
  /// Margins of all checks together, none if one has none (ValidityCheck::margins()).
  std::optional<int> margins() const;
  bool margins_at(std::span<const double> q, std::span<double> out) const;
  /// Necessary limits of all checks together (ValidityCheck::necessary_limits()).
  const NecessaryLimits& necessary_limits() const;
  void necessary_values(std::span<const double> q, std::span<double> values) const;
  /// Null if there is none.
  const Cell* cell() const;
  /// True if collisions or sights constrain configurations: checks then cost much more.
  bool cut_by_cell() const;
  /// Shares of the candidates that each sampler draws: the problem's, or half evenly and half on the boundary, with a
  /// part near obstacles where collisions or sights cut the space.
  const std::vector<std::pair<SamplerKind, double>>& sampler_shares() const;
  /// True if the problem names the samplers.
  bool samplers_are_given() const;
  /// Proposes configurations from which the instrument sees; null for an instrument that sees from everywhere.
  const ViewSampler* views() const;
  /// Moves q to where joined tips meet; null if no tips are joined, and any configuration within the limits is one.
  const Closure* closure() const;
  /// Name of all that makes it what it is: robot, variant, cell, contents of their files. Empty, as at first: not
  /// known.
  const std::string& identity() const;
  void identify(std::string identity);
  /// State space and validity checker for OMPL's own algorithms; isValid() of a state is violation() < 0.
  const std::shared_ptr<ompl::base::SpaceInformation>& space_information() const;
  /// True if q lies on the boundary of the feasible set: a coordinate within 1e-6 of its range from where it may be
  /// proposed at most, or an actuator within `actuator_share` of its stroke from an end.
  bool on_boundary(std::span<const double> q, double actuator_share = 0.01) const;
  /// Share of the coordinates that sit there.
  double share_of_coordinates_on_limits(std::span<const double> q) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The robot's coordinates with the problem file's limits applied, the margin not. Throws InputError, see Workspace.
/// @param cell  where a robot that is not calibrated yet keeps more room; null: it does not
std::vector<Coordinate> limits_in_force(const IdentificationModel& model, const Problem& problem,
                                        const Cell* cell = nullptr);
/// The problem's coupled limits, and those that its controller's settings make of a coupling: lower ≤ J3 − f·J2 ≤
/// upper.
std::vector<CoupledLimits> coupled_limits(const IdentificationModel& model, const WorkspaceSpec& spec);

}  // namespace posewright
