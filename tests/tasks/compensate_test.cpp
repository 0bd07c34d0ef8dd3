// Commands for a calibrated robot, judged by roads of their own: rigid motions multiplied out over the corrected URDF,
// potential energy for what loads bend, leg vectors for platforms.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "posewright/lists/parameters_file.hpp"
#include "posewright/model/apply_parameters.hpp"
#include "posewright/model/corrected_urdf.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"
#include "posewright/tasks/compensate_problem.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/urdf_text.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Joints = std::vector<double>;

constexpr double micro = 1e-6;  // m or rad: what a commanded pose may miss

/// Corrections of `share` tolerances at most to the parameters that `free` matches, as a parameters file has them.
std::vector<EstimatedValue> random_values(const Problem& problem, const std::string& free, double share,
                                          std::uint64_t seed) {
  const VariantSpec& variant = problem.variants.front();
  const auto model = make_model({problem, variant});
  Random random(seed, 0);
  std::vector<double> correction;
  for (const Parameter& p : model->parameters())
    correction.push_back(std::regex_match(p.name, std::regex(free)) ? share * random.uniform(-1, 1) * p.tolerance
                                                                    : 0.0);
  std::vector<EstimatedValue> values;
  for (const CalibratedValue& v : calibrated_values({problem, variant}, *model, correction)) values.push_back({v, {}});
  return values;
}

Problem calibrated(Problem problem, const std::vector<EstimatedValue>& values) {
  apply_parameters(
      problem, parse_calibrated_parameters(parameters_yaml({problem, problem.variants.front()}, values), "cal.yaml"),
      {});
  return problem;
}

std::vector<CalibratedValue> plain(const std::vector<EstimatedValue>& values) {
  std::vector<CalibratedValue> result;
  for (const EstimatedValue& v : values) result.push_back(v.value);
  return result;
}

/// Poses anywhere within `share` of the limits about their middle; choices at random.
PoseList random_poses(const Problem& problem, int count, double share, std::uint64_t seed) {
  const std::vector<Coordinate> coordinates = compensation_coordinates(problem);
  Random random(seed, 1);
  PoseList list;
  list.name = "list.csv";
  for (int i = 0; i < count; ++i) {
    Joints q;
    for (const Coordinate& c : coordinates) {
      const double half = share * (c.upper - c.lower) / 2, middle = (c.upper + c.lower) / 2;
      q.push_back(c.discrete() ? c.values[std::size_t(random.index(int(c.values.size())))]
                               : random.uniform(middle - half, middle + half));
    }
    list.configurations.push_back(q);
    list.ids.push_back(i + 1);
    list.lines.push_back(i + 2);
  }
  return list;
}

Joints command_of(const Compensation& c, std::size_t pose) {
  const auto q = c.lists.front().configuration(pose);
  return {q.begin(), q.end()};
}

/// The product of rigid motions, as the URDF's description has it.
Eigen::Isometry3d tip_by_hand(const ChainDescription& chain, const Joints& q) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (const ChainJoint& joint : chain.joints) {
    const double value = joint.multiplier * q[std::size_t(joint.coordinate)] + joint.offset;
    X = X * joint.X_ParentJoint;
    if (joint.prismatic) X = X * Eigen::Translation3d(value * joint.axis);
    else X = X * Eigen::AngleAxisd(value, joint.axis);
  }
  return X * chain.X_LastTip;
}

double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  // Of the chord, since the cosine of a microradian is one.
  return 2 * std::asin(std::min(1.0, (a.linear() - b.linear()).norm() / std::sqrt(8.0)));
}

void expect_same_pose(const Eigen::Isometry3d& found, const Eigen::Isometry3d& wanted) {
  EXPECT_LT((found.translation() - wanted.translation()).norm(), micro);
  EXPECT_LT(angle_between(found, wanted), micro);
}

