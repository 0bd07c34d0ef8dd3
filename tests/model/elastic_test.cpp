// Elastostatics: deflections against their definition, columns against automatic differentiation, the compensator's
// stiffness against the derivative of its torque.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "posewright/model/elastic_chain.hpp"
#include "posewright/model/explicit_model.hpp"
#include "posewright/model/gravity_compensator.hpp"
#include "posewright/model/load_difference.hpp"
#include "posewright/model/measurement_factory.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/jets.hpp"
#include "tests/kit/random_chain.hpp"
#include "tests/kit/residuals.hpp"

namespace posewright {
namespace {

constexpr double degree = std::numbers::pi / 180;

CompensatorSpec kr270_compensator() {
  CompensatorSpec spec;
  spec.joint = {"j2", 5};
  spec.L = 0.18472, spec.ax = 0.68593, spec.ay = 0.12330;
  spec.stiffness = 1 / 0.144e-6;
  spec.free_length = 0.458;
  spec.joint_stiffness = 1 / 0.302e-6;
  return spec;
}

ElastostaticSpec springs() {
  ElastostaticSpec spec;
  spec.compliance = {{{"j1", 1}, {0.6e-6}}, {{"j3", 2}, {0.4e-6}}, {{"j4", 3}, {2.8e-6}}, {{"j6", 4}, {2e-6}}};
  spec.link_gravity = true;
  LoadCaseSpec pull, payload;
  pull.name = "pull", pull.force = {300, -200, -2000}, pull.moment = {10, 50, -20}, pull.point = {0.1, 0, 0.2};
  payload.name = "payload", payload.mass = 150, payload.centre_of_mass = {0.05, -0.02, 0.1};
  LoadCaseSpec none;
  none.name = "none";
  spec.loads = {none, pull, payload};
  return spec;
}

ChainDescription heavy_chain() {
  ChainDescription chain = random_chain(31, false, false);
  Random random(1, 7);
  for (ChainJoint& joint : chain.joints) {
    joint.mass = random.uniform(20, 200);
    joint.centre_of_mass = random_pose(random).translation();
  }
  return chain;
}

/// Torques by their definition: derivative of the loads' potential along each joint, by Jets through the kinematics.
std::vector<double> torques_by_definition(const ChainDescription& chain, const ElastostaticSpec& spec, int load,
                                          const std::vector<double>& q) {
  const ChainLayout layout(chain);
  std::vector<Jet> correction(std::size_t(layout.count), Jet(0.0));
  for (std::size_t c = 0; c < 6; ++c) correction[std::size_t(layout.offset[c])].v[Eigen::Index(c)] = 1;
  const LoadCaseSpec& w = spec.loads[std::size_t(load)];
  std::vector<double> torque(6, 0.0);
  const auto add_force = [&](const Frame<Jet>& frame, const Eigen::Vector3d& point, const Eigen::Vector3d& force) {
    const Eigen::Matrix<Jet, 3, 1> p = frame * Eigen::Matrix<Jet, 3, 1>(point.cast<Jet>());
    for (std::size_t c = 0; c < 6; ++c)
      for (int k = 0; k < 3; ++k) torque[c] += force[k] * p[k].v[Eigen::Index(c)];
  };
  for (std::size_t n = 1; spec.link_gravity && n <= chain.joints.size(); ++n) {
    ChainDescription part = chain;  // up to and with joint n, tip on the joint's moved frame
    part.joints.resize(n);
    part.X_LastTip.setIdentity();
    const ChainLayout partial(part);
    std::vector<Jet> c(std::size_t(partial.count), Jet(0.0));
    for (std::size_t i = 0; i < n; ++i) c[std::size_t(partial.offset[i])].v[Eigen::Index(i)] = 1;
    const ChainJoint& body = chain.joints[n - 1];
    add_force(tip_pose<Jet>(part, partial, q.data(), c.data()), body.centre_of_mass, body.mass * spec.gravity);
  }
  const Frame<Jet> tip = tip_pose<Jet>(chain, layout, q.data(), correction.data());
  add_force(tip, w.point, w.force);
  add_force(tip, w.centre_of_mass, w.mass * spec.gravity);
  // A moment works on the rotation: ω from dR Rᵀ.
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R(i, j) = tip.R(i, j).a;
  for (std::size_t c = 0; c < 6; ++c) {
    Eigen::Matrix3d dR;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) dR(i, j) = tip.R(i, j).v[Eigen::Index(c)];
    const Eigen::Matrix3d S = dR * R.transpose();
    torque[c] += w.moment.dot(Eigen::Vector3d(S(2, 1), S(0, 2), S(1, 0)));
  }
  return torque;
}

TEST(ElasticChain, TorquesAreTheDerivativeOfTheLoadsWork) {
  const ChainDescription chain = heavy_chain();
  const ElastostaticSpec spec = springs();
  const ElasticChain model(chain, spec, {});
  Random random(2, 0);
  for (int i = 0; i < 20; ++i) {
    std::vector<double> q = random_configuration(model.coordinates(), random), torque(6);
    model.torques(q, int(q.back()), torque);
    const std::vector<double> expected = torques_by_definition(chain, spec, int(q.back()), q);
    for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(torque[c], expected[c], 1e-9 * (1 + std::abs(expected[c])));
  }
}

TEST(ElasticChain, LoadsBendTheArmAsItStands) {
  const std::vector<double> d = {0.4, -0.2, 0.1, 1.9, -0.4, 2.6};  // base.x … base.rz: put down on a slope
  const ChainDescription chain = heavy_chain();
  ChainDescription turned = chain;
  Frame<double> base;
  base.then(chain.X_MeasureBase);
  base.then_displace(d.data());
  turned.X_MeasureBase.linear() = base.R;
  turned.X_MeasureBase.translation() = base.p;
  ElasticChain model(chain, springs(), {});
  const ElasticChain expected(turned, springs(), {});
  std::vector<double> correction(model.parameters().size(), 0.0);
  std::copy(d.begin(), d.end(), correction.begin());
  const auto offset = std::ranges::find(model.parameters(), "j3.offset", &Parameter::name);
  ASSERT_NE(offset, model.parameters().end());
  correction[std::size_t(offset - model.parameters().begin())] = 0.3;
  model.take_loads_at(correction);
  Random random(3, 0);
  for (int i = 0; i < 20; ++i) {
    std::vector<double> q = random_configuration(model.coordinates(), random), moved = q, torque(6), as_built(6);
    moved[2] += 0.3;
    model.torques(q, int(q.back()), torque);
    expected.torques(moved, int(q.back()), as_built);
    for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(torque[c], as_built[c], 1e-9 * (1 + std::abs(as_built[c])));
  }
}

PointsMeasurement elastic_points() {
  PointsMeasurement p;
  p.targets = {{"A", {0.1, 0.2, -0.3}, 0}, {"B", {-0.2, 0.05, 0.4}, 0}};
  p.noise = GaussianNoise{1e-8 * Eigen::Matrix3d::Identity()};
  return p;
}

MeasurementSpec measurement() {
  MeasurementSpec spec;
  spec.instrument = elastic_points();
  return spec;
}

/// Readings of the deflected arm; parameters: chain without tool, springs, targets.
std::vector<Jet> loaded_points(const ChainDescription& chain, const ElastostaticSpec& spec,
                               const std::vector<double>& q, const std::vector<Jet>& d) {
  const ChainLayout layout(chain);
  std::vector<Jet> correction(d.begin(), d.begin() + layout.tool);
  correction.resize(std::size_t(layout.count), Jet(0.0));
  const std::vector<double> torque = torques_by_definition(chain, spec, int(q[6]), q);
  std::vector<double> nominal(6, 0.0);
  for (const auto& [name, k] : spec.compliance) nominal[std::size_t(name.value[1] - '1')] = k.value;
  std::size_t next = std::size_t(layout.tool);
  for (std::size_t c = 0; c < 6; ++c) {
    Jet deflection;
    if (spec.compensator && c == 1) {
      const CompensatorSpec& s = *spec.compensator;
      const Jet K0 = d[next] + s.joint_stiffness, Kc = d[next + 1] + s.stiffness,
                preload = d[next + 2] + s.stiffness * s.free_length;
      const CompensatorLinkage<Jet> linkage(s, Jet(q[1]));
      const Jet stiffness = K0 + linkage.added_stiffness(Kc, preload);
      if (s.torque) {
        deflection = (torque[1] - linkage.torque(Kc, preload)) / stiffness;
      } else {
        // Nothing bends the unloaded arm: what the load changes, by the equivalent stiffness.
        ElastostaticSpec weightless = spec;
        weightless.link_gravity = false;
        deflection = torques_by_definition(chain, weightless, int(q[6]), q)[1] / stiffness;
      }
      next += 3;
    } else if (spec.listed && c == 1) {
      for (std::size_t i = 0; i < spec.listed->at.size(); ++i)
        if (q[1] == spec.listed->at[i]) deflection = (d[next + i] + nominal[1]) * torque[1];
      next += spec.listed->at.size();
    } else {
      deflection = (d[next++] + nominal[c]) * torque[c];
    }
    correction[std::size_t(layout.offset[c])] += deflection;
  }
  const Frame<Jet> tip = tip_pose<Jet>(chain, layout, q.data(), correction.data());
  std::vector<Jet> rows;
  const PointsMeasurement p = elastic_points();
  for (std::size_t t = 0; t < 2; ++t) {
    Eigen::Matrix<Jet, 3, 1> target = p.targets[t].position.cast<Jet>();
    for (int k = 0; k < 3; ++k) target[k] += d[next + 3 * t + std::size_t(k)];
    const Eigen::Matrix<Jet, 3, 1> y = tip * target;
    rows.insert(rows.end(), {y[0], y[1], y[2]});
  }
  return rows;
}

TEST(ElasticChain, ColumnsEqualAutomaticDifferentiation) {
  const ChainDescription chain = heavy_chain();
  ElastostaticSpec constant = springs(), stiffened = springs(), compensated = springs(), listed = springs();
  stiffened.compensator = compensated.compensator = kr270_compensator();
  compensated.compensator->torque = true;
  listed.listed = ElastostaticSpec::Listed{{"j2", 5}, {-1.5, -0.5, 0.5}, Quantity::number};
  for (const ElastostaticSpec& spec : {constant, stiffened, compensated, listed}) {
    const ExplicitModel model(std::make_unique<ElasticChain>(chain, spec, SourcePlace{}),
                              make_measurement(measurement()));
    const auto oracle = [&](const std::vector<double>& q, const std::vector<Jet>& d) {
      return loaded_points(chain, spec, q, d);
    };
    for (const double size : {0.0, 1.0}) EXPECT_LT(worst_model_error(model, 250, size, 1, oracle), 1e-9);
  }
}

TEST(Compensator, UnloadedArmStandsStraightUnlessTheTorqueIsAskedFor) {
  ElastostaticSpec spec = springs();
  spec.link_gravity = false;
  spec.compensator = kr270_compensator();
  const ChainDescription chain = heavy_chain();
  ElastostaticSpec rigid = spec;
  rigid.compensator.reset();
  for (auto& compliance : rigid.compliance) compliance.second.value = 0;
  const std::vector<double> q = {0.1, -0.8, 0.4, 0.2, 0.3, 0.1, 0};  // the last: no load
  Twists none;
  Eigen::Isometry3d straight, X;
  ASSERT_TRUE(ElasticChain(chain, rigid, {}).linearise({q, {}}, {}, straight, none, nullptr));
  ASSERT_TRUE(ElasticChain(chain, spec, {}).linearise({q, {}}, {}, X, none, nullptr));
  EXPECT_LT((X.matrix() - straight.matrix()).norm(), 1e-14);
  spec.compensator->torque = true;
  ASSERT_TRUE(ElasticChain(chain, spec, {}).linearise({q, {}}, {}, X, none, nullptr));
  EXPECT_GT((X.matrix() - straight.matrix()).norm(), 1e-2);
}

TEST(Compensator, WarningNamesTheDeflectionThatTheTorqueAloneCauses) {
  Problem problem = example("kr270/compensator.yaml");
  const std::vector<Coordinate> coordinates = make_model(problem)->coordinates();
  EXPECT_EQ(compensator_warning(problem.robot, coordinates), "");
  std::get<SerialArmSpec>(problem.robot).elastostatic->compensator->torque = true;
  // 5.85 degrees: the spring's torque over the joint's equivalent stiffness, by hand over −140° … 0°.
  EXPECT_THAT(compensator_warning(problem.robot, coordinates), testing::HasSubstr("joint_a2 by up to 5.8"));
}

TEST(LoadDifference, RowsAreThoseOfLoadedLessUnloadedWithTwiceTheReadingNoise) {
  const ChainDescription chain = heavy_chain();
  const ElastostaticSpec spec = springs();
  const LoadDifference model(std::make_unique<ExplicitModel>(std::make_unique<ElasticChain>(chain, spec, SourcePlace{}),
                                                             make_measurement(measurement())));
  ASSERT_EQ(model.coordinates().back().labels, (std::vector<std::string>{"pull", "payload"}));
  const auto oracle = [&](const std::vector<double>& q, const std::vector<Jet>& d) {
    std::vector<double> unloaded = q;
    unloaded.back() = 0;
    std::vector<Jet> rows = loaded_points(chain, spec, q, d);
    const std::vector<Jet> before = loaded_points(chain, spec, unloaded, d);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] -= before[i];
    return rows;
  };
  EXPECT_LT(worst_model_error(model, 250, 0.0, 1, oracle), 1e-9);
  Linearisation out;
  Random random(1, 0);
  ASSERT_TRUE(model.linearise(random_configuration(model.coordinates(), random), {}, std::vector<int>{0}, out));
  EXPECT_NEAR(out.covariance(0, 0), 2e-8, 1e-20);
}

