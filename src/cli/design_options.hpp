#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright::cli {

/// Options of a command that are keys of the design: "poses", "criterion", …
using DesignOptions = std::vector<std::string_view>;

void add_design_options(po::options_description& options, const DesignOptions& names);
/// given_problem() with the keys that these options state.
Problem designed_problem(const std::filesystem::path& file, const po::variables_map& values,
                         const DesignOptions& names);

/// Rows of the table of keys (path, option, schema, default, description) and of the options of each command, as JSON.
std::string design_keys_json();

}  // namespace posewright::cli