/// The arm of the URDF that the calibration writes.
ChainDescription corrected_arm(const Problem& problem, const std::vector<EstimatedValue>& values) {
  const TemporaryFolder folder;
  SerialArmSpec arm = std::get<SerialArmSpec>(problem.robot);
  const CorrectedUrdf urdf = corrected_urdf(arm, {}, problem.variants.front().convention, plain(values));
  arm.urdf = folder.write("corrected.urdf", urdf.text);
  return read_urdf_chain(arm, {});
}

ChainDescription nominal_arm(const Problem& problem) {
  return read_urdf_chain(std::get<SerialArmSpec>(problem.robot), {});
}

const char* const pose_instrument =
    "measurement: {type: pose, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}}\n"
    "variants: {all: {parameters: auto}}\ndesign: {poses: 20}\n";

Problem arm_problem(const TemporaryFolder& folder, const std::string& kind, const std::string& more = "") {
  for (const NamedChain& named : named_chains())
    if (named.name == kind) folder.write("arm.urdf", urdf_text(named.joints));
  return read_problem(folder.write("p.yaml", "posewright: 1\nrobot:\n  urdf: arm.urdf\n" + more + pose_instrument));
}

/// All but what a URDF cannot say.
const char* const geometry = "(?!.*\\.gear).*";

void expect_compensated(const Problem& before, double share, std::uint64_t seed, std::size_t at_least) {
  const std::vector<EstimatedValue> values = random_values(before, geometry, 1, seed);
  const Problem problem = calibrated(before, values);
  const PoseList list = random_poses(problem, 60, share, seed);
  const Compensation c = compensate_problem(problem, {list}, {}, Monitor{});
  const ChainDescription nominal = nominal_arm(before), real = corrected_arm(before, values);
  EXPECT_GE(c.compensated, at_least);
  double worst = 0;
  for (std::size_t i = 0; i < list.configurations.size(); ++i) {
    if (c.lists[0].solutions[i].outcome != CommandSolver::Outcome::reached) continue;
    const Eigen::Isometry3d wanted = tip_by_hand(nominal, list.configurations[i]);
    expect_same_pose(tip_by_hand(real, command_of(c, i)), wanted);
    const Eigen::Isometry3d missed = tip_by_hand(real, list.configurations[i]);
    worst = std::max(worst, (missed.translation() - wanted.translation()).norm());
    EXPECT_NEAR(c.lists[0].solutions[i].before.position, (missed.translation() - wanted.translation()).norm(), 1e-9);
    EXPECT_NEAR(c.lists[0].solutions[i].before.rotation, angle_between(missed, wanted), 1e-8);
  }
  EXPECT_GT(worst, 1e-4) << "there was something to compensate";
  EXPECT_GE(c.before.position_largest, worst * 0.999);
}

TEST(Compensate, BringsTheTipOfTheCorrectedUrdfToWhereTheNominalArmHadIt) {
  for (const std::uint64_t seed : {1, 2, 3}) expect_compensated(example("kr270/problem.yaml"), 0.8, seed, 50);
  const TemporaryFolder folder;
  for (const char* kind :
       {"generic_6R", "anthropomorphic_6R", "elbow_with_parallel_axes_6R", "stanford_RRPRRR", "gantry_PPPRRR"})
    expect_compensated(arm_problem(folder, kind), 0.7, 4, 40);
}

TEST(Compensate, TakesPosesBeyondTheLimitsOfThoseThatAreMeasured) {
  Problem problem = read_problem(POSEWRIGHT_SOURCE_DIR "/examples/kr270/problem.yaml");
  problem = calibrated(problem, random_values(problem, "joint_.*", 1, 3));
  const std::vector<Coordinate> own = compensation_coordinates(problem);
  problem.workspace.limits.push_back({{own.back().name, 1}, -1, 1, Quantity::angle});
  EXPECT_EQ(compensation_coordinates(problem).back().lower, own.back().lower);
  EXPECT_LT(own.back().lower, -3);
}

