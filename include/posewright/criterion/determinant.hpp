#pragma once

#include <memory>
#include <string>
#include <utility>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/information_function.hpp"

namespace posewright {

/// log det of the information of the interest parameters, i.e. of the Schur complement S = M_ii − M_in M_nn⁻¹ M_ni of
/// the leading nuisance block: log det S = log det M − log det M_nn. Its gradient is M⁻¹ less M_nn⁻¹ padded with zeros;
/// (det S)^{1/s} is concave (s interest parameters), so degree() is s.
class LogDetFunction : public InformationFunction {
 public:
  LogDetFunction(int nuisance, int columns) : nuisance_(nuisance), interest_(columns - nuisance) {}
  double value(const Eigen::MatrixXd& information) const override;
  Eigen::MatrixXd gradient(const Eigen::MatrixXd& information) const override;
  bool concave() const override { return true; }
  double degree() const override { return interest_; }
  std::unique_ptr<Expansion> expand(const Eigen::MatrixXd& information) const override;
  std::unique_ptr<BlockFunction> with_block(const Eigen::MatrixXd& information) const override;

 private:
  int nuisance_, interest_;
};

/// `o1`, D-optimality: Φ = LogDetFunction. Borm & Menq (1991), Int. J. Robotics Research 10(1); Fedorov (1972), ch. 3,
/// for the exchange.
class DeterminantCriterion : public Criterion {
 public:
  /// @param name  name for users: o1, or ds where the elimination is meant to show
  DeterminantCriterion(std::string name, int nuisance, int columns)
      : name_(std::move(name)), function_(nuisance, columns) {}
  std::string name() const override { return name_; }
  const InformationFunction& function() const override { return function_; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override;

 private:
  std::string name_;
  LogDetFunction function_;
};

}  // namespace posewright
