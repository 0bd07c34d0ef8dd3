#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "posewright/controller/controller_settings.hpp"
#include "posewright/problem/calibrated_parameters.hpp"
#include "posewright/problem/cell_specs.hpp"
#include "posewright/problem/design_specs.hpp"
#include "posewright/problem/measurement_specs.hpp"
#include "posewright/problem/package_search.hpp"
#include "posewright/problem/robot_specs.hpp"
#include "posewright/problem/units.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/key_edit.hpp"

namespace posewright {

/// A smooth effect that a variant lacks (docs/theory.md).
struct UnmodelledSpec {
  std::optional<double> size;    ///< 1σ along each axis, m; none: as large as the problem makes it
  std::optional<double> length;  ///< over which it changes, rad of joints; none: as the calibration says, else 60 deg
  double rotation = 0.0;         ///< 1σ about each axis, rad
  int line = 0;
};

/// One robot model with the set of parameters that calibration will estimate.
struct VariantSpec {
  std::string name;
  /// Source of the names: the robot's joint frames or its Denavit–Hartenberg parameters, distal or proximal
  /// (modified).
  enum class Convention { frames, dh, mdh } convention = Convention::frames;
  bool automatic = false;                        ///< auto, dh, mdh: irreducible subset of the geometric ones
  std::vector<Located<std::string>> parameters;  ///< names or globs (* and ?), of interest
  std::vector<Located<std::string>> nuisance;    ///< names or globs
  std::vector<Located<std::string>> fixed;       ///< names or globs taken out again
  std::vector<PatternValue> tolerance;           ///< later entries win
  std::vector<PatternValue> nominal;             ///< values that this variant is linearised at, in place of the robot's
  std::optional<UnmodelledSpec> unmodelled;
  int line = 0;
};

/// Limits for one configuration coordinate that replace (and may only narrow) the robot's own.
struct CoordinateLimits {
  Located<std::string> name;
  double lower = 0.0, upper = 0.0;
  Quantity quantity = Quantity::number;  ///< kind of unit written (length, angle); number: none, so SI
};

/// Samplers of candidates: even, on the boundary of the feasible set, in view of the targets, and by
/// OMPL's samplers of valid states.
enum class SamplerKind { even, boundary, look_at, obstacle_based, gaussian, clearance };

struct WorkspaceSpec {
  /// Margin of proposed poses to both ends of limits: rad of revolute joints, m of prismatic ones. Not given: 1 % of
  /// a serial arm's own range, at most 2 deg or 5 mm.
  std::optional<double> joint_margin, joint_margin_length;
  std::vector<CoordinateLimits> limits;  ///< `joints: limits:` or `pose:` of a platform
  std::vector<CoupledLimits> coupled;
  std::optional<ControllerSettings> controller;  ///< whose ranges the poses keep too
  std::optional<ToolBoxSpec> tool;
  std::optional<SingularitySpec> singularity;
  std::optional<CollisionSpec> collision;
  std::optional<LineOfSightSpec> line_of_sight;
  std::optional<StationChoiceSpec> stations;  ///< to choose among, for the command `stations`
  MotionSpec motion;
  std::vector<std::pair<SamplerKind, double>> samplers;  ///< shares of the candidates; empty: chosen by the constraints
  int samplers_line = 0;
  /// Robots drawn from the tolerances that the instrument must be able to read at a pose, beside the nominal one.
  int readable_for = 0;
  double uncalibrated = 0.0;  ///< margins grow by this number of σ of the tolerances' effect; 0: they don't
};

/// Source of a problem: its file, places of values in it, folders of packages.
struct ProblemFile {
  std::filesystem::path file;
  std::string sha256;  ///< of the file's bytes, then of `changed` beside the design, lower-case hexadecimal
  KeyEdits changed;    ///< keys that have another value than in the file, with the names of their options
  /// Folders of package://NAME/… for URDF and meshes, besides those of find_package().
  Packages packages;

  /// Place of a value by its line; -1, -2, …: the option of the first, second, … changed key.
  SourcePlace at(int line) const {
    return line < 0 ? SourcePlace{changed[std::size_t(-line) - 1].said_by} : SourcePlace{file.string(), line};
  }
};

/// A whole problem file.
struct Problem : ProblemFile {
  // Out of line: copying a problem is much code, and many sources hold one.
  Problem();
  Problem(const Problem&);
  Problem(Problem&&) noexcept;
  Problem& operator=(const Problem&);
  Problem& operator=(Problem&&) noexcept;
  ~Problem();

  RobotSpec robot;
  int robot_line = 0;
  MeasurementSpec measurement;
  std::vector<VariantSpec> variants;  ///< at least one
  WorkspaceSpec workspace;
  DesignSpec design;
  /// Calibrated parameters; put here by apply_parameters (model/apply_parameters.hpp).
  std::optional<CalibratedParameters> parameters;
};

/// Seconds that an instrument takes.
struct InstrumentTimes {
  double setup = 0.0;    ///< until its first pose
  double reading = 0.0;  ///< of one target's readings at a pose
  int in_turn = 1;       ///< targets that it reads one after the other
};
InstrumentTimes times_of(const MeasurementSpec& instrument, const MotionSpec& motion);

/// Throws InputError at a list of instruments.
/// @param what  works with one alone: "a route"
void require_one_instrument(const Problem& problem, const std::string& what);

/// One variant of a problem: what a model is made of. Both must outlive it.
struct ProblemVariant {
  const Problem& problem;
  const VariantSpec& spec;
};

}  // namespace posewright
