#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "posewright/criterion/information_function.hpp"
#include "posewright/planning/approximate_design.hpp"
#include "posewright/planning/configuration_space.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

// With fewer candidates a plan is a quick look.
inline constexpr std::size_t few_candidates = 1000;

/// Limits of a proof over the workspace.
struct ProofLimits {
  /// It ends where the largest d is proved to be within this share of h, so that no plan over the workspace is better
  /// than the weights found by more, as D-efficiency. None: within a thousandth of the largest d that it finds.
  std::optional<double> gap;
  /// And after so long, whatever it has proved then; 0: no proof. None: after an amount of work that is the same on
  /// every machine, some seconds.
  std::optional<double> seconds;
};

struct WorkspaceBoundOptions {
  int starts = 32;          ///< local searches a round: from the largest d, ends of coordinates, drawn candidates
  int rounds = 30;          ///< at most: new configurations enter, the weights are solved again;
                            ///< with fewer than 1,000 candidates, a quick look, no more than 8
  double tolerance = 1e-3;  ///< stop where no search finds d above degree·(1 + tolerance)
  int evaluations = 400;    ///< of one local search
  Eigen::MatrixXd prior{};  ///< as ApproximateDesignOptions
  ProofLimits proof{};
  std::vector<std::vector<double>> known{};  ///< configurations that take part from the beginning
  /// Configurations near which d = ‖J(q) T‖² may exceed a limit, feasible or not: starts that candidates lack where
  /// actuators cut the workspace. Empty: there are none.
  using FurtherStarts =
      std::function<std::vector<std::vector<double>>(const Eigen::MatrixXd& T, double limit, const Monitor& monitor)>;
  FurtherStarts further_starts{};
  /// No bound, but configurations that weights would use: a search for plans between the candidates begins with them.
  bool starts_alone = false;
  std::uint64_t seed = 0;
  int threads = 0;
};

/// True if the largest d over the limits of the workspace is proved.
struct WorkspaceProof {
  /// The reason if it was stopped before it bounded every configuration.
  static constexpr const char* cut_short = "its time ended first";
  std::string why_not;                ///< empty: it is proved
  double max_ratio = 1.0;             ///< no d within the limits exceeds it times h
  double bound = 0.0;                 ///< Φ(w) + h ln(max_ratio)
  long boxes = 0;                     ///< that it took
  std::string ended{};                ///< why not more of them; empty: they were enough
  std::vector<std::string> limits{};  ///< conditions besides the joints' limits: "tool box"
  /// Configuration of the largest d found on the way; limits that the space knows allow it, other checks may not.
  std::vector<double> largest_at{};
  std::vector<double> refuted_by{};    ///< a feasible configuration whose d exceeds h by more than the tolerance
  std::string largest_forbidden_by{};  ///< reason that forbids it, as in the table of rejections; empty: it is feasible
};

/// Optimal weights over the whole workspace, as far as a search can tell.
struct WorkspaceBound {
  double bound = 0.0;      ///< Φ(w) + h ln(max d / h): an upper bound if max_sensitivity is the true maximum of d
  double value = 0.0;      ///< Φ(w)
  double degree = 0.0;     ///< h
  double max_ratio = 1.0;  ///< largest d found over h
  int searches = 0;        ///< local searches carried out
  int confirmed = 0;       ///< searches from drawn candidates that found nothing better in the end; 0: not settled
  std::vector<std::vector<double>> support;  ///< configurations with weight that were not candidates
  std::vector<double> weights;               ///< theirs; with those of the candidates they sum to one
  std::vector<int> candidates;               ///< with weight, ascending
  std::vector<double> candidate_weights;
  Eigen::MatrixXd factor;  ///< T of d(q) = ‖J(q) T‖² at the weights
  WorkspaceProof proof{"not asked for"};
  bool stopped = false;

  double bound_for(int poses) const;
};

/// Column generation: optimal weights on the candidates and the configurations found so far, then multi-start local
/// maximisation of d(q) = ‖J(q) T‖², winners enter, until none exceeds. Then as many searches from drawn candidates
/// must find nothing better, or the rounds go on. Repeats are allowed (in a continuum two poses may be as near as one
/// likes). Starts are deterministic; the number of threads does not matter.
/// @param blocks  candidates
/// @param design  optimal weights on them: those with weight or large d take part
WorkspaceBound workspace_bound(const BlockArray& blocks, const ApproximateDesign& design,
                               const InformationFunction& function, const ConfigurationSpace& space,
                               const WorkspaceBoundOptions& options, const Monitor& monitor);

}  // namespace posewright
