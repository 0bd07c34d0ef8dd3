#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/criterion/inverse_information.hpp"

namespace posewright {

/// c_kj = x_k V x_jᵀ of every member k with every candidate j, for blocks of one row, kept while V changes: a scan for
/// the swaps of a member costs a look at n numbers in place of n products of m. A swap adds two terms to every row;
/// they are kept aside and brought to a row when it is asked for, to all of them as one product of matrices when they
/// have become many.
class MemberProducts {
 public:
  explicit MemberProducts(const InverseInformation& inverse) : inverse_(inverse) {}

  /// True if rows are so long, and members so few, that this saves time and takes no more than twice the memory
  /// of the blocks.
  static bool pays(const BlockArray& blocks, std::size_t members);

  /// V is another one, or the members are: all rows are computed anew when one is asked for.
  void forget() { known_ = false; }
  /// n numbers for the member at a position.
  const double* row(const std::vector<int>& members, int position);
  /// After inverse.change() has brought `enter` in the place of the member at some position.
  void change(const std::vector<int>& members, const RankChange& made);

 private:
  void compute(const std::vector<int>& members);
  void bring_to_all();

  const InverseInformation& inverse_;
  bool known_ = false;
  BlockArray::RowMatrix rows_;  // N × n
  std::vector<int> whose_;      // candidate of each row
  Eigen::MatrixXd terms_;       // n × most_terms; each is sign · term termᵀ less in X V Xᵀ
  Eigen::VectorXd signs_;
  std::vector<Eigen::Index> done_;  // terms that a row has
  Eigen::Index count_ = 0;
};

}  // namespace posewright
