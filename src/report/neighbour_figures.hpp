#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "posewright/report/report.hpp"

namespace posewright {

/// Errors of a list's figures with one moved pose if its block is interpolated.
struct NeighbourErrors {
  double efficiency = 0.0;  ///< |Δ log det| / parameters of interest
  double sigma = 0.0;       ///< largest |Δσ| / σ
  double accuracy = 0.0;    ///< |Δρ0| / ρ0 at the test poses

  /// True if figures to a hundredth of a percent (of σ and ρ0: a thousandth) are valid.
  bool small() const;
  void include(const NeighbourErrors& other);
};

/// A block as a quadratic polynomial of whole steps k, from rounded terms as ReportNeighbours::Pose has them.
class BlockSurface {
 public:
  using BlockAt = std::function<std::optional<Eigen::MatrixXd>(const std::vector<int>&)>;
  /// The polynomial that is exact at 0, at `node` steps of one coordinate to either side and, in its mixed differences,
  /// of two; rows that a factorisation turned over are turned back first. None where a block is missing.
  static std::optional<BlockSurface> through(std::size_t coordinates, int node, const BlockAt& block_at);

  Eigen::MatrixXd at(const std::vector<int>& k) const;
  Eigen::MatrixXd middle() const { return term(0); }
  int rows() const { return int(rows_); }
  const std::vector<std::int16_t>& terms() const { return terms_; }
  const std::array<std::vector<double>, 3>& scale() const { return scale_; }

 private:
  BlockSurface(const std::vector<Eigen::MatrixXd>& terms, std::size_t coordinates);
  std::size_t order(std::size_t term) const { return term == 0 ? 0 : term <= coordinates_ ? 1 : 2; }
  Eigen::MatrixXd term(std::size_t index) const;

  Eigen::Index rows_ = 0, columns_ = 0;
  std::size_t coordinates_ = 0;
  std::vector<std::int16_t> terms_;
  std::array<std::vector<double>, 3> scale_;
};

/// Figures of the whole list as the page computes them, information in units of tolerance.
class NeighbourFigures {
 public:
  explicit NeighbourFigures(const ReportInformation& information);

  bool regular() const { return regular_; }
  const Eigen::VectorXd& tolerance() const { return tolerance_; }
  /// @param id      of a pose of the information
  /// @param found   its interpolated block, `middle` that at no step; the page adds the difference of their squares
  /// @param there   the model's block
  NeighbourErrors compare(int id, const Eigen::MatrixXd& found, const Eigen::MatrixXd& middle,
                          const Eigen::MatrixXd& there) const;

 private:
  struct Figures {
    double log_det = 0.0, variance = 0.0;
    Eigen::VectorXd sigma;
  };
  std::optional<Figures> of(const Eigen::MatrixXd& M) const;

  const ReportInformation& information_;
  Eigen::Index nuisance_ = 0;
  Eigen::VectorXd tolerance_;
  Eigen::MatrixXd M_, test_;
  bool regular_ = false;
};

}  // namespace posewright
