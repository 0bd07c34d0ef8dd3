// Poses that are moved on a page: what the program says of each is what it says of a list that has the pose there.
// Pictures that a camera will take, and the points where bodies are nearest.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "posewright/problem/read_problem.hpp"
#include "posewright/report/judge_poses.hpp"
#include "posewright/report/report_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/judgement.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/random.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/packed_matrix.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using nlohmann::json;
using testing::HasSubstr;

struct MadeMoves {
  Plan plan;
  json report;
  DesignEdits options;
  std::filesystem::path file;
};

MadeMoves make(const Problem& problem, int poses, int candidates, const TemporaryFolder& folder) {
  MadeMoves made;
  made.options.edit("poses", poses);
  made.options.edit("candidates", candidates);
  made.options.edit("restarts", 1);
  made.options.edit("method", "exchange");
  made.plan = planned(problem, made.options);
  made.file = folder.write("plan.json", plan_json(made.plan));
  ReportOptions options;
  options.sizes = options.candidates = false;
  made.report = parse_json(report_json(report_problem(problem, made.file, options, Monitor{})));
  return made;
}

std::vector<double> plain(const PlannedPose& pose) {
  std::vector<double> q;
  for (const NamedValue& v : pose.configuration) q.push_back(v.value);
  return q;
}

/// The pose of the plan with every continuous coordinate elsewhere within `reach` of its range.
std::vector<double> moved(const PlannedPose& pose, const json& ranges, double reach, Random& random) {
  std::vector<double> q = plain(pose);
  for (const json& range : ranges) {
    const double lower = range["lower"], upper = range["upper"];
    double& value = q[range["index"].get<std::size_t>()];
    value = std::clamp(value + reach * (upper - lower) * random.uniform(-1, 1), lower, upper);
  }
  return q;
}

std::string csv_of(const PlannedPose& pose, const std::vector<double>& q) {
  std::string names = "pose", values = std::to_string(pose.id);
  for (std::size_t k = 0; k < q.size(); ++k) {
    names += "," + pose.configuration[k].name;
    values += "," + json(q[k]).dump();
  }
  return names + "\n" + values + "\n";
}

json judged(const Problem& problem, const MadeMoves& made, const TemporaryFolder& folder, const std::string& csv) {
  return parse_json(report_json(judge_poses(problem, made.file, folder.write("moved.csv", csv), Monitor{})));
}

/// Moves poses at random: verdicts are the workspace's, and the matrices of the page with the moved pose's give log det
/// and σ of the judgement of that list.
void expect_as_judged(const Problem& problem, int poses, int candidates, double reach) {
  const TemporaryFolder folder;
  const MadeMoves made = make(problem, poses, candidates, folder);
  const Problem searched = made.options.of(problem);
  const Study study = make_study(resolve(searched, made.options, Monitor{}), Monitor{});
  const auto m = Eigen::Index(made.report["columns"].size());
  const json ranges = judged(problem, made, folder, csv_of(made.plan.poses[0], plain(made.plan.poses[0])))["ranges"];
  ASSERT_FALSE(ranges.empty());
  Eigen::VectorXd tolerance(m);
  Eigen::Index nuisance = 0;
  double units = 0;
  for (Eigen::Index j = 0; j < m; ++j) {
    const json& column = made.report["columns"][std::size_t(j)];
    tolerance[j] = column["tolerance"];
    if (column["role"] == "nuisance") ++nuisance;
    else units += 2 * std::log(tolerance[j]);
  }
  Random random(4, 0);
  int feasible = 0, forbidden = 0;
  for (int look = 0; look < 12; ++look) {
    const auto at = std::size_t(random.index(poses));
    const std::vector<double> q = moved(made.plan.poses[at], ranges, look % 2 ? reach : 0.02, random);
    const json one = judged(problem, made, folder, csv_of(made.plan.poses[at], q))["poses"][0];
    Configurations list;
    list.dimension = int(study.first().workspace->coordinates().size());
    Eigen::MatrixXd M = unpacked(one["packed"], m);
    for (std::size_t i = 0; i < made.plan.poses.size(); ++i) {
      std::vector<double> own = q;
      if (i != at) {
        own = plain(made.plan.poses[i]);
        M += information_of(made.report["information"], made.report["information"]["poses"][i], m);
      }
      own.resize(std::size_t(list.dimension), 0.0);  // one station, one load case
      append(list, own);
    }
    const Workspace& workspace = *study.first().workspace;
    const int reason = workspace.violation(list[at]);
    if (reason < 0) EXPECT_TRUE(one["reason"].is_null()) << one["reason"];
    else EXPECT_EQ(one["reason"], workspace.reasons()[std::size_t(reason)]);
    (reason < 0 ? feasible : forbidden) += 1;
    if (study.cell->collision != nullptr) {
      const auto nearest = study.cell->collision->nearest(list[at]);
      ASSERT_TRUE(nearest.has_value());
      EXPECT_EQ(one["pose"]["nearest"]["distance"].get<double>(), nearest->distance);
    }
    const Eigen::Vector3d tip = study.first().model->tool_pose(list[at]).translation();
    for (int e = 0; e < 3; ++e) EXPECT_NEAR(one["keyframe"]["tip"][std::size_t(e)].get<double>(), tip[e], 1e-5);
    const Evaluation evaluation = judge(study, list).evaluations.front();
    const auto log_det = [](const Eigen::MatrixXd& A) {
      return 2 * A.llt().matrixLLT().diagonal().array().log().sum();
    };
    EXPECT_NEAR(log_det(M) - (nuisance > 0 ? log_det(M.topLeftCorner(nuisance, nuisance)) : 0) - units,
                evaluation.log_det, 1e-8 * std::abs(evaluation.log_det));
    const Eigen::VectorXd sigma = M.inverse().diagonal().cwiseSqrt();
    for (Eigen::Index j = 0; j < m; ++j)
      EXPECT_NEAR(sigma[j] * tolerance[j], evaluation.sigma[j], 1e-6 * evaluation.sigma[j]);
  }
  EXPECT_GT(feasible, 0);
  if (study.cell->collision != nullptr) {
    EXPECT_GT(forbidden, 0);
  }
}

