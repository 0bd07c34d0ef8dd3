// Second roads to proofs: grids of candidates finer than any plan needs, sensitivities at random configurations by the
// model alone.
#include "posewright/proof/workspace_proof.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "posewright/criterion/determinant.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/proof/harmonic_rows.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/space.hpp"
#include "posewright/support/random.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/workspace/workspace.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/planar_arm.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;
using testing::Not;

class WorkspaceProofs : public testing::Test {
 protected:
  Problem arm(const std::string& more = "", const std::string& parameters = "q1.offset, q2.offset, tool.x",
              const std::string& workspace = "", const std::string& robot = "", const std::string& margin = "0 deg") {
    folder_.write("arm.urdf", planar_arm_urdf);
    return read_problem(
        folder_.write("p.yaml", "posewright: 1\nrobot: {urdf: arm.urdf" + robot +
                                    "}\nmeasurement: {type: pose, components: [x, y], device: {type: "
                                    "isotropic, "
                                    "noise: {position: 0.1 mm, rotation: 1 deg}}" +
                                    more + "}\nvariants:\n  only: {parameters: [" + parameters +
                                    "]}\nworkspace: {joints: {margin: " + margin + "}" + workspace +
                                    "}\ndesign: {variant: only, criterion: o1, poses: 6, candidates: 300}\n"));
  }
  /// The best of the places on a grid of both joints' limits is below what no plan exceeds, and not far.
  static void expect_best_of_a_grid_below(const Problem& problem, const Plan& plan, int steps,
                                          const std::function<bool(double, double)>& allowed) {
    std::vector<std::vector<double>> grid;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= steps; ++j) {
        const double q1 = -2 + 4.0 * i / steps, q2 = -2 + 4.0 * j / steps;
        if (allowed(q1, q2)) grid.push_back({q1, q2});
      }
    DesignEdits options;
    options.candidates_from = given_poses(problem, grid);
    options.edit("repeats", "allow");
    const Plan on_grid = planned(problem, options);
    EXPECT_LE(on_grid.certificate.bound, plan.certificate.workspace->bound + 1e-9);
    EXPECT_GT(on_grid.certificate.bound, plan.certificate.workspace->bound - 0.02 * 3);
  }
  TemporaryFolder folder_;
};

TEST_F(WorkspaceProofs, NoGridOfCandidatesHasAPlanBeyondTheBound) {
  const Problem problem = arm();
  const Plan plan = plan_problem(problem, {}, Monitor{});
  ASSERT_TRUE(plan.certificate.workspace && plan.certificate.workspace->proved) << plan.certificate.workspace->why_not;
  expect_best_of_a_grid_below(problem, plan, 60, [](double, double) { return true; });
  EXPECT_LE(plan.log_det, plan.certificate.workspace->bound);
  EXPECT_THAT(plan_summary(plan), HasSubstr("Proved within the joint limits, between"));
}

TEST_F(WorkspaceProofs, TheSentenceNamesTheMarginWithoutWhichTheBoundDoesNotHold) {
  const Problem problem = arm("", "q1.offset, q2.offset, tool.x", "", "", "60 deg");
  const Plan plan = plan_problem(problem, {}, Monitor{});
  ASSERT_TRUE(plan.certificate.workspace && plan.certificate.workspace->proved) << plan.certificate.workspace->why_not;
  EXPECT_THAT(plan_summary(plan), HasSubstr("Proved within the joint limits less 60 deg, between"));
  const double inner = 2 - 60 * std::numbers::pi / 180 + 1e-9;
  expect_best_of_a_grid_below(problem, plan, 98,
                              [&](double q1, double q2) { return std::abs(q1) <= inner && std::abs(q2) <= inner; });
  DesignEdits options;
  options.candidates_from = given_poses(problem, {{-2, -2}, {-2, 2}, {2, -2}, {2, 2}, {0, 1.5}, {0, -1.5}});
  options.edit("repeats", "allow");
  EXPECT_GT(planned(problem, options).log_det, plan.certificate.workspace->bound);
}