TEST(Compensate, DoesSoForDenavitHartenbergParameters) {
  const TemporaryFolder folder;
  Problem problem = arm_problem(folder, "generic_6R");
  for (const auto convention : {VariantSpec::Convention::dh, VariantSpec::Convention::mdh}) {
    problem.variants.front().convention = convention;
    expect_compensated(problem, 0.7, 5, 40);
  }
}

TEST(Compensate, BringsRedundantArmsThereToo) {
  const TemporaryFolder folder;
  for (const char* kind : {"redundant_7R", "track_and_arm_P6R"})
    expect_compensated(arm_problem(folder, kind), 0.7, 6, 40);
}

TEST(Compensate, OfThePandaReachesEveryPose) {
  const fs::path urdf =
      fs::path(POSEWRIGHT_SHARED_DIR) / "robots/franka_panda/moveit_resources_panda_description/urdf/panda.urdf";
  if (!fs::exists(urdf)) GTEST_SKIP() << "the folder of shared robots is absent";
  const TemporaryFolder folder;
  expect_compensated(read_problem(folder.write("p.yaml", "posewright: 1\nrobot: {urdf: \"" + urdf.string() +
                                                             "\", tip: panda_link8}\n" + pose_instrument)),
                     0.6, 7, 50);
}

/// 6 × n derivatives of the pose by differences.
Eigen::MatrixXd columns_by_differences(const ChainDescription& chain, const Joints& q) {
  Eigen::MatrixXd J(6, Eigen::Index(q.size()));
  const Eigen::Isometry3d X = tip_by_hand(chain, q);
  for (std::size_t i = 0; i < q.size(); ++i) {
    Joints more = q, less = q;
    more[i] += 1e-6;
    less[i] -= 1e-6;
    const Eigen::Isometry3d a = tip_by_hand(chain, more), b = tip_by_hand(chain, less);
    const Eigen::Matrix3d turn = (a.linear() - b.linear()) * X.linear().transpose() / 2e-6;
    J.col(Eigen::Index(i)) << (a.translation() - b.translation()) / 2e-6, turn(2, 1), turn(0, 2), turn(1, 0);
  }
  return J;
}

TEST(Compensate, OfARedundantArmIsTheSmallestChangeThatDoesIt) {
  const TemporaryFolder folder;
  const Problem before = arm_problem(folder, "redundant_7R");
  const std::vector<EstimatedValue> values = random_values(before, geometry, 1, 8);
  const Problem problem = calibrated(before, values);
  const PoseList list = random_poses(problem, 40, 0.6, 8);
  const Compensation c = compensate_problem(problem, {list}, {}, Monitor{});
  const ChainDescription real = corrected_arm(before, values);
  for (std::size_t i = 0; i < 40; ++i) {
    if (c.lists[0].solutions[i].outcome != CommandSolver::Outcome::reached) continue;
    const Joints q = command_of(c, i);
    // What moves nothing at the tip: a change along it would be one for nothing.
    const Eigen::MatrixXd J = columns_by_differences(real, q);
    const Eigen::VectorXd nothing = J.jacobiSvd(Eigen::ComputeFullV).matrixV().col(6);
    Eigen::VectorXd change(7);
    for (std::size_t k = 0; k < 7; ++k) change[Eigen::Index(k)] = q[k] - list.configurations[i][k];
    EXPECT_LT(std::abs(change.dot(nothing)), 1e-6 + 1e-4 * change.norm());
  }
}

const char* const springs =
    "  elastostatic:\n"
    "    compliance: {j1: 1 urad/Nm, j2: 2 urad/Nm, j3: 3 urad/Nm, j4: 9 urad/Nm, j5: 9 urad/Nm, j6: 9 urad/Nm}\n"
    "    loads: {none: {}, tool: {mass: 40, centre_of_mass: [0.1, 0, 0.2]}, push: {force: [300, -200, 100]}}\n";

