#pragma once

#include <string>
#include <utility>
#include <vector>

#include "posewright/blocks/read_blocks.hpp"
#include "posewright/planning/spread_design.hpp"
#include "posewright/planning/whiten.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/support/workers.hpp"

namespace posewright {

/// Candidates of which each process holds a share.
class SpreadCandidates : public SpreadBlocks {
 public:
  SpreadCandidates(BlockShare share, Workers& workers, int threads, const Monitor& monitor)
      : share_(std::move(share)), workers_(workers), threads_(threads), monitor_(monitor) {}

  std::size_t count() const override { return share_.total; }
  int rows() const override { return share_.blocks.rows(); }
  int columns() const override { return share_.blocks.columns(); }
  BlockArray fetch(const std::vector<int>& candidates) override;
  void pass(const Eigen::MatrixXd& T) override;
  std::vector<Ranked> largest(std::size_t most, double least, const std::vector<int>& except) override;
  bool stopped() override;

  /// Replaces all blocks by whitened ones.
  Whitening whitened();

  /// This process's candidates, then spare blocks; the first one, and how many.
  BlockArray& own() { return share_.blocks; }
  int first() const { return int(share_.first); }
  std::size_t own_count() const { return share_.count; }
  bool has(int candidate) const { return candidate >= first() && std::size_t(candidate) < share_.first + share_.count; }
  Workers& workers() { return workers_; }
  int threads() const { return threads_; }
  /// The process that holds a candidate.
  int owner(int candidate) const;

 private:
  Eigen::MatrixXd gram();
  void solve(const Eigen::MatrixXd& r);
  /// Rows of the k-th group of share_group candidates of this process.
  BlockArray::Map group(std::size_t k);
  std::size_t groups() const { return (share_.count + share_group - 1) / share_group; }

  BlockShare share_;
  Workers& workers_;
  int threads_;
  const Monitor& monitor_;
  std::vector<double> d_;
};

}  // namespace posewright
