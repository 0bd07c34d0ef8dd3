#include "posewright/search/design_measure.hpp"

#include <numeric>

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

std::vector<double> DesignMeasure::phi_without(const std::vector<SearchPart>& poses,
                                               const std::vector<SearchPart>& known) const {
  const Eigen::MatrixXd whole = information(side_by_side(poses));
  const BlockArray each = side_by_side(known);
  const BlockArray::RowMatrix J = whitened(each);
  std::vector<double> result;
  for (std::size_t i = 0; i < each.count(); ++i) {
    const auto rows = J.middleRows(Eigen::Index(i) * each.rows(), each.rows());
    result.push_back(criterion_->function().value(whole - rows.transpose() * rows) + offset_);
  }
  return result;
}

std::vector<double> DesignMeasure::shares(const std::vector<SearchPart>& poses, const std::vector<int>& group,
                                          int groups) const {
  const BlockArray each = side_by_side(poses);
  const BlockArray::RowMatrix J = whitened(each);
  const Eigen::MatrixXd S = criterion_->function().gradient(information(each));
  std::vector<double> result(std::size_t(groups) + 1, 0.0);
  for (std::size_t i = 0; i < each.count(); ++i) {
    const auto rows = J.middleRows(Eigen::Index(i) * each.rows(), each.rows());
    result[std::size_t(group[i])] += (rows * S).cwiseProduct(rows).sum();
  }
  if (prior_.size() > 0) result.back() = prior_.cwiseProduct(S).sum();
  const double all = std::accumulate(result.begin(), result.end(), 0.0);
  for (double& share : result) share /= all;
  return result;
}

BlockArray::RowMatrix DesignMeasure::whitened(const BlockArray& blocks) const {
  // R is as ill-conditioned as the raw columns: it is solved for, one row after the other, and never inverted.
  return R_.transpose().triangularView<Eigen::Lower>().solve(Eigen::MatrixXd(blocks.all().transpose())).transpose();
}

Eigen::MatrixXd DesignMeasure::information(const BlockArray& blocks) const {
  const BlockArray::RowMatrix J = whitened(blocks);
  Eigen::MatrixXd result = J.transpose() * J;
  if (prior_.size() > 0) result += prior_;
  return result;
}

double DesignMeasure::phi(const BlockArray& blocks) const {
  return criterion_->function().value(information(blocks)) + offset_;
}

}  // namespace posewright
