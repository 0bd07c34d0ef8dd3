#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace posewright {

/// Settings of a controller besides the joint values, from a YAML file (docs/export.md). Lists are in the order
/// of the plan's joints, empty if the file has none.
struct ControllerSettings {
  std::string file;                  ///< as messages call it
  std::filesystem::path path;        ///< that they were read from; empty: none
  std::map<std::string, int> lines;  ///< keys that are given, and where
  std::vector<double> sign;          ///< +1 or −1
  std::vector<double> zero_deg;
  std::vector<double> pulses_per_degree;
  /// Range of each axis in the controller's count: deg, mm of an axis that slides.
  std::vector<std::array<double, 2>> range_deg;
  std::optional<double> coupling;  ///< f in J3 = J3_urdf − f · J2_urdf
  std::vector<std::string> axes;   ///< names of the joints on the controller
  std::optional<int> decimals;
  std::optional<std::array<double, 3>> pivot_mm;  ///< platform origin as the hexapod counts it

  /// Indices of the axes that `coupling` is between, the third less f times the second.
  std::pair<std::size_t, std::size_t> coupled_axes() const;
};

/// Throws InputError with file and line for unknown keys and values that make no sense.
ControllerSettings parse_controller_settings(const std::string& text, const std::string& file);

}  // namespace posewright
