#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "posewright/criterion/criterion_data.hpp"
#include "posewright/planning/approximate_design.hpp"
#include "posewright/planning/design_task.hpp"
#include "posewright/planning/workspace_bound.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/support/repeats.hpp"

namespace posewright {

/// Candidates as one variant sees them.
struct SearchPart {
  BlockArray blocks;  ///< raw
  int nuisance = 0;
  double weight = 1.0;      ///< for criteria over several variants
  Eigen::VectorXd scale{};  ///< unit of every column for criteria that depend on it
  std::vector<TestPoint> test_points{};
  Eigen::MatrixXd prior{};  ///< information that is there before, raw (m × m); empty: none
  EffectGroup effects{};    ///< of the trailing columns, for criteria that need a truth
};

/// The part of planning that is the same for a robot's blocks and for a user's.
struct SearchRequest {
  std::string criterion, method;
  int poses = 0;
  Repeats repeats;
  bool reserve = false;
  PlannerOptions planner;
  bool certify = true;  ///< false: no bound is sought, which takes longer than the search for a few poses
  /// False: nobody asks for a certificate. Bounds are computed as far as they serve the search; the result has the
  /// design alone.
  bool certificate = true;
  /// Relative tolerance of the bound. Every value gives a valid bound, small ones a tight one.
  double bound_tolerance = ApproximateDesignOptions{}.tolerance;
  bool prove = false;  ///< the certificate over the workspace, after the search and where it can be proved
  ProofLimits proof{};
  std::vector<double> references{};  ///< bounds of the parts' log det that count instead of this search's own, raw
  const Spacing* spacing = nullptr;  ///< with the candidates' points; null: no minimum distance
  /// Configurations behind the blocks, for the whitening R of all columns; empty: there are only blocks.
  std::function<std::unique_ptr<ConfigurationSpace>(const Eigen::MatrixXd& R)> make_space{};
};

class DesignMeasure;

struct SearchResult {
  Design design;
  std::shared_ptr<const DesignMeasure> measure;  ///< Φ of any list, as the search counts it
  std::vector<BlockArray> chosen;  ///< raw blocks of the design's members that are candidates, for each part
  Certificate certificate;         ///< efficiencies still to be filled from an evaluation, see certify()
  double degree = 0.0;             ///< of Φ; 0: no bound
  /// Bound of the log det of every part, raw units; only if there are several.
  std::vector<double> references{};
  std::vector<double> without{};  ///< per member: e^{(Φ(S∖i) − Φ(S))/h}, 0 where it is indispensable
  std::vector<PlanStage> stages{};
  /// Configurations between the candidates that optimal weights over the workspace use: the certificate counts them.
  std::vector<std::vector<double>> support{};
  bool stopped = false;
};

/// Throws InputError if no criterion or planner has that name. `place` is where the name was written; `other` is a word
/// that may be in place of a criterion's name, for the message.
void require_known(const std::string& criterion, const std::string& method, const SourcePlace& criterion_place,
                   const SourcePlace& method_place, std::string_view other = {});

/// Whitens, solves for the bounds, searches. One part, unless the criterion is over several variants. Memory: the
/// blocks and a few vectors of their number.
SearchResult search(std::vector<SearchPart> parts, const SearchRequest& request, const Monitor& monitor);

/// The bound alone, over all plans of as many of the candidates.
struct Bound {
  Certificate certificate;
  std::shared_ptr<const DesignMeasure> measure;  ///< Φ of any list, to be held against the bound
  double degree = 0.0;
  std::vector<double> references{};
  std::vector<double> sensitivity{};  ///< of every candidate at the best weights
  double price = 0.0;                 ///< candidates with a sensitivity well below it are in no good plan
};
Bound bound_only(std::vector<SearchPart> parts, const SearchRequest& request, const Monitor& monitor);

/// Bounds over the same candidates by one criterion after the other. Candidates are whitened once, a solution begins
/// where the one before had its weights, and what two criteria share is solved once. Each bound is that of bound_only,
/// up to the tolerance of its solution.
class CandidateBounds {
 public:
  /// @param parts    that do for all criteria that are asked for
  /// @param request  its criterion does not count; its spacing outlives this
  CandidateBounds(std::vector<SearchPart> parts, const SearchRequest& request);
  ~CandidateBounds();
  CandidateBounds(CandidateBounds&&) noexcept;
  Bound of(const std::string& criterion, const Monitor& monitor);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The measure of a list by itself, without candidates: the list's own blocks give the coordinates.
std::shared_ptr<const DesignMeasure> measure_of(std::vector<SearchPart> parts, const SearchRequest& request,
                                                const Monitor& monitor);

/// Efficiencies of a plan whose Φ is `phi`; the last step so that they rest on the evaluation's number.
void certify(Certificate& certificate, double phi, double degree);

}  // namespace posewright
