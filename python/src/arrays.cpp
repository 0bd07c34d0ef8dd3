#include "arrays.hpp"

#include <fmt/format.h>

#include <cmath>

#include "posewright/support/error.hpp"

namespace posewright::python {
namespace {

std::string shape_text(const py::array& a) {
  std::string text;
  for (py::ssize_t k = 0; k < a.ndim(); ++k) text += (k > 0 ? " × " : "") + std::to_string(a.shape(k));
  return a.ndim() == 0 ? "a single number" : text;
}

}  // namespace

py::array_t<double> real_array(const py::object& value, const std::string& name, int dimensions,
                               const std::string& shape) {
  const py::array array = py::module_::import("numpy").attr("asarray")(value);
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u' && array.size() > 0)
    throw py::type_error(
        fmt::format("{} must be real numbers, not {}", name, py::str(py::object(array.dtype())).cast<std::string>()));
  if (array.ndim() != dimensions)
    throw InputError({}, fmt::format("{} is {}", name, shape_text(array)), shape + " is expected");
  return py::array_t<double, py::array::forcecast>(array);
}

std::vector<std::vector<double>> rows_of(const py::object& value, const std::string& name) {
  const auto array = real_array(value, name, 2, "N poses × n coordinates");
  const auto a = array.unchecked<2>();
  std::vector<std::vector<double>> rows(static_cast<std::size_t>(a.shape(0)));
  for (py::ssize_t i = 0; i < a.shape(0); ++i)
    for (py::ssize_t k = 0; k < a.shape(1); ++k) rows[std::size_t(i)].push_back(a(i, k));
  return rows;
}

BlockArray block_array(const py::object& value, std::optional<int> rows) {
  py::array_t<double> array = rows ? real_array(value, "blocks", 2, "(n·r) × m, beside rows=r,")
                                   : real_array(value, "blocks", 3, "n × r × m, or (n·r) × m beside rows=r,");
  if (rows) {
    if (*rows < 1 || array.shape(0) % *rows != 0)
      throw InputError({}, fmt::format("blocks of {} rows do not make up {} rows", *rows, array.shape(0)),
                       "rows must divide them");
    array = array.reshape({array.shape(0) / *rows, py::ssize_t(*rows), array.shape(1)});
  }
  const auto a = array.unchecked<3>();
  constexpr py::ssize_t most = 100000;
  if (array.size() == 0 || a.shape(1) > most || a.shape(2) > most)
    throw InputError({}, "blocks are " + shape_text(array), "n, r and m must be at least 1, r and m at most 100000");
  BlockArray blocks(std::size_t(a.shape(0)), int(a.shape(1)), int(a.shape(2)));
  for (py::ssize_t i = 0; i < a.shape(0); ++i)
    for (py::ssize_t k = 0; k < a.shape(1); ++k) {
      double* row = blocks.row(std::size_t(i), int(k));
      for (py::ssize_t j = 0; j < a.shape(2); ++j) {
        row[j] = a(i, k, j);
        if (!std::isfinite(row[j]))
          throw InputError({}, fmt::format("block {}, row {}, column {} is not finite", i, k, j),
                           "all numbers must be finite");
      }
    }
  return blocks;
}

std::vector<int> indices_of(const py::object& value, const std::string& name, std::size_t count) {
  const py::array array = py::module_::import("numpy").attr("asarray")(value);
  if (array.ndim() != 1 || array.size() == 0)
    throw InputError({}, fmt::format("{} is {}", name, shape_text(array)), "a list of indices is expected");
  if (const char kind = array.dtype().kind(); kind != 'i' && kind != 'u')
    throw py::type_error(name + " must be whole numbers");
  const py::array_t<long long, py::array::forcecast> numbers(array);
  const auto a = numbers.unchecked<1>();
  std::vector<int> result;
  for (py::ssize_t i = 0; i < a.shape(0); ++i) {
    if (a(i) < 0 || std::size_t(a(i)) >= count)
      throw InputError({}, fmt::format("{}[{}] is {}", name, i, a(i)), fmt::format("0 to {} is allowed", count - 1));
    result.push_back(int(a(i)));
  }
  return result;
}

py::array_t<double> array_of(const std::vector<double>& values) {
  return py::array_t<double>(py::ssize_t(values.size()), values.data());
}

py::array_t<double> array_of(const Eigen::VectorXd& values) {
  return py::array_t<double>(py::ssize_t(values.size()), values.data());
}

py::array_t<double> array_of(const Eigen::MatrixXd& values) {
  const BlockArray::RowMatrix rows = values;
  return py::array_t<double>({py::ssize_t(rows.rows()), py::ssize_t(rows.cols())}, rows.data());
}

py::array_t<double> array_of(const std::vector<std::vector<double>>& rows, std::size_t columns) {
  py::array_t<double> result({py::ssize_t(rows.size()), py::ssize_t(columns)});
  auto out = result.mutable_unchecked<2>();
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < columns; ++k) out(py::ssize_t(i), py::ssize_t(k)) = rows[i][k];
  return result;
}

py::array_t<double> view_of(const BlockArray& blocks, const py::object& owner) {
  const auto n = py::ssize_t(blocks.count()), r = py::ssize_t(blocks.rows()), m = py::ssize_t(blocks.columns());
  constexpr auto size = py::ssize_t(sizeof(double));
  const py::ssize_t row = blocks.stride() * size;
  return py::array_t<double>({n, r, m}, {r * row, row, size}, blocks.data(), owner);
}

}  // namespace posewright::python
