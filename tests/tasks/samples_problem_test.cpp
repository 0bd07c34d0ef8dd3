// Hand-eye calibration from samples. Samples are made by the definition seen = (tip · camera)⁻¹ · board, or
// camera⁻¹ · tip · board; the program knows neither frame.

#include "posewright/tasks/samples_problem.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "posewright/model/placement.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/random.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double position_noise = 1e-3, rotation_noise = 2e-3;

Isometry3d pose(const Vector3d& p, const Vector3d& rotation) {
  Isometry3d X = Isometry3d::Identity();
  if (rotation.norm() > 0) X.linear() = Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix();
  X.translation() = p;
  return X;
}

Vector3d normal(Random& random, double sigma) {
  Vector3d v;
  for (int k = 0; k < 3; ++k) v[k] = sigma * random.normal();
  return v;
}

struct Drawn {
  Isometry3d camera, board;
  std::vector<std::pair<Isometry3d, Isometry3d>> samples;  ///< tip, seen
};

Drawn drawn(bool on_hand, std::uint64_t seed, int count = 20) {
  Random random(seed, 0);
  Drawn drawn{pose({0.05, -0.02, 0.08}, normal(random, 1.2)), pose({0.6, 0.1, 0}, normal(random, 1.2)), {}};
  for (int i = 0; i < count; ++i) {
    const Vector3d place = Vector3d(0.5, 0, 0.6) + Vector3d(0.2 * (random.uniform(-1, 1)), 0.2 * random.uniform(-1, 1),
                                                            0.2 * random.uniform(-1, 1));
    const Isometry3d tip = pose(place, {std::numbers::pi, 0, 0}) * pose(Vector3d::Zero(), normal(random, 0.5));
    Isometry3d seen = on_hand ? (tip * drawn.camera).inverse() * drawn.board
                              : drawn.board.inverse() * tip * drawn.camera;  // the camera stands where `board` is
    seen.linear() = pose({}, normal(random, rotation_noise)).linear() * seen.linear();
    seen.translation() += normal(random, position_noise);
    drawn.samples.emplace_back(tip, seen);
  }
  return drawn;
}

std::string moveit_text(const Drawn& drawn) {
  std::string text;
  for (const auto& [tip, seen] : drawn.samples)
    for (const auto& [key, X] : {std::pair("- effector_wrt_world", tip), std::pair("  object_wrt_sensor", seen)}) {
      text += std::string(key) + ": [";
      for (int i = 0; i < 16; ++i) text += fmt::format("{}{}", i > 0 ? ", " : "", X.matrix()(i / 4, i % 4));
      text += "]\n";
    }
  return text;
}

std::string transform_text(const char* key, const Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  const Vector3d p = X.translation();
  return fmt::format("{}:\n    translation: {{x: {}, y: {}, z: {}}}\n    rotation: {{x: {}, y: {}, z: {}, w: {}}}\n",
                     key, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
}

std::string easy_text(const Drawn& drawn, bool on_hand) {
  std::string text =
      fmt::format("parameters:\n  calibration_type: {}\nsamples:\n", on_hand ? "eye_in_hand" : "eye_on_base");
  for (const auto& [tip, seen] : drawn.samples)
    text += transform_text("- robot", on_hand ? tip : tip.inverse()) + transform_text("  tracking", seen);
  return text;
}

std::string numbers(const std::vector<double>& values) { return fmt::format("[ {} ]", fmt::join(values, ", ")); }

/// As cv::FileStorage of OpenCV 4.6 writes lists of matrices under the names of calibrateHandEye's arguments.
std::string opencv_text(const Drawn& drawn) {
  std::string text = "%YAML:1.0\n---\n";
  for (const bool seen : {false, true})
    for (const bool rotation : {true, false}) {
      text += fmt::format("{}_{}:\n", rotation ? "R" : "t", seen ? "target2cam" : "gripper2base");
      for (const auto& sample : drawn.samples) {
        const Eigen::Matrix4d X = (seen ? sample.second : sample.first).matrix();
        const int cols = rotation ? 3 : 1;
        std::vector<double> data;
        for (int i = 0; i < 3 * cols; ++i) data.push_back(rotation ? X(i / 3, i % 3) : X(i, 3));
        text += fmt::format("   - !!opencv-matrix\n      rows: 3\n      cols: {}\n      dt: d\n      data: {}\n", cols,
                            numbers(data));
      }
    }
  return text;
}

/// As Python writes arrays of rotation vectors and of translations, here those of calibrateRobotWorldHandEye.
std::string opencv_arrays(const Drawn& drawn) {
  std::string text = "%YAML:1.0\n---\n";
  for (const bool seen : {false, true})
    for (const bool rotation : {true, false}) {
      std::vector<double> data;
      for (const auto& sample : drawn.samples) {
        const Isometry3d X = seen ? sample.second : sample.first.inverse();
        const Eigen::AngleAxisd turn(X.linear());
        const Vector3d v = rotation ? Vector3d(turn.angle() * turn.axis()) : Vector3d(X.translation());
        data.insert(data.end(), v.begin(), v.end());
      }
      text +=
          fmt::format("{}_{}: !!opencv-matrix\n   rows: {}\n   cols: 3\n   dt: d\n   data: {}\n", rotation ? "R" : "t",
                      seen ? "world2cam" : "base2gripper", drawn.samples.size(), numbers(data));
    }
  return text;
}

std::string csv_text(const Drawn& drawn) {
  std::string text =
      "id,robot.x [mm],robot.y [mm],robot.z [mm],robot.qx,robot.qy,robot.qz,robot.qw,pose.x,pose.y,pose.z,"
      "pose.qx,pose.qy,pose.qz,pose.qw\n";
  int id = 0;
  for (const auto& [tip, seen] : drawn.samples) {
    const Eigen::Quaterniond a(tip.linear()), b(seen.linear());
    const Vector3d p = 1e3 * tip.translation(), r = seen.translation();
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", ++id, p.x(), p.y(), p.z(), a.x(), a.y(),
                        a.z(), a.w(), r.x(), r.y(), r.z(), b.x(), b.y(), b.z(), b.w());
  }
  return text;
}

