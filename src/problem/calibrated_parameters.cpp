#include "posewright/problem/calibrated_parameters.hpp"

#include <fmt/format.h>

#include "posewright/support/file.hpp"
#include "posewright/support/sha256.hpp"
#include "posewright/support/text.hpp"
#include "posewright/support/text_file.hpp"
#include "yaml_section.hpp"

namespace posewright {
namespace {

constexpr std::size_t parameters_size_limit = 10'000'000;

/// {value: …, unit: …}; what else stands there is for messages.
ParameterEntry read_entry(const yaml::Entry& entry) {
  const yaml::Section section(entry.value);
  // "{value: 0,1}" is a value 0 beside an empty key 1.
  for (const yaml::Entry& any : section.entries())
    if (!any.value.is_scalar() && !any.value.is_list() && !any.value.is_mapping())
      any.value.fail("is empty", "a key with its value is expected, and a decimal point in numbers");
  ParameterEntry parameter;
  parameter.name = entry.key;
  parameter.value = section.at("value").number(Quantity::number);
  if (const yaml::Value* unit = section.find("unit")) parameter.unit = unit->text();
  if (const yaml::Value* nominal = section.find("nominal")) parameter.nominal = nominal->number(Quantity::number);
  return parameter;
}

}  // namespace

CalibratedParameters read_calibrated_parameters(const std::filesystem::path& file) {
  std::error_code code;
  if (std::filesystem::is_character_file(file, code) || std::filesystem::is_block_file(file, code))
    throw InputError({file.string(), 0}, "is a device", "a file is needed");
  return parse_calibrated_parameters(read_file(file, parameters_size_limit), file);
}

CalibratedParameters parse_calibrated_parameters(const std::string& text, const std::filesystem::path& file) {
  const std::string name = file.string();
  if (text.size() > parameters_size_limit)
    throw InputError({name, 0}, fmt::format("has {} bytes", text.size()),
                     fmt::format("at most {} are read", parameters_size_limit));
  require_text(text, name);
  const yaml::Section root(yaml::Value(yaml::load_document(text, name), 1, "", name));
  const yaml::Value& version = root.at("posewright_parameters");
  if (const std::string number = version.text("the version 1 is expected"); number != "1")
    version.fail("is " + in_quotes(number), "the only known version is 1");
  CalibratedParameters parameters;
  parameters.file = file;
  parameters.sha256 = sha256_hex(text);
  parameters.variant = root.at("variant").located_text();
  if (const yaml::Value* convention = root.find("convention"))
    parameters.convention = convention->choice({"frames", "dh", "mdh"});
  if (const yaml::Value* unmodelled = root.find("unmodelled")) {
    const yaml::Section section(*unmodelled);
    parameters.unmodelled = {section.at("size").number(Quantity::length, yaml::Sign::positive),
                             section.at("length").number(Quantity::angle, yaml::Sign::positive)};
  }
  for (const yaml::Entry& entry : yaml::Section(root.at("parameters")).entries())
    parameters.values.push_back(read_entry(entry));
  return parameters;
}

}  // namespace posewright
