#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "eigenvalue_program.hpp"
#include "posewright/criterion/spectral.hpp"
#include "posewright/planning/design_task.hpp"
#include "rank_limited.hpp"
#include "row_inertia.hpp"

namespace posewright {

/// Lower and upper number of each candidate.
struct ChoiceBox {
  std::vector<std::uint16_t> least, most;
};

/// Relaxation of a box: fractional numbers n_i, and an upper `bound` for all designs in the box.
struct RelaxedBox {
  double bound = 0.0;
  std::vector<double> numbers;  ///< n_i of every candidate, Σ n_i = N
  int branch = -1;              ///< candidate whose number is best made whole; −1: all are
};

/// The optimum of Φ(M0 + Σ n_i J_iᵀJ_i) over least ≤ n ≤ most, Σ n_i = N: sequential quadratic programming with exact
/// second derivatives, from the numbers of the box around it. Every iterate also bounds the optimum (its sensitivities
/// d_i, concavity of e^{Φ/h}), and most boxes end at the first such bound. For o3 E and its bound take their place
/// (EigenvalueProgram), within what single rows must be like (RowInertia). One per thread: it keeps its memory.
class NodeRelaxation {
 public:
  /// Criteria with a degree only.
  explicit NodeRelaxation(const DesignTask& task);

  /// Bounds the box; tightens it by what the sensitivities rule out in anything better than `best`. `relaxed.numbers`
  /// is where to begin. False if nothing in the box is better than `best`.
  bool solve(ChoiceBox& box, RelaxedBox& relaxed, double best);

 private:
  using RowMatrix = BlockArray::RowMatrix;

  void gather(const ChoiceBox& box);
  bool make_feasible(const ChoiceBox& box, std::vector<double>& numbers) const;
  void add_information(const std::vector<double>& numbers);
  std::unique_ptr<Expansion> expand_at(const Eigen::MatrixXd& information) const;
  void find_sensitivities(const std::vector<double>& numbers);
  /// From here on the tighter bound of few remaining rows, where there is one.
  void limit_rank();
  bool start_regular(const ChoiceBox& box, std::vector<double>& numbers);
  /// Σ of the largest d_i that the box allows.
  void grant();
  /// Φ's bound from it.
  double bound();
  /// The sum that anything better than `best` must reach.
  double needed(double best) const;
  bool step(std::vector<double>& numbers);
  bool search_along(std::vector<double>& numbers);
  void choose_working_set(const std::vector<double>& numbers);
  void solve_quadratic(const std::vector<double>& numbers);
  /// solve() for o3 (theory.md eq. (44), (60), (61)). Nothing if that way is not open: too many candidates, or numbers
  /// that leave a parameter unknown.
  std::optional<bool> solve_least_eigenvalue(ChoiceBox& box, RelaxedBox& relaxed, double best);
  /// True if inertia_ applies to these candidates: one row each, no nuisance columns.
  bool single_rows() const { return r_ == 1 && least_eigenvalue_->nuisance() == 0; }
  bool rule_out_rows(ChoiceBox& box) const;
  void limit_rows(const std::vector<double>& numbers);
  void grant_within_limits();
  void lower_bound_of_least(RelaxedBox& relaxed, double best);
  int branching_by_number(const ChoiceBox& box, const std::vector<double>& numbers) const;
  bool tighten(ChoiceBox& box, double best) const;
  int branching_candidate(const std::vector<double>& numbers);
  void copy_working_rows();

  const DesignTask& task_;
  const BlockArray& blocks_;
  const InformationFunction& function_;
  const SpectralFunction* least_eigenvalue_;  // null: another criterion
  int r_, m_;
  bool log_det_;                   // of all columns
  std::vector<int> free_;          // candidates whose number is open
  std::vector<int> least_, room_;  // of each free candidate
  int left_ = 0;                   // poses to choose among them
  RowMatrix rows_;                 // of the free candidates
  RowMatrix projected_;            // rows_ T
  Eigen::MatrixXd fixed_, information_;
  std::unique_ptr<Expansion> expansion_;
  Eigen::VectorXd d_;  // of the free candidates
  std::unique_ptr<RankLimitedLogDet> limited_;
  double fixed_share_ = 0.0;  // tr(S M) of what is fixed; nothing where the rank is limited
  double open_share_ = 0.0;   // Σ n_i d_i of what is not
  std::vector<int> order_, granted_;
  bool of_least_eigenvalue_ = false;  // d_ and what is below are tr(J E Jᵀ) and sums of them
  double weakest_ = 0.0, next_ = 0.0, most_possible_ = 0.0;
  std::vector<int> working_;  // positions in free_
  RowMatrix working_rows_;
  Eigen::MatrixXd curvature_;
  Eigen::VectorXd change_;  // of the working candidates' numbers
  // For o3: rows in units of the scale, what single rows must be like, and the problem of numbers.
  EigenvalueProgram program_;
  RowInertia inertia_;
  NumberLimits limits_;
  RowMatrix scaled_rows_;
  Eigen::MatrixXd scaled_known_;
  Eigen::VectorXd scaled_room_, group_room_, open_numbers_, priced_, tightest_;
  double tightest_share_ = 0.0;
};

}  // namespace posewright
