#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "arrays.hpp"
#include "bindings.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/table.hpp"

namespace posewright::python {
std::string plan_line(const Plan& plan) {
  const auto kept = std::count_if(plan.parameters.begin(), plan.parameters.end(),
                                  [](const PlannedParameter& p) { return p.sigma.has_value(); });
  std::string text = fmt::format("{} poses for {} parameters{}, log det {:.4f}", plan.poses.size(), kept,
                                 plan.variant.empty() ? "" : " of " + plan.variant, plan.log_det);
  if (plan.certificate.proved)
    text += fmt::format(", at least {} of the best of {} candidates", percent(plan.certificate.efficiency),
                        plan.certificate.count);
  return text + (plan.interrupted ? ", interrupted" : "");
}

py::object parsed(const std::string& json) { return py::module_::import("json").attr("loads")(json); }

py::array_t<double> pose_configurations(const std::vector<PlannedPose>& poses) {
  const auto rows =
      of_each(poses, [](const PlannedPose& pose) { return of_each(pose.configuration, &NamedValue::value); });
  return array_of(rows, rows.empty() ? 0 : rows.front().size());
}

py::dict indices_dict(const ObservabilityIndices& o) {
  py::dict result;
  result["o1"] = o.o1;
  result["o2"] = o.o2;
  result["o3"] = o.o3;
  result["o4"] = o.o4;
  result["o5"] = o.o5;
  return result;
}

void require_absent(const std::filesystem::path& file, bool overwrite) {
  if (!std::filesystem::exists(file) || overwrite) return;
  PyErr_SetString(PyExc_FileExistsError, (file.string() + " exists; overwrite=True replaces it").c_str());
  throw py::error_already_set();
}

void save_text(const py::object& path, const std::string& text, bool overwrite) {
  const auto file = path.cast<std::filesystem::path>();
  require_absent(file, overwrite);
  write_file_atomically(file, text);
}

}  // namespace posewright::python
