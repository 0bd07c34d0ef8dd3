#include "design_keywords.hpp"

#include <algorithm>
#include <set>

#include "posewright/lists/read_poses.hpp"
#include "posewright/problem/design_keys.hpp"

namespace posewright::python {
namespace {

/// "minimum_distance_angle", and the name of the option where it is another one.
std::vector<std::string> keyword_names(const DesignKey& key, const std::vector<std::string>& taken) {
  std::vector<std::string> names{key.name(), key.option};
  for (std::string& name : names)
    for (char& c : name)
      if (c == '.' || c == '-') c = '_';
  if (names[1] == names[0]) names.pop_back();
  std::erase_if(names, [&](const std::string& name) {
    return name.empty() || std::find(taken.begin(), taken.end(), name) != taken.end();
  });
  return names;
}

/// Text of a value in YAML: JSON of a mapping or list, yes or no of a truth value.
std::string yaml_text(const py::object& value) {
  if (PyBool_Check(value.ptr())) return value.cast<bool>() ? "yes" : "no";
  if (py::isinstance<py::dict>(value) || py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value))
    return py::module_::import("json").attr("dumps")(value, py::arg("ensure_ascii") = false).cast<std::string>();
  return py::str(value);
}

std::optional<PoseList>& list_of(const DesignKey& key, RunOptions& run) {
  if (key.path == "design.measured") return run.measured;
  return key.path == "design.fixed" ? run.fixed : run.candidates_from;
}

}  // namespace

std::shared_ptr<GivenProblem> designed(const GivenProblem& given, const py::kwargs& keywords,
                                       const std::vector<std::string>& taken, RunOptions& run) {
  auto result = std::make_shared<GivenProblem>(given);
  std::set<std::string> known;
  for (const DesignKey& key : design_keys())
    for (const std::string& name : keyword_names(key, taken)) {
      known.insert(name);
      if (!keywords.contains(name)) continue;
      const py::object value = keywords[name.c_str()];
      if (value.is_none() || (py::isinstance<py::str>(value) && value.cast<std::string>().empty())) continue;
      if (!key.lists_poses) {
        set(result->problem, key.path, yaml_text(value), name);
        continue;
      }
      const std::vector<Coordinate> coordinates = coordinates_of(*result);
      list_of(key, run) = pose_list(value, key.path == "design.fixed" ? coordinates : without_limits(coordinates));
    }
  for (const auto& [name, value] : keywords)
    if (!known.contains(name.cast<std::string>()))
      throw py::type_error("unexpected keyword argument '" + name.cast<std::string>() + "'");
  return result;
}

std::string signature(const std::string& name, const std::string& before, const std::vector<std::string>& taken,
                      const std::string& after, const std::string& result) {
  std::string text = name + "(" + before;
  for (const DesignKey& key : design_keys())
    for (const std::string& keyword : keyword_names(key, taken)) text += ", " + keyword + ": object = None";
  return text + after + ") -> " + result + "\n\n";
}

}  // namespace posewright::python