TEST_F(WorkspaceProofs, IsRefusedWhereTheJointsReadWorseThanTheInstrument) {
  // 0.1 mm beside 0.5 mrad of links of a metre or so: one matrix for the whole workspace is far too high.
  const Plan plan = plan_problem(arm("", "q1.offset, q2.offset, tool.x", "", ", encoder_noise: 0.0005"), {}, Monitor{});
  ASSERT_TRUE(plan.certificate.workspace);
  EXPECT_FALSE(plan.certificate.workspace->proved);
  EXPECT_THAT(plan.certificate.workspace->why_not,
              HasSubstr("the bound of joint noise, visit noise or deflections is "));
}

/// What is there to be bounded beside an arm seen by points: word of the problem file, and whether the bound is d
/// itself up to the width of boxes.
struct Kind {
  std::string name, robot, measurement, columns;
  bool tight;
  bool turns = false;    ///< all its joints
  bool follows = false;  ///< the last joint follows the first
  int joints = 0;        ///< 0: any number
  /// Words of the problem file that limit the workspace about a place of the tip.
  std::string (*limits)(const Eigen::Isometry3d&, Random&) = nullptr;
};

std::string tool_box(const Eigen::Isometry3d& X, Random& random) {
  std::string text = ", tool: {";
  for (int i = 0; i < 3; ++i) {
    const double at = X.translation()[i];
    text += fmt::format("{}{}: [{}, {}]", i > 0 ? ", " : "", "xyz"[i], at - random.uniform(0.001, 0.2),
                        at + random.uniform(0.001, 0.2));
  }
  return text + "}";
}

/// Seen from the tracker's station: at that place with room to spare.
std::string sight(const Eigen::Isometry3d& X, Random& random) {
  const Eigen::Vector3d way = Eigen::Vector3d(3, 1, 0.5) - X.translation();
  const Eigen::Vector3d normal = X.linear().transpose() * way.normalized();
  return fmt::format(", line_of_sight: {{range: [{}, {}], acceptance: {} deg, normals: {{\"*\": [{}, {}, {}]}}}}",
                     way.norm() - random.uniform(0.5, 0.8), way.norm() + random.uniform(0.5, 0.8),
                     random.uniform(25, 40), normal.x(), normal.y(), normal.z());
}

std::vector<Kind> kinds() {
  const std::string isotropic = "device: {type: isotropic, noise: 0.1 mm}";
  const std::string tracker =
      "device: {type: laser_tracker, noise: {range: 3 um, range_per_m: 1 um, angle: 6 urad}, stations: {A: [3, 1, 0.5]";
  const std::string elastic =
      ", elastostatic: {loads: {light: {mass: 2, centre_of_mass: [0.1, 0, 0.2]}, heavy: {force: [20, -40, -150], "
      "point: [0.1, 0.2, -0.1], moment: [3, -2, 5]}}";
  const std::string list = "- {name: a, type: points, targets: {P: [0.1, 0.2, 0.1], Q: [0, 0.1, 0.3]}, " + tracker +
                           "}}}\n  - {name: b, type: position, target: [0.2, 0.1, 0.1], " + isotropic +
                           ", repeatability: 30 um}\n";
  return {
      {"points", "", isotropic, "", true},
      {"tracker", "", tracker + "}}", "", true},
      {"tracker with a displacement of each visit", "", tracker + "}}\n  repeatability: 100 um", "", false},
      {"two stations", "", tracker + ", B: [-2, -3, 1]}}", "station.B.x, ", true},
      {"noise of the joints", ", encoder_noise: 0.0003", isotropic, "", false},
      {"gear", "", isotropic, "j0.gear, ", false},
      {"points in a box", "", isotropic, "", true, false, false, 0, tool_box},
      {"noise of the joints in a box", ", encoder_noise: 0.0003", isotropic, "", false, false, false, 0, tool_box},
      {"tracker that sees some", "", tracker + "}}", "", true, false, false, 0, sight},
      {"position", "", "type: position\n  target: [0.1, 0.05, -0.02]\n  " + isotropic, "", true},
      {"pose", "", "type: pose\n  device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.01 deg}}", "", true},
      {"distances", "",
       "type: distance\n  targets: {A: [0.1, 0.05, -0.02]}\n  anchors: {P: [3, 2, 0.5], Q: [-2, 3, 1]}\n  " + isotropic,
       "", false},
      {"a list of instruments", "", list, "target@a.P.x, target@b.target.y, ", true},
      {"a joint that follows", "", isotropic, "", true, true, true},
      {"compliances", elastic + "}", isotropic, "j0.compliance, ", true, true},
      {"deflections", elastic + ", compliance: {j0: 1e-5}}", isotropic, "j0.compliance, ", false, true},
      {"loaded minus unloaded", elastic + ", compliance: {j0: 1e-5}}", isotropic + "\n  load: loaded_minus_unloaded",
       "j0.compliance, ", false, true},
      {"eccentricity and gear teeth", ", joint_effects: {j0: {eccentricity: yes, gear_ratio: 31}}", isotropic,
       "j0.cos1, j0.sin1, j0.cos2, j0.sin2, j0.cos_g, j0.sin_g, ", false}};
}

