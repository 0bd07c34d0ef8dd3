#include "sections.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

constexpr int most_grid_points = 100000;

void read_list(const Section& section, const Value& at, TestPosesSpec& spec) {
  for (const Value& pose : at.items("a list of configurations is expected")) {
    spec.at.emplace_back();
    for (const Value& number : pose.items("a list of numbers is expected"))
      spec.at.back().push_back(number.measured({Quantity::angle, Quantity::length}));
  }
  if (spec.at.empty()) at.fail("is empty", "at least one configuration is needed");
  if (const Value* weights = section.find("weights"))
    for (const Value& weight : weights->items(spec.at.size(), "one weight for each configuration is expected"))
      spec.weights.push_back(weight.number(Quantity::number, Sign::positive));
}

TestPosesSpec::Grid read_grid(const Value& value) {
  const Section section(value);
  section.allow({"lower", "upper", "counts"});
  TestPosesSpec::Grid grid;
  grid.lower = section.at("lower").vector(Quantity::length);
  grid.upper = section.at("upper").vector(Quantity::length);
  if ((grid.upper - grid.lower).minCoeff() < 0) value.fail("has an upper corner below its lower one", "lower ≤ upper");
  const std::vector<Value> counts = section.at("counts").items(3, "three numbers of points are expected");
  for (std::size_t k = 0; k < 3; ++k) grid.counts[k] = counts[k].integer(1, 1000);
  if (long(grid.counts[0]) * grid.counts[1] * grid.counts[2] > most_grid_points)
    value.fail("has too many points", "at most 100000");
  return grid;
}

}  // namespace

TestPosesSpec read_test_poses(const Value& value, const std::filesystem::path& folder) {
  const Section section(value);
  section.allow({"at", "random", "file", "grid", "weights", "point", "load_case"});
  TestPosesSpec spec;
  spec.line = value.line();
  int ways = 0;
  for (const char* way : {"at", "random", "file", "grid"}) ways += section.has(way) ? 1 : 0;
  if (ways != 1) value.fail("needs one of at, random, file, grid", "configurations, a number, a CSV file or a box");
  if (const Value* weights = section.find("weights"); weights != nullptr && !section.has("at"))
    weights->fail("is for a list of configurations", "in a file, a column 'weight'");
  if (const Value* random = section.find("random")) spec.random = random->integer(1, most_grid_points);
  if (const Value* at = section.find("at")) read_list(section, *at, spec);
  if (const Value* file = section.find("file")) spec.file = file->file(folder);
  if (const Value* grid = section.find("grid")) spec.grid = read_grid(*grid);
  if (const Value* point = section.find("point")) spec.point = point->vector(Quantity::length);
  if (const Value* load = section.find("load_case")) spec.load_case = load->located_text();
  return spec;
}

}  // namespace posewright
