#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

#include "posewright/problem/design_specs.hpp"
#include "posewright/study/run_options.hpp"

namespace posewright::python {

namespace py = pybind11;

constexpr int most_poses = 1'000'000, most_candidates = 10'000'000, most_restarts = 1'000'000, most_threads = 4096;

/// Throws InputError "NAME is VALUE; LOWER to UPPER is allowed".
int checked(const std::string& name, long long value, int lower, int upper);
/// None: not said; else 1 to `upper`.
std::optional<int> optional_number(const py::object& value, const std::string& name, int upper, int lower = 1);
/// None: not said; else a number from `lower` to `upper`.
std::optional<double> within(const py::object& value, const std::string& name, double lower, double upper);
/// None: empty; else one of the allowed words, or InputError.
std::string choice(const py::object& value, const std::string& name, const std::vector<std::string>& allowed);
/// None: not said; "allow", "forbid" or how often.
std::optional<Repeats> repeats_of(const py::object& value);
/// From 0 up. Throws InputError for other numbers.
std::uint64_t seed_of(const py::int_& value);
/// Seed and threads of a run.
RunOptions run_options(const py::int_& seed, long long threads);

}  // namespace posewright::python
