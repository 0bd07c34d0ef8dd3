#include <pybind11/stl.h>

#include <cstring>

#include "arrays.hpp"
#include "bindings.hpp"
#include "keywords.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/select_blocks.hpp"

namespace posewright::python {
namespace {

/// Blocks with labels, whatever they were given as. Blocks that stay with Python are copied.
struct Labelled {
  BlockArray array;
  std::vector<Parameter> parameters;
  int nuisance = 0;
};

BlockArray copy_of(const BlockArray& blocks) {
  BlockArray copy(blocks.count(), blocks.rows(), blocks.columns());
  std::memcpy(copy.data(), blocks.data(),
              blocks.count() * std::size_t(blocks.rows() * blocks.stride()) * sizeof(double));
  return copy;
}

Labelled labelled(const py::object& given, std::optional<int> rows, const std::optional<int>& nuisance) {
  Labelled result;
  if (py::isinstance<Blocks>(given)) {
    const auto& blocks = given.cast<const Blocks&>();
    result = {copy_of(*blocks.array), blocks.parameters, blocks.nuisance};
  } else {
    result.array = block_array(given, rows);
    for (int j = 0; j < result.array.columns(); ++j)
      result.parameters.push_back({"column " + std::to_string(j), "1", 0.0, 1.0, Role::interest});
  }
  if (nuisance) result.nuisance = checked("nuisance", *nuisance, 0, result.array.columns() - 1);
  for (std::size_t j = 0; j < result.parameters.size(); ++j)
    result.parameters[j].role = int(j) < result.nuisance ? Role::nuisance : Role::interest;
  return result;
}

Plan select(const py::object& blocks, const py::object& poses, const py::kwargs& named) {
  Keywords keywords(named);
  keywords.set("poses", poses);
  const py::object names = keywords.take("names");
  SelectOptions options;
  options.nuisance = -1;
  keywords.read(select_options(), options);
  const std::optional<int> nuisance = options.nuisance < 0 ? std::nullopt : std::optional(options.nuisance);
  Labelled given = labelled(blocks, options.rows, nuisance);
  options.nuisance = given.nuisance;
  const std::optional<double> limit = keywords.time_limit();
  keywords.finish();
  BlockFile file{std::move(given.array), {}, {}};
  for (const Parameter& p : given.parameters) file.columns.push_back(p.name);
  if (!names.is_none()) {
    auto columns = names.cast<std::vector<std::string>>();
    if (columns.size() != file.columns.size())
      throw InputError({}, "there are " + std::to_string(columns.size()) + " names",
                       "one for each of the " + std::to_string(file.columns.size()) + " columns is expected");
    file.columns = std::move(columns);
  }
  Plan result;
  Watch watch(limit, keywords.progress);
  watch.run([&](const Monitor& monitor) { result = select_blocks(std::move(file), options, monitor); },
            OnInterrupt::keep_best);
  return result;
}

/// An evaluation together with what the value of a criterion needs beside it.
struct Judged {
  BlockArray blocks;
  Evaluation evaluation;
  std::vector<Parameter> parameters;
  int nuisance = 0;
  Eigen::VectorXd scale;
  Eigen::MatrixXd prior;  // empty: none
};

Judged evaluate_blocks(const py::object& blocks, const py::object& chosen, std::optional<int> nuisance,
                       std::optional<int> rows, const py::object& tolerance, bool prior) {
  Labelled given = labelled(blocks, rows, nuisance);
  const auto m = given.parameters.size();
  if (!tolerance.is_none()) {
    const auto values = real_array(tolerance, "tolerance", 1, "one for each column");
    if (std::size_t(values.size()) != m)
      throw InputError({}, "there are " + std::to_string(values.size()) + " tolerances",
                       "one for each of the " + std::to_string(m) + " columns is expected");
    for (std::size_t j = 0; j < m; ++j) {
      given.parameters[j].tolerance = values.at(py::ssize_t(j));
      if (!(given.parameters[j].tolerance > 0) || !std::isfinite(given.parameters[j].tolerance))
        throw InputError({}, "tolerance[" + std::to_string(j) + "] is not positive", "positive numbers are expected");
    }
  }
  if (!chosen.is_none()) given.array = given.array.subset(indices_of(chosen, "chosen", given.array.count()));
  Judged result;
  result.scale.resize(Eigen::Index(m));
  for (std::size_t j = 0; j < m; ++j) result.scale[Eigen::Index(j)] = given.parameters[j].tolerance;
  const py::gil_scoped_release release;
  result.evaluation = evaluate(given.array, given.parameters, prior ? Prior::every : Prior::none, result.scale);
  if (prior) result.prior = result.scale.array().square().inverse().matrix().asDiagonal();
  result.blocks = std::move(given.array);
  result.parameters = std::move(given.parameters);
  result.nuisance = given.nuisance;
  return result;
}

void bind_blocks_class(py::module_& m) {
  py::class_<Blocks>(m, "Blocks", "Whitened Jacobian blocks n × r × m with the labels of their columns.")
      .def_property_readonly(
          "values", [](const py::object& self) { return view_of(*self.cast<const Blocks&>().array, self); },
          "n × r × m, without a copy")
      .def_property_readonly(
          "parameters", [](const Blocks& b) { return of_each(b.parameters, unplanned); },
          "labels of the columns, nuisance first")
      .def_property_readonly("names", [](const Blocks& b) { return of_each(b.parameters, &Parameter::name); })
      .def_property_readonly("units", [](const Blocks& b) { return of_each(b.parameters, &Parameter::unit); })
      .def_readonly("nuisance", &Blocks::nuisance, "how many leading columns are nuisance")
      .def_property_readonly(
          "shape",
          [](const Blocks& b) { return py::make_tuple(b.array->count(), b.array->rows(), b.array->columns()); })
      .def(
          "__array__",
          [](const py::object& self, const py::object& dtype) {
            return py::module_::import("numpy").attr("asarray")(self.attr("values"), dtype);
          },
          py::arg("dtype") = py::none())
      .def("__len__", [](const Blocks& b) { return b.array->count(); })
      .def("__repr__", [](const Blocks& b) {
        return py::str("<Blocks {} × {} × {}, {} columns nuisance>")
            .format(b.array->count(), b.array->rows(), b.array->columns(), b.nuisance);
      });
}

void bind_judged(py::module_& m) {
  py::class_<Judged>(m, "BlockEvaluation", "What chosen blocks are worth.")
      .def_property_readonly(
          "log_det", [](const Judged& j) { return j.evaluation.log_det; },
          "log det of the information, nuisance eliminated")
      .def_property_readonly("log_det_full", [](const Judged& j) { return j.evaluation.log_det_full; })
      .def_property_readonly(
          "sigma", [](const Judged& j) { return array_of(j.evaluation.sigma); }, "1σ of each column")
      .def_property_readonly(
          "covariance", [](const Judged& j) { return array_of(j.evaluation.covariance); }, "m × m")
      .def_property_readonly(
          "singular_values", [](const Judged& j) { return array_of(j.evaluation.singular_values); },
          "of the interest columns, nuisance eliminated, in units of tolerance, descending")
      .def_property_readonly("indices", [](const Judged& j) { return indices_dict(j.evaluation.indices); })
      .def_property_readonly("condition", [](const Judged& j) { return j.evaluation.condition; })
      .def_property_readonly(
          "contributions", [](const Judged& j) { return array_of(j.evaluation.contribution); },
          "share of all information of each block")
      .def(
          "value",
          [](const Judged& j, const std::string& criterion) {
            return value_of_blocks(criterion, j.blocks, j.evaluation, j.nuisance, j.scale, j.prior);
          },
          py::arg("criterion"), "Value of a criterion in its own terms: o1 to o5, ds, a.")
      .def("__repr__", [](const Judged& j) {
        return py::str("<BlockEvaluation: {} blocks, {} columns, log det {:.6f}>")
            .format(j.evaluation.contribution.size(), j.parameters.size(), j.evaluation.log_det);
      });
}

}  // namespace

void bind_blocks(py::module_& m) {
  bind_blocks_class(m);
  bind_judged(m);
  const py::none none;
  {
    define(
        m, "select", &select,
        documentation(
            "select", "blocks: object, poses: int, *, names: object = None", rows_of(select_options()), {"poses"},
            false, run_arguments, "Plan",
            R"(The same search on whitened Jacobian blocks of your own: an array n × r × m, (n·r) × m with rows=r, or Blocks.

Blocks state their nuisance columns; fixed, augment: indices of blocks. Columns are taken as they are: multiply them by
their tolerances for criteria that depend on the scale. plan.candidates are the indices of the chosen blocks. Ctrl-C as
in plan().)"),
        py::arg("blocks"), py::arg("poses"));
  }
  m.def("evaluate_blocks", &evaluate_blocks, py::arg("blocks"), py::arg("chosen") = none, py::kw_only(),
        py::arg("nuisance") = none, py::arg("rows") = none, py::arg("tolerance") = none, py::arg("prior") = false,
        R"(What the chosen blocks (all where none are named) are worth, by a QR of their rows.

tolerance: units of the columns for sigma's prior and the indices; Blocks know theirs, else 1. prior: count every
tolerance as one more measurement. CannotDo where they do not identify all columns.)");
  m.def(
      "log_det",
      [](const py::object& blocks, const py::object& chosen, std::optional<int> nuisance, std::optional<int> rows) {
        return evaluate_blocks(blocks, chosen, nuisance, rows, py::none(), false).evaluation.log_det;
      },
      py::arg("blocks"), py::arg("chosen") = none, py::kw_only(), py::arg("nuisance") = none, py::arg("rows") = none,
      "log det of the information of the chosen blocks, nuisance eliminated.");
}

}  // namespace posewright::python
