#include "posewright/controller/controller_settings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "posewright/controller/yaml_document.hpp"
#include "posewright/support/text.hpp"

namespace posewright {
namespace {

const std::string allowed_keys =
    "allowed: sign, zero_deg, pulses_per_degree, range_deg, coupling, axes, decimals, pivot_mm";

class SettingsReader {
 public:
  SettingsReader(const yaml::Document& yaml, ControllerSettings& settings) : yaml_(yaml), settings_(settings) {}

  void read(const YAML::Node& root) {
    if (!root.IsMap()) yaml_.fail(root, "is not a mapping", allowed_keys);
    for (const auto& entry : root) {
      const std::string key = yaml_.text(entry.first, "a key");
      if (!settings_.lines.emplace(key, yaml_.line(entry.first)).second)
        yaml_.fail(entry.first, "has '" + key + "' twice", "each key once");
      read_entry(key, entry.first, entry.second);
    }
  }

 private:
  void read_entry(const std::string& key, const YAML::Node& at, const YAML::Node& value) {
    if (key == "sign")
      settings_.sign = checked(
          value, key, [](double x) { return x == 1 || x == -1; }, "1 or -1");
    else if (key == "zero_deg")
      settings_.zero_deg = checked(
          value, key, [](double x) { return std::abs(x) < 1e6; }, "numbers");
    else if (key == "pulses_per_degree")
      settings_.pulses_per_degree = checked(
          value, key, [](double x) { return x > 0 && x < 1e7; }, "numbers above 0");
    else if (key == "range_deg") read_ranges(value, key);
    else if (key == "coupling") settings_.coupling = one(value, key, -10, 10);
    else if (key == "decimals") settings_.decimals = int(one(value, key, 3, 9));
    else if (key == "axes") settings_.axes = yaml_.texts(value, key);
    else if (key == "pivot_mm") {
      const auto pivot = checked(
          value, key, [](double x) { return x > -1e5 && x < 1e5; }, "three numbers");
      if (pivot.size() != 3) yaml_.fail(at, "pivot_mm has not three numbers", "[R, S, T] in mm");
      settings_.pivot_mm = {pivot[0], pivot[1], pivot[2]};
    } else {
      yaml_.fail(at, "unknown key " + in_quotes(key), allowed_keys);
    }
  }

  void read_ranges(const YAML::Node& value, const std::string& key) {
    for (const YAML::Node& item : yaml_.items(value, key)) {
      const std::vector<double> ends = yaml_.numbers(item, key);
      if (ends.size() != 2 || !(ends[0] < ends[1]))
        yaml_.fail(item, "range_deg has no range here", "[lower, upper], one for each joint");
      settings_.range_deg.push_back({ends[0], ends[1]});
    }
  }

  template <class Allowed>
  std::vector<double> checked(const YAML::Node& node, const std::string& key, const Allowed& allowed,
                              const char* expected) const {
    std::vector<double> values = yaml_.numbers(node, key);
    if (!std::all_of(values.begin(), values.end(), allowed))
      yaml_.fail(node, key + " has a number that is not allowed", std::string(expected) + ", one for each joint");
    return values;
  }

  double one(const YAML::Node& node, const std::string& key, double lower, double upper) const {
    const double value = yaml_.number(node, key);
    if (!(value >= lower && value <= upper))
      yaml_.fail(node, fmt::format("{} is {}", key, value), fmt::format("{} to {} are allowed", lower, upper));
    return value;
  }

  const yaml::Document& yaml_;
  ControllerSettings& settings_;
};

}  // namespace

std::pair<std::size_t, std::size_t> ControllerSettings::coupled_axes() const {
  using Names = std::pair<const char*, const char*>;
  for (const auto& [second, third] :
       {Names("A2", "A3"), Names("rax_2", "rax_3"), Names("J2", "J3"), Names("j2", "j3"), Names("L", "U")}) {
    const auto a = std::find(axes.begin(), axes.end(), second), b = std::find(axes.begin(), axes.end(), third);
    if (a != axes.end() && b != axes.end()) return {std::size_t(a - axes.begin()), std::size_t(b - axes.begin())};
  }
  return {1, 2};
}

ControllerSettings parse_controller_settings(const std::string& text, const std::string& file) {
  ControllerSettings settings;
  settings.file = file;
  const yaml::Document yaml(file);
  try {
    SettingsReader(yaml, settings).read(YAML::Load(text));
  } catch (const YAML::Exception& error) {
    throw InputError({file, std::max(error.mark.line + 1, 0)}, "is not valid YAML: " + in_quotes(error.msg), "");
  }
  return settings;
}

}  // namespace posewright
