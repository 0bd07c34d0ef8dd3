#pragma once

#include <nlohmann/json.hpp>

#include "posewright/problem/problem.hpp"

namespace posewright {

/// How every result begins: schema, version, problem.
nlohmann::ordered_json begin_document(const char* schema, const Problem& problem);
/// The same with the seed.
nlohmann::ordered_json begin_document(const char* schema, const Problem& problem, std::uint64_t seed);

}  // namespace posewright
