#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "posewright/blocks/block_array.hpp"

namespace posewright::python {

namespace py = pybind11;

/// Anything that numpy takes for an array of real numbers, as doubles; strides as they are, so float64 is not copied.
/// Throws TypeError for other kinds of entries, InputError for another number of dimensions.
py::array_t<double> real_array(const py::object& value, const std::string& name, int dimensions,
                               const std::string& shape);

/// N × n → N configurations; judged later by the coordinates of the problem.
std::vector<std::vector<double>> rows_of(const py::object& value, const std::string& name);

/// n × r × m, or (n·r) × m where r is given: copied once, whatever the strides. Throws InputError as real_array() does,
/// for empty arrays, and for numbers that are not finite.
BlockArray block_array(const py::object& value, std::optional<int> rows);

/// Whole numbers 0 … count − 1.
std::vector<int> indices_of(const py::object& value, const std::string& name, std::size_t count);

py::array_t<double> array_of(const std::vector<double>& values);
py::array_t<double> array_of(const Eigen::VectorXd& values);
/// Row-major copy.
py::array_t<double> array_of(const Eigen::MatrixXd& values);
/// N × n from N rows of n numbers.
py::array_t<double> array_of(const std::vector<std::vector<double>>& rows, std::size_t columns);
/// n × r × m over the memory of the blocks, which `owner` keeps alive.
py::array_t<double> view_of(const BlockArray& blocks, const py::object& owner);

}  // namespace posewright::python