Calibration calibrated(const std::filesystem::path& file, const SamplesProblem& found) {
  CalibrateOptions options;
  options.data = file;
  return calibrate_problem(parse_problem(found.text, "p.yaml"), options, Monitor{});
}

const PlacedFrame& frame(const Calibration& c, const std::string& name) {
  for (const PlacedFrame& f : c.frames)
    if (f.name == name) return f;
  throw std::logic_error("no frame " + name);
}

TEST(SamplesProblem, FindsTheMountAndBothFramesFromEveryForm) {
  const TemporaryFolder folder;
  for (const bool on_hand : {true, false}) {
    const Drawn d = drawn(on_hand, 3);
    const Isometry3d tool = d.camera, base = d.board.inverse();
    std::vector<std::string> texts;
    for (const std::string& text :
         {moveit_text(d), easy_text(d, on_hand), csv_text(d), opencv_text(d), opencv_arrays(d)}) {
      const auto file = folder.write("samples.txt", text);
      const SamplesProblem found = samples_problem(file, {});
      EXPECT_EQ(found.on_hand, on_hand);
      const Calibration result = calibrated(file, found);
      EXPECT_EQ(result.verdict, Verdict::use_it) << found.text;
      // Twenty samples: errors of the mean of the noise, times what turns of half a radian leave of it.
      EXPECT_LT((frame(result, "tool").X.translation() - tool.translation()).norm(), 3e-3);
      EXPECT_LT(Eigen::AngleAxisd(frame(result, "tool").X.linear().transpose() * tool.linear()).angle(), 3e-3);
      EXPECT_LT((frame(result, "base").X.translation() - base.translation()).norm(), 5e-3);
      texts.push_back(found.text.substr(found.text.find("placement:"), 300));
    }
    for (const int other : {2, 3, 4}) EXPECT_EQ(texts[0].substr(0, 60), texts[std::size_t(other)].substr(0, 60));
  }
}

TEST(SamplesProblem, FindsTheCameraByTrajectoriesOfHandAndCamera) {
  Drawn d = drawn(true, 3);
  for (auto& [tip, seen] : d.samples) seen = seen.inverse();  // the camera in the frame of the board
  const TemporaryFolder folder;
  const auto file = folder.write("samples.csv", csv_text(d));
  const SamplesProblem found = samples_problem(file, {});
  EXPECT_FALSE(found.on_hand) << "the moving thing that is seen is the camera itself";
  const Calibration result = calibrated(file, found);
  EXPECT_LT((frame(result, "tool").X.translation() - d.camera.translation()).norm(), 3e-3);
  EXPECT_LT((frame(result, "instrument").X.translation() - d.board.translation()).norm(), 5e-3);
}

