// What a report holds so that poses can be moved on its page: figures, verdicts and clearances near every pose, an arm
// that follows its joints, pictures that a camera will take.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <nlohmann/json.hpp>

#include "posewright/problem/read_problem.hpp"
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

/// As docs/report.md says: letters to six bits, two bytes a number, the lower one first.
std::vector<int> whole_numbers(const std::string& base64) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<int> bytes, numbers;
  unsigned word = 0;
  int bits = 0;
  for (const char c : base64) {
    if (c == '=') break;
    word = word << 6 | unsigned(letters.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(int(word >> bits & 0xff));
  }
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const int number = bytes[i] + 256 * bytes[i + 1];
    numbers.push_back(number < 32768 ? number : number - 65536);
  }
  return numbers;
}

/// B(k) = T₀ + Σ k_i T_i + Σ_{i ≤ j} k_i k_j T_ij.
Eigen::MatrixXd block(const json& pose, const std::vector<int>& k, Eigen::Index m) {
  const std::vector<int> terms = whole_numbers(pose["terms"]);
  const Eigen::Index r = pose["rows"];
  std::vector<std::pair<double, int>> factors{{1.0, 0}};
  for (const int i : k) factors.emplace_back(i, 1);
  for (std::size_t i = 0; i < k.size(); ++i)
    for (std::size_t j = i; j < k.size(); ++j) factors.emplace_back(k[i] * k[j], 2);
  EXPECT_EQ(terms.size(), factors.size() * std::size_t(r * m));
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(r, m);
  std::size_t next = 0;
  for (const auto& [factor, order] : factors)
    for (Eigen::Index i = 0; i < r; ++i)
      for (Eigen::Index j = 0; j < m; ++j)
        B(i, j) += factor * terms[next++] * pose["scale"][std::size_t(order)][std::size_t(j)].get<double>();
  return B;
}

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

/// The plan's configurations with one of them k steps away.
Configurations moved_list(const Study& study, const MadeMoves& made, std::size_t moved, const std::vector<int>& k) {
  const json& n = made.report["neighbours"];
  Configurations list;
  list.dimension = int(study.first().workspace->coordinates().size());
  for (std::size_t i = 0; i < made.plan.poses.size(); ++i) {
    std::vector<double> q;
    for (const NamedValue& v : made.plan.poses[i].configuration) q.push_back(v.value);
    for (std::size_t j = 0; i == moved && j < k.size(); ++j)
      if (k[j] != 0)
        q[n["coordinates"][j]["index"].get<std::size_t>()] += k[j] * n["poses"][i]["steps"][j].get<double>();
    q.resize(std::size_t(list.dimension), 0.0);  // one station, one load case
    append(list, q);
  }
  return list;
}

