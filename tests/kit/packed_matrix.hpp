#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace posewright {

/// Symmetric matrix (m × m) of a report's data: rows of the lower triangle, one behind the other.
inline Eigen::MatrixXd unpacked(const nlohmann::json& packed, Eigen::Index m) {
  Eigen::MatrixXd M(m, m);
  std::size_t k = 0;
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) M(i, j) = M(j, i) = packed.at(k++).get<double>();
  EXPECT_EQ(k, packed.size());
  return M;
}

}  // namespace posewright