TEST(Compensate, OfAnElasticArmMakesUpForWhatItsLoadBends) {
  const TemporaryFolder folder;
  const Problem before = arm_problem(folder, "anthropomorphic_6R", springs);
  const std::vector<EstimatedValue> values = random_values(before, "(?!.*\\.gear|base).*", 1, 9);
  const Problem problem = calibrated(before, values);
  const PoseList list = random_poses(problem, 40, 0.6, 9);
  const Compensation c = compensate_problem(problem, {list}, {}, Monitor{});
  const ChainDescription nominal = nominal_arm(before), real = corrected_arm(before, values);
  Joints compliance(6, 0.0);
  for (const EstimatedValue& v : values)
    for (int j = 0; j < 6; ++j)
      if (v.value.name == "j" + std::to_string(j + 1) + ".compliance") compliance[std::size_t(j)] = v.value.value;
  // Work of the load, J: the torque on a joint is how it changes with the joint.
  const auto work = [&](const Joints& q, double load) {
    const Eigen::Isometry3d X = tip_by_hand(real, q);
    if (load == 1) return 40 * Eigen::Vector3d(0, 0, -9.81).dot(X * Eigen::Vector3d(0.1, 0, 0.2));
    return load == 2 ? Eigen::Vector3d(300, -200, 100).dot(X.translation()) : 0.0;
  };
  EXPECT_GE(c.compensated, 30U);
  for (std::size_t i = 0; i < 40; ++i) {
    if (c.lists[0].solutions[i].outcome != CommandSolver::Outcome::reached) continue;
    const Joints q = command_of(c, i);
    Joints bent(q.begin(), q.begin() + 6);
    for (std::size_t j = 0; j < 6; ++j) {
      Joints more(q.begin(), q.begin() + 6), less = more;
      more[j] += 1e-5;
      less[j] -= 1e-5;
      bent[j] += compliance[j] * (work(more, q[6]) - work(less, q[6])) / 2e-5;
    }
    expect_same_pose(tip_by_hand(real, bent), tip_by_hand(nominal, list.configurations[i]));
    EXPECT_EQ(q[6], list.configurations[i][6]);
  }
}

TEST(Compensate, OfPosesFoundWithTheNominalSpringsLeavesAnArmAsItIsWhereNothingWasFound) {
  const TemporaryFolder folder;
  const Problem before = arm_problem(folder, "anthropomorphic_6R", springs);
  const Problem problem = calibrated(before, random_values(before, "nothing", 1, 1));
  const PoseList list = random_poses(problem, 20, 0.6, 2);
  const Compensation same = compensate_problem(problem, {list}, {.elastic_target = true}, Monitor{});
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(command_of(same, i), list.configurations[i]);
  const Compensation bent = compensate_problem(problem, {list}, {}, Monitor{});
  EXPECT_GT(bent.before.position_largest, 1e-4);
  EXPECT_THAT(bent.notes, testing::Contains(HasSubstr("only what the problem file states is compensated")));
}

TEST(Compensate, LeavesJointsAsTheyAreWhereNothingWasFound) {
  for (const char* name : {"kr270/problem.yaml", "gough/problem.yaml", "telescope/within_stroke.yaml"}) {
    const Problem before = example(name);
    const Problem problem = calibrated(before, random_values(before, "nothing", 1, 1));
    const PoseList list = random_poses(problem, 20, 0.2, 3);
    const Compensation c = compensate_problem(problem, {list}, {}, Monitor{});
    for (std::size_t i = 0; i < 20; ++i)
      for (std::size_t k = 0; k < 6; ++k) {
        // A platform's coordinates go through its actuators and back.
        const double allowed = c.parallel ? 1e-11 : 0.0;
        EXPECT_NEAR(command_of(c, i)[k], list.configurations[i][k], allowed) << name;
      }
    EXPECT_LT(c.before.position_largest, 1e-11);
  }
}