void expect_figures(const Problem& problem, int poses, int candidates, double told_share) {
  const TemporaryFolder folder;
  const MadeMoves made = make(problem, poses, candidates, folder);
  const json& n = made.report["neighbours"];
  ASSERT_FALSE(n.is_null()) << made.report["why_no_neighbours"];
  const Problem searched = made.options.of(problem);
  const Study study = make_study(resolve(searched, made.options, Monitor{}), Monitor{});
  const auto m = Eigen::Index(made.report["columns"].size());
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(m, m);
  Eigen::VectorXd tolerance(m);
  Eigen::Index nuisance = 0;
  double units = 0;
  for (Eigen::Index j = 0; j < m; ++j) {
    const json& column = made.report["columns"][std::size_t(j)];
    tolerance[j] = column["tolerance"];
    if (column["role"] == "nuisance") ++nuisance;
    else units += 2 * std::log(tolerance[j]);
  }
  for (const json& pose : made.report["information"]["poses"]) M += unpacked(pose["packed"], m);
  EXPECT_LE(n["errors"]["efficiency"].get<double>(), 1e-4);
  EXPECT_LE(n["errors"]["sigma"].get<double>(), 1e-3);
  Random random(4, 0);
  int told = 0, feasible = 0;
  constexpr int looks = 150;
  for (int look = 0; look < looks; ++look) {
    const auto moved = std::size_t(random.index(poses));
    const json& pose = n["poses"][moved];
    const auto place = std::size_t(random.index(int(n["places"].size())));
    const std::vector<int> k = n["places"][place];
    const Configurations list = moved_list(study, made, moved, k);
    const int verdict = pose["verdicts"][place];
    const int reason = study.first().workspace->violation(list[moved]);
    EXPECT_EQ(verdict < 0, reason < 0);
    feasible += reason < 0;
    if (reason >= 0) {
      EXPECT_EQ(n["reasons"][std::size_t(verdict)], study.first().workspace->reasons()[std::size_t(reason)]);
    }
    if (study.cell->collision != nullptr) {
      const auto nearest = study.cell->collision->nearest(list[moved]);
      ASSERT_TRUE(nearest.has_value());
      EXPECT_NEAR(pose["clearance"][place].get<double>() * 1e-4, nearest->distance, 0.51e-4);
    }
    if (pose["told"][place] == 0) continue;
    ++told;
    const Judgement judgement = judge(study, list);
    const Eigen::MatrixXd B = block(pose, k, m), B0 = block(pose, std::vector<int>(k.size(), 0), m);
    const Eigen::MatrixXd changed = M + B.transpose() * B - B0.transpose() * B0;
    const auto log_det = [](const Eigen::MatrixXd& A) { return std::log(A.llt().matrixLLT().diagonal().prod()) * 2; };
    const double stated =
        log_det(changed) - (nuisance > 0 ? log_det(changed.topLeftCorner(nuisance, nuisance)) : 0) - units;
    EXPECT_NEAR(stated, judgement.evaluations.front().log_det,
                double(m - nuisance) * n["errors"]["efficiency"].get<double>() * 1.001 + 1e-9);
    const Eigen::VectorXd sigma = changed.inverse().diagonal().cwiseSqrt();
    for (Eigen::Index j = 0; j < m; ++j) {
      const double true_sigma = judgement.evaluations.front().sigma[j];
      EXPECT_NEAR(sigma[j] * tolerance[j], true_sigma,
                  true_sigma * (n["errors"]["sigma"].get<double>() * 1.001 + 1e-9));
    }
  }
  EXPECT_GT(told, told_share * looks);
  EXPECT_GT(feasible, looks / 4);
}

TEST(ReportMoves, FiguresAndVerdictsNearAPoseAreThoseOfTheMovedListInACell) {
  Problem problem = read_problem(examples_folder() / "cell" / "problem.yaml");
  problem.workspace.motion.reachable = false;  // another reason, and a roadmap
  expect_figures(problem, 14, 100, 0.5);
}

TEST(ReportMoves, FiguresNearAPoseAreThoseOfTheMovedListForAnArmAndForClosedChains) {
  expect_figures(read_problem(examples_folder() / "kr270" / "problem.yaml"), 12, 100, 0.9);
  expect_figures(read_problem(examples_folder() / "delta" / "problem.yaml"), 12, 100, 0.9);
  expect_figures(read_problem(examples_folder() / "telescope" / "problem.yaml"), 16, 100, 0.9);
}

