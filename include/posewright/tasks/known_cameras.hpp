#pragma once

#include <string>
#include <vector>

namespace posewright {

/// A camera as its maker describes it: where a plan begins. Its own calibration has better numbers.
struct KnownCamera {
  std::string name;
  int width = 0, height = 0;  ///< px, of the image that the row is about
  double focal = 0.0;         ///< px, both axes
  std::string source;         ///< who says so, and how the focal length follows

  /// Whole angles of view of a pinhole camera, rad: 2 atan(size / (2 focal)).
  double horizontal_view() const;
  double vertical_view() const;
};

/// One row a camera.
const std::vector<KnownCamera>& known_cameras();

/// A row by its name, or a camera that is written as WIDTHxHEIGHT@FOCAL in pixels. Throws InputError that lists the
/// names.
KnownCamera find_camera(const std::string& text);

}  // namespace posewright
