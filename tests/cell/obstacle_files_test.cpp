#include "src/cell/obstacle_files.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>

#include "posewright/cell/cell.hpp"
#include "posewright/cell/collision.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"
#include "src/cell/mesh_file.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const char* const one_link_arm = R"(<robot name="arm"><link name="base"/>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <joint name="j1" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint></robot>)";

struct FilesOfObstacles {
  TemporaryFolder folder;

  Problem problem(const std::string& obstacles) {
    folder.write("arm.urdf", one_link_arm);
    return read_problem(
        folder.write("p.yaml",
                     "posewright: 1\nrobot: {urdf: arm.urdf}\n"
                     "measurement: {type: position, target: [0.1, 0, 0], device: {type: isotropic, noise: 0.1 mm}}\n"
                     "variants: {all: {parameters: auto}}\nworkspace:\n  collision:\n    obstacles: " +
                         obstacles + "\n"));
  }

  std::vector<PlacedShape> shapes(const std::string& name, const std::string& text, const std::string& more = "") {
    folder.write(name, text);
    const Problem p = problem(fmt::format("[{{file: {}{}}}]", name, more));
    return read_obstacle_file(p.workspace.collision->obstacle_files.front(), p);
  }

  std::string refusal(const std::string& name, const std::string& text, const std::string& more = "") {
    try {
      shapes(name, text, more);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was refused";
  }
};

// A table whose top is at z = 0.8, turned by 90 degrees about z, and a post of 0.1 m; written in four ways.
const char* const as_sdf = R"(<?xml version="1.0"?>
<sdf version="1.9"><world name="cell">
  <frame name="corner"><pose>1 2 0 0 0 1.5707963267948966</pose></frame>
  <model name="table"><static>true</static><pose relative_to="corner">0.5 0 0.8 0 0 0</pose>
    <link name="top"><collision name="c"><pose>0 0 -0.05 0 0 0</pose>
      <geometry><box><size>2 1 0.1</size></box></geometry></collision></link>
  </model>
  <model name="fence"><static>true</static>
    <link name="near"><pose>0 -1 0.5 0 0 0</pose><collision name="c">
      <geometry><cylinder><radius>0.05</radius><length>1</length></cylinder></geometry></collision></link>
    <link name="far"><pose degrees="true" relative_to="near">0 0 0 0 90 0</pose><collision name="c">
      <geometry><capsule><radius>0.02</radius><length>0.4</length></capsule></geometry></collision></link>
  </model>
  <model name="robot"><link name="hand"><collision name="c">
      <geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link></model>
</world></sdf>)";

const char* const as_moveit = R"((noname)+
* table
0.99999999999999989 2.5 0.8
0 0 0.70710678118654757 0.70710678118654757
1
box
2 1 0.1
0 0 -0.05
0 0 0 1
0 0 0 0
1
corner
1 0 0
0 0 0 1
* floor
0 0 0
0 0 0 1
1
plane
0 0 2 1
0 0 0
0 0 0 1
0 0 0 0
0
* wedge
0 0 1
0 0 0 1
1
mesh
4 4
0 0 0
1 0 0
0 1 0
0 0 1
0 2 1
0 1 3
0 3 2
1 2 3
0.5 0 0
0 0 0 1
0 0 0 0
0
.
)";

const PlacedShape& named(const std::vector<PlacedShape>& shapes, const std::string& name) {
  for (const PlacedShape& shape : shapes)
    if (shape.name == name) return shape;
  throw std::runtime_error(name + " is missing");
}

