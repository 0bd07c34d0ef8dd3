#include <fmt/format.h>

#include <algorithm>

#include "formats/text.hpp"
#include "formats/yaml_list.hpp"

namespace posewright {
namespace {

using formats::YamlList;

const std::string allowed_keys = "allowed: sign, zero_deg, pulses_per_degree, coupling, axes, decimals, pivot_mm";

class SettingsReader {
 public:
  SettingsReader(const YamlList& yaml, ControllerSettings& settings) : yaml_(yaml), settings_(settings) {}

  void read(const YAML::Node& root) {
    if (!root.IsMap()) yaml_.fail(root, "is no mapping", allowed_keys);
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
    else if (key == "coupling") settings_.coupling = one(value, key, -10, 10);
    else if (key == "decimals") settings_.decimals = int(one(value, key, 3, 9));
    else if (key == "axes") settings_.axes = yaml_.texts(value, key);
    else if (key == "pivot_mm") {
      const auto pivot = checked(
          value, key, [](double x) { return x > -1e5 && x < 1e5; }, "three numbers");
      if (pivot.size() != 3) yaml_.fail(at, "pivot_mm has not three numbers", "[R, S, T] in mm");
      settings_.pivot_mm = {pivot[0], pivot[1], pivot[2]};
    } else {
      yaml_.fail(at, "unknown key " + formats::in_quotes(key), allowed_keys);
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

  const YamlList& yaml_;
  ControllerSettings& settings_;
};

}  // namespace

ControllerSettings parse_controller_settings(const std::string& text, const std::string& file) {
  ControllerSettings settings;
  settings.file = file;
  const YamlList yaml(file);
  try {
    SettingsReader(yaml, settings).read(YAML::Load(text));
  } catch (const YAML::Exception& error) {
    throw InputError({file, std::max(error.mark.line + 1, 0)}, "is no valid YAML: " + formats::ascii(error.msg), "");
  }
  return settings;
}

}  // namespace posewright
