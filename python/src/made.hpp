#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <utility>

#include "keywords.hpp"
#include "posewright/report/report.hpp"
#include "posewright/report/report_result.hpp"
#include "posewright/support/json.hpp"

namespace posewright::python {

using Limit = std::optional<double>;
using Shared = std::shared_ptr<GivenProblem>;

/// A result with what it was made from: its text and JSON are those of the command line.
template <class T, class Options>
struct Made {
  Shared problem;
  Options options;
  T value;

  /// watched() of the work.
  template <class Work>
  static Made of(Shared problem, Options options, Limit time_limit, const py::object& progress, const Work& work) {
    Made made{std::move(problem), std::move(options), {}};
    made.value = watched(*made.problem, time_limit, progress, OnInterrupt::raise,
                         [&](const Monitor& monitor) { return work(made.problem->problem, made.options, monitor); });
    return made;
  }
};

/// Members of all results. text_of(M) and json_of(M) are found beside M.
template <class M>
py::class_<M> bind_made(py::module_& m, const char* name, const char* doc) {
  return py::class_<M>(m, name, doc)
      .def(
          "summary", [](const M& made) { return text_of(made); }, "The table that the command line prints.")
      .def(
          "to_json", [](const M& made) { return json_text(json_of(made)); }, "What the command prints with --json.")
      .def("to_dict", [](const M& made) { return parsed(json_text(json_of(made), JsonLayout::one_line)); });
}

/// Members of results with a page of their own.
template <class M>
py::class_<M> bind_page(py::class_<M> made) {
  return made.def(
      "to_html",
      [](const M& m) {
        return report_html(ResultReport{.title = title_of(m.problem->problem.file),
                                        .file = {},
                                        .result_json = json_text(json_of(m), JsonLayout::one_line)});
      },
      "The page that posewright report makes of it.");
}

}  // namespace posewright::python