/// The legs of a platform with what was found of them: joints in base and platform, direction, length.
std::vector<LegSpec> corrected_legs(const SixLegsSpec& spec, const std::vector<EstimatedValue>& values) {
  std::vector<LegSpec> legs = spec.legs;
  for (const EstimatedValue& v : values)
    for (std::size_t i = 0; i < legs.size(); ++i) {
      const std::string prefix = "leg_" + std::to_string(i + 1) + ".";
      if (!v.value.name.starts_with(prefix)) continue;
      const std::string entry = v.value.name.substr(prefix.size());
      const int axis = entry.size() == 2 ? entry[1] - 'x' : 0;
      if (entry == "l") legs[i].l += v.value.correction();
      else if (entry[0] == 'a') legs[i].a[axis] += v.value.correction();
      else if (entry[0] == 'b') legs[i].b[axis] += v.value.correction();
      else if (entry[0] == 'u') legs[i].u[axis] += v.value.correction();
    }
  return legs;
}

/// How far leg i is from closing with its actuator at rho, m.
double gap(const SixLegsSpec& spec, const LegSpec& leg, const Eigen::Isometry3d& X, double rho) {
  if (spec.actuation == LegActuation::extend) return (X * leg.b - leg.a).norm() - (leg.l + rho);
  return (X * leg.b - leg.a - rho * leg.u).norm() - leg.l;
}

