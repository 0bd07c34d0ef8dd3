#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "posewright/pipeline/simulate_problem.hpp"

namespace posewright::cli {

/// What a person reads: every parameter predicted and observed, accuracy, χ², the verdict.
std::string simulation_text(const Simulation& simulation, const SimulateOptions& options);

/// The same for machines: what posewright/simulation/1 has besides program and problem.
nlohmann::ordered_json simulation_json(const Simulation& simulation, const SimulateOptions& options);

}  // namespace posewright::cli
