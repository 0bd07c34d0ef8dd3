// The files of worlds/ against what libsdformat makes of them (worlds/golden.json, worlds/golden.cpp).

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "posewright/problem/read_problem.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "src/cell/obstacle_files.hpp"
#include "tests/kit/mutate.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

const fs::path worlds = fs::path(POSEWRIGHT_SOURCE_DIR) / "tests/cell/worlds";

std::vector<PlacedShape> shapes_of(const fs::path& file, const std::vector<std::string>& except = {},
                                   const Packages& packages = {}) {
  Problem problem;
  problem.file = "p.yaml";
  problem.packages = packages;
  ObstacleFileSpec spec;
  spec.file = file;
  for (const std::string& name : except) spec.except.push_back({name, 7});
  return read_obstacle_file(spec, problem);
}

std::string sdf_refusal(const std::string& text) {
  const TemporaryFolder folder;
  try {
    shapes_of(folder.write("w.sdf", text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

std::string in_model(const std::string& content) {
  return "<sdf version='1.9'>\n<model name='m'>\n" + content + "\n</model></sdf>";
}
std::string in_link(const std::string& content) {
  return in_model("<link name='l'>\n" + content +
                  "<collision name='c'>\n<geometry><sphere><radius>1</radius></sphere></geometry></collision></link>");
}

/// Kind and sizes as golden.json has them, and the mesh's name.
struct Described {
  std::string kind;
  std::vector<double> values;
  std::string uri;
};

Described described(const ShapeSpec& shape) {
  const auto list = [](const Eigen::Vector3d& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
  if (const auto* box = std::get_if<BoxShape>(&shape)) return {"box", list(box->size), ""};
  if (const auto* c = std::get_if<CylinderShape>(&shape)) return {"cylinder", {c->radius, c->length}, ""};
  if (const auto* s = std::get_if<SphereShape>(&shape)) return {"sphere", {s->radius}, ""};
  if (const auto* plane = std::get_if<HalfSpaceShape>(&shape)) return {"plane", list(plane->normal), ""};
  const MeshShape& mesh = std::get<MeshShape>(shape);
  const bool elsewhere = mesh.file.string().find("://") != std::string::npos;
  return {"mesh", list(mesh.scale), (elsewhere ? mesh.file : fs::relative(mesh.file, worlds)).string()};
}

TEST(SdfWorld, ShapesAndPosesAreThoseOfLibsdformat) {
  const json golden = parse_json(read_file(worlds / "golden.json"));
  ASSERT_EQ(golden.size(), 10U);
  for (const auto& [file, expected] : golden.items()) {
    const std::vector<PlacedShape> shapes =
        shapes_of(worlds / file, {}, {{"bench", worlds / "bench"}, {"gripper", worlds / "gripper"}});
    ASSERT_EQ(shapes.size(), expected.size()) << file;
    // libsdformat writes a merged model's pose as a text of six digits, and reads it again.
    const double rounded = file == "merged.sdf" ? 1e-6 : 1e-12;
    // libsdformat puts models below the links of the model that they are in, whatever the file's order.
    for (const json& one : expected) {
      const auto p = one["position"].get<std::vector<double>>(), q = one["quaternion"].get<std::vector<double>>();
      const Eigen::Matrix3d R = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().matrix();
      const auto equal = [&](const PlacedShape& shape) {
        const Described is = described(shape.shape);
        return shape.name == one["name"].get<std::string>() && is.kind == one["kind"].get<std::string>() &&
               is.uri == one["uri"].get<std::string>() && is.values == one["values"].get<std::vector<double>>() &&
               (shape.X.translation() - Eigen::Vector3d(p[0], p[1], p[2])).norm() < rounded &&
               (shape.X.linear() - R).norm() < 1e-12;
      };
      EXPECT_EQ(std::count_if(shapes.begin(), shapes.end(), equal), 1) << file << ": " << one;
    }
  }
}

TEST(SdfWorld, AFileIsTheOneOfItsFolderWhateverItIsCalled) {
  const TemporaryFolder folder;
  fs::copy(worlds / "world.sdf", folder.path());
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  const std::vector<PlacedShape> shapes = shapes_of("world.sdf");
  fs::current_path(before);
  ASSERT_EQ(shapes.size(), 1U);
  EXPECT_EQ(shapes.front().name, "block");
  EXPECT_EQ(shapes.front().line, 2);
}

TEST(SdfWorld, WhatIsLeftOutNeedNotBeFound) {
  EXPECT_THAT(shapes_of(worlds / "include.world", {"bench", "stand", "other_stand"}), IsEmpty());
  try {
    shapes_of(worlds / "include.world", {}, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("include.world:4: the model 'model://bench' is not found"),
                                    HasSubstr("--package NAME=FOLDER")));
  }
}

TEST(SdfWorld, WhatIsWrongIsNamedWithItsLine) {
  EXPECT_THAT(sdf_refusal(""), HasSubstr("w.sdf"));
  EXPECT_THAT(sdf_refusal("<robot name='r'/>"), HasSubstr("w.sdf:1: has the root 'robot'"));
  EXPECT_THAT(sdf_refusal("<sdf>\n<model name='m'/></sdf>"), HasSubstr("version"));
  EXPECT_THAT(sdf_refusal("<sdf version='1.9'>\n<model/></sdf>"), HasSubstr("w.sdf:2: <model> has no name"));
  EXPECT_THAT(sdf_refusal(in_link("<pose>1 2 3</pose>")), HasSubstr("w.sdf:4: <pose> has 3 numbers"));
  EXPECT_THAT(sdf_refusal(in_link("<pose>1 2 3 4 5 1,5</pose>")), HasSubstr("w.sdf:4: <pose> holds '1 2 3 4 5 1,5'"));
  EXPECT_THAT(sdf_refusal(in_link("<pose>1 2 3 4 5 1e999</pose>")), HasSubstr("finite"));
  EXPECT_THAT(sdf_refusal(in_link("<pose rotation_format='quat_xyzw'>1 2 3 0 0 0 0</pose>")), HasSubstr("of length 1"));
  EXPECT_THAT(sdf_refusal(in_link("<pose rotation_format='matrix'>1 2 3 0 0 0</pose>")),
              HasSubstr("euler_rpy, quat_xyzw"));
  EXPECT_THAT(sdf_refusal(in_link("<pose relative_to='arm'>1 2 3 0 0 0</pose>")),
              HasSubstr("w.sdf:3: the frame 'm::arm' is not there"));
  EXPECT_THAT(sdf_refusal(in_link("<pose relative_to='world'/>")), HasSubstr("'m::world' is not there"));
  EXPECT_THAT(sdf_refusal(in_link("<pose relative_to='l'/>")), HasSubstr("depends on itself"));
  EXPECT_THAT(
      sdf_refusal(in_model(
          "<frame name='a' attached_to='b'/>\n<frame name='b' attached_to='a'/><link name='l'><pose relative_to='a'/>"
          "<collision name='c'><geometry><sphere><radius>1</radius></sphere></geometry></collision></link>")),
      HasSubstr("depends on itself"));
  EXPECT_THAT(sdf_refusal(in_link("").replace(in_link("").find("<radius>1"), 9, "<radius>0")),
              HasSubstr("w.sdf:5: <radius> is not above zero"));
  EXPECT_THAT(sdf_refusal(in_model("<link name='l'><collision name='c'/></link>")), HasSubstr("no <geometry>"));
  EXPECT_THAT(sdf_refusal(in_model("<link name='l'/>\n<link name='l'/>")),
              HasSubstr("w.sdf:4: the name 'm::l' is taken"));
  for (const std::string kind : {"heightmap", "cone", "polyline"})
    EXPECT_THAT(sdf_refusal(in_model("<link name='l'><collision name='c'><geometry><" + kind +
                                     "/></geometry></collision></link>")),
                AllOf(HasSubstr("'" + kind + "'"), HasSubstr("capsule, plane")));
  EXPECT_THAT(
      sdf_refusal(in_model(
          "<link name='l'><collision name='c'><geometry><mesh><uri>a.stl</uri><submesh><name>s</name></submesh></mesh>"
          "</geometry></collision></link>")),
      HasSubstr("whole meshes"));
  EXPECT_THAT(sdf_refusal("<sdf version='1.6'><world name='w'>\n<population name='p'/></world></sdf>"),
              HasSubstr("w.sdf:2: <population>"));
  EXPECT_THAT(sdf_refusal("<sdf version='1.6'><world name='w'>\n<include/></world></sdf>"),
              HasSubstr("w.sdf:2: <include> has no <uri>"));
  EXPECT_THAT(
      sdf_refusal("<sdf version='1.6'><world name='w'>\n<include><uri>https://fuel/m</uri></include></world></sdf>"),
      HasSubstr("w.sdf:2: the model 'https://fuel/m' is not found"));
}

TEST(SdfWorld, FilesThatIncludeEachOtherEnd) {
  const TemporaryFolder folder;
  const std::string twice =
      "<include><uri>a.sdf</uri><name>x</name></include><include><uri>a.sdf</uri><name>y</name></include>";
  const fs::path file = folder.write("a.sdf", in_model(twice));
  EXPECT_THROW(shapes_of(file), InputError);
}

/// A damaged file is read or refused; nothing else happens.
TEST(SdfWorld, DamagedFilesAreReadOrRefused) {
  const TemporaryFolder folder;
  std::ifstream in(worlds / "nested.sdf");
  const std::string good((std::istreambuf_iterator<char>(in)), {});
  Random random(5, 0);
  int read = 0;
  for (int i = 0; i < 300; ++i) {
    try {
      shapes_of(folder.write("d.sdf", mutated(good, random)));
      ++read;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("d.sdf"));
    }
  }
  EXPECT_GT(read, 10);
}

}  // namespace
}  // namespace posewright
