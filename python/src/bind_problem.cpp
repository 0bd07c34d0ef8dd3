#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.hpp"
#include "keywords.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/model/apply_parameters.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/study/written_plan.hpp"
#include "posewright/support/error.hpp"

namespace posewright::python {
namespace {

namespace fs = std::filesystem;

Packages packages_of(const py::dict& given) {
  Packages packages;
  for (const auto& [name, folder] : given) {
    const auto path = py::cast<fs::path>(folder);
    std::error_code code;
    if (!fs::is_directory(path, code))
      throw InputError({}, "packages: '" + path.string() + "' is not a folder", "an existing folder is expected");
    packages.emplace_back(py::cast<std::string>(name), path);
  }
  return packages;
}

std::shared_ptr<GivenProblem> read(const fs::path& file, const py::dict& packages) {
  auto problem = std::make_shared<GivenProblem>();
  problem->problem = read_problem(file, packages_of(packages));
  return problem;
}

std::shared_ptr<GivenProblem> parse(const std::string& text, const fs::path& file, std::vector<std::string> places,
                                    const py::dict& packages) {
  auto problem = std::make_shared<GivenProblem>();
  problem->places = std::move(places);
  // What a failed reading says needs the file's name before there is a problem.
  problem->problem.file = file;
  problem->problem = with_places(*problem, [&] { return parse_problem(text, file, packages_of(packages)); });
  return problem;
}

fs::path in_folder(const py::object& base, const char* name) {
  return base.is_none() ? fs::path(name) : base.cast<fs::path>() / name;
}

std::shared_ptr<GivenProblem> read_given(const py::object& source, const py::object& base, const py::dict& packages) {
  if (const auto file = file_name(source)) {
    if (!base.is_none()) throw py::type_error("base belongs to a mapping; paths in a file are relative to the file");
    return read(*file, packages);
  }
  const py::tuple text = py::module_::import("posewright._mapping").attr("problem_text")(source);
  return parse(text[0].cast<std::string>(), in_folder(base, "problem"), text[1].cast<std::vector<std::string>>(),
               packages);
}

/// Notes about the parameters become warnings.
std::shared_ptr<GivenProblem> given(const py::object& source, const py::object& base, const py::dict& packages,
                                    const py::object& parameters) {
  auto problem = read_given(source, base, packages);
  if (parameters.is_none()) return problem;
  for (const std::string& note :
       apply_parameters(problem->problem, read_calibrated_parameters(parameters.cast<fs::path>()), {}))
    if (PyErr_WarnEx(PyExc_RuntimeWarning, note.c_str(), 1) != 0) throw py::error_already_set();
  return problem;
}

std::shared_ptr<GivenProblem> from_text(const std::string& text, const py::object& base, const std::string& name,
                                        const py::dict& packages) {
  return parse(text, in_folder(base, name.c_str()), {}, packages);
}

/// Text of a first problem file.
std::string init(const py::object& robot, const py::kwargs& named) {
  Keywords keywords(named);
  InitCall call;
  keywords.read(init_options(), call);
  const py::object packages = keywords.take("packages"), folder = keywords.take("folder");
  keywords.finish();
  if (robot.is_none() == call.facts.samples.empty())
    throw py::type_error("init() needs a robot or samples, one of them");
  if (!call.names_instrument()) throw InputError({}, "no instrument is named", "tracker=True or camera=NAME");
  if (!robot.is_none()) call.facts.robot = robot.cast<fs::path>();
  if (!packages.is_none()) call.facts.packages = packages_of(packages.cast<py::dict>());
  call.facts.files_beside = false;
  const fs::path file = in_folder(folder, "problem.yaml");
  return watched(GivenProblem{}, {}, keywords.progress, OnInterrupt::raise,
                 [&](const Monitor& monitor) { return init_problem(call.facts, file, monitor).text; });
}

std::vector<std::string> variant_names(const GivenProblem& problem) {
  std::vector<std::string> names;
  for (const VariantSpec& variant : problem.problem.variants) names.push_back(variant.name);
  return names;
}

}  // namespace

std::optional<fs::path> file_name(const py::object& value) {
  if (!py::isinstance<py::str>(value) && !py::hasattr(value, "__fspath__")) return std::nullopt;
  return value.cast<fs::path>();
}

PoseList pose_list(const py::object& poses, const std::vector<Coordinate>& coordinates, const std::string& format) {
  if (const auto file = file_name(poses)) return read_poses(*file, coordinates, format);
  if (!format.empty()) throw InputError({}, "format is '" + format + "'", "it belongs to the name of a pose list");
  if (py::isinstance<Plan>(poses)) return poses_of(poses.cast<const Plan&>(), coordinates);
  return poses_given(rows_of(poses, "configurations"), coordinates);
}

void bind_problem(py::module_& m) {
  // Made here and not in a class of Python's, whose __init__ would show tracebacks an object that is not one yet.
  py::class_<GivenProblem, std::shared_ptr<GivenProblem>>(m, "Problem",
                                                          R"(Robot, instrument, variants and workspace.

source: the name of a problem file (docs/problem-file.md), or a mapping with its keys. base: folder that paths in a
mapping are relative to (the current one); in a file they are relative to the file. packages: {name: folder} for meshes
named package://name/…; parameters: a parameters file to linearise at, as Calibration.save writes it)")
      .def(py::init(&given), py::arg("source"), py::arg("base") = py::none(), py::kw_only(),
           py::arg("packages") = py::dict(), py::arg("parameters") = py::none())
      .def_static("from_text", &from_text, py::arg("text"), py::arg("base") = py::none(), py::kw_only(),
                  py::arg("name") = "problem", py::arg("packages") = py::dict(),
                  "The text of a problem file; messages call it by `name`.")
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
  define(m, "init", &init,
         documentation("init", "robot: object = None, *", rows_of(init_options()), {}, false,
                       ", packages: dict = {}, folder: object = None, progress: object = None", "str",
                       "Text of a problem file for a URDF or xacro, or for samples of hand-eye calibration: for "
                       "Problem.from_text or a file; paths in it are "
                       "relative to `folder` (docs/init.md). Lengths without unit in m."),
         py::arg("robot") = py::none());
}

}  // namespace posewright::python
