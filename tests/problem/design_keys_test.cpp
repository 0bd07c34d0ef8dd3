#include "posewright/problem/design_keys.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "example_files.hpp"
#include "posewright/problem/read_problem.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

Problem problem_with(const std::string& design = "") {
  std::string text = example::serial;
  if (!design.empty()) text = text.substr(0, text.find("\ndesign:")) + "\ndesign: " + design + "\n";
  return parse_problem(text, "arm.yaml");
}

std::string refusal_of(const std::string& path, const std::string& value, const std::string& said_by) {
  Problem problem = problem_with();
  try {
    set(problem, path, value, said_by);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(DesignKeys, SetWhatAFileSets) {
  const Problem file = problem_with(
      "{poses: 7, repeats: 2, minimum_distance: {angle: 5 deg}, robust: {draws: 20, measure: worst}, "
      "require: {accuracy: 0.1 mm, rotation: {z: 1 mrad}}, reserve: yes, scaling: norm}");
  Problem edited = problem_with("{poses: 9}");
  const std::pair<const char*, const char*> edits[] = {{"design.poses", "7"},
                                                       {"design.repeats", "2"},
                                                       {"design.minimum_distance", "5 deg"},
                                                       {"design.robust", "20"},
                                                       {"design.robust.measure", "worst"},
                                                       {"design.require.accuracy", "0.1 mm"},
                                                       {"design.require.rotation", "{z: 1 mrad}"},
                                                       {"design.reserve", "yes"},
                                                       {"design.scaling", "norm"}};
  for (const auto& [path, value] : edits) set(edited, path, value, path);
  const DesignSpec &a = file.design, &b = edited.design;
  EXPECT_EQ(a.poses->value, b.poses->value);
  EXPECT_EQ(a.repeats, b.repeats);
  EXPECT_EQ(a.minimum_distance->angle, b.minimum_distance->angle);
  EXPECT_EQ(a.robust->draws, b.robust->draws);
  EXPECT_EQ(a.robust->aim, b.robust->aim);
  EXPECT_EQ(a.require.accuracy, b.require.accuracy);
  EXPECT_EQ(a.require.axes, b.require.axes);
  EXPECT_EQ(a.reserve, b.reserve);
  EXPECT_EQ(a.scaling, b.scaling);
}

TEST(DesignKeys, NameTheOptionInWhatIsSaidOfTheirValues) {
  EXPECT_THAT(refusal_of("design.poses", "x", "--poses"),
              HasSubstr("--poses is 'x'; a whole number from 1 to 1000000"));
  EXPECT_THAT(refusal_of("design.variant", "none", "--variant"), HasSubstr("--variant is 'none'; allowed: geometric"));
  EXPECT_THAT(refusal_of("design.require.accuracy", "0.1", "--set"), HasSubstr("--set has no unit"));
  EXPECT_THAT(refusal_of("design.robust", "{drawn: 3}", "--set"), HasSubstr("--set: unknown key 'drawn'"));
  EXPECT_THAT(refusal_of("design.pose", "3", "--set"), HasSubstr("did you mean 'design.poses'?"));
  EXPECT_THAT(refusal_of("design.require", "[", "--set"), HasSubstr("is not valid YAML"));
  Problem problem = problem_with();
  set(problem, "design.poses", "3", "--poses");
  set(problem, "design.criterion", "a", "--criterion");
  EXPECT_EQ(problem.at(problem.design.poses->line).file, "--poses");
  EXPECT_EQ(problem.at(problem.design.criterion.line).file, "--criterion");
  EXPECT_EQ(problem.at(12).file, "arm.yaml");
}

TEST(DesignKeys, OfAnOptionReplaceThoseOfTheFileThatTheyExclude) {
  Problem problem = problem_with("{poses: 9, candidates_from: taught.csv}");
  set(problem, "design.candidates", "50", "--candidates");
  EXPECT_FALSE(problem.design.candidates_from.has_value());
  EXPECT_THROW(set(problem, "design.candidates_from", "a.csv", "--candidates-from"), InputError) << "both are options";
  Problem drawn = problem_with("{poses: auto, candidates: 50}");
  set(drawn, "design.candidates_from", "a.csv", "--candidates-from");
  EXPECT_EQ(drawn.design.candidates_from->value, "a.csv") << "relative to the working directory";
  set(drawn, "design.poses", "9", "--poses");
  EXPECT_FALSE(drawn.design.smallest);
  EXPECT_THROW(problem_with("{candidates: 50, candidates_from: a.csv}"), InputError);
}

TEST(DesignKeys, HaveUniquePathsAndOptionsAndASentence) {
  std::vector<std::string> paths, options;
  for (const DesignKey& key : design_keys()) {
    paths.push_back(key.path);
    if (!key.option.empty()) options.push_back(key.option);
    EXPECT_TRUE(key.help.ends_with('.')) << key.path;
    EXPECT_NO_THROW(design_key(key.path));
  }
  for (auto* names : {&paths, &options}) {
    std::sort(names->begin(), names->end());
    EXPECT_EQ(std::adjacent_find(names->begin(), names->end()), names->end());
  }
}

}  // namespace
}  // namespace posewright
