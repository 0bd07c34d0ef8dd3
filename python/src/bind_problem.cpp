#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"

namespace posewright::python {
namespace {

namespace fs = std::filesystem;

using Packages = std::vector<std::pair<std::string, fs::path>>;

Packages packages_of(const py::dict& given) {
  Packages packages;
  for (const auto& [name, folder] : given) {
    const auto path = py::cast<fs::path>(folder);
    std::error_code code;
    if (!fs::is_directory(path, code))
      throw InputError({}, "packages: '" + path.string() + "' is no folder", "an existing folder is expected");
    packages.emplace_back(py::cast<std::string>(name), path);
  }
  return packages;
}

std::shared_ptr<GivenProblem> read(const fs::path& file, const py::dict& packages) {
  auto given = std::make_shared<GivenProblem>();
  given->problem = read_problem(file);
  given->problem.packages = packages_of(packages);
  return given;
}

std::shared_ptr<GivenProblem> parse(const std::string& text, const fs::path& file, std::vector<std::string> places,
                                    const py::dict& packages) {
  auto given = std::make_shared<GivenProblem>();
  given->places = std::move(places);
  // What a failed reading says needs the file's name before there is a problem.
  given->problem.file = file;
  given->problem = with_places(*given, [&] { return parse_problem(text, file); });
  given->problem.packages = packages_of(packages);
  return given;
}

std::vector<std::string> variant_names(const GivenProblem& given) {
  std::vector<std::string> names;
  for (const VariantSpec& variant : given.problem.variants) names.push_back(variant.name);
  return names;
}

}  // namespace

std::optional<fs::path> file_name(const py::object& value) {
  if (!py::isinstance<py::str>(value) && !py::hasattr(value, "__fspath__")) return std::nullopt;
  return value.cast<fs::path>();
}

PoseSource pose_source(const py::object& poses) {
  if (py::isinstance<Plan>(poses)) return poses_of(poses.cast<const Plan&>());
  if (const auto file = file_name(poses)) return poses_in_file(*file);
  return poses_given(rows_of(poses, "configurations"));
}

void bind_problem(py::module_& m) {
  py::class_<GivenProblem, std::shared_ptr<GivenProblem>>(m, "Problem")
      .def(py::init(&read), py::arg("file"), py::arg("packages"))
      .def(py::init(&parse), py::arg("text"), py::arg("file"), py::arg("places"), py::arg("packages"))
      .def_property_readonly(
          "file", [](const GivenProblem& p) { return p.problem.file.string(); }, "The file, or what stands for it.")
      .def_property_readonly(
          "sha256", [](const GivenProblem& p) { return p.problem.sha256; }, "Of the text, as a plan states it.")
      .def_property_readonly("variants", &variant_names, "Names of the variants, in their order.")
      .def("__repr__", [](const GivenProblem& p) {
        std::string names;
        for (const std::string& name : variant_names(p)) names += (names.empty() ? "" : ", ") + name;
        return "<Problem " + p.problem.file.string() + ": variants " + names + ">";
      });
}

}  // namespace posewright::python
