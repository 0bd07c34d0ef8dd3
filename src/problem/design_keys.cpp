#include "posewright/problem/design_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "posewright/problem/design_words.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/repeats.hpp"
#include "posewright/support/text.hpp"
#include "sections.hpp"

namespace posewright {

struct DesignReading {
  DesignSpec& design;
  const std::vector<VariantSpec>& variants;
  const std::filesystem::path& folder;  ///< that paths are relative to
};

namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;
using Read = std::function<void(const Value&, DesignReading&)>;

constexpr int most_candidates = 10'000'000, most_restarts = 1'000'000;

const char* const name_schema = R"("type": ["string", "number"])";
const char* const file_schema = R"("$ref": "#/$defs/file")";

std::string whole_schema(int lower, int upper) {
  return fmt::format(R"("type": "integer", "minimum": {}, "maximum": {})", lower, upper);
}

std::string word_schema(const std::vector<std::string_view>& words) {
  return fmt::format(R"("enum": ["{}"])", fmt::join(words, R"(", ")"));
}

std::string reference(std::string_view definition) { return fmt::format(R"("$ref": "#/$defs/{}")", definition); }

/// A file, and the keys below it, in place of the same from a file that it is not stated with.
bool stated_together(int line, int other) { return line != 0 && other != 0 && (line < 0) == (other < 0); }

void require_variant(const Value& value, const std::string& name, const std::vector<VariantSpec>& variants) {
  std::string names;
  for (const VariantSpec& variant : variants) {
    if (variant.name == name) return;
    names += (names.empty() ? "" : ", ") + variant.name;
  }
  value.fail("is " + in_quotes(name), "allowed: " + names);
}

Read variant_name(std::optional<Located<std::string>> DesignSpec::*member) {
  return [=](const Value& value, DesignReading& reading) {
    reading.design.*member = value.located_text();
    require_variant(value, (reading.design.*member)->value, reading.variants);
  };
}

/// A list of names, or names with weights.
void read_several(const Value& value, DesignReading& reading) {
  std::vector<DesignSpec::Weighted> result;
  if (value.is_mapping()) {
    for (const yaml::Entry& entry : Section(value).entries()) {
      require_variant(entry.value, entry.key.value, reading.variants);
      result.push_back({entry.key, entry.value.number(Quantity::number, Sign::positive)});
    }
  } else {
    for (const Value& item : value.items("a list of variants, or variants with weights, is expected")) {
      require_variant(item, item.text(), reading.variants);
      const auto same = [&](const DesignSpec::Weighted& other) { return other.name.value == item.text(); };
      if (std::any_of(result.begin(), result.end(), same)) item.fail("is named twice", "each variant once");
      result.push_back({item.located_text(), 1.0});
    }
  }
  if (result.empty()) value.fail("is empty", "at least one variant is needed");
  reading.design.variants = std::move(result);
}

Read located_text(Located<std::string> DesignSpec::*member) {
  return [=](const Value& value, DesignReading& reading) { reading.design.*member = value.located_text(); };
}

void read_poses(const Value& value, DesignReading& reading) {
  DesignSpec& design = reading.design;
  design.poses.reset();
  design.smallest = value.is_scalar() && value.text("a number or auto is expected") == "auto";
  if (!design.smallest) design.poses = {value.integer(1, most_stated_poses), value.line()};
}

void read_candidates(const Value& value, DesignReading& reading) {
  DesignSpec& design = reading.design;
  design.candidates = {value.integer(1, most_candidates), value.line()};
  if (design.candidates_from && stated_together(design.candidates_from->line, value.line()))
    value.fail("cannot be combined with candidates_from", "leave one of them out");
  design.candidates_from.reset();
}

void read_candidates_from(const Value& value, DesignReading& reading) {
  DesignSpec& design = reading.design;
  if (stated_together(design.candidates.line, value.line()))
    value.fail("cannot be combined with candidates", "leave one of them out");
  design.candidates_from = {value.file(reading.folder), value.line()};
}

Read file(std::optional<std::filesystem::path> DesignSpec::*member) {
  return [=](const Value& value, DesignReading& reading) { reading.design.*member = value.file(reading.folder); };
}

void read_repeats(const Value& value, DesignReading& reading) {
  const std::string text = value.text("forbid, allow or a number is expected");
  const std::optional<Repeats> repeats = repeats_of(text);
  if (!repeats) value.fail("is " + in_quotes(text), repeats_allowed);
  reading.design.repeats = *repeats;
}

/// A key that is a mapping, read by the rows below it.
void read_below(const std::string& path, const Value& value, DesignReading& reading, bool may_be_empty = false) {
  std::vector<std::string_view> names;
  std::vector<const DesignKey*> keys;
  for (const DesignKey& key : design_keys()) {
    const std::size_t dot = key.path.rfind('.');
    if (std::string_view(key.path).substr(0, dot) != path) continue;
    names.push_back(std::string_view(key.path).substr(dot + 1));
    keys.push_back(&key);
  }
  const Section section(value);
  section.allow(names);
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (const Value* one = section.find(names[i])) keys[i]->read(*one, reading);
  if (section.entries().empty() && !may_be_empty)
    value.fail("is empty", fmt::format("allowed: {}", fmt::join(names, ", ")));
}

/// A mapping, or one distance for coordinates of its unit.
void read_minimum_distance(const Value& value, DesignReading& reading) {
  reading.design.minimum_distance = DesignSpec::MinimumDistance{};
  if (!value.is_scalar()) return read_below("design.minimum_distance", value, reading);
  const Measured one = value.measured({Quantity::angle, Quantity::length}, Sign::positive);
  if (one.quantity == Quantity::number)
    value.fail("has no unit", "allowed: " + allowed_units({Quantity::angle, Quantity::length}));
  DesignSpec::MinimumDistance& distance = *reading.design.minimum_distance;
  (one.quantity == Quantity::angle ? distance.angle : distance.length) = one.value;
}

Read distance(double DesignSpec::MinimumDistance::*member, Quantity quantity) {
  return [=](const Value& value, DesignReading& reading) {
    auto& stated = reading.design.minimum_distance;
    if (!stated) stated = DesignSpec::MinimumDistance{};
    (*stated).*member = value.number(quantity, Sign::positive);
  };
}

RequirementSpec& requirement_stated_at(const Value& value, DesignReading& reading) {
  RequirementSpec& require = reading.design.require;
  if (require.line == 0) require.line = value.line();
  return require;
}

/// Requirements come from a drawing or contract: 0.1 without a unit would be 0.1 m.
double required_number(const Value& value, Quantity quantity) {
  const Measured number = value.measured({quantity}, Sign::positive);
  if (number.quantity != quantity) value.fail("has no unit", "allowed: " + allowed_units({quantity}));
  return number.value;
}

/// One value for all three axes, or {x: …, z: …}: an axis that is not named may be off.
Read required_axes(int first, Quantity quantity) {
  return [=](const Value& value, DesignReading& reading) {
    std::optional<double>* axes = requirement_stated_at(value, reading).axes.data() + first;
    if (!value.is_mapping()) {
      std::fill(axes, axes + 3, required_number(value, quantity));
      return;
    }
    const Section each(value);
    each.allow({"x", "y", "z"});
    for (const char* name : {"x", "y", "z"}) {
      if (const Value* one = each.find(name)) *axes = required_number(*one, quantity);
      ++axes;
    }
    if (each.entries().empty()) value.fail("is empty", "allowed: x, y, z");
  };
}

RobustSpec& robust_stated_at(const Value& value, DesignReading& reading) {
  auto& robust = reading.design.robust;
  if (!robust) robust.emplace();
  if (robust->line == 0) robust->line = value.line();
  return *robust;
}

void read_draws(const Value& value, DesignReading& reading) {
  robust_stated_at(value, reading).draws = value.integer(least_robust_draws, most_robust_draws);
}

/// A mapping, or the number of robots.
void read_robust(const Value& value, DesignReading& reading) {
  if (value.is_scalar()) return read_draws(value, reading);
  reading.design.robust.reset();
  robust_stated_at(value, reading);
  read_below("design.robust", value, reading, true);
}

void read_robust_measure(const Value& value, DesignReading& reading) {
  const std::optional<RobustAim> aim = robust_aim_of(value.text("a measure is expected"));
  if (!aim) value.fail("is no measure", robust_aims_allowed);
  robust_stated_at(value, reading).aim = *aim;
}

// Words of criteria and methods are those of their registries, in later stages; the schema's writer adds them.
std::vector<DesignKey> make_keys() {
  const DesignSpec standard;
  const RobustSpec robust;
  const auto quoted = [](const std::string& word) { return '"' + word + '"'; };
  const std::vector<std::string_view> scalings{"tolerance", "norm", "none"}, priors{"none", "tolerance"};
  return {
      {"design.variant", "variant", "V", name_schema, "", "The variant that is planned for (default: the first).",
       variant_name(&DesignSpec::variant)},
      {"design.truth", "truth", "V", name_schema, "",
       "Variant that may be the case while the planned one is fitted: criteria discriminate and bias.",
       variant_name(&DesignSpec::truth)},
      {"design.variants", "", "",
       R"("anyOf": [{"type": "array", "items": {"type": ["string", "number"]}, )"
       R"("minItems": 1, "uniqueItems": true}, {"type": "object", "minProperties": 1, )"
       R"("additionalProperties": {"type": "number", "exclusiveMinimum": 0}}])",
       "", "Variants of the criteria compound and maximin: a list or {NAME: weight} (default: all).", read_several},
      {"design.criterion", "criterion", "NAME", R"("type": "string")", quoted(standard.criterion.value),
       "Criterion to maximise.", located_text(&DesignSpec::criterion)},
      {"design.method", "method", "NAME", R"("type": "string")", quoted(standard.method.value), "The planner.",
       located_text(&DesignSpec::method)},
      {"design.poses", "poses", "N|auto",
       fmt::format(R"("anyOf": [{{{}}}, {{"const": "auto"}}])", whole_schema(1, most_stated_poses)), "",
       "Number of poses; auto, not for compare: the smallest number that meets the requirements.", read_poses},
      {"design.require", "", "", R"("type": "object", "minProperties": 1)", "",
       "Requirements for poses: auto (95 % at every test pose) and for a calibration.",
       [](const Value& value, DesignReading& reading) {
         reading.design.require = {};
         reading.design.require.line = value.line();
         read_below("design.require", value, reading);
       }},
      {"design.require.accuracy", "", "", reference("length_with_unit"), "",
       "Predicted error at the test poses, root mean square.",
       [](const Value& value, DesignReading& reading) {
         requirement_stated_at(value, reading).accuracy = required_number(value, Quantity::length);
       }},
      {"design.require.position", "", "", reference("required_lengths"), "", "Error along each axis.",
       required_axes(0, Quantity::length)},
      {"design.require.rotation", "", "", reference("required_angles"), "", "Error about each axis.",
       required_axes(3, Quantity::angle)},
      {"design.require.sigma", "", "",
       R"("type": "object", "additionalProperties": {"$ref": "#/$defs/parameter_value_positive"})", "",
       "{glob: 1σ} of parameters.",
       [](const Value& value, DesignReading& reading) {
         requirement_stated_at(value, reading).sigma = read_pattern_values(value, Sign::positive);
       }},
      {"design.candidates", "candidates", "n", whole_schema(1, most_candidates),
       std::to_string(standard.candidates.value), "Feasible configurations to choose from.", read_candidates},
      {"design.candidates_from", "candidates-from", "FILE", file_schema, "",
       "A list to choose from in place of drawn candidates (CSV, plan.json, measured data).", read_candidates_from,
       true},
      {"design.restarts", "restarts", "k", whole_schema(1, most_restarts), std::to_string(standard.restarts.value),
       "Starts of the search.",
       [](const Value& value, DesignReading& reading) {
         reading.design.restarts = {value.integer(1, most_restarts), value.line()};
       }},
      {"design.repeats", "repeats", "allow|forbid|k",
       R"("anyOf": [{"enum": ["forbid", "allow"]}, {"type": "integer", "minimum": 1, "maximum": 1000000}])",
       quoted(repeats_text(standard.repeats)), "Largest number of visits of one configuration, or allow or forbid.",
       read_repeats},
      {"design.minimum_distance", "", "",
       R"("anyOf": [{"$ref": "#/$defs/angle_with_unit"}, {"$ref": "#/$defs/length_with_unit"}, )"
       R"({"type": "object", "minProperties": 1}])",
       "",
       "Two poses differ by this much in at least one coordinate; other load cases and stations are other poses. "
       "Without it, where candidates are drawn and poses may not repeat: 5 deg or a fiftieth of the range, whichever "
       "is less, halved until enough candidates keep it.",
       read_minimum_distance},
      {"design.minimum_distance.angle", "", "", reference("angle_positive"), "", "Distance of revolute coordinates.",
       distance(&DesignSpec::MinimumDistance::angle, Quantity::angle)},
      {"design.minimum_distance.length", "", "", reference("length_positive"), "", "Distance of prismatic coordinates.",
       distance(&DesignSpec::MinimumDistance::length, Quantity::length)},
      {"design.scaling", "scaling", "tolerance|norm|none", word_schema(scalings),
       quoted(scaling_text(standard.scaling)), "Units of the columns for o2 to o5 and a.",
       [=](const Value& value, DesignReading& reading) {
         reading.design.scaling = *scaling_of(value.choice(scalings));
       }},
      {"design.prior", "prior", "none|tolerance", word_schema(priors), quoted("none"),
       "Use of tolerances as prior knowledge.",
       [=](const Value& value, DesignReading& reading) { reading.design.prior = value.choice(priors) == "tolerance"; }},
      {"design.reserve", "reserve", "", reference("flag"), "false", "Optimise for the loss of the worst single pose.",
       [](const Value& value, DesignReading& reading) { reading.design.reserve = value.flag(); }},
      {"design.robust", "robust", "K",
       fmt::format(R"("anyOf": [{{{}}}, {{"type": "object"}}])", whole_schema(least_robust_draws, most_robust_draws)),
       "",
       "The plan that is best over robots drawn from the tolerances (so many), not for the nominal one alone. With "
       "criterion o1 or ds.",
       read_robust},
      {"design.robust.draws", "", "", whole_schema(least_robust_draws, most_robust_draws), std::to_string(robust.draws),
       "Robots that are drawn.", read_draws},
      {"design.robust.measure", "robust-measure", "M",
       R"("type": "string", "pattern": "^(mean|worst|tail( +0?\\.[0-9]+)?)$")", quoted(robust_aim_text(robust.aim)),
       "Summary of their efficiencies: `mean`, `worst`, or `tail 0.1`, the mean over the worst tenth.",
       read_robust_measure},
      {"design.measured", "augment", "POSES", file_schema, "",
       "Poses that are measured already (CSV or plan.json); the planned ones come to them.",
       file(&DesignSpec::measured), true},
      {"design.fixed", "fixed", "POSES", file_schema, "",
       "Poses that every plan has among its own (CSV or plan.json; of a list with a column fixed, those with yes). For "
       "plan alone.",
       file(&DesignSpec::fixed), true},
      {"design.test_poses", "", "", reference("test_poses"), "", "Poses for the predicted accuracy after calibration.",
       [](const Value& value, DesignReading& reading) {
         reading.design.test_poses = read_test_poses(value, reading.folder);
       }},
  };
}

}  // namespace

const std::vector<DesignKey>& design_keys() {
  static const std::vector<DesignKey> keys = make_keys();
  return keys;
}

const DesignKey& design_key(const std::string& path) {
  std::vector<std::string> paths;
  for (const DesignKey& key : design_keys()) {
    if (key.path == path) return key;
    paths.push_back(key.path);
  }
  throw InputError({}, "'" + path.substr(0, 60) + "' is no key that can be set" + meant_instead(path, paths),
                   fmt::format("allowed: {}", fmt::join(paths, ", ")));
}

DesignSpec read_design(const Value& value, const std::vector<VariantSpec>& variants,
                       const std::filesystem::path& folder) {
  DesignSpec design;
  design.line = value.line();
  DesignReading reading{design, variants, folder};
  read_below("design", value, reading, true);
  return design;
}

void set(Problem& problem, const std::string& path, const std::string& value, const std::string& said_by) {
  const DesignKey& key = design_key(path);
  const std::string no_file;
  const std::filesystem::path here;
  problem.changed.push_back({path, value, said_by});
  const bool flow = value.starts_with('{') || value.starts_with('[');
  const YAML::Node node = flow ? yaml::load_document(value, said_by) : YAML::Node(value);
  DesignReading reading{problem.design, problem.variants, here};
  key.read(Value(node, -int(problem.changed.size()), said_by, no_file), reading);
}

void set_design(Problem& problem, const KeyEdits& edits) {
  for (const KeyEdit& edit : edits)
    if (is_of_design(edit)) set(problem, edit.key, edit.value, "--set " + edit.key);
}

bool is_of_design(const KeyEdit& edit) { return edit.key == "design" || edit.key.starts_with("design."); }

}  // namespace posewright
