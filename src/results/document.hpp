#pragma once

#include <nlohmann/json.hpp>

#include "posewright/problem/problem.hpp"

namespace posewright {

/// Begin of every result: schema, version, problem.
nlohmann::ordered_json begin_document(const char* schema, const Problem& problem);
/// Overload with the seed.
nlohmann::ordered_json begin_document(const char* schema, const Problem& problem, std::uint64_t seed);

}  // namespace posewright
