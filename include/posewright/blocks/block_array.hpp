#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <vector>

namespace posewright {

/// n blocks of r rows × m columns, row-major; each row is padded with zeros to a multiple of eight doubles and
/// starts on a 64-byte boundary. Shared read-only by all threads of a search.
class BlockArray {
 public:
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Map = Eigen::Map<RowMatrix, Eigen::Unaligned, Eigen::OuterStride<>>;
  using ConstMap = Eigen::Map<const RowMatrix, Eigen::Unaligned, Eigen::OuterStride<>>;

  BlockArray() = default;
  /// All zero. Throws std::bad_alloc if memory does not suffice.
  BlockArray(std::size_t count, int rows, int columns);

  std::size_t count() const { return count_; }
  int rows() const { return rows_; }
  int columns() const { return columns_; }
  /// Doubles from one row to the next, a multiple of 8.
  int stride() const { return stride_; }

  double* row(std::size_t block, int row) { return data_.get() + (block * rows_ + row) * stride_; }
  const double* row(std::size_t block, int row) const { return data_.get() + (block * rows_ + row) * stride_; }
  const double* data() const { return data_.get(); }
  double* data() { return data_.get(); }

  Map block(std::size_t i) { return {row(i, 0), rows_, columns_, Eigen::OuterStride<>(stride_)}; }
  ConstMap block(std::size_t i) const { return {row(i, 0), rows_, columns_, Eigen::OuterStride<>(stride_)}; }
  /// All rows as one (n·r) × m matrix.
  Map all() { return {data_.get(), Eigen::Index(count_ * rows_), columns_, Eigen::OuterStride<>(stride_)}; }
  ConstMap all() const { return {data_.get(), Eigen::Index(count_ * rows_), columns_, Eigen::OuterStride<>(stride_)}; }

  /// Copy of the named blocks, in that order.
  BlockArray subset(const std::vector<int>& blocks) const;

 private:
  struct Free {
    void operator()(double* p) const { std::free(p); }
  };
  std::unique_ptr<double[], Free> data_;
  std::size_t count_ = 0;
  int rows_ = 0, columns_ = 0, stride_ = 0;
};

}  // namespace posewright