/// By hand: 90 degrees about z at (1, 2), then 0.5 along the turned x, which is y.
void expect_table(const PlacedShape& table) {
  EXPECT_TRUE(std::get<BoxShape>(table.shape).size.isApprox(Eigen::Vector3d(2, 1, 0.1)));
  EXPECT_LT((table.X.translation() - Eigen::Vector3d(1, 2.5, 0.75)).norm(), 1e-12);
  EXPECT_LT((table.X.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(ObstacleFiles, FramesAndLinksOfAnSdfWorldAreWhereTheyAreByHand) {
  FilesOfObstacles files;
  const std::vector<PlacedShape> shapes = files.shapes("cell.sdf", as_sdf, ", except: [robot]");
  EXPECT_THAT(files.refusal("cell.sdf", as_sdf, ", except: [robto]"),
              HasSubstr("'robto' is not in cell.sdf; allowed: "));
  expect_table(named(shapes, "table"));
  const PlacedShape& near = named(shapes, "fence::near");
  EXPECT_DOUBLE_EQ(std::get<CylinderShape>(near.shape).radius, 0.05);
  EXPECT_LT((near.X.translation() - Eigen::Vector3d(0, -1, 0.5)).norm(), 1e-12);
  // The capsule lies along x: its ends are spheres at x = ±0.2.
  std::vector<double> ends;
  for (const PlacedShape& s : shapes)
    if (s.name == "fence::far" && std::holds_alternative<SphereShape>(s.shape)) ends.push_back(s.X.translation().x());
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_NEAR(std::min(ends[0], ends[1]), -0.2, 1e-12);
  EXPECT_NEAR(std::max(ends[0], ends[1]), 0.2, 1e-12);
  for (const PlacedShape& s : shapes) EXPECT_NE(s.name, "robot");
}

TEST(ObstacleFiles, AMoveitSceneIsReadWithPosesOfObjectsAndWithout) {
  FilesOfObstacles files;
  const std::vector<PlacedShape> shapes = files.shapes("cell.scene", as_moveit);
  ASSERT_EQ(shapes.size(), 3U);
  expect_table(named(shapes, "table"));
  // 2 z + 1 = 0: half a metre below.
  EXPECT_NEAR(named(shapes, "floor").X.translation().z(), -0.5, 1e-12);
  const auto wedge = std::get<std::shared_ptr<const TrianglesShape>>(named(shapes, "wedge").shape);
  EXPECT_EQ(wedge->triangles.size(), 4U);
  EXPECT_LT((named(shapes, "wedge").X.translation() - Eigen::Vector3d(0.5, 0, 1)).norm(), 1e-12);

  const std::vector<PlacedShape> old = files.shapes("old.scene",
                                                    "(noname)+\n* table\n1\nbox\n2 1 0.1\n1 2.5 0.75\n"
                                                    "0 0 0.70710678118654757 0.70710678118654757\n0 0 0 0\n.\n");
  ASSERT_EQ(old.size(), 1U);
  expect_table(old.front());
}

TEST(ObstacleFiles, AUrdfStandsAtZeroPositionAndWhereItIsPut) {
  FilesOfObstacles files;
  files.folder.write("room.urdf", R"(<robot name="room"><link name="floor"/>
    <link name="door"><collision><origin xyz="0.4 0 1"/><geometry><box size="0.8 0.05 2"/></geometry></collision></link>
    <joint name="hinge" type="revolute"><parent link="floor"/><child link="door"/><origin xyz="1 0 0"/>
      <axis xyz="0 0 1"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>)");
  const Problem p = files.problem("[{file: room.urdf, at: [0, 3, 0], rpy: [0, 0, 90 deg]}]");
  const auto cell = make_cell(p);
  ASSERT_NE(cell->collision, nullptr);
  const std::vector<PlacedShape> shapes = read_obstacle_file(p.workspace.collision->obstacle_files.front(), p);
  ASSERT_EQ(shapes.size(), 1U);
  EXPECT_LT((shapes.front().X.translation() - Eigen::Vector3d(1.4, 0, 1)).norm(), 1e-12);
}

/// Shapes of a file and the same ones written out by hand reject the same configurations, by the same distance.
TEST(ObstacleFiles, ChecksAreThoseOfTheSameShapesWrittenByHand) {
  FilesOfObstacles files;
  files.folder.write("cell.scene",
                     "cell\n* block\n0.5 0.9 0\n0 0 0 1\n1\nbox\n0.2 0.3 0.4\n0 0 0\n0 0 0 1\n0 0 0 0\n0\n.\n");
  const Problem from_file = files.problem("[{file: cell.scene}]");
  const Problem by_hand = files.problem("[{name: block, box: [0.2, 0.3, 0.4], at: [0.5, 0.9, 0]}]");
  const auto a = make_cell(from_file), b = make_cell(by_hand);
  Random random(3, 0);
  int free = 0;
  for (int i = 0; i < 500; ++i) {
    const std::vector<double> q{-3 + 6 * random.uniform()};
    EXPECT_DOUBLE_EQ(a->collision->slack(q, 5), b->collision->slack(q, 5));
    free += a->collision->violation(q) < 0;
  }
  EXPECT_GT(free, 50);
  EXPECT_LT(free, 490);
}

TEST(ObstacleFiles, WhatIsWrongIsNamed) {
  FilesOfObstacles files;
  EXPECT_THAT(files.refusal("cell.step", "x"), HasSubstr(".sdf, .world, .urdf, .scene"));
  EXPECT_THAT(files.refusal("cut.scene", "a\n* b\n1\nbox\n1 1\n"), HasSubstr("an edge"));
  EXPECT_THAT(files.refusal("zero.scene", "a\n* b\n1\nbox\n1 0 1\n0 0 0\n0 0 0 1\n0 0 0 0\n.\n"),
              AllOf(HasSubstr("zero.scene:5"), HasSubstr("above zero")));
  EXPECT_THAT(files.refusal("cone.scene", "a\n* b\n1\ncone\n1 1\n0 0 0\n0 0 0 1\n0 0 0 0\n.\n"), HasSubstr("'cone'"));
  EXPECT_THAT(files.refusal("mesh.scene", "a\n* b\n1\nmesh\n3 1\n0 0 0\n1 0 0\n0 1 0\n0 1 3\n"),
              HasSubstr("not there"));
  EXPECT_THAT(files.refusal("b.sdf", "<sdf version='1.9'><model name='m'>"), HasSubstr("b.sdf"));
  EXPECT_THAT(
      files.refusal("e.sdf", R"(<sdf version="1.9"><model name="egg"><link name="l"><collision name="c"><geometry>
      <ellipsoid><radii>1 1 2</radii></ellipsoid></geometry></collision></link></model></sdf>)"),
      AllOf(HasSubstr("'ellipsoid'"), HasSubstr("capsule"), HasSubstr("except")));
  EXPECT_THAT(files.refusal("x.scene", as_moveit, ", except: [chair]"),
              AllOf(HasSubstr("'chair'"), HasSubstr("wedge")));
}

TEST(ObstacleFiles, AModelThatAWorldIncludesIsFoundByItsPackageOrMustBeLeftOut) {
  FilesOfObstacles files;
  const char* const world = R"(<sdf version="1.9"><world name="w">
    <include><uri>model://a_posewright_bench</uri><name>bench</name><pose>0 0 1 0 0 0</pose></include></world></sdf>)";
  EXPECT_THAT(files.refusal("w.world", world), HasSubstr("a_posewright_bench"));
  EXPECT_TRUE(files.shapes("w.world", world, ", except: [a_posewright_bench]").empty());
  std::filesystem::create_directories(files.folder.path() / "a_posewright_bench");
  files.folder.write("a_posewright_bench/model.config",
                     "<model><name>bench</name><version>1</version><sdf version='1.9'>model.sdf</sdf></model>");
  files.folder.write("a_posewright_bench/model.sdf", R"(<sdf version="1.9"><model name="m"><link name="l">
    <collision name="c"><geometry><sphere><radius>0.3</radius></sphere></geometry></collision></link></model></sdf>)");
  const std::vector<PlacedShape> shapes = files.shapes("w.world", world);
  ASSERT_EQ(shapes.size(), 1U);
  EXPECT_EQ(shapes.front().name, "bench");
  EXPECT_NEAR(shapes.front().X.translation().z(), 1, 1e-12);
}

TEST(Packages, AreFoundByTheNameInTheirOwnFileBesideTheUrdfsPackage) {
  const TemporaryFolder folder;
  const std::filesystem::path src = folder.path() / "src";
  std::filesystem::create_directories(src / "robot_support" / "urdf");
  std::filesystem::create_directories(src / "tools-repository" / "grinder" / "meshes");
  folder.write("src/robot_support/urdf/arm.urdf", one_link_arm);
  folder.write("src/tools-repository/grinder/package.xml", "<package><name> my_tools </name></package>");
  folder.write("src/tools-repository/grinder/meshes/g.stl", "solid g\nendsolid g\n");
  Problem problem;
  SerialArmSpec arm;
  arm.urdf = src / "robot_support" / "urdf" / "arm.urdf";
  problem.robot = arm;
  EXPECT_EQ(find_mesh("package://my_tools/meshes/g.stl", problem, {}),
            src / "tools-repository" / "grinder" / "meshes" / "g.stl");
  EXPECT_THROW(find_mesh("package://grinders/meshes/g.stl", problem, {}), InputError);
}

TEST(Packages, HoldTheRobotsUrdfToo) {
  const TemporaryFolder folder;
  const std::filesystem::path src = folder.path() / "src";
  std::filesystem::create_directories(src / "robot_support" / "urdf");
  std::filesystem::create_directories(src / "calibration");
  const auto urdf = folder.write("src/robot_support/urdf/arm.urdf", one_link_arm);
  const auto named = [&](const std::string& package) {
    return folder.write("src/calibration/p.yaml",
                        "posewright: 1\nrobot: {urdf: \"package://" + package +
                            "/urdf/arm.urdf\"}\nmeasurement: {type: position, target: [0, 0, 0], device: {type: "
                            "isotropic, noise: 1 mm}}\nvariants: {all: {parameters: auto}}\n");
  };
  const auto urdf_of = [](const Problem& problem) { return std::get<SerialArmSpec>(problem.robot).urdf; };
  // By the folder's name above the problem file, and where the user says.
  EXPECT_EQ(urdf_of(read_problem(named("robot_support"))), urdf);
  EXPECT_EQ(urdf_of(read_problem(named("elsewhere"), {{"elsewhere", src / "robot_support"}})), urdf);
  try {
    read_problem(named("elsewhere"));
    FAIL() << "found";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("p.yaml:2: package 'elsewhere' is not found"));
  }
}

}  // namespace
}  // namespace posewright
