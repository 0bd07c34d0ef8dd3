#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arguments.hpp"
#include "bindings.hpp"
#include "posewright/controller/known_controllers.hpp"
#include "posewright/outputs/route.hpp"
#include "posewright/outputs/write_plan.hpp"
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

std::string text_or_none(const py::object& value) {
  return value.is_none() ? std::string() : py::str(value).cast<std::string>();
}

std::optional<int> number_of(const py::object& value, const std::string& name) {
  if (value.is_none()) return std::nullopt;
  return checked(name, value.cast<long long>(), 0, 255);
}

Exported exported(const py::object& plan, const std::string& to, const std::shared_ptr<GivenProblem>& problem,
                  bool unchecked, const py::object& name, const py::object& speed, const py::object& settle,
                  const py::object& wait, const py::object& digital_output, const py::object& digital_input,
                  const py::object& tool, const py::object& payload, const py::object& base, const py::object& coupling,
                  const py::object& controller, const py::object& group, const py::object& station) {
  const PoseFormat& format = find_pose_format(to);
  std::vector<std::string> given;
  const std::pair<const char*, const py::object&> options[] = {{"name", name},
                                                               {"speed", speed},
                                                               {"settle", settle},
                                                               {"wait", wait},
                                                               {"digital-output", digital_output},
                                                               {"digital-input", digital_input},
                                                               {"tool", tool},
                                                               {"payload", payload},
                                                               {"base", base},
                                                               {"coupling", coupling},
                                                               {"controller", controller},
                                                               {"group", group},
                                                               {"station", station}};
  for (const auto& [option, value] : options)
    if (!value.is_none()) given.emplace_back(option);
  ExportOptions wanted;
  wanted.speed = within(speed, "speed", 1, 100);
  wanted.settle = within(settle, "settle", 0, 3600);
  wanted.wait = within(wait, "wait", 0.01, 3600);
  wanted.coupling = within(coupling, "coupling", -10, 10);
  wanted.tool = text_or_none(tool);
  wanted.payload = text_or_none(payload);
  wanted.base = number_of(base, "base");
  wanted.digital_output = text_or_none(digital_output);
  wanted.digital_input = text_or_none(digital_input);
  wanted.name = text_or_none(name);
  wanted.group = text_or_none(group);
  wanted.station = text_or_none(station);
  if (!controller.is_none()) wanted.controller = controller_settings(text_or_none(controller));
  require_read(format, given);
  PoseSequence sequence = sequence_from(plan);
  if (!format.moves_robot() || unchecked) return export_sequence(format, std::move(sequence), wanted, nullptr);
  if (problem == nullptr)
    throw InputError({}, "a program for " + format.name + " is checked against the robot",
                     "problem=, or unchecked=True");
  return with_places(*problem, [&] { return export_sequence(format, sequence, wanted, &problem->problem); });
}

py::dict files_of(const Exported& made) {
  py::dict files;
  for (const ExportedFile& file : made.files) files[py::str(file.name)] = py::bytes(file.bytes);
  return files;
}

/// The first file is the program, or what opens the others: it is written when they are there.
std::vector<fs::path> save(const Exported& made, const fs::path& folder, bool overwrite) {
  std::vector<fs::path> files;
  for (const ExportedFile& file : made.files) {
    files.push_back(folder / file.name);
    if (!fs::exists(files.back()) || overwrite) continue;
    PyErr_SetString(PyExc_FileExistsError, (files.back().string() + " exists; overwrite=True replaces it").c_str());
    throw py::error_already_set();
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
  const py::none none;
  m.def("export", &exported, py::arg("plan"), py::arg("to"), py::arg("problem") = nullptr, py::kw_only(),
        py::arg("unchecked") = false, py::arg("name") = none, py::arg("speed") = none, py::arg("settle") = none,
        py::arg("wait") = none, py::arg("digital_output") = none, py::arg("digital_input") = none,
        py::arg("tool") = none, py::arg("payload") = none, py::arg("base") = none, py::arg("coupling") = none,
        py::arg("controller") = none, py::arg("group") = none, py::arg("station") = none,
        R"(A Plan, a Route or a file of either as a robot program or a list of a calibration tool (docs/export.md).

Programs are checked against the robot of `problem`, unless unchecked. The rest is as the command's options: speed in
percent, settle and wait in s, controller the name of a known one or of a file; None: the format's default.)");
}

}  // namespace posewright::python
