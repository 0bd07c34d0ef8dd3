#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "posewright/results/plan.hpp"

namespace posewright {

/// Key `other_numbers` of a plan: what other numbers of poses reach, with the identity of the poses that it is beside.
/// @param plan  the JSON of the plan, with problem, criterion and poses
nlohmann::ordered_json other_numbers_json(const nlohmann::ordered_json& plan, const std::vector<CurvePoint>& points);

/// The points of a plan that was read, ascending by number; none where it has none, or where its poses, problem or
/// criterion are not those that the points are beside: somebody has edited them.
/// @param file  for messages
/// Throws InputError with the file where the key is not as the schema says.
std::optional<std::vector<CurvePoint>> read_other_numbers(const nlohmann::json& plan, const std::string& file);

}  // namespace posewright