TEST(ReportMoves, EvaluateAcceptsAMovedListExactlyWhereThePageSaysThatItIsFeasible) {
  const TemporaryFolder folder;
  Problem problem = read_problem(examples_folder() / "cell" / "problem.yaml");
  problem.workspace.motion.reachable = false;
  const MadeMoves made = make(problem, 14, 100, folder);
  const Problem searched = made.options.of(problem);
  const Study study = make_study(resolve(searched, made.options, Monitor{}), Monitor{});
  const json& n = made.report["neighbours"];
  std::vector<std::pair<std::size_t, std::size_t>> looks;  // two of each verdict
  for (const bool wanted : {true, false})
    for (std::size_t i = 0, found = 0; i < 14 && found < 2; ++i)
      for (std::size_t p = 0; p < n["places"].size(); p += 5)
        if ((n["poses"][i]["verdicts"][p] < 0) == wanted) {
          looks.emplace_back(i, p);
          ++found;
          break;
        }
  ASSERT_EQ(looks.size(), 4U);
  for (const auto& [i, p] : looks) {
    const std::vector<int> k = n["places"][p];
    const Configurations list = moved_list(study, made, i, k);
    std::vector<std::vector<double>> rows;
    for (std::size_t row = 0; row < list.count(); ++row) rows.emplace_back(list[row].begin(), list[row].end());
    const int verdict = n["poses"][i]["verdicts"][p];
    try {
      const auto judged = evaluate_problem(made.options.of(problem),
                                           poses_given(rows, study.first().workspace->coordinates()), {}, Monitor{});
      EXPECT_LT(verdict, 0);
      EXPECT_NEAR(judged.plan.poses[i].nearest->distance, n["poses"][i]["clearance"][p].get<double>() * 1e-4, 0.51e-4);
    } catch (const InputError& error) {
      ASSERT_GE(verdict, 0) << error.what();
      EXPECT_THAT(error.what(), testing::AnyOf(HasSubstr(n["reasons"][std::size_t(verdict)].get<std::string>()),
                                               HasSubstr("allowed: ")));  // beyond a limit the list is refused
    }
  }
}

TEST(ReportMoves, ARobotWithoutAChainIsDrawnAtWholeSteps) {
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "delta" / "problem.yaml");
  const MadeMoves made = make(problem, 12, 60, folder);
  EXPECT_TRUE(made.report["chain"].is_null());
  const Problem searched = made.options.of(problem);
  const Study study = make_study(resolve(searched, made.options, Monitor{}), Monitor{});
  const json& n = made.report["neighbours"];
  const int reach = n["reach"];
  for (std::size_t j = 0; j < n["coordinates"].size(); ++j) {
    std::vector<int> k(n["coordinates"].size(), 0);
    k[j] = reach;
    const Eigen::Isometry3d tip = study.first().model->tool_pose(moved_list(study, made, 2, k)[2]);
    for (int e = 0; e < 3; ++e)
      EXPECT_NEAR(n["poses"][2]["drawn"][j]["tip"][std::size_t(e)].get<double>(), tip.translation()[e], 1e-5);
  }
}

TEST(ReportMoves, WhatIsLeftOutIsSaid) {
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "delta" / "problem.yaml");
  const MadeMoves made = make(problem, 12, 60, folder);
  ReportOptions brief;
  brief.sizes = brief.candidates = brief.moves = false;
  const Report report = report_problem(problem, made.file, brief, Monitor{});
  EXPECT_FALSE(report.neighbours.has_value());
  EXPECT_THAT(report.why_no_neighbours, HasSubstr("--brief"));
}

TEST(ReportCamera, PointsOfTheBoardAreWhereAPinholeSeesThem) {
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "instruments" / "camera_on_hand.yaml");
  const MadeMoves made = make(problem, 10, 60, folder);
  const json& camera = made.report["camera"];
  const auto& spec = std::get<CameraMeasurement>(problem.measurement.instrument);
  ASSERT_EQ(camera["pictures"].size(), 10U);
  EXPECT_EQ(camera["on_tip"], true);
  const auto placed = [](const json& x) {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = Eigen::Vector3d(x[0], x[1], x[2]);
    X.linear() = Eigen::Quaterniond(x[6], x[3], x[4], x[5]).normalized().toRotationMatrix();
    return X;
  };
  for (std::size_t i = 0; i < 10; ++i) {
    const Eigen::Isometry3d X_CameraBoard =
        (*made.plan.poses[i].tool_pose * placed(camera["camera"])).inverse() * placed(camera["board"]);
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
