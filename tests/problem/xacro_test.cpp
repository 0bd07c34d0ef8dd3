#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A program `xacro` that is first in the search path, as a script of the test's own.
class Xacro : public testing::Test {
 protected:
  void SetUp() override {
    const char* path = std::getenv("PATH");
    path_ = path == nullptr ? "" : path;
    std::filesystem::create_directories(folder.path() / "bin");
  }
  void TearDown() override { ::setenv("PATH", path_.c_str(), 1); }

  void install(const std::string& body) {
    const auto script = folder.write("bin/xacro", "#!/bin/sh\n" + body);
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    ::setenv("PATH", ((folder.path() / "bin").string() + ":" + path_).c_str(), 1);
  }

  Problem read(const std::string& robot) {
    return read_problem(folder.write(
        "p.yaml", "posewright: 1\nrobot: " + robot +
                      "\nmeasurement: {type: position, device: {type: isotropic, noise: 0.1 mm}, target: [0, 0, 0.1]}\n"
                      "variants: {all: {parameters: auto}}\n"));
  }

  std::string refusal(const std::string& robot) {
    try {
      read(robot);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was refused";
  }

  TemporaryFolder folder;

 private:
  std::string path_;
};

const char* const macro = R"(<robot name="r" xmlns:x="http://www.ros.org/wiki/xacro">
  <x:arg name="prefix"/><x:arg name="height" default="1"/><link name="$(arg prefix)base"/></robot>)";

TEST_F(Xacro, GetsTheFileAndEveryArgumentAsOneWordAndItsOutputIsTheRobot) {
  folder.write("arm.urdf.xacro", macro);
  install("printf '%s|' \"$@\"\necho noise >&2\n");
  const Problem problem = read("{urdf: arm.urdf.xacro, xacro: {prefix: \"\", height: 0.5, note: a b$(c)}}");
  const auto& arm = std::get<SerialArmSpec>(problem.robot);
  ASSERT_NE(arm.expanded, nullptr);
  EXPECT_EQ(*arm.expanded, (folder / "arm.urdf.xacro").string() + "|prefix:=|height:=0.5|note:=a b$(c)|");
}

TEST_F(Xacro, ArgumentsWithoutDefaultAreNamedBeforeTheToolRuns) {
  folder.write("arm.urdf.xacro", macro);
  install("exit 9\n");
  EXPECT_THAT(refusal("{urdf: arm.urdf.xacro}"),
              AllOf(HasSubstr("p.yaml:2"), HasSubstr("no default: prefix"), HasSubstr("xacro: {prefix: VALUE}")));
  EXPECT_THAT(refusal("{urdf: arm.urdf.xacro}"), testing::Not(HasSubstr("height")));
}

TEST_F(Xacro, WhatTheToolSaysLastIsTold) {
  folder.write("arm.urdf.xacro", macro);
  install("echo first >&2; echo 'error: unknown macro name: xacro:tool' >&2; exit 2\n");
  EXPECT_THAT(refusal("{urdf: arm.urdf.xacro, xacro: {prefix: a_}}"),
              AllOf(HasSubstr("status 2"), HasSubstr("unknown macro name: xacro:tool"), HasSubstr("prefix:=a_")));
}

TEST_F(Xacro, WithoutTheToolTheCommandToRunElsewhereIsTold) {
  folder.write("arm.urdf.xacro", macro);
  ::setenv("PATH", (folder.path() / "bin").c_str(), 1);
  EXPECT_THAT(refusal("{urdf: arm.urdf.xacro, xacro: {prefix: a_}}"),
              AllOf(HasSubstr("no program xacro"), HasSubstr("xacro arm.urdf.xacro prefix:=a_ > robot.urdf")));
}

TEST_F(Xacro, ArgumentsOfAPlainUrdfAreRefused) {
  EXPECT_THAT(refusal("{urdf: arm.urdf, xacro: {prefix: a_}}"), HasSubstr("needs a xacro file"));
  EXPECT_THAT(refusal("{urdf: arm.urdf, group: arm}"), HasSubstr("srdf: FILE"));
  EXPECT_THAT(refusal("{urdf: arm.urdf, srdf: a.srdf, group: arm, tip: t}"), HasSubstr("group, or base and tip"));
}

}  // namespace
}  // namespace posewright
