#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "posewright/study/run_options.hpp"

namespace posewright::python {

/// The problem with the keys of the design that keywords state; poses that are given as such (a Plan, the name of a
/// file, an array) come into `run`. None and an empty text: as in the problem.
/// @param taken  names that the function has for itself
/// Throws TypeError for a keyword that is no key, InputError for a value that is wrong.
std::shared_ptr<GivenProblem> designed(const GivenProblem& given, const py::kwargs& keywords,
                                       const std::vector<std::string>& taken, RunOptions& run);

/// First line of a function's documentation: its arguments with the keys of the design among those that need their
/// name, as pybind11 writes a signature.
/// @param before, after  arguments in front of the keys and behind them
std::string signature(const std::string& name, const std::string& before, const std::vector<std::string>& taken,
                      const std::string& after, const std::string& result);

}  // namespace posewright::python
