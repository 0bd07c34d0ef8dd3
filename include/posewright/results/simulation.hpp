#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/tasks/simulate_problem.hpp"

namespace posewright {

/// Text for the terminal: every parameter predicted and observed, accuracy, χ², the verdict.
std::string simulation_text(const Simulation& simulation, const SimulateOptions& options);

/// Complete JSON: schema posewright/simulation/1.
nlohmann::ordered_json simulation_json(const Problem& problem, const SimulateOptions& options,
                                       const Simulation& simulation);

}  // namespace posewright
