#include "keywords.hpp"

#include <algorithm>

#include "posewright/lists/read_poses.hpp"
#include "posewright/problem/design_keys.hpp"

namespace posewright::python {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// "minimum_distance_angle", and the name of the option where it is another one.
std::vector<std::string> keyword_names(const DesignKey& key, const std::vector<std::string>& taken) {
  std::vector<std::string> names{key.name(), key.option};
  for (std::string& name : names)
    for (char& c : name)
      if (c == '.' || c == '-') c = '_';
  if (names[1] == names[0]) names.pop_back();
  std::erase_if(names, [&](const std::string& name) { return name.empty() || contains(taken, name); });
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

bool is_absent(const py::object& value) {
  return value.is_none() || (py::isinstance<py::str>(value) && py::len(value) == 0);
}

}  // namespace

Keywords::Keywords(const py::kwargs& given) : rest_(py::reinterpret_steal<py::dict>(PyDict_Copy(given.ptr()))) {
  if (const py::object value = take("seed"); !value.is_none()) seed_ = seed_of(value);
  if (const py::object value = take("threads"); !value.is_none())
    threads_ = checked("threads", value.cast<long long>(), 0, most_threads);
  progress = take("progress");
}

py::object Keywords::take(const std::string& name) {
  if (!rest_.contains(name)) return py::none();
  return rest_.attr("pop")(name);
}

std::string Keywords::text(const std::string& name) {
  const py::object value = take(name);
  return value.is_none() ? std::string() : py::str(value).cast<std::string>();
}

std::optional<GivenOption> Keywords::given(const OptionRow& row) {
  if (row.kind == OptionKind::program) return std::nullopt;
  const py::object value = take(row.keyword());
  if (is_absent(value) || (row.kind == OptionKind::flag && !value.cast<bool>())) return std::nullopt;
  GivenOption given{row.keyword(), {}};
  const bool several = row.kind == OptionKind::list || row.kind == OptionKind::blocks;
  if (several && !py::isinstance<py::str>(value)) {
    for (const auto& one : value) given.values.push_back(py::str(one));
    return given.values.empty() ? std::nullopt : std::optional(given);
  }
  given.values = {yaml_text(value)};
  if (!row.unit.empty() && PyNumber_Check(value.ptr()) != 0) given.values.front() += " " + row.unit;
  return given;
}

bool Keywords::flag(const std::string& name) {
  const py::object value = take(name);
  return !value.is_none() && value.cast<bool>();
}

void Keywords::finish() const {
  for (const auto& [name, value] : rest_)
    throw py::type_error("unexpected keyword argument '" + name.cast<std::string>() + "'");
}

std::shared_ptr<GivenProblem> Keywords::designed(const GivenProblem& given, const std::vector<std::string>& taken,
                                                 RunOptions& run) {
  auto result = std::make_shared<GivenProblem>(given);
  for (const DesignKey& key : design_keys())
    for (const std::string& name : keyword_names(key, taken)) {
      const py::object value = take(name);
      if (is_absent(value)) continue;
      if (!key.lists_poses) {
        posewright::set(result->problem, key.path, yaml_text(value), name);
        continue;
      }
      const std::vector<Coordinate> coordinates = coordinates_of(*result);
      list_of(key, run) = pose_list(value, key.path == "design.fixed" ? coordinates : without_limits(coordinates));
    }
  finish();
  return result;
}

std::string documentation(const std::string& name, const std::string& before, const std::vector<OptionRow>& options,
                          std::vector<std::string> taken, bool design, const std::string& after,
                          const std::string& result, const std::string& text) {
  std::string signature = name + "(" + before, help;
  for (const OptionRow& row : options) {
    if (row.kind == OptionKind::program || contains(taken, row.keyword())) continue;
    taken.push_back(row.keyword());
    signature += ", " + row.keyword() + ": object = None";
    help += row.keyword() + ": " + row.help + "\n";
  }
  if (design)
    for (const DesignKey& key : design_keys())
      for (const std::string& keyword : keyword_names(key, taken)) signature += ", " + keyword + ": object = None";
  return signature + after + ") -> " + result + "\n\n" + text + (help.empty() ? "" : "\n\n") + help;
}

int checked(const std::string& name, long long value, int lower, int upper) {
  if (value < lower || value > upper)
    throw InputError({}, fmt::format("{} is {}", name, value), fmt::format("{} to {} is allowed", lower, upper));
  return int(value);
}

std::optional<int> optional_number(const py::object& value, const std::string& name, int upper, int lower) {
  if (value.is_none()) return std::nullopt;
  if (PyBool_Check(value.ptr()) || !PyIndex_Check(value.ptr()))
    throw py::type_error(name + " must be a whole number, not " + py::repr(value).cast<std::string>());
  return checked(name, value.cast<long long>(), lower, upper);
}

std::uint64_t seed_of(const py::object& value) {
  if (PyIndex_Check(value.ptr()) == 0) throw py::type_error("seed must be a whole number");
  const unsigned long long seed = PyLong_AsUnsignedLongLong(py::int_(value).ptr());
  if (PyErr_Occurred() == nullptr) return seed;
  PyErr_Clear();
  throw InputError({}, "seed is " + py::repr(value).cast<std::string>(), "0 to 18446744073709551615 is allowed");
}

}  // namespace posewright::python