TEST(LoadDifference, NeedsTwoLoadCases) {
  ElastostaticSpec spec = springs();
  spec.loads.resize(1);
  EXPECT_THROW(
      LoadDifference(std::make_unique<ExplicitModel>(std::make_unique<ElasticChain>(heavy_chain(), spec, SourcePlace{}),
                                                     make_measurement(measurement()))),
      CannotDo);
}

TEST(ElasticChain, UnknownJointsAreNamed) {
  ElastostaticSpec spec = springs();
  spec.compliance.push_back({{"joint_9", 12}, {1e-6}});
  try {
    const ElasticChain model(heavy_chain(), spec, {"p.yaml", 3});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("p.yaml:12: 'joint_9' is not a joint of this arm"));
  }
}

TEST(GravityCompensator, EquivalentStiffnessIsTheDerivativeOfTheTorque) {
  const CompensatorSpec spec = kr270_compensator();
  const double preload = spec.stiffness * spec.free_length;
  for (double q2 = -140 * degree; q2 <= 0; q2 += 0.25 * degree) {
    ceres::Jet<double, 1> q(q2, 0);
    const CompensatorLinkage<ceres::Jet<double, 1>> moving(spec, q);
    const double derivative = moving.torque(ceres::Jet<double, 1>(spec.stiffness), ceres::Jet<double, 1>(preload)).v[0];
    const CompensatorLinkage<double> linkage(spec, q2);
    EXPECT_NEAR(linkage.added_stiffness(spec.stiffness, preload), derivative, 1e-12 * spec.joint_stiffness);
    // And numerically: fourth-order central differences.
    const auto torque = [&](double at) { return CompensatorLinkage<double>(spec, at).torque(spec.stiffness, preload); };
    constexpr double h = 1e-3;
    const double numeric =
        (8 * (torque(q2 + h) - torque(q2 - h)) - (torque(q2 + 2 * h) - torque(q2 - 2 * h))) / (12 * h);
    const double total = spec.joint_stiffness + linkage.added_stiffness(spec.stiffness, preload);
    EXPECT_NEAR((spec.joint_stiffness + numeric) / total, 1, 1e-8) << q2 / degree;
  }
}

}  // namespace
}  // namespace posewright
