// Controllers that posewright knows by name.

#include "posewright/controller/known_controllers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <numbers>
#include <set>

#include "posewright/formats/pose_formats.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "program_readers.hpp"
#include "sequences.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/run_program.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path source = POSEWRIGHT_SOURCE_DIR;

TEST(KnownControllers, AreTheFilesOfTheFolderAndEachSaysWhereItIsFrom) {
  const std::string sources = read_file(source / "controllers/README.md");
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(source / "controllers")) {
    if (entry.path().extension() != ".yaml") continue;
    std::string name = entry.path().stem().string();
    std::replace(name.begin(), name.end(), '_', '-');
    EXPECT_THAT(sources, HasSubstr("| " + name + " |"));
    // By name and by file they are the same.
    const ControllerSettings named = controller_settings(name), read = controller_settings(entry.path().string());
    EXPECT_EQ(named.range_deg, read.range_deg);
    EXPECT_EQ(named.coupling, read.coupling);
    EXPECT_EQ(named.axes.size(), 6U) << name << ": plans of other robots would not be refused";
    EXPECT_TRUE(named.path.empty());
    EXPECT_EQ(read.path, entry.path());
    files.insert(name);
  }
  const std::vector<std::string> known = known_controllers();
  EXPECT_EQ(std::set<std::string>(known.begin(), known.end()), files);
}

PoseSequence arm(const std::vector<double>& q) {
  PoseSequence sequence = random_sequence(int(q.size()), 2, 1);
  for (SequencePose& pose : sequence.poses) pose.values = q;
  return sequence;
}

TEST(KnownControllers, AxesOfProgramsAreThoseThatTheMakerCounts) {
  // What the sources say in words: FANUC's third axis is J3 - J2, a parallelogram's J3 + J2, all others as the URDF.
  struct Case {
    const char *name, *format;
    double coupling, unit;
    std::function<readers::Program(const Exported&)> read;
  };
  const double degree = std::numbers::pi / 180;
  const auto first = [](const Exported& exported) { return exported.files[0].bytes; };
  const std::vector<Case> cases = {
      {"fanuc-m10ia", "fanuc-tp", 1, degree, [&](const Exported& e) { return readers::read_tp(first(e)); }},
      {"abb-irb120", "abb-rapid", 0, degree, [&](const Exported& e) { return readers::read_rapid(first(e)); }},
      {"abb-irb2400", "abb-rapid", -1, degree, [&](const Exported& e) { return readers::read_rapid(first(e)); }},
      {"kuka-kr-c4", "kuka-krl", 0, degree,
       [&](const Exported& e) { return readers::read_krl(e.files[0].bytes, e.files[1].bytes, "CALPOSES"); }},
      {"universal-robots", "urscript", 0, 1, [&](const Exported& e) { return readers::read_urscript(first(e)); }}};
  const std::vector<double> q = {0.1, -0.2, 0.3, 0.4, -0.5, 0.6};
  for (const Case& each : cases) {
    ExportOptions options;
    options.controller = controller_settings(each.name);
    const Exported exported = export_poses(find_pose_format(each.format), arm(q), options);
    for (const std::string& note : exported.notes)
      EXPECT_EQ(note.find("signs and zeros are taken"), std::string::npos) << each.name;
    const std::vector<double> axes = each.read(exported).moves.front();
    std::vector<double> expected = q;
    expected[2] -= each.coupling * q[1];
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(axes[i] * each.unit, expected[i], 2e-6) << each.name << i;
    // A third axis beyond the range that the maker states is refused, and by whom is told.
    if (options.controller.range_deg.empty()) continue;
    std::vector<double> beyond = q;
    beyond[2] = expected[2] = options.controller.range_deg[2][1] * degree + each.coupling * q[1] + 0.02;
    EXPECT_THAT(message_of<CannotDo>([&] { export_poses(find_pose_format(each.format), arm(beyond), options); }),
                HasSubstr(std::string(each.name) + " allows"));
  }
}

TEST(KnownControllers, RefuseOtherRobotsAndNamesThatNobodyKnows) {
  ExportOptions options;
  for (const std::string& name : known_controllers()) {
    options.controller = controller_settings(name);
    const char* format = name.starts_with("abb")     ? "abb-rapid"
                         : name.starts_with("fanuc") ? "fanuc-tp"
                         : name.starts_with("kuka")  ? "kuka-krl"
                                                     : "urscript";
    try {
      export_poses(find_pose_format(format), arm({0, 0, 0, 0, 0, 0, 0}), options);
      ADD_FAILURE() << name;
    } catch (const InputError& error) {  // exit 2
      EXPECT_THAT(error.what(), HasSubstr(name + ":2: axes has 6 names; the plan has 7 joints"));
    }
  }
  const TemporaryFolder folder;
  const ProgramRun unknown =
      run_program(folder.path(), {"export", (source / "tests/formats/golden/plan.json").string(), "--to", "kuka-krl",
                                  "--controller", "kuka-kr-c9", "--unchecked"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err,
              HasSubstr("is neither a file nor a known one (did you mean 'kuka-kr-c4'?); known: abb-irb120, "));
  EXPECT_EQ(folder.count_files(), 0U);
}

TEST(KnownControllers, GiveTheirRangesToAWorkspace) {
  const TemporaryFolder folder;
  fs::copy_file(source / "examples/kr270/kr270.urdf", folder / "kr270.urdf");
  const auto problem = [&](const std::string& controller) {
    std::string text = read_file(source / "examples/kr270/problem.yaml");
    return folder.write("p.yaml", text + "\nworkspace: {joints: {controller: " + controller + "}}\n");
  };
  EXPECT_EQ(read_problem(problem("abb-irb2400")).workspace.controller->range_deg[2], (std::array<double, 2>{-60, 65}));
  try {
    read_problem(problem("abb"));
    ADD_FAILURE() << "read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is 'abb', neither a file nor a known controller; known: abb-irb120"));
    EXPECT_GT(error.place().line, 0);
  }
}

}  // namespace
}  // namespace posewright
