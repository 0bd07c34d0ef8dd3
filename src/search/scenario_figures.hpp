#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "posewright/criterion/determinant.hpp"
#include "posewright/criterion/summed_information.hpp"
#include "posewright/planning/approximate_design.hpp"
#include "posewright/search/robust_search.hpp"
#include "posewright/support/bytes.hpp"

namespace posewright {

/// Indices by their value, ties by index.
std::vector<int> by_value(const std::vector<double>& values, bool largest_first);

/// Figures of plans and weights over all scenarios. Every scenario is loaded with all candidates, and released again
/// but for one number a candidate.
class ScenarioFigures {
 public:
  /// Whitens, and solves for the weights that are best at nominal parameters.
  ScenarioFigures(const RobustRequest& request, const Monitor& monitor);

  int columns() const { return columns_; }
  double interest() const { return interest_; }
  double cap() const { return options_.cap; }
  const LogDetFunction& function() const { return function_; }
  const BlockArray& nominal() const { return nominal_; }
  const ApproximateDesign& optimum() const { return optimum_; }
  CandidateWeights optimal_weights() const;
  std::size_t scenarios() const { return std::size_t(request_.scenarios); }

  /// Finds what no plan exceeds in each scenario, and what the plan given has there; looks from the weights that are
  /// best at nominal parameters.
  /// @return false if it was stopped before all were seen; nothing else may be asked then
  bool find_references(long& unreached);
  /// log det (whitened) that counts as efficiency 1; the same raw.
  const std::vector<double>& references() const { return references_; }
  std::vector<double> raw_references() const;
  /// ln e of the plan given.
  const std::vector<double>& given() const { return given_; }

  /// Looks at all scenarios once more: ln e of the weights, and d of every candidate there, become those that bound()
  /// and mean_sensitivity() rest on. Returns false if it was stopped; what was known before stays.
  bool evaluate_at(const CandidateWeights& weights);
  /// Σ_k λ_k d_ik of every candidate.
  std::vector<double> mean_sensitivity(const std::vector<double>& lambda) const;
  /// d of the candidate in scenario k.
  double sensitivity(std::size_t k, int candidate) const { return at_weights_.sensitivity[k][std::size_t(candidate)]; }
  /// Bound of the combined efficiency of any plan: the smallest so far.
  double bound() const { return bound_; }
  /// Possible gain of any weights over the last ones: ln of the ratio.
  double gap() const { return std::log(bound_) - combine(at_weights_.values); }

  /// The aim over so many of the scenarios, none more likely than another: those that stand for all where the mean
  /// counts, else the worst.
  Combination combination(std::size_t some) const {
    return {request_.aim, std::vector<double>(some, 1.0), double(scenarios())};
  }
  double combine(const std::vector<double>& values) const { return combination(scenarios()).of(values); }
  RobustFigures figures(const std::vector<double>& values) const;
  void whiten(BlockArray& blocks) const;
  /// Whitened, for all poses; empty: none.
  Eigen::MatrixXd prior_of(int scenario) const;
  /// Figures of one scenario at given weights.
  struct Seen {
    double log_det, of_prior;  ///< whitened, of as many poses as a plan has; d of what is there before
    std::vector<double> sensitivity;
  };
  /// @param blocks  whitened
  /// @param prior   for all poses, whitened; empty: none
  Seen evaluate(const BlockArray& blocks, const Eigen::MatrixXd& prior, const CandidateWeights& weights) const;
  /// log det of a plan; −∞ if parameters are not determined.
  double log_det_of(const BlockArray& blocks, const Eigen::MatrixXd& prior, const std::vector<int>& members) const;
  /// ln e of what has this log det (whitened) in scenario k.
  double efficiency(double log_det, std::size_t k) const { return (log_det - references_[k]) / interest_; }

 private:
  std::string reference_of(int scenario) const;
  struct AtWeights {
    std::vector<double> log_dets, of_prior;
    std::vector<std::vector<double>> sensitivity;
    std::vector<double> values{};  // ln e
  };
  static void write(const Seen& seen, ByteWriter& out);
  static void read(ByteReader& in, AtWeights& bounds);
  void accept(AtWeights bounds);
  double bound_by(const std::vector<double>& lambda) const;
  double bound_here() const;

  const RobustRequest& request_;
  const Monitor& monitor_;
  int columns_;
  double interest_;
  LogDetFunction function_;
  BlockArray nominal_;
  Eigen::MatrixXd R_;
  double offset_ = 0.0;
  ApproximateDesign optimum_;
  ApproximateDesignOptions options_;
  std::vector<double> references_, given_;
  // At the weights that were looked from last.
  AtWeights at_weights_;
  double bound_ = 1.0;
};

}  // namespace posewright