/// A chain of one to four random joints with small ranges, seen by points; what a test of its sensitivity needs.
struct RandomArm {
  std::unique_ptr<IdentificationModel> model;
  std::unique_ptr<Workspace> workspace;
  Problem problem;
  std::vector<double> inside;  // feasible
  std::vector<int> selected;
  Eigen::MatrixXd scale, factor;  // R of the columns, T of d(q) = ‖J(q) R⁻¹ T‖²

  RandomArm(const TemporaryFolder& folder, const Kind& kind, Random& random) {
    const auto triple = [&](double size) {
      return fmt::format("{} {} {}", random.uniform(-size, size), random.uniform(-size, size),
                         random.uniform(-size, size));
    };
    std::string text = "<robot name=\"chain\"><link name=\"base\"/>", parent = "base", joints;
    // What a gear adds is another number a turn further.
    const bool several_turns = kind.name == "gear" && random.uniform() < 0.5;
    const int count = kind.joints > 0 ? kind.joints : (kind.follows ? 2 : 1) + random.index(kind.turns ? 2 : 4);
    for (int k = 0; k < count; ++k) {
      const std::string child = fmt::format("l{}", k);
      // Effects of joints are of the first, and of one that turns.
      const bool turns = random.uniform() < 0.7 || (k == 0 && !kind.robot.empty()) || kind.turns;
      const bool follows = kind.follows && k == count - 1;
      const double middle = random.uniform(-2, 2), half = several_turns && k == 0 && turns
                                                              ? random.uniform(3.3, 6.0)
                                                              : random.uniform(0.05, turns ? 0.5 : 0.2);
      text += fmt::format(
          "<link name=\"{0}\"/><joint name=\"j{1}\" type=\"{2}\"><parent link=\"{3}\"/><child link=\"{0}\"/><origin "
          "xyz=\"{4}\" rpy=\"{5}\"/><axis xyz=\"{6}\"/><limit lower=\"{7}\" upper=\"{8}\" effort=\"1\" "
          "velocity=\"1\"/>{9}</joint>",
          child, k, turns ? "revolute" : "prismatic", parent, triple(0.5), triple(3), triple(1),
          follows ? -4 : middle - half, follows ? 4 : middle + half,
          follows ? "<mimic joint=\"j0\" multiplier=\"-1\"/>" : "");
      joints += fmt::format("{1}j{0}.x, j{0}.rx, j{0}.rz, ", k, follows ? "" : fmt::format("j{}.offset, ", k));
      parent = child;
    }
    folder.write("arm.urdf", text + "</robot>");
    const std::string points =
        fmt::format("type: points\n  targets: {{A: [{}, {}, 0.1], B: [{}, 0.05, {}]}}\n  ", random.uniform(-0.3, 0.3),
                    random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
    const std::string before = "posewright: 1\nrobot: {urdf: arm.urdf" + kind.robot + "}\nmeasurement:\n  " +
                               (kind.measurement.starts_with("device") ? points : "") + kind.measurement +
                               "\nvariants: {v: {parameters: [" + joints + kind.columns +
                               "base.x, base.rz]}}\nworkspace: {joints: {margin: 0}";
    problem = read_problem(folder.write("p.yaml", before + "}\n"));
    if (auto* list = std::get_if<InstrumentList>(&problem.measurement.instrument))
      list->instruments.front().noise_factor = 1.7;
    model = make_model(problem);
    for (const Coordinate& c : model->coordinates())
      inside.push_back(c.discrete() ? c.values.front() : random.uniform(c.lower, c.upper));
    std::shared_ptr<const Cell> cell;
    if (kind.limits != nullptr) {
      problem = read_problem(folder.write("p.yaml", before + kind.limits(model->tool_pose(inside), random) + "}\n"));
      model = make_model(problem);
      if (problem.workspace.line_of_sight) cell = make_cell(problem);
    }
    workspace = std::make_unique<Workspace>(*model, problem, cell);
    selected = select_columns(*model, {problem, problem.variants.front()}).selected;
    const auto m = Eigen::Index(selected.size());
    // Columns of very different size, as units and tolerances make them: rounding has its chance.
    Eigen::VectorXd size(m);
    for (double& s : size) s = std::pow(10.0, random.uniform(-12, 12));
    scale = size.asDiagonal();
    factor.resize(m, 1 + random.index(int(m)));
    for (double& value : factor.reshaped()) value = random.normal();
    factor = scale * factor * 1e-4;
  }

  double sensitivity(ConfigurationSpace::Probe& probe, const std::vector<double>& q, BlockArray& block) const {
    EXPECT_TRUE(probe.block(q, block.row(0, 0), block.stride()));
    return (block.block(0) * factor).squaredNorm();
  }
};

TEST_F(WorkspaceProofs, NoConfigurationOfARandomArmIsBeyondTheBound) {
  const char* wanted = std::getenv("POSEWRIGHT_RANDOM_ARMS");
  const int arms = wanted != nullptr ? std::atoi(wanted) : 140;
  int wide = 0, refused = 0, loose = 0, refuted = 0;
  const std::vector<Kind> all = kinds();
  for (int i = 0; i < arms; ++i) {
    Random random(23, std::uint64_t(i));
    const Kind& kind = all[std::size_t(i) % all.size()];
    SCOPED_TRACE(kind.name);
    const RandomArm arm(folder_, kind, random);
    const auto space =
        make_configuration_space({{arm.model.get(), arm.workspace.get(), arm.selected, {}}}, {}, {}, {}, arm.scale);
    const int m = int(arm.selected.size()), rows = arm.model->block_rows(arm.selected);
    const auto probe = space->probe();
    BlockArray block(1, rows, m);
    // Dense sampling, its best taken uphill by ever smaller random steps.
    ASSERT_TRUE(probe->feasible(arm.inside));
    double largest = arm.sensitivity(*probe, arm.inside, block);
    std::vector<double> best = arm.inside, q;
    const auto& axes = arm.workspace->coordinates();
    for (int sample = 0; sample < 1200; ++sample) {
      const double reach = sample < 600 ? 1.0 : std::pow(0.98, sample - 600);
      q.clear();
      for (std::size_t k = 0; k < axes.size(); ++k) {
        const double width = axes[k].upper - axes[k].lower;
        if (axes[k].discrete()) {
          q.push_back(axes[k].values[std::size_t(random.index(int(axes[k].values.size())))]);
          continue;
        }
        const double at = sample < 600 ? random.uniform(axes[k].lower - 0.1 * width, axes[k].upper + 0.1 * width)
                                       : best[k] + reach * width * random.normal();
        q.push_back(std::clamp(at, axes[k].lower, axes[k].upper));
      }
      if (!probe->feasible(q)) continue;
      const double d = arm.sensitivity(*probe, q, block);
      if (d > largest) largest = d, best = q;
    }
    WorkspaceBound result;
    result.factor = arm.factor;
    // Far below the largest value, so that the proof has to find it.
    result.degree = 1e-2 * largest;
    // What can be chosen is tuned to where d is large.
    result.support = {best};
    result.weights = {1.0};
    // What takes long is stopped, and is a bound too.
    WorkspaceBoundOptions options;
    options.proof.seconds = 0.25;
    prove_workspace(result, *space, 1000, rows, options, Monitor{});
    // Cut short: a busy machine did not even interpolate it in time.
    if (result.proof.why_not == WorkspaceProof::cut_short ||
        (!kind.tight && result.proof.why_not.find("too high") != std::string::npos)) {
      ++refused;
      continue;
    }
    ASSERT_EQ(result.proof.why_not, "") << "arm " << i;
    EXPECT_GE(result.proof.max_ratio * result.degree, largest * (1 - 1e-12)) << "arm " << i;
    if (const auto& refuting = result.proof.refuted_by; !refuting.empty()) {
      EXPECT_TRUE(probe->feasible(refuting));
      EXPECT_GT(arm.sensitivity(*probe, refuting, block), result.degree);
      refuted += 1;
    }
    wide += int(kind.tight && result.proof.max_ratio * result.degree > 1.005 * largest);
    if (kind.tight) {
      EXPECT_LT(result.proof.max_ratio * result.degree, 20 * largest) << "arm " << i;
    }
    loose += int(result.proof.max_ratio * result.degree > 20 * largest);
  }
  // A bound that is nowhere near would hold as well; random steps do not always find the largest value.
  EXPECT_LT(wide, arms / 20);
  EXPECT_LT(refused, arms / 7);
  EXPECT_LT(loose, arms / 100);
  // The weight on one place is never optimal: a feasible configuration says so.
  EXPECT_GT(refuted, arms / 2);
}

TEST_F(WorkspaceProofs, NoColumnOfAnElasticArmIsFartherFromItsExpansionThanStated) {
  double nearest = 0;
  for (Kind kind : kinds()) {
    if (kind.name != "deflections" && kind.name != "loaded minus unloaded") continue;
    // Deflections of some degrees: what the first order leaves out is far above rounding.
    kind.robot.replace(kind.robot.find("1e-5"), 4, "3e-4, j1: 2e-4");
    kind.columns += "j1.gear, j1.compliance, ";
    for (int i = 0; i < 40; ++i) {
      Random random(37, std::uint64_t(i));
      kind.joints = 2 + i % 2;
      const RandomArm arm(folder_, kind, random);
      const int m = int(arm.selected.size()), rows = arm.model->block_rows(arm.selected);
      Linearisation scratch;
      BlockArray::RowMatrix J(rows, m), B;
      for (int sample = 0; sample < 50; ++sample) {
        std::vector<double> q, factors;
        for (const Coordinate& c : arm.workspace->coordinates())
          q.push_back(c.discrete() ? c.values[std::size_t(random.index(int(c.values.size())))]
                                   : random.uniform(c.lower, c.upper));
        std::string why_not;
        const auto expansion = harmonic_expansion(*arm.model, q, arm.selected, why_not);
        ASSERT_NE(expansion, nullptr) << why_not;
        for (const ColumnFactor& f : expansion->factors()) factors.push_back(q[std::size_t(f.coordinate)]);
        ASSERT_TRUE(expansion->at(q, factors, *expansion->work(), B, {}));
        ASSERT_TRUE(whitened_block(*arm.model, q, {}, arm.selected, scratch, J.data(), m));
        const std::vector<double>& remainders = expansion->remainders();
        for (int c = 0; c < m; ++c) {
          const double off = (J.col(c) - B.col(c)).norm(),
                       stated = remainders.empty() ? 0.0 : remainders[std::size_t(c)];
          EXPECT_LE(off, stated * (1 + 1e-9) + 1e-8 * J.col(c).norm() + 1e-9)
              << kind.name << " " << i << ": "
              << arm.model->parameters()[std::size_t(arm.selected[std::size_t(c)])].name;
          if (stated > 0) nearest = std::max(nearest, off / stated);
        }
      }
    }
  }
  // A remainder that is nowhere near would hold as well.
  EXPECT_GT(nearest, 0.2);
}

TEST_F(WorkspaceProofs, NoTargetOfATrackerIsFartherFromTheMeanDistanceThanStated) {
  double nearest = 0;
  for (const Kind& kind : kinds()) {
    if (kind.name != "tracker" && kind.name != "two stations") continue;
    for (int i = 0; i < 40; ++i) {
      Random random(41, std::uint64_t(i));
      const RandomArm arm(folder_, kind, random);
      for (int sample = 0; sample < 50; ++sample) {
        std::vector<double> q;
        for (const Coordinate& c : arm.workspace->coordinates())
          q.push_back(c.discrete() ? c.values[std::size_t(random.index(int(c.values.size())))]
                                   : random.uniform(c.lower, c.upper));
        std::string why_not;
        const auto rows = harmonic_rows(*arm.model, q, arm.selected, why_not);
        ASSERT_NE(rows, nullptr) << why_not;
        ASSERT_EQ(rows->distances(), 2);
        ASSERT_EQ(rows->spreads().size(), 2u);
        double r[2];
        BlockArray::RowMatrix B;
        ASSERT_TRUE(rows->at(q, {}, *rows->work(), B, r));
        for (const int t : {0, 1}) {
          const DistanceSpread& spread = rows->spreads()[std::size_t(t)];
          const double off = std::abs(0.5 * (r[0] + r[1]) - r[t]),
                       stated = spread.slope * std::sqrt(r[t]) + spread.constant;
          EXPECT_LE(off, stated) << kind.name << " " << i;
          nearest = std::max(nearest, off / stated);
        }
      }
    }
  }
  EXPECT_GT(nearest, 0.7);
}

TEST_F(WorkspaceProofs, WhatIsNoPolynomialIsSearchedAndSaidToBe) {
  const auto why = [&](const Problem& problem) {
    DesignEdits options;
    options.edit("candidates", 200);
    const Plan plan = planned(problem, options);
    EXPECT_FALSE(plan.certificate.workspace->proved);
    EXPECT_THAT(plan_summary(plan), HasSubstr("no proof: "));
    return plan.certificate.workspace->why_not;
  };
  EXPECT_THAT(why(arm(", repeatability: {position: 0.1 mm, rotation: 0.01 deg}")), HasSubstr("turns of each visit"));
  EXPECT_THAT(why(example("instruments/camera_on_hand.yaml")), HasSubstr("not linear in where the tip is"));
}

TEST_F(WorkspaceProofs, ASearchThatDidNotEndGivesNoFigureButWhatIsNotExceeded) {
  DesignEdits options;
  options.edit("candidates", 1000);
  Plan plan = planned(arm(", repeatability: {position: 0.1 mm, rotation: 0.01 deg}"), options);
  Certificate::Workspace& whole = *plan.certificate.workspace;
  ASSERT_TRUE(whole.settled) << whole.method;
  EXPECT_THAT(plan_summary(plan), HasSubstr("Over the whole workspace: "));
  EXPECT_THAT(plan_summary(plan), Not(HasSubstr("no figure")));
  EXPECT_THAT(whole.method, HasSubstr(" more from drawn candidates found nothing better"));
  EXPECT_GE(whole.at_most, whole.efficiency);
  EXPECT_NEAR(whole.at_most, whole.efficiency, 0.005);
  EXPECT_THAT(plan_summary(plan), HasSubstr("Predicted σ: from the stated noise alone"));
  whole.settled = false;
  whole.at_most = 0.8765;
  EXPECT_THAT(plan_summary(plan), HasSubstr("Over the whole workspace: no figure, the search for better poses was not "
                                            "finished; at most 87.7 % of the best (no proof: "));
  whole.at_most = 1.02;
  EXPECT_THAT(plan_summary(plan), HasSubstr("was not finished (no proof: "));
}

TEST_F(WorkspaceProofs, TakesWhatRefutesItIntoTheWeights) {
  const Problem problem = arm();
  const auto model = make_model(problem);
  const Workspace workspace(*model, problem);
  const std::vector<int> selected = select_columns(*model, {problem, problem.variants.front()}).selected;
  const int m = int(selected.size()), rows = model->block_rows(selected);
  Configurations candidates;
  candidates.dimension = 2;
  Random random(3, 1);
  for (int i = 0; i < 80; ++i) candidates.values.push_back(random.uniform(-0.3, 0.3));
  const auto space = make_configuration_space({{model.get(), &workspace, selected, {}}}, candidates, {}, {},
                                              Eigen::MatrixXd::Identity(m, m));
  BlockArray blocks(candidates.count(), rows, m);
  const auto probe = space->probe();
  for (std::size_t i = 0; i < candidates.count(); ++i) probe->block(candidates[i], blocks.row(i, 0), blocks.stride());
  const LogDetFunction log_det(0, m);
  const ApproximateDesign design = solve_approximate_design(blocks, log_det, {}, Monitor{});
  WorkspaceBoundOptions options;
  // Searches from nowhere: all that is good beyond the candidates is missed.
  options.starts = 0;
  options.rounds = 1;
  WorkspaceBound once = workspace_bound(blocks, design, log_det, *space, options, Monitor{}), settled = once;
  prove_workspace(once, *space, blocks.count(), rows, options, Monitor{});
  ASSERT_FALSE(once.proof.refuted_by.empty());
  settle_workspace(settled, blocks, design, log_det, *space, options, Monitor{});
  ASSERT_EQ(settled.proof.why_not, "");
  EXPECT_LT(settled.proof.bound, once.proof.bound - 0.1);
  EXPECT_GT(settled.value, once.value);
  EXPECT_GE(settled.proof.bound, settled.value);
}

TEST_F(WorkspaceProofs, CountsTheToolBoxAndSaysSo) {
  const std::string columns = "q1.offset, q2.offset, tool.x", box = ", tool: {x: [0.9, 1.2], y: [-0.2, 0.2]}";
  const Plan free = plan_problem(arm("", columns), {}, Monitor{});
  const Problem problem = arm("", columns, box);
  const Plan plan = plan_problem(problem, {}, Monitor{});
  ASSERT_TRUE(plan.certificate.workspace && plan.certificate.workspace->proved) << plan.certificate.workspace->why_not;
  EXPECT_THAT(plan_summary(plan), HasSubstr("Proved within the joint limits and the limits of tool box"));
  expect_best_of_a_grid_below(problem, plan, 400, [](double q1, double q2) {
    const double x = std::cos(q1) + 0.8 * std::cos(q1 + q2), y = std::sin(q1) + 0.8 * std::sin(q1 + q2);
    return x >= 0.9 && x <= 1.2 && std::abs(y) <= 0.2;
  });
  EXPECT_LT(plan.certificate.workspace->bound, free.certificate.workspace->bound);
}

TEST_F(WorkspaceProofs, OfPosesThatSomethingForbidsIsLooseAndSaysSo) {
  const Plan free = plan_problem(arm(), {}, Monitor{});
  const Plan plan =
      plan_problem(arm("", "q1.offset, q2.offset, tool.x",
                       ", collision: {tool: [{name: ball, sphere: 0.05}], obstacles: [{name: west, box: "
                       "[2, 6, 1], at: [-0.2, 0, 0]}, {name: east, box: [1, 6, 1], at: [1.75, 0, 0]}, "
                       "{name: north, box: [4, 2, 1], at: [0, 1.3, 0]}, {name: south, box: [4, 2, 1], at: "
                       "[0, -1.3, 0]}]}"),
                   {}, Monitor{});
  ASSERT_TRUE(plan.certificate.workspace);
  EXPECT_FALSE(plan.certificate.workspace->proved);
  EXPECT_THAT(plan.certificate.workspace->why_not, HasSubstr("forbidden by conditions outside it: collision with "));
  ASSERT_TRUE(plan.certificate.workspace->loose_bound);
  EXPECT_GE(*plan.certificate.workspace->loose_bound, plan.log_det);
  EXPECT_LT(plan.log_det, free.log_det);
}

TEST_F(WorkspaceProofs, PlanIsTheSameOnAnyNumberOfThreads) {
  const Problem problem = arm();
  const auto text = [&](int threads) {
    DesignEdits options;
    options.threads = threads;
    Plan plan = planned(problem, options);
    plan.statistics.seconds = 0;
    for (PlanStage& stage : plan.statistics.stages) stage.seconds = 0;
    return plan_json(plan);
  };
  EXPECT_EQ(text(1), text(3));
}

}  // namespace
}  // namespace posewright