Eigen::Isometry3d platform_pose(const SixLegsSpec& spec, const Joints& q) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = spec.reference.position + Eigen::Vector3d(q[0], q[1], q[2]);
  X.linear() = (Eigen::AngleAxisd(q[5], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(q[4], Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(q[3], Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  return X;
}

TEST(Compensate, OfAPlatformClosesTheRealLegsAtTheNominalPoseAndTheNominalLegsAtTheCommandedOne) {
  for (const char* name : {"gough/problem.yaml", "telescope/within_stroke.yaml"}) {
    const Problem before = example(name);
    const auto& spec = std::get<SixLegsSpec>(before.robot);
    const std::vector<EstimatedValue> values = random_values(before, "leg_.*\\.(a.|b.|l)|base.*", 0.1, 10);
    const Problem problem = calibrated(before, values);
    const PoseList list = random_poses(problem, 30, 0.3, 10);
    const Compensation c = compensate_problem(problem, {list}, {}, Monitor{});
    const std::vector<LegSpec> real = corrected_legs(spec, values);
    ASSERT_GE(c.compensated, 10U) << name << (c.failures.empty() ? "" : c.failures.front().text());
    EXPECT_GT(c.before.position_largest, 1e-5) << name;
    for (std::size_t i = 0; i < 30; ++i) {
      if (c.lists[0].solutions[i].outcome != CommandSolver::Outcome::reached) continue;
      const Eigen::Isometry3d meant = platform_pose(spec, list.configurations[i]),
                              commanded = platform_pose(spec, command_of(c, i));
      for (std::size_t leg = 0; leg < 6; ++leg) {
        const double rho = c.lists[0].actuators[6 * i + leg];
        EXPECT_LT(std::abs(gap(spec, real[leg], meant, rho)), 1e-9) << name;
        EXPECT_LT(std::abs(gap(spec, spec.legs[leg], commanded, rho)), 1e-9) << name;
      }
    }
  }
}

TEST(Compensate, CountsTheBaseOnlyWhereItIsAskedTo) {
  const Problem before = example("kr270/problem.yaml");
  const std::vector<EstimatedValue> values = random_values(before, "base.*", 1, 11);
  const Problem problem = calibrated(before, values);
  const PoseList list = random_poses(problem, 10, 0.5, 11);
  const Compensation left = compensate_problem(problem, {list}, {}, Monitor{});
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(command_of(left, i), list.configurations[i]);
  EXPECT_THAT(left.notes, testing::Contains(HasSubstr("--with-base")));
  CompensateOptions options;
  options.solver.with_base = true;
  const Compensation counted = compensate_problem(problem, {list}, options, Monitor{});
  EXPECT_GT(counted.before.position_largest, 1e-4);
  EXPECT_LT(counted.after.position_largest, 1e-9);
}

/// Newton's method with differences for the position alone, by the first three joints; false if it is out of reach.
bool bring_by_three(const ChainDescription& arm, const Eigen::Vector3d& wanted, std::vector<double>& q) {
  for (int step = 0; step < 20; ++step) {
    const Eigen::Vector3d at = tip_by_hand(arm, q).translation();
    Eigen::Matrix3d J;
    for (int k = 0; k < 3; ++k) {
      std::vector<double> moved = q;
      moved[std::size_t(k)] += 1e-6;
      J.col(k) = (tip_by_hand(arm, moved).translation() - at) / 1e-6;
    }
    const Eigen::Vector3d change = J.fullPivLu().solve(wanted - at);
    for (int k = 0; k < 3; ++k) q[std::size_t(k)] += change[k];
  }
  return (tip_by_hand(arm, q).translation() - wanted).norm() < 1e-6;
}

TEST(Compensate, OfFewerThanSixAxesIsRefusedOrReachesPositionsAlone) {
  const TemporaryFolder folder;
  const Problem before = arm_problem(folder, "scara_RRPR");
  const std::vector<EstimatedValue> values = random_values(before, geometry, 1, 12);
  const Problem problem = calibrated(before, values);
  const PoseList list = random_poses(problem, 30, 0.5, 12);
  EXPECT_THAT(message_of<CannotDo>([&] { compensate_problem(problem, {list}, {}, Monitor{}); }),
              testing::AllOf(HasSubstr("4 axes"), HasSubstr("--position-only")));
  CompensateOptions options;
  options.solver.position_only = true;
  const Compensation c = compensate_problem(problem, {list}, options, Monitor{});
  EXPECT_GE(c.compensated, 25U);
  const ChainDescription nominal = nominal_arm(before), real = corrected_arm(before, values);
  int farther = 0, tried = 0;
  for (std::size_t i = 0; i < 30; ++i) {
    if (c.lists[0].solutions[i].outcome != CommandSolver::Outcome::reached) continue;
    const Eigen::Isometry3d found = tip_by_hand(real, command_of(c, i)),
                            wanted = tip_by_hand(nominal, list.configurations[i]);
    EXPECT_LT((found.translation() - wanted.translation()).norm(), micro);
    EXPECT_NEAR(c.lists[0].solutions[i].after.rotation, angle_between(found, wanted), 1e-8);
    // Wherever else the last axis stands, the tip is turned farther from the intended orientation. Near a singularity
    // the position is found before.
    for (const double aside : {-0.02, 0.02}) {
      std::vector<double> other = command_of(c, i);
      other[3] += aside;
      if (!bring_by_three(real, wanted.translation(), other)) continue;
      farther += angle_between(tip_by_hand(real, other), wanted) > angle_between(found, wanted) ? 1 : 0;
      ++tried;
    }
  }
  EXPECT_GT(farther, 0.8 * tried);  // half of them where the axis stays
}

TEST(Compensate, NamesWhatIsBeyondALimitOutOfReachAndNearASingularity) {
  const TemporaryFolder folder;
  const Problem before = arm_problem(folder, "anthropomorphic_6R");
  const auto with = [&](const std::string& name, double change) {
    std::vector<EstimatedValue> values = random_values(before, "nothing", 1, 1);
    for (EstimatedValue& v : values)
      if (v.value.name == name) v.value.value += change;
    return calibrated(before, values);
  };
  PoseList list;
  list.name = "list.csv";
  list.lines = {7, 8};
  list.ids = {3, 4};
  // Joint 4 reads less than it turns by a milliradian; it would have to pass its limit of 2.5 rad.
  list.configurations = {{0.1, 0.2, 0.3, 2.5, 0.5, 0.2}, {0.1, 0.2, 0.3, 0.4, 0.5, 0.2}};
  Compensation c = compensate_problem(with("j4.offset", -1e-3), {list}, {}, Monitor{});
  ASSERT_EQ(c.failures.size(), 1U);
  EXPECT_THAT(
      c.failures[0].text(),
      HasSubstr("list.csv:7: pose 3: 'j4' would be at 143.2967 deg, allowed are -143.2394 deg to 143.2394 deg"));
  EXPECT_EQ(c.compensated, 1U);
  EXPECT_NEAR(command_of(c, 1)[3], 0.401, 1e-9);
  EXPECT_EQ(command_of(c, 0), list.configurations[0]) << "what is not compensated stays";
  // Stretched to its end (the elbow's 55 mm count), and the forearm is a millimetre shorter than it was.
  const double straight = -std::atan2(0.055, 1.1);
  list.configurations = {{0.1, 0.2, straight, 0.4, 0.5, 0.2}, {0.1, 0.2, 0.7, 0.4, 0.5, 0.2}};
  c = compensate_problem(with("j4.x", -1e-3), {list}, {}, Monitor{});
  ASSERT_EQ(c.failures.size(), 1U);
  EXPECT_THAT(c.failures[0].text(), HasSubstr("list.csv:7: pose 3: the calibrated robot does not reach it: "));
  // The axes of 4 and 6 in line: a turn about the third direction takes both far away.
  list.configurations = {{0.1, 0.2, 0.3, 0.4, 0.0, 0.2}, {0.1, 0.2, 0.3, 0.4, 0.5, 0.2}};
  c = compensate_problem(with("j6.rz", 1e-3), {list}, {}, Monitor{});
  ASSERT_EQ(c.failures.size(), 1U);
  EXPECT_THAT(c.failures[0].text(), testing::AnyOf(HasSubstr("a singularity is near"), HasSubstr("does not reach it")));
}

TEST(Compensate, OfARedundantArmKeepsALimitAndReachesThePoseWithTheOtherJoints) {
  const TemporaryFolder folder;
  const Problem before = arm_problem(folder, "redundant_7R");
  const std::vector<EstimatedValue> values = random_values(before, geometry, 1, 13);
  const Problem problem = calibrated(before, values);
  PoseList list = random_poses(problem, 60, 0.5, 13);
  for (std::size_t i = 0; i < 60; ++i) list.configurations[i][2] = i % 2 == 0 ? 2.5 : -2.5;
  const Compensation c = compensate_problem(problem, {list}, {}, Monitor{});
  const ChainDescription nominal = nominal_arm(before), real = corrected_arm(before, values);
  int held = 0;
  EXPECT_GE(c.compensated, 50U);
  for (std::size_t i = 0; i < 60; ++i) {
    if (c.lists[0].solutions[i].outcome != CommandSolver::Outcome::reached) continue;
    const Joints q = command_of(c, i);
    EXPECT_LE(std::abs(q[2]), 2.5);
    held += std::abs(q[2]) == 2.5 ? 1 : 0;
    expect_same_pose(tip_by_hand(real, q), tip_by_hand(nominal, list.configurations[i]));
  }
  EXPECT_GT(held, 10);
}

TEST(Compensate, HasTheSameResultOnAnyNumberOfThreads) {
  const Problem before = example("kr270/problem.yaml");
  const Problem problem = calibrated(before, random_values(before, geometry, 1, 14));
  const PoseList list = random_poses(problem, 3000, 0.9, 14);
  CompensateOptions one, four;
  one.threads = 1;
  four.threads = 4;
  const Compensation a = compensate_problem(problem, {list}, one, Monitor{}),
                     b = compensate_problem(problem, {list}, four, Monitor{});
  EXPECT_EQ(a.lists[0].configurations, b.lists[0].configurations);
  EXPECT_EQ(a.before.position_rms, b.before.position_rms);
  EXPECT_EQ(a.failures.size(), b.failures.size());
}

TEST(Compensate, StopsWhereItIsAskedTo) {
  const Problem before = example("kr270/problem.yaml");
  const Problem problem = calibrated(before, random_values(before, geometry, 1, 15));
  const std::atomic<bool> stop = true;
  Monitor monitor;
  monitor.interrupted = &stop;
  EXPECT_THROW(compensate_problem(problem, {random_poses(problem, 10, 0.5, 1)}, {}, monitor), CannotDo);
}

}  // namespace
}  // namespace posewright
