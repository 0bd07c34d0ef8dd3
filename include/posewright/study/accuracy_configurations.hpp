#pragma once

#include <cstdint>
#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/study/variant.hpp"

namespace posewright {

/// Configurations of test poses and their weights (empty: all 1).
struct TestConfigurations {
  std::vector<std::vector<double>> configurations;
  std::vector<double> weights;
};
/// The problem's test poses: as written, from a file, evenly through the workspace, or reached for points of a box or a
/// file.
/// @param seen  the variant's model with an instrument that reads the tip's pose
TestConfigurations test_configurations(const Variant& variant, const IdentificationModel& seen, std::uint64_t seed);

}  // namespace posewright