TEST(SamplesProblem, IntervalsHoldTheTruth) {
  const TemporaryFolder folder;
  int inside = 0, all = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const bool on_hand = seed % 2 == 0;
    const Drawn d = drawn(on_hand, 100 + seed, 15);
    const auto file = folder.write("samples.yaml", moveit_text(d));
    const SamplesProblem found = samples_problem(file, on_hand);
    const Problem problem = parse_problem(found.text, "p.yaml");
    const Calibration result = calibrated(file, found);
    const auto& spec = std::get<GivenPosesSpec>(problem.robot);
    // True values of both displacements from where the problem puts base and tool.
    const std::array<Isometry3d, 2> truth{isometry(spec.placement).inverse() * d.board.inverse(),
                                          isometry(spec.tool).inverse() * d.camera};
    for (const CalibratedParameter& p : result.parameters) {
      const Isometry3d& X = truth[p.label.name.starts_with("base") ? 0 : 1];
      const std::string end = p.label.name.substr(5);
      const Vector3d rpy = rpy_of(X.linear());
      const double value = p.label.nominal + (end.size() == 1 ? X.translation()[end[0] - 'x'] : rpy[end[1] - 'x']);
      inside += value >= p.lower && value <= p.upper;
      ++all;
    }
  }
  EXPECT_EQ(all, 720);
  // 95 % of 720 values of 60 sets, three standard errors of the sets' means.
  EXPECT_GT(inside, int(0.92 * all));
  EXPECT_LT(inside, int(0.98 * all));
}

TEST(SamplesProblem, NamesWrongSamplesAndFindsTheFramesWithoutThem) {
  const TemporaryFolder folder;
  Drawn d = drawn(true, 8);
  d.samples[6].second.translation() += Vector3d(0.05, 0, 0);
  d.samples[13].second.linear() = pose({}, {0, 0.3, 0}).linear() * d.samples[13].second.linear();
  const SamplesProblem found = samples_problem(folder.write("samples.yaml", moveit_text(d)), {});
  EXPECT_EQ(found.wrong, (std::vector{7, 14}));
  const Problem problem = parse_problem(found.text, "p.yaml");
  const auto& spec = std::get<GivenPosesSpec>(problem.robot);
  EXPECT_LT((isometry(spec.tool).translation() - d.camera.translation()).norm(), 3e-3);
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    EXPECT_TRUE(samples_problem(folder.write("samples.yaml", moveit_text(drawn(true, 200 + seed))), {}).wrong.empty())
        << seed;
}

/// A noise as large as what a wrong convention leaves would let it pass.
TEST(SamplesProblem, AreNotUsedWhereQuaternionsHaveTheRealPartFirst) {
  const TemporaryFolder folder;
  for (const std::uint64_t seed : {8, 9, 10}) {
    Drawn d = drawn(true, seed);
    for (auto& [tip, seen] : d.samples)
      for (Eigen::Isometry3d* X : {&tip, &seen}) {
        const Eigen::Quaterniond q(X->linear());
        X->linear() = Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()).toRotationMatrix();
      }
    const auto file = folder.write("samples.csv", csv_text(d));
    const SamplesProblem found = samples_problem(file, {});
    try {
      EXPECT_EQ(calibrated(file, found).verdict, Verdict::do_not_use);
    } catch (const CannotDo& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("w stands first"));
    }
  }
}

TEST(SamplesProblem, NamesWhatIsWrongInOneLine) {
  const TemporaryFolder folder;
  const Drawn d = drawn(true, 5, 4);
  const std::string good = easy_text(d, true), matrices = moveit_text(d), cv = opencv_text(d);
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
           {replaced(good, "eye_in_hand", "eye_in_head"), "f:2: calibration_type is 'eye_in_head'; eye_in_hand or"},
           {replaced(good, "w: ", "w: 7"), "the quaternion has length"},
           {replaced(good, "tracking", "trackin"), "f:4: has no 'tracking'"},
           {matrices.substr(0, matrices.find("- eff", 10)), "f has 1 whole samples; 3 are needed"},
           {replaced(matrices, "[", "[7, "), "f:1: has 17 numbers; 16 of a 4 x 4 matrix"},
           {replaced(matrices, "[", "[7"), "f:1: is not a rotation; a pose is expected: 4 x 4"},
           {replaced(cv, "t_target2cam", "t_target"), "has no 't_target2cam'"},
           {replaced(cv, "[ ", "[ 7"), "f:4: is not a rotation; number 1 of R_gripper2base is 3 x 3, row by row"},
           {replaced(cv, "[ ", "[ 7, "), "R_gripper2base and t_gripper2base number 1 have 10 and 3 numbers; 9 (or 3"},
           {replaced(opencv_arrays(d), "rows: 4", "rows: 5"), "R_base2gripper has 12 numbers for 5 matrices"},
           {"time" + csv_text(d).substr(2) + csv_text(d).substr(csv_text(d).find("\n1,") + 1),
            "f:6: has the time of line 2; one sample for each"},
           {"id,robot.x,robot.qx,robot.qy,robot.qz,robot.qw,pose.x,pose.y,pose.z\n1,0,0,0,0,1,0,0,0\n",
            "has no column 'robot.y'"},
       }) {
    const auto file = folder.write("f", text);
    try {
      samples_problem(file, {});
      ADD_FAILURE() << message;
    } catch (const std::exception& error) {
      EXPECT_THAT(std::string(error.what()), HasSubstr(message));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace posewright
