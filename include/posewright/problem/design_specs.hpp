#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "posewright/problem/units.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/repeats.hpp"
#include "posewright/support/robust_aim.hpp"

namespace posewright {

/// Feasible configurations that a plan chooses from, and that a variant's columns are judged by, unless something else
/// is said.
inline constexpr int default_candidates = 10000;

/// Name in place of a criterion's: the number of poses decides.
inline constexpr const char* automatic_criterion = "auto";

/// Scale of the columns, for criteria and indices that depend on it.
enum class Scaling { tolerance, norm, none };

/// A value for the parameters that a glob matches, as in variants: tolerance.
struct PatternValue {
  Located<std::string> pattern;
  double value = 0.0;                    ///< SI
  Quantity quantity = Quantity::number;  ///< quantity of the written unit; number: none was written
};

/// Configurations where accuracy after compensation matters. One of `at`, `random`, `file`, `grid`.
struct TestPosesSpec {
  std::vector<std::vector<Measured>> at;  ///< values of the robot's coordinates, or
  int random = 0;                         ///< so many, evenly through the workspace
  std::filesystem::path file;             ///< CSV of coordinates or of points x, y, z, maybe with weights
  struct Grid {                           ///< points of a box in the measurement frame
    Eigen::Vector3d lower, upper;         ///< m
    std::array<int, 3> counts{1, 1, 1};
  };
  std::optional<Grid> grid;
  std::vector<double> weights;                      ///< one for each of `at`; empty: all 1
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, tip frame: whose position counts
  /// Load case of an elastic arm; default: the first with a load (random configurations: any).
  std::optional<Located<std::string>> load_case;
  int line = 0;
};

/// Requirements on a plan of `poses: auto` and on a calibration.
struct RequirementSpec {
  std::optional<double> accuracy;   ///< ρ0 at the test poses, m
  std::vector<PatternValue> sigma;  ///< 1σ of parameters
  /// Error of a pose along x, y, z (m) and about them (rad): 95 % of a plan's at every test pose, the largest that a
  /// calibration leaves at its verification poses.
  std::array<std::optional<double>, 6> axes{};
  int line = 0;

  bool of_axes() const {
    for (const std::optional<double>& axis : axes)
      if (axis) return true;
    return false;
  }
};

/// A plan for robots drawn from the tolerances, not for the nominal one alone.
struct RobustSpec {
  int draws = 200;
  RobustAim aim;
  int line = 0;
};
// Of one robot nothing can be said to be worst; of more, one number for each and each candidate would fill the memory.
inline constexpr int least_robust_draws = 2, most_robust_draws = 10'000;

struct DesignSpec {
  std::optional<Located<std::string>> variant;  ///< default: the first
  struct Weighted {
    Located<std::string> name;
    double weight = 1.0;
  };
  std::vector<Weighted> variants;             ///< for criteria over several variants
  std::optional<Located<std::string>> truth;  ///< the variant that may be the case while another one is fitted
  Located<std::string> criterion{automatic_criterion, 0};
  Located<std::string> method{"auto", 0};
  std::optional<Located<int>> poses;
  bool smallest = false;  ///< poses: auto
  RequirementSpec require;
  Located<int> candidates{default_candidates, 0};
  std::optional<Located<std::filesystem::path>> candidates_from;  ///< a user's list in place of drawn ones
  Located<int> restarts{10, 0};
  Repeats repeats;
  /// Two poses differ in at least one coordinate by this much: rad and m; 0: no distance is asked of that kind.
  struct MinimumDistance {
    double angle = 0.0, length = 0.0;
  };
  std::optional<MinimumDistance> minimum_distance;
  Scaling scaling = Scaling::tolerance;
  bool prior = false;    ///< count the tolerances as prior knowledge: M = GᵀG + diag(1/tolerance²)
  bool reserve = false;  ///< optimise for the loss of the worst single pose
  std::optional<RobustSpec> robust;
  std::optional<std::filesystem::path> measured;  ///< poses that are measured already: new ones come to them
  std::optional<std::filesystem::path> fixed;     ///< poses that any plan has among its own
  std::optional<TestPosesSpec> test_poses;
  int line = 0;
};

}  // namespace posewright
