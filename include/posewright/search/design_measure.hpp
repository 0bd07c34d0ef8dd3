#pragma once

#include <memory>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/criterion/criterion.hpp"
#include "posewright/search/search.hpp"

namespace posewright {

/// Measure of a search, for other lists of poses: Φ by the criterion's own function, in the coordinates
/// in which the search's bound was computed, so that the two can be held against each other.
class DesignMeasure {
 public:
  /// @param R        J_raw = J R of all parts side by side
  /// @param prior    information that is there before, in the coordinates of J; empty: none
  /// @param offset   offset of Φ in these coordinates
  DesignMeasure(std::shared_ptr<const Criterion> criterion, Eigen::MatrixXd R, Eigen::MatrixXd prior, double offset)
      : criterion_(std::move(criterion)), R_(std::move(R)), prior_(std::move(prior)), offset_(offset) {}

  /// Φ of the poses with these raw blocks; −∞ where they do not identify all parameters.
  double phi(const BlockArray& blocks) const;
  /// Overload for blocks of several parts.
  double phi(const std::vector<SearchPart>& parts) const;
  /// Φ of the poses without each of some: of the known ones, whose information the prior holds, or of the poses
  /// themselves.
  std::vector<double> phi_without(const std::vector<SearchPart>& poses, const std::vector<SearchPart>& known) const;
  /// Shares of groups of poses in the information: tr(M_g S)/tr(M S), S = ∂Φ/∂M at M of all; the last is the prior's.
  /// They add to one.
  /// @param group  of each pose: 0, 1, … below `groups`
  std::vector<double> shares(const std::vector<SearchPart>& poses, const std::vector<int>& group, int groups) const;

 private:
  BlockArray::RowMatrix whitened(const BlockArray& blocks) const;
  Eigen::MatrixXd information(const BlockArray& blocks) const;

  std::shared_ptr<const Criterion> criterion_;
  Eigen::MatrixXd R_, prior_;
  double offset_;
};

/// The parts' blocks as one array: columns side by side, rows below each other.
BlockArray side_by_side(const std::vector<SearchPart>& parts);

}  // namespace posewright
