#include "arguments.hpp"

#include <fmt/format.h>

#include "posewright/support/error.hpp"

namespace posewright::python {

int checked(const std::string& name, long long value, int lower, int upper) {
  if (value < lower || value > upper)
    throw InputError({}, fmt::format("{} is {}", name, value), fmt::format("{} to {} is allowed", lower, upper));
  return int(value);
}

std::optional<int> optional_number(const py::object& value, const std::string& name, int upper, int lower) {
  if (value.is_none()) return std::nullopt;
  if (PyBool_Check(value.ptr()) || !PyIndex_Check(value.ptr()))
    throw py::type_error(name + " must be a whole number, not " + py::repr(value).cast<std::string>());
  return checked(name, value.cast<long long>(), lower, upper);
}

std::uint64_t seed_of(const py::object& value) {
  if (PyIndex_Check(value.ptr()) == 0) throw py::type_error("seed must be a whole number");
  const unsigned long long seed = PyLong_AsUnsignedLongLong(py::int_(value).ptr());
  if (PyErr_Occurred() == nullptr) return seed;
  PyErr_Clear();
  throw InputError({}, "seed is " + py::repr(value).cast<std::string>(), "0 to 18446744073709551615 is allowed");
}

}  // namespace posewright::python
