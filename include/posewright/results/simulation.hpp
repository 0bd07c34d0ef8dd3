#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/tasks/simulate_problem.hpp"

namespace posewright {

/// What a person reads: every parameter predicted and observed, accuracy, χ², the verdict.
std::string simulation_text(const Simulation& simulation, const SimulateOptions& options);

/// The same for machines, nothing left out: schema posewright/simulation/1.
nlohmann::ordered_json simulation_json(const Problem& problem, const SimulateOptions& options,
                                       const Simulation& simulation);

}  // namespace posewright
