#pragma once

#include <cmath>

namespace posewright {

/// Image of a point in camera coordinates (z ahead) through a pinhole with radial (k1, k2, k3) and tangential (p1, p2)
/// distortion (Brown 1971, as in OpenCV): x = X/Z, y = Y/Z, s = x² + y²,
///   u = fx (x (1 + k1 s + k2 s² + k3 s³) + 2 p1 x y + p2 (s + 2 x²)) + cx, v likewise.
/// @param lens  fx, fy, cx, cy (px), k1, k2, p1, p2, k3
template <class T>
void project(const T* point, const T* lens, T* pixel) {
  const T x = point[0] / point[2], y = point[1] / point[2], s = x * x + y * y;
  const T radial = T(1.0) + s * (lens[4] + s * (lens[5] + s * lens[8]));
  pixel[0] = lens[0] * (x * radial + T(2.0) * lens[6] * x * y + lens[7] * (s + T(2.0) * x * x)) + lens[2];
  pixel[1] = lens[1] * (y * radial + lens[6] * (s + T(2.0) * y * y) + T(2.0) * lens[7] * x * y) + lens[3];
}

}  // namespace posewright
