#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

namespace posewright::python {

namespace py = pybind11;

constexpr int most_candidates = 10'000'000, most_threads = 4096;

/// Throws InputError "NAME is VALUE; LOWER to UPPER is allowed".
int checked(const std::string& name, long long value, int lower, int upper);
/// None: not said; else 1 to `upper`.
std::optional<int> optional_number(const py::object& value, const std::string& name, int upper, int lower = 1);
/// From 0 up. Throws InputError for other numbers.
std::uint64_t seed_of(const py::object& value);

}  // namespace posewright::python
