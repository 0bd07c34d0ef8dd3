#include "posewright/criterion/observability_indices.hpp"

#include <cmath>

namespace posewright {

ObservabilityIndices observability_indices(const Eigen::VectorXd& sigma, int poses) {
  ObservabilityIndices indices;
  const double largest = sigma[0], smallest = sigma[sigma.size() - 1];
  if (!(smallest > 0)) return indices;
  indices.o1 = std::exp(sigma.array().log().mean()) / std::sqrt(double(poses));
  indices.o2 = smallest / largest;
  indices.o3 = smallest;
  indices.o4 = smallest * smallest / largest;
  indices.o5 = 1 / sigma.cwiseInverse().sum();
  return indices;
}

}  // namespace posewright
