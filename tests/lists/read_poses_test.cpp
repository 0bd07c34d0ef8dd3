// Names and units of pose lists put to the coordinates of a problem.

#include "posewright/lists/read_poses.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "posewright/support/error.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

std::vector<Coordinate> arm() { return {{"a1", "rad", -3, 3}, {"rail", "m", -1, 1}, {"a2", "rad", -3, 3}}; }

class ReadPoses : public testing::Test {
 protected:
  PoseList read(const std::string& text, const std::string& format = "",
                const std::vector<Coordinate>& coordinates = arm()) {
    return read_poses(folder_.write("list", text), coordinates, format);
  }
  std::string error(const std::string& text, const std::string& format = "",
                    const std::vector<Coordinate>& coordinates = arm()) {
    return message_of<InputError>([&] { read(text, format, coordinates); }, "accepted");
  }
  TemporaryFolder folder_;
};

TEST_F(ReadPoses, MeetListedPositionsWithinTheirDigits) {
  Coordinate listed{"a1", "rad", -3, 3};
  listed.values = {-1.5, 0.5};
  EXPECT_EQ(read("a1 [deg]\n-85.9437\n28.6479\n", "", {listed}).configurations,
            (std::vector<std::vector<double>>{{-1.5}, {0.5}}));
  // Another place stays what it is: the workspace says what it thinks of it.
  EXPECT_EQ(read("a1 [deg]\n-85.9\n", "", {listed}).configurations.front().front(), -85.9 * std::numbers::pi / 180);
}

TEST_F(ReadPoses, NamesGoToTheirCoordinatesInAnyOrder) {
  const PoseList list =
      read("- joints: [a2, gripper, rail, a1]\n  positions: [0.25, 9, 0.5, -1]\n", "robot-calibration");
  EXPECT_EQ(list.configurations, (std::vector<std::vector<double>>{{-1, 0.5, 0.25}}));
  EXPECT_TRUE(list.notes.empty());
  EXPECT_THAT(error("- {joints: [a1, a2], positions: [0, 0]}\n", "robot-calibration"),
              HasSubstr("has no column 'rail'"));
}

TEST_F(ReadPoses, ListsWithoutNamesGoByOrderAndSaySo) {
  const PoseList list = read("90,500,-45\n0,1,2\n", "robodk-csv");
  const double right = std::numbers::pi / 2;
  ASSERT_EQ(list.configurations.size(), 2U);
  EXPECT_DOUBLE_EQ(list.configurations[0][0], right);
  EXPECT_DOUBLE_EQ(list.configurations[0][1], 0.5) << "millimetres of what slides";
  EXPECT_DOUBLE_EQ(list.configurations[0][2], -right / 2);
  ASSERT_EQ(list.notes.size(), 1U);
  EXPECT_THAT(list.notes[0], HasSubstr("names no joints: its columns are taken as a1, rail, a2"));
  EXPECT_THAT(error("1,2\n", "robodk-csv"), HasSubstr("list:1: has 2 numbers a pose; 3 in this order: a1, rail, a2"));
}

TEST_F(ReadPoses, LimitsHoldForEveryFormat) {
  EXPECT_THAT(error("a1,rail,a2\n4,0,0\n"), HasSubstr("list:2: 'a1' is 4 rad; allowed: -3 to 3 rad"));
  EXPECT_THAT(error("a1 [deg],rail [mm],a2\n1,2000,0\n"), HasSubstr("list:2: 'rail' is 2 m"));
  EXPECT_EQ(read("a1,rail,a2\n3.0000001,0,0\n").configurations[0][0], 3.0) << "a hair beyond is the limit";
}

TEST_F(ReadPoses, StationsNeedAFormatThatNamesThem) {
  std::vector<Coordinate> coordinates = arm();
  coordinates.push_back(make_choice("station", {"A", "B"}));
  EXPECT_THAT(error("1,0,1\n", "robodk-csv", coordinates), HasSubstr("has no place for the station of a pose"));
  const std::string json =
      R"({"schema": "posewright/poses/1", "names": ["a1", "rail", "a2"], "units": ["rad", "m", "rad"],)"
      R"( "poses": [{"id": 7, "values": [1, 0.5, 2], "station": "B"}]})";
  const PoseList list = read(json, "", coordinates);
  EXPECT_EQ(list.configurations[0], (std::vector<double>{1, 0.5, 2, 1}));
  EXPECT_EQ(list.ids, std::vector<int>{7});
  coordinates.back() = make_choice("station", {"A"});
  EXPECT_EQ(read("1,0,1\n", "robodk-csv", coordinates).configurations[0].size(), 4U) << "one station needs no column";
  EXPECT_THAT(error(json, "", coordinates), HasSubstr("'B' is no station; allowed: A"));
}

}  // namespace
}  // namespace posewright
