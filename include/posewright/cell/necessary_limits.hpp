#pragma once

#include <string>
#include <vector>

namespace posewright {

/// Functions that are never negative at feasible configurations: with them whole boxes of
/// configurations are known to be forbidden (theory.md eq. (58)).
struct NecessaryLimits {
  /// constant + factor v + root √s, v and s two of the values; s = −1: without the root. Values are of degree 1 in the
  /// motion of every joint, as coordinates of a point on a body and squares of its distances from a place are.
  struct OfPoints {
    int value = 0;
    double factor = 1.0, constant = 0.0;
    int square = -1;
    double root = 0.0;
  };
  /// constant + Σ factors_i q_i.
  struct OfCoordinates {
    std::vector<double> factors;
    double constant = 0.0;
  };

  std::vector<std::string> names{};  ///< name of the limit, for messages: "tool box"
  int values = 0;                    ///< how many there are
  std::vector<OfPoints> of_points{};
  std::vector<OfCoordinates> of_coordinates{};
};

}  // namespace posewright
