// Pose lists, plans, routes and settings that are wrong or damaged.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "posewright/results/plan.hpp"
#include "posewright/results/route.hpp"
#include "posewright/support/error.hpp"
#include "tests/formats/sequences.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/mutate.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

struct DamagedList {
  const char* format;
  std::string text, message;
};

TEST(PoseLists, BadListsNameTheLineAndWhatIsAllowed) {
  for (const DamagedList& bad : std::vector<DamagedList>{
           {"robot-calibration", "- joints: [a, b]\n  positions: [1]\n",
            "f:2: positions has 1 numbers; 2 joints are named"},
           {"robot-calibration", "- joints: [a]\n  positions: [1]\n- joints: [c]\n  positions: [1]\n",
            "f:3: has other joints"},
           {"robot-calibration", "a: 1\n", "f:1: the file is not a list"},
           {"robot-calibration", "", "the file is not a list"},
           {"figaroh", "calibration_joint_names: [a]\n", "f:1: has no 'calibration_joint_configurations'"},
           {"moveit", "joint_names: [a]\njoint_values: [[x]]\n", "f:2: joint_values: 'x' is not a number"},
           {"moveit", "joint_names: [a]\njoint_values: [[.nan]]\n", "is not a number; a finite number"},
           {"industrial-calibration", "a: {camera_joints: [], target_joints: []}\n",
            "joints of both camera and target, or of none"},
           {"joint-trajectory", "joint_names: [a]\npoints: [{positions: [1, 2]}]\n",
            "f:2: positions has 2 numbers; 1 joints"},
           {"srdf",
            "<robot><group_state name=\"a\" group=\"g\"><joint name=\"a\" value=\"1,5\"/></group_state></robot>",
            "f:1: joint without"},
           {"srdf", "<robot name=\"a\"/>", "has no <group_state>"},
           {"srdf", "<robot", "is not valid XML"},
           {"pybotics-npy", "abc", "is not a .npy array"},
           {"pybotics-csv", "1,2,3\n", "f:1: has 3 numbers; joints, then the 16 numbers of a pose"},
           {"delmia", "t\t1\t2\n", "f:1: has 2 numbers; tag, X, Y, Z"},
           {"robodk-csv", "J1,J2\n1,2\n1\n", "f:3: has 1 numbers; the rows before have 2"},
           {"robodk-csv", "1,2\n1,a\n", "f:2: 'a' is not a number"},
           {"robodk-csv", "\n", "f: has no poses"},
           {"csv", "# of a table\nid;a [deg]\n1;2,5\n", "f:2: has semicolons between its cells; commas between cells"},
           {"csv", "id\ta\n1\t2\n", "f:1: has tabs between its cells"},
           {"csv", "a,b\n1\n", "f:2: has 1 cells; the header has 2"},
           {"json", "{\"schema\": \"posewright/plan/9\", \"poses\": []}",
            "has schema 'posewright/plan/9'; allowed: posewright/plan/1"},
           {"json", "[", "is not a plan"},
       }) {
    EXPECT_THAT(message_of<InputError>([&] { find_pose_format(bad.format).read(bad.text, "f"); }),
                HasSubstr(bad.message))
        << bad.format;
  }
  EXPECT_THROW(find_pose_format("excel"), InputError);
  EXPECT_THROW(find_readable_format("kuka-krl"), InputError);
}

int case_count() {
  const char* text = std::getenv("POSEWRIGHT_FUZZ_CASES");
  return text == nullptr ? 2000 : std::atoi(text);
}

template <class Parse>
void sweep(const std::string& name, const std::string& good, const Parse& parse) {
  int accepted = 0;
  for (int i = 0; i < case_count(); ++i) {
    Random random(17, std::uint64_t(i));
    const std::string text = mutated(good, random);
    try {
      parse(text);
      ++accepted;
    } catch (const InputError& error) {
      const std::string what = error.what();
      ASSERT_TRUE(what.starts_with("fuzz")) << name << ": " << what << "\ncase " << i;
      ASSERT_EQ(what.find('\n'), what.npos) << name << ": " << what << "\ncase " << i;
      ASSERT_LE(error.place().line, std::count(text.begin(), text.end(), '\n') + 1) << name << ": " << what;
    } catch (const std::exception& error) {
      FAIL() << name << " case " << i << ": " << error.what() << "\n" << text;
    }
  }
  EXPECT_GT(accepted, 0) << name;
  EXPECT_LT(accepted, case_count()) << name;
}

TEST(FuzzPoseLists, MutatedListsAreReadOrGiveOneLineThatStartsWithTheFile) {
  for (const PoseFormat& format : pose_formats())
    if (format.read != nullptr)
      sweep(format.name, text_in(format.name, random_sequence(3, 4, 1)), [&](const std::string& text) {
        for (const PoseRow& row : format.read(text, "fuzz").rows) ASSERT_FALSE(row.cells.empty());
      });
}

TEST(FuzzPoseLists, MutatedRoutesPlansAndSettingsAreReadOrGiveOneLineThatStartsWithTheFile) {
  Plan plan;
  Route route;
  const PoseSequence sequence = random_route(3, 3, 2);
  for (const SequencePose& pose : sequence.poses) {
    PlannedPose planned;
    planned.id = pose.id;
    planned.tool_pose = pose.tool_pose;
    for (std::size_t i = 0; i < 3; ++i) planned.configuration.push_back({sequence.names[i], "rad", pose.values[i]});
    plan.poses.push_back(planned);
    route.poses.push_back(planned);
  }
  route.names = sequence.names;
  route.units = sequence.units;
  route.home = sequence.home;
  route.closed = route.from_home = true;
  for (const SequenceMotion& m : sequence.motions)
    route.motions.push_back({m.from, m.to, m.points, m.seconds, 0, "straight"});
  for (const std::string& text : {plan_json(plan), route_json(route)})
    sweep("sequence", text, [](const std::string& mutant) {
      const PoseSequence read = parse_sequence(mutant, "fuzz.json");
      ExportOptions options;
      options.coupling = 1;
      for (const char* name : {"csv", "joint-trajectory", "json"}) try {
          find_pose_format(name).write(read, options);
        } catch (const CannotDo&) {
        }
    });
  sweep("settings",
        "sign: [1, -1, 1]\nzero_deg: [0, 90.5, -90]\npulses_per_degree: [1, 2, 3]\ncoupling: 1\naxes: [A1, "
        "A2]\ndecimals: 5\npivot_mm: [1, 2, 3]\n",
        [](const std::string& text) { parse_controller_settings(text, "fuzz.yaml"); });
}

}  // namespace
}  // namespace posewright
