#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bindings.hpp"
#include "keywords.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/results/route.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/text_file.hpp"
#include "posewright/tasks/export_sequence.hpp"

namespace posewright::python {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_plan = 200'000'000;

PoseSequence sequence_from(const py::object& plan) {
  if (const auto file = file_name(plan)) return parse_sequence(read_text(*file, largest_plan), file->string());
  if (py::isinstance<Plan>(plan)) return parse_sequence(plan_json(plan.cast<const Plan&>()), "plan");
  if (py::isinstance<Route>(plan)) return parse_sequence(route_json(plan.cast<const Route&>()), "route");
  throw InputError({}, "there is nothing to export", "a Plan, a Route or the name of a file of either");
}

Exported exported(const py::object& plan, const std::string& to, const std::shared_ptr<GivenProblem>& problem,
                  const py::kwargs& named) {
  const PoseFormat& format = find_pose_format(to);
  Keywords keywords(named);
  std::vector<std::string> given;
  for (const auto& row : export_options().rows())
    if (row.read && named.contains(row.keyword()) && !named[row.keyword().c_str()].is_none()) given.push_back(row.name);
  ExportOptions options;
  keywords.read(export_options(), options);
  const bool unchecked = keywords.flag("unchecked");
  keywords.finish();
  require_read(format, given);
  PoseSequence sequence = sequence_from(plan);
  if (!format.moves_robot() || unchecked) return export_sequence(format, std::move(sequence), options, nullptr);
  if (problem == nullptr)
    throw InputError({}, "a program for " + format.name + " is checked against the robot",
                     "problem=, or unchecked=True");
  return with_places(*problem, [&] { return export_sequence(format, sequence, options, &problem->problem); });
}

py::dict files_of(const Exported& made) {
  return dict_of(made.files, &ExportedFile::name, [](const ExportedFile& file) { return py::bytes(file.bytes); });
}

/// The first file is the program, or what opens the others: it is written when they are there.
std::vector<fs::path> save(const Exported& made, const fs::path& folder, bool overwrite) {
  std::vector<fs::path> files;
  for (const ExportedFile& file : made.files) {
    files.push_back(folder / file.name);
    require_absent(files.back(), overwrite);
  }
  for (std::size_t i = files.size(); i-- > 0;) {
    if (files[i].has_parent_path()) fs::create_directories(files[i].parent_path());
    write_file_atomically(files[i], made.files[i].bytes);
  }
  return files;
}

}  // namespace

void bind_export(py::module_& m) {
  py::class_<Exported>(m, "Exported", "Poses as files of other programs; docs/export.md.")
      .def_property_readonly("files", &files_of, "{name: bytes}")
      .def_readonly("notes", &Exported::notes)
      .def("save", &save, py::arg("folder") = fs::path("."), py::kw_only(), py::arg("overwrite") = false,
           "Writes the files into a folder; returns their names.")
      .def("__repr__", [](const Exported& e) { return py::str("<Exported: {}>").format(files_of(e).attr("keys")()); });
  define(m, "export", &exported,
         documentation("export", "plan: object, to: str, problem: Problem = None, *", rows_of(export_options()),
                       {"to", "problem"}, false, "", "Exported",
                       "A Plan, a Route or a file of either as a robot program or a list of a calibration tool "
                       "(docs/export.md). Programs are checked against the robot of `problem`, unless unchecked."),
         py::arg("plan"), py::arg("to"), py::arg("problem") = nullptr);
}

}  // namespace posewright::python
