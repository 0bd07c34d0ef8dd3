#include "posewright/search/design_measure.hpp"

#include "posewright/criterion/information_function.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {

BlockArray side_by_side(const std::vector<SearchPart>& parts) {
  int rows = 0, columns = 0;
  for (const SearchPart& part : parts) {
    rows += part.blocks.rows();
    columns += part.blocks.columns();
  }
  BlockArray joined(parts.front().blocks.count(), rows, columns);
  for (std::size_t i = 0; i < joined.count(); ++i) {
    Eigen::Index row = 0, column = 0;
    for (const SearchPart& part : parts) {
      joined.block(i).block(row, column, part.blocks.rows(), part.blocks.columns()) = part.blocks.block(i);
      row += part.blocks.rows();
      column += part.blocks.columns();
    }
  }
  return joined;
}

double DesignMeasure::phi(const std::vector<SearchPart>& parts) const {
  return parts.size() == 1 ? phi(parts.front().blocks) : phi(side_by_side(parts));
}

double DesignMeasure::phi(const BlockArray& blocks) const {
  // R is as ill-conditioned as the raw columns: it is solved for, one row after the other, and never inverted.
  const Eigen::MatrixXd J =
      R_.transpose().triangularView<Eigen::Lower>().solve(Eigen::MatrixXd(blocks.all().transpose()));
  Eigen::MatrixXd information = J * J.transpose();
  if (prior_.size() > 0) information += prior_;
  return criterion_->function().value(information) + offset_;
}

}  // namespace posewright
