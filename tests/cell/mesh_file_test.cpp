#include "src/cell/mesh_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>

#include "posewright/support/random.hpp"
#include "src/cell/triangle_files.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Triangle = std::array<std::array<float, 3>, 3>;

/// The twelve triangles of a unit cube.
std::vector<Triangle> cube() {
  const auto corner = [](int k) {
    return std::array<float, 3>{float(k & 1), float((k >> 1) & 1), float((k >> 2) & 1)};
  };
  std::vector<Triangle> triangles;
  for (const std::array<int, 4>& q : std::vector<std::array<int, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    triangles.push_back({corner(q[0]), corner(q[1]), corner(q[2])});
    triangles.push_back({corner(q[0]), corner(q[2]), corner(q[3])});
  }
  return triangles;
}

std::string binary_stl(const std::vector<Triangle>& triangles, std::uint32_t claimed) {
  std::string bytes(80, ' ');
  bytes.replace(0, 5, "solid");  // as some programs begin binary files too
  bytes.append(reinterpret_cast<const char*>(&claimed), 4);
  for (const Triangle& t : triangles) {
    bytes.append(12, '\0');
    bytes.append(reinterpret_cast<const char*>(t.data()), sizeof t);
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string text_stl(const std::vector<Triangle>& triangles) {
  std::string text = "solid cube\n";
  for (const Triangle& t : triangles) {
    text += "  facet normal 0 0 1\n    outer loop\n";
    for (const auto& p : t) text += fmt::format("      vertex {} {} {:e}\n", p[0], p[1], p[2]);
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid cube\n";
}

const char* const obj =
    "# cube\nmtllib a.mtl\no cube\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "vn 0 0 1\nusemtl m\nf 1//1 3//1 4//1 2//1\nf -4 -3 -1 -2\nf 1/1 2/1 6/1 5/1\nf 3 7 8 4\nf 1 5 7 3\n"
    "f 2 4 8\nf 2 8 6\n";

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum +=
        mesh.vertices[std::size_t(t[0])].dot(mesh.vertices[std::size_t(t[1])].cross(mesh.vertices[std::size_t(t[2])])) /
        6;
  return std::abs(sum);
}

std::string dae(const std::string& unit, const std::string& positions = "0 0 0 1 0 0 0 1 0 0 0 1") {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\"><asset>"
         "<unit meter=\"" +
         unit +
         "\"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id=\"g\"><mesh><source "
         "id=\"p\"><float_array "
         "id=\"a\" count=\"12\">" +
         positions +
         "</float_array><technique_common><accessor source=\"#a\" count=\"4\" stride=\"3\"><param name=\"X\" "
         "type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"
         "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
         "<triangles count=\"4\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p>"
         "</triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\"><node "
         "id=\"n\"><instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene>"
         "<instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

TEST(MeshFile, ACubeIsTheSameInEveryFormat) {
  for (const std::string& bytes : {binary_stl(cube(), 12), text_stl(cube())}) {
    const TriangleMesh mesh = read_stl(bytes);
    EXPECT_EQ(mesh.vertices.size(), 8U) << "corners at one place are one vertex";
    EXPECT_EQ(mesh.triangles.size(), 12U);
    EXPECT_NEAR(volume(mesh), 1, 1e-12);
  }
  const TriangleMesh mesh = read_obj(obj);
  EXPECT_EQ(mesh.vertices.size(), 8U);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_NEAR(volume(mesh), 1, 1e-12);
}

TEST(MeshFile, ColladaIsReadInItsUnit) {
  const TemporaryFolder folder;
  for (const double unit : {1.0, 0.001}) {
    const TriangleMesh mesh = read_mesh(folder.write("t.dae", dae(fmt::format("{}", unit))), {1, 1, 1}, {});
    EXPECT_NEAR(volume(mesh), unit * unit * unit / 6, 1e-6 * unit * unit * unit) << unit;
  }
}

std::string refusal(const fs::path& file) {
  try {
    read_mesh(file, {1, 1, 1}, {"p.yaml", 7});
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MeshFile, WhatIsWrongIsSaidWithTheFilesName) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& name, const std::string& bytes) {
    return refusal(folder.write(name, bytes));
  };
  EXPECT_THAT(said("a.ply", "ply\n"), HasSubstr("a.ply' has an unknown format: .stl, .obj and .dae are read"));
  EXPECT_THAT(said("a.stl", "this is not a mesh"), HasSubstr("p.yaml:7: mesh '"));
  EXPECT_THAT(said("a.STL", binary_stl(cube(), 4'000'000'000U)), HasSubstr("claims 4000000000 triangles"));
  EXPECT_THAT(said("a.stl", binary_stl(cube(), 13)), HasSubstr("ends before its 13 triangles do"));
  std::vector<Triangle> odd = cube();
  odd[3][1][2] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(said("a.stl", binary_stl(odd, 12)), HasSubstr("a vertex that is not finite"));
  odd[3][1][2] = 2e3F;
  EXPECT_THAT(said("a.stl", binary_stl(odd, 12)), HasSubstr("farther than 1000 m; is it in mm?"));
  EXPECT_THAT(said("a.stl", "solid a\nfacet\nvertex 0 0 x\n"), HasSubstr("has 'x' where a number is expected"));
  EXPECT_THAT(said("a.obj", "v 0 0 0\nf 1 2 3\n"), HasSubstr("has a face with corner '2' of 1"));
  EXPECT_THAT(said("a.obj", "v 0 0 0\n"), HasSubstr("has no triangles"));
  EXPECT_THAT(said("a.dae", "<COLLADA"), HasSubstr("a.dae' cannot be read: "));
}

TEST(MeshFile, ADamagedFileIsReadOrRefusedAndNothingElse) {
  const std::vector<std::pair<std::string, TriangleMesh (*)(std::string_view)>> files = {
      {binary_stl(cube(), 12), read_stl}, {text_stl(cube()), read_stl}, {obj, read_obj}};
  Random random(5, 0);
  for (const auto& [good, read] : files)
    for (int i = 0; i < 20000; ++i) {
      std::string bytes = good.substr(0, i % 3 == 0 ? std::size_t(random.index(int(good.size()))) : good.size());
      for (int k = random.index(4); k > 0 && !bytes.empty(); --k)
        bytes[std::size_t(random.index(int(bytes.size())))] = char(random.index(256));
      try {
        const TriangleMesh mesh = read(bytes);
        for (const auto& triangle : mesh.triangles)
          for (const int corner : triangle) ASSERT_LT(std::size_t(corner), mesh.vertices.size());
      } catch (const BadMesh&) {
        continue;
      }
    }
}

TEST(MeshFile, ABombGoesOffInAProcessOfItsOwn) {
  const fs::path bomb = fs::path(POSEWRIGHT_SHARED_DIR) / "repro" / "bomb.dae";
  if (!fs::exists(bomb)) GTEST_SKIP() << "skipped: " << bomb << " is not there";
  EXPECT_THAT(refusal(bomb), HasSubstr("bomb.dae"));
}

}  // namespace
}  // namespace posewright
