#include "arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "posewright/support/error.hpp"
#include "posewright/support/repeats.hpp"

namespace posewright::python {

int checked(const std::string& name, long long value, int lower, int upper) {
  if (value < lower || value > upper)
    throw InputError({}, fmt::format("{} is {}", name, value), fmt::format("{} to {} is allowed", lower, upper));
  return int(value);
}

std::optional<double> within(const py::object& value, const std::string& name, double lower, double upper) {
  if (value.is_none()) return std::nullopt;
  const auto number = value.cast<double>();
  if (number >= lower && number <= upper) return number;
  throw InputError({}, name + " is " + py::str(value).cast<std::string>(),
                   std::to_string(lower) + " to " + std::to_string(upper) + " is allowed");
}

std::optional<int> optional_number(const py::object& value, const std::string& name, int upper, int lower) {
  if (value.is_none()) return std::nullopt;
  if (PyBool_Check(value.ptr()) || !PyIndex_Check(value.ptr()))
    throw py::type_error(name + " must be a whole number, not " + py::repr(value).cast<std::string>());
  return checked(name, value.cast<long long>(), lower, upper);
}

std::string choice(const py::object& value, const std::string& name, const std::vector<std::string>& allowed) {
  if (value.is_none()) return {};
  const std::string text = py::str(value);
  if (std::find(allowed.begin(), allowed.end(), text) != allowed.end()) return text;
  throw InputError({}, fmt::format("{} is '{}'", name, text), fmt::format("allowed: {}", fmt::join(allowed, ", ")));
}

std::optional<Repeats> repeats_of(const py::object& value) {
  if (!py::isinstance<py::str>(value)) {
    const std::optional<int> number = optional_number(value, "repeats", most_poses);
    return number ? std::optional(Repeats{*number}) : std::nullopt;
  }
  const std::string text = py::str(value);
  if (const auto repeats = posewright::repeats_of(text)) return repeats;
  throw InputError({}, fmt::format("repeats is '{}'", text), repeats_allowed);
}

std::uint64_t seed_of(const py::int_& value) {
  const unsigned long long seed = PyLong_AsUnsignedLongLong(value.ptr());
  if (PyErr_Occurred() == nullptr) return seed;
  PyErr_Clear();
  throw InputError({}, "seed is " + py::repr(value).cast<std::string>(), "0 to 18446744073709551615 is allowed");
}

RunOptions run_options(const py::int_& seed, long long threads) {
  RunOptions run;
  run.seed = seed_of(seed);
  run.threads = checked("threads", threads, 0, most_threads);
  return run;
}

}  // namespace posewright::python
