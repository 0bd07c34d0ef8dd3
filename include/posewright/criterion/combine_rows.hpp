#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace posewright {

/// Multiplies one axis of a tensor by M: `in` holds outer × M.cols() × stride numbers, `out` outer × M.rows() × stride.
/// Sums run in a fixed order, so that every processor gives the same bits.
void combine_rows(const double* in, double* out, std::size_t outer, std::size_t stride, const Eigen::MatrixXd& M);

}  // namespace posewright