TEST(ReportMoves, AMovedPoseIsJudgedAsTheListThatHasItInACell) {
  Problem problem = read_problem(examples_folder() / "cell" / "problem.yaml");
  problem.workspace.motion.reachable = false;  // another reason, and a roadmap
  expect_as_judged(problem, 14, 100, 0.4);
}

TEST(ReportMoves, AMovedPoseIsJudgedAsTheListThatHasItForAnArmAndForClosedChains) {
  expect_as_judged(read_problem(examples_folder() / "kr270" / "problem.yaml"), 12, 100, 0.3);
  expect_as_judged(read_problem(examples_folder() / "delta" / "problem.yaml"), 12, 100, 0.2);
  expect_as_judged(read_problem(examples_folder() / "telescope" / "problem.yaml"), 16, 100, 0.2);
}

TEST(ReportMoves, EvaluateRefusesExactlyTheMovedPosesThatAreNotFeasible) {
  const TemporaryFolder folder;
  Problem problem = read_problem(examples_folder() / "cell" / "problem.yaml");
  problem.workspace.motion.reachable = false;
  const MadeMoves made = make(problem, 14, 100, folder);
  const Problem searched = made.options.of(problem);
  const std::vector<Coordinate> coordinates = pose_coordinates(searched);
  const json ranges = judged(problem, made, folder, csv_of(made.plan.poses[0], plain(made.plan.poses[0])))["ranges"];
  Random random(7, 0);
  int refused = 0;
  for (int look = 0; look < 4; ++look) {
    const auto at = std::size_t(random.index(14));
    std::vector<std::vector<double>> rows;
    for (const PlannedPose& pose : made.plan.poses) rows.push_back(plain(pose));
    rows[at] = moved(made.plan.poses[at], ranges, look % 2 ? 0.4 : 0.01, random);
    const json one = judged(problem, made, folder, csv_of(made.plan.poses[at], rows[at]))["poses"][0];
    try {
      evaluate_problem(searched, poses_given(rows, coordinates), {}, Monitor{});
      EXPECT_TRUE(one["reason"].is_null()) << one["reason"];
    } catch (const InputError& error) {
      ++refused;
      ASSERT_FALSE(one["reason"].is_null()) << error.what();
      EXPECT_THAT(error.what(), HasSubstr(one["reason"].get<std::string>()));
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, 4);
}

TEST(ReportMoves, TheListSaysInWordsWhatEachPoseIs) {
  const TemporaryFolder folder;
  Problem problem = read_problem(examples_folder() / "cell" / "problem.yaml");
  problem.workspace.motion.reachable = false;
  const MadeMoves made = make(problem, 14, 100, folder);
  const std::string text = judged_text(judge_poses(problem, made.file, made.file, Monitor{}));
  EXPECT_THAT(text, testing::MatchesRegex("(Pose [0-9]+: feasible; .* and .* are .* apart\n){14}"));
  EXPECT_THROW(judge_poses(problem, made.file, folder.write("list.csv", "pose,joint_a1\n1,0\n"), Monitor{}),
               InputError);
}

TEST(ReportCamera, PointsOfTheBoardAreWhereAPinholeSeesThem) {
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "instruments" / "camera_on_hand.yaml");
  const MadeMoves made = make(problem, 10, 60, folder);
  ASSERT_EQ(made.report["cameras"].size(), 1U);
  const json& camera = made.report["cameras"][0];
  const auto& spec = std::get<CameraMeasurement>(problem.measurement.instrument);
  ASSERT_EQ(camera["pictures"].size(), 10U);
  EXPECT_EQ(camera["board"]["frame"], 0) << "the board stands still";
  const auto placed = [](const json& x) {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = Eigen::Vector3d(x[0], x[1], x[2]);
    X.linear() = Eigen::Quaterniond(x[6], x[3], x[4], x[5]).normalized().toRotationMatrix();
    return X;
  };
  for (std::size_t i = 0; i < 10; ++i) {
    // The camera's place is in the tip's frame, which is that of the last joint.
    const Eigen::Isometry3d X_CameraBoard =
        (*made.plan.poses[i].tool_pose * placed(camera["camera"]["placement"])).inverse() *
        placed(camera["board"]["placement"]);
    const json& pixels = camera["pictures"][i]["pixels"];
    ASSERT_EQ(pixels.size(), std::size_t(spec.rows * spec.columns));
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const Eigen::Vector3d p = X_CameraBoard * Eigen::Vector3d(double(int(k) % spec.columns) * spec.spacing,
                                                                double(int(k) / spec.columns) * spec.spacing, 0);
      // OpenCV's lens, written out.
      const auto& d = spec.distortion;
      const double x = p.x() / p.z(), y = p.y() / p.z(), s = x * x + y * y;
      const double radial = 1 + d[0] * s + d[1] * s * s + d[4] * s * s * s;
      const double u = spec.fx * (x * radial + 2 * d[2] * x * y + d[3] * (s + 2 * x * x)) + spec.cx;
      const double v = spec.fy * (y * radial + d[2] * (s + 2 * y * y) + 2 * d[3] * x * y) + spec.cy;
      EXPECT_NEAR(pixels[k][0].get<double>(), u, 0.2) << "placements are written to 10 µm and 10 µrad";
      EXPECT_NEAR(pixels[k][1].get<double>(), v, 0.2);
      EXPECT_TRUE(u >= 0 && u <= spec.width && v >= 0 && v <= spec.height) << "planned poses see the whole board";
    }
  }
  // Corners of the picture are seen along their lines of sight.
  const std::vector<Eigen::Vector2d> corners = {{0, 0}, {spec.width, 0}, {spec.width, spec.height}, {0, spec.height}};
  for (std::size_t c = 0; c < 4; ++c) {
    const double x = camera["corners"][c][0], y = camera["corners"][c][1], s = x * x + y * y;
    const auto& d = spec.distortion;
    const double radial = 1 + d[0] * s + d[1] * s * s + d[4] * s * s * s;
    EXPECT_NEAR(spec.fx * (x * radial + 2 * d[2] * x * y + d[3] * (s + 2 * x * x)) + spec.cx, corners[c].x(), 0.1);
    EXPECT_NEAR(spec.fy * (y * radial + d[2] * (s + 2 * y * y) + 2 * d[3] * x * y) + spec.cy, corners[c].y(), 0.1);
  }
}

TEST(ReportNearest, WrittenPointsAreAsFarApartAsTheBodies) {
  const TemporaryFolder folder;
  Problem problem = read_problem(examples_folder() / "cell" / "problem.yaml");
  problem.workspace.motion.reachable = false;
  const MadeMoves made = make(problem, 14, 100, folder);
  int stated = 0;
  for (const json& pose : made.report["plan"]["poses"]) {
    if (!pose["nearest"].contains("points")) continue;
    ++stated;
    const json& p = pose["nearest"]["points"];
    const double apart =
        (Eigen::Vector3d(p[0][0], p[0][1], p[0][2]) - Eigen::Vector3d(p[1][0], p[1][1], p[1][2])).norm();
    EXPECT_NEAR(apart, pose["nearest"]["distance"].get<double>(), 1e-5);
  }
  EXPECT_GT(stated, 10);
}

}  // namespace
}  // namespace posewright
