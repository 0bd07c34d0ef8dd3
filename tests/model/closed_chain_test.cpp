// Closed chains: loop equations against automatic differentiation, kinematics there and back, and the two ways to
// write the information of a measured pose.

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <numbers>

#include "posewright/model/delta.hpp"
#include "posewright/model/explicit_model.hpp"
#include "posewright/model/five_bar.hpp"
#include "posewright/model/measurement_factory.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/six_legs.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/problem/read_problem.hpp"
#include "tests/kit/jets.hpp"
#include "tests/kit/residuals.hpp"

namespace posewright {
namespace {

Problem telescope() {
  return read_problem(std::filesystem::path(POSEWRIGHT_SOURCE_DIR) / "examples/telescope/problem.yaml");
}

SixLegsSpec inclined_telescope() {
  SixLegsSpec spec = std::get<SixLegsSpec>(telescope().robot);
  // Inclined actuators exercise the third component of u too.
  for (std::size_t i = 0; i < 6; ++i) spec.legs[i].u = Eigen::Vector3d(0.1 * double(i) - 0.2, 0.15, 1).normalized();
  return spec;
}

SixLegsSpec gough() {
  SixLegsSpec spec = std::get<SixLegsSpec>(telescope().robot);
  spec.actuation = LegActuation::extend;
  for (LegSpec& leg : spec.legs) leg.l = 0.4;
  spec.travel_lower = 0.05;
  spec.travel_upper = 0.2;
  return spec;
}

FiveBarSpec five_bar() {
  FiveBarSpec spec;
  spec.legs = {{{{-0.15, 0.02}, 0.25, 0.35, 1.0}, {{0.15, -0.01}, 0.24, 0.36, -1.0}}};
  spec.placement.position = {0.1, 0.2, 0.3};
  spec.placement.rpy = {0.1, -0.2, 0.3};
  spec.encoder_noise = 1e-4;
  spec.x_lower = -0.15, spec.x_upper = 0.15, spec.y_lower = 0.3, spec.y_upper = 0.5;
  return spec;
}

DeltaSpec delta() {
  DeltaSpec spec;
  spec.base_radius = 0.2, spec.platform_radius = 0.05, spec.arm = 0.3, spec.forearm = 0.7;
  spec.encoder_noise = 1e-4;
  spec.travel_lower = -0.5, spec.travel_upper = 1.5;
  spec.lower = {-0.2, -0.2, -0.8};
  spec.upper = {0.2, 0.2, -0.6};
  return spec;
}

std::vector<CoordinateLimits> limits() { return telescope().workspace.limits; }

/// Loop equations by the templated residuals: corrections of the own parameters, platform twist about its origin,
/// actuators, in one list.
using LoopOracle =
    std::function<std::vector<Jet>(std::span<const double>, std::span<const double>, const std::vector<Jet>&)>;

std::vector<Jet> leg_loops(const SixLegsSpec& spec, std::span<const double> q, std::span<const double> rho,
                           const std::vector<Jet>& d) {
  const bool slides = spec.actuation == LegActuation::slide;
  const std::size_t per_leg = slides ? 9 : 7, own = slides ? 54 + 43 : 42;
  const Eigen::Isometry3d X = SixLegs(spec, {}).platform(q);
  Frame<Jet> frame;
  frame.then(Eigen::Isometry3d(Eigen::Translation3d(X.translation())));
  frame.then_translate({d[own], d[own + 1], d[own + 2]});
  for (int k = 0; k < 3; ++k) frame.then_rotate(Eigen::Vector3d::Unit(k), d[own + 3 + std::size_t(k)]);
  frame.R = (frame.R * X.linear().cast<Jet>()).eval();
  Jet p[3], r[9], actuator[6];
  for (int k = 0; k < 3; ++k) p[k] = frame.p[k];
  for (int k = 0; k < 9; ++k) r[k] = frame.R(k / 3, k % 3);
  for (std::size_t i = 0; i < 6; ++i) actuator[i] = d[own + 6 + i] + rho[i];
  std::vector<double> reference(6, 0.0);
  if (slides) {
    EXPECT_TRUE(SixLegs(spec, {}).actuator_values({std::vector<double>(6, 0.0), {}}, reference));
  }
  std::vector<Jet> g;
  for (std::size_t i = 0; i < 6; ++i) {
    const LegSpec& leg = spec.legs[i];
    const Jet* c = d.data() + per_leg * i;
    LegParameters<Jet> parameters;
    for (std::size_t k = 0; k < 3; ++k) {
      parameters.a[k] = c[k] + leg.a[Eigen::Index(k)];
      parameters.b[k] = c[3 + k] + leg.b[Eigen::Index(k)];
    }
    for (std::size_t k = 0; k < 2; ++k) parameters.u[k] = (slides ? c[6 + k] : Jet(0.0)) + leg.u[Eigen::Index(k)];
    parameters.l = c[per_leg - 1] + leg.l;
    Jet lift(0.0);
    if (slides) {
      // How far each actuator stands from where the nominal robot's stands at the reference.
      const auto change = [&](std::size_t j) { return actuator[j] - Jet(reference[j]); };
      lift = (d[54] + d[55 + i]) * change(i);
      for (std::size_t j = 0; j < 6; ++j) lift += d[61 + 6 * i + j] * change(j);
    }
    g.push_back(leg_residual<Jet>(p, r, slides ? actuator[i] : Jet(0.0), slides ? Jet(0.0) : actuator[i], lift,
                                  parameters, 1.0));
  }
  return g;
}

void compare_loops(const ClosedChain& chain, std::size_t own, const LoopOracle& oracle, double size) {
  Random random(2, 0);
  std::vector<int> all(own);
  std::iota(all.begin(), all.end(), 0);
  const std::size_t actuators = chain.actuators().size();
  int compared = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::vector<double> q = random_configuration(chain.coordinates(), random);
    std::vector<double> correction(chain.parameters().size(), 0.0), rho(actuators);
    for (std::size_t j = 0; j < own; ++j)
      correction[6 + j] = size * random.uniform(-1, 1) * chain.parameters()[6 + j].tolerance;
    if (!chain.actuator_values({q, correction}, rho)) continue;
    ++compared;
    ClosedChain::Loops loops;
    chain.loops({q, rho, std::span(correction).subspan(6, own), all}, loops);
    EXPECT_LT(loops.value.cwiseAbs().maxCoeff(), 1e-12) << "inverse kinematics closes the loops";
    // The platform's twist in the loops is about the base's origin; the oracle's about the platform's.
    Eigen::MatrixXd analytic(loops.value.size(), Eigen::Index(own + 6 + actuators));
    const Eigen::Vector3d p = chain.platform(q).translation();
    Eigen::MatrixXd about_platform = loops.platform;
    for (int k = 0; k < 3; ++k)
      about_platform.col(3 + k) += loops.platform.leftCols<3>() * p.cross(Eigen::Vector3d::Unit(k));
    // A platform that does not turn leaves those columns without meaning.
    if (q.size() < 6) about_platform.rightCols<3>().setZero();
    analytic << loops.parameter, about_platform, loops.actuator;
    std::vector<double> point(correction.begin() + 6, correction.begin() + 6 + std::ptrdiff_t(own));
    point.resize(own + 6 + actuators, 0.0);
    ASSERT_LT(worst_column_error(analytic, point, [&](const auto& jets) { return oracle(q, rho, jets); }), 1e-9);
  }
  EXPECT_GT(compared, 900);
}

TEST(SixLegs, LoopDerivativesEqualAutomaticDifferentiation) {
  for (const double size : {0.0, 1.0}) {
    const SixLegsSpec spec = inclined_telescope();
    compare_loops(
        SixLegs(spec, limits()), 97, [&](auto q, auto rho, const auto& d) { return leg_loops(spec, q, rho, d); }, size);
  }
}

TEST(SixLegs, LoopDerivativesOfAGoughPlatformEqualAutomaticDifferentiation) {
  const SixLegsSpec spec = gough();
  for (const double size : {0.0, 1.0})
    compare_loops(
        SixLegs(spec, limits()), 42, [&](auto q, auto rho, const auto& d) { return leg_loops(spec, q, rho, d); }, size);
}

TEST(FiveBar, LoopDerivativesEqualAutomaticDifferentiation) {
  const FiveBarSpec spec = five_bar();
  const auto oracle = [&](std::span<const double> q, std::span<const double> rho, const std::vector<Jet>& d) {
    std::vector<Jet> g;
    for (std::size_t i = 0; i < 2; ++i) {
      const FiveBarSpec::Leg& leg = spec.legs[i];
      const Jet* c = d.data() + 6 * i;
      const Jet values[5] = {c[0] + leg.base.x(), c[1] + leg.base.y(), c[2] + leg.proximal, c[3] + leg.distal, c[4]};
      g.push_back(five_bar_residual<Jet>(d[12] + q[0], d[13] + q[1], d[18 + i] + rho[i], values));
    }
    return g;
  };
  for (const double size : {0.0, 1.0}) compare_loops(FiveBar(spec), 12, oracle, size);
}

TEST(Delta, LoopDerivativesEqualAutomaticDifferentiation) {
  const DeltaSpec spec = delta();
  const auto oracle = [&](std::span<const double> q, std::span<const double> rho, const std::vector<Jet>& d) {
    std::vector<Jet> g;
    const Jet x[3] = {d[18] + q[0], d[19] + q[1], d[20] + q[2]};
    for (std::size_t i = 0; i < 3; ++i) {
      const Jet* c = d.data() + 6 * i;
      const Jet leg[6] = {c[0] + spec.base_radius,
                          c[1] + spec.platform_radius,
                          c[2] + spec.arm,
                          c[3] + spec.forearm,
                          c[4],
                          c[5] + double(i) * 2 * std::numbers::pi / 3};
      g.push_back(delta_residual<Jet>(x, d[24 + i] + rho[i], leg));
    }
    return g;
  };
  for (const double size : {0.0, 1.0}) compare_loops(Delta(spec), 18, oracle, size);
}

std::vector<std::unique_ptr<ClosedChain>> all_chains() {
  std::vector<std::unique_ptr<ClosedChain>> chains;
  chains.push_back(std::make_unique<SixLegs>(inclined_telescope(), limits()));
  chains.push_back(std::make_unique<SixLegs>(gough(), limits()));
  chains.push_back(std::make_unique<FiveBar>(five_bar()));
  chains.push_back(std::make_unique<Delta>(delta()));
  return chains;
}

TEST(ClosedChain, ForwardKinematicsUndoesInverseKinematics) {
  for (const auto& chain : all_chains()) {
    Random random(4, 0);
    int compared = 0;
    for (int i = 0; i < 200; ++i) {
      const std::vector<double> q = random_configuration(chain->coordinates(), random);
      std::vector<double> middle, rho(chain->actuators().size()), correction(chain->parameters().size());
      for (const Coordinate& c : chain->coordinates()) middle.push_back(0.5 * (c.lower + c.upper));
      for (std::size_t j = 0; j < correction.size(); ++j)
        correction[j] = random.uniform(-1, 1) * chain->parameters()[j].tolerance;
      if (!chain->actuator_values({q, correction}, rho)) continue;
      const auto back = chain->forward_kinematics(rho, {middle, correction});
      ASSERT_TRUE(back.has_value());
      for (std::size_t k = 0; k < q.size(); ++k) EXPECT_NEAR((*back)[k], q[k], 1e-9);
      ++compared;
    }
    EXPECT_GT(compared, 150);
  }
}

TEST(ClosedChain, ForwardKinematicsSaysWhereThereIsNone) {
  const SixLegs chain(inclined_telescope(), limits());
  EXPECT_FALSE(
      chain.forward_kinematics(std::vector<double>{0.9, -0.9, 0.9, -0.9, 0.9, -0.9}, {std::vector<double>(6), {}}));
}

TEST(ClosedChain, TwistsOfParametersAreThoseOfThePlatformWhenActuatorsStandStill) {
  // The implicit-function theorem against forward kinematics with the parameter changed, central differences.
  for (const auto& chain : all_chains()) {
    std::vector<double> q;
    for (const Coordinate& c : chain->coordinates()) q.push_back(c.lower + 0.6 * (c.upper - c.lower));
    std::vector<double> rho(chain->actuators().size());
    ASSERT_TRUE(chain->actuator_values({q, {}}, rho));
    std::vector<int> all(chain->parameters().size());
    std::iota(all.begin(), all.end(), 0);
    Eigen::Isometry3d X;
    Twists twists, readings, none;
    ASSERT_TRUE(chain->linearise({q, {}}, all, X, twists, &readings));
    const auto tip_at = [&](const std::vector<double>& correction, const std::vector<double>& actuators) {
      Eigen::Isometry3d Y;
      const auto x = chain->forward_kinematics(actuators, {q, correction});
      EXPECT_TRUE(x.has_value());
      chain->linearise({*x, correction}, {}, Y, none, nullptr);
      return Y;
    };
    const auto compare = [&](const Eigen::Isometry3d& plus, const Eigen::Isometry3d& minus, double h,
                             const Twist& twist) {
      const Eigen::Vector3d moved = (plus.translation() - minus.translation()) / (2 * h);
      const Eigen::Matrix3d D = plus.linear() * minus.linear().transpose();
      const Eigen::Vector3d turned =
          Eigen::Vector3d(D(2, 1), D(0, 2), D(1, 0)) - Eigen::Vector3d(D(1, 2), D(2, 0), D(0, 1));
      EXPECT_LT((twist.head<3>() + Eigen::Vector3d(twist.tail<3>()).cross(X.translation()) - moved).norm(),
                1e-6 * (1 + moved.norm()));
      EXPECT_LT((twist.tail<3>() - turned / (4 * h)).norm(), 1e-6 * (1 + turned.norm() / (4 * h)));
    };
    constexpr double h = 1e-5;
    for (std::size_t j = 0; j < all.size(); ++j) {
      std::vector<double> plus(all.size(), 0.0), minus(all.size(), 0.0);
      plus[j] = h, minus[j] = -h;
      compare(tip_at(plus, rho), tip_at(minus, rho), h, twists.col(Eigen::Index(j)));
    }
    for (std::size_t j = 0; j < rho.size(); ++j) {
      std::vector<double> plus = rho, minus = rho;
      plus[j] += h, minus[j] -= h;
      const std::vector<double> zero(all.size(), 0.0);
      compare(tip_at(zero, plus), tip_at(zero, minus), h, readings.col(Eigen::Index(j)));
    }
  }
}

TEST(ClosedChain, InformationEqualsThatOfTheWeightedLoopEquations) {
  // theory.md eq. (7): J = W^{1/2} ∂f/∂ξ, W = (F_X Σ_X F_Xᵀ + F_ρ Σ_ρ F_ρᵀ)⁻¹, the residual written on the legs.
  const SixLegsSpec spec = inclined_telescope();
  MeasurementSpec pose;
  Eigen::Matrix<double, 6, 6> sigma = Eigen::Matrix<double, 6, 6>::Zero();
  sigma.diagonal() << 4e-12, 4e-12, 4e-12, 25e-12, 25e-12, 25e-12;
  sigma(0, 4) = sigma(4, 0) = 3e-12;
  pose.instrument = PoseMeasurement{sigma, {0, 1, 2, 3, 4, 5}, {}, 0};
  const ExplicitModel model(std::make_unique<SixLegs>(spec, limits()), make_measurement(pose));
  const SixLegs chain(spec, limits());
  const std::vector<double> q = {1e-3, -5e-4, 1e-4, 2e-3, -1e-3, 3e-3};
  std::vector<double> rho(6);
  ASSERT_TRUE(chain.actuator_values({q, {}}, rho));
  std::vector<int> selected(54), own(54);
  std::iota(selected.begin(), selected.end(), 6);
  std::iota(own.begin(), own.end(), 0);
  ClosedChain::Loops loops;
  chain.loops({q, rho, {}, own}, loops);
  Eigen::MatrixXd F_X = loops.platform;  // about the platform's origin, as the measured pose is
  for (int k = 0; k < 3; ++k)
    F_X.col(3 + k) += loops.platform.leftCols<3>() * chain.platform(q).translation().cross(Eigen::Vector3d::Unit(k));
  const Eigen::MatrixXd W =
      (F_X * sigma * F_X.transpose() + 1e-12 * loops.actuator * loops.actuator.transpose()).inverse();
  const Eigen::MatrixXd expected = loops.parameter.transpose() * W * loops.parameter;
  Linearisation scratch;
  std::vector<double> out(6 * 56);
  ASSERT_TRUE(whitened_block(model, q, {}, selected, scratch, out.data(), 56));
  const Eigen::MatrixXd J = Eigen::Map<Eigen::Matrix<double, 6, 56, Eigen::RowMajor>>(out.data()).leftCols(54);
  EXPECT_LT((J.transpose() * J - expected).norm(), 1e-9 * expected.norm());
}

TEST(Delta, ElbowsPointOutwardsWhetherThePlatformHangsOrStands) {
  DeltaSpec spec = delta();
  const Delta hanging(spec);
  spec.lower.z() = 0.6, spec.upper.z() = 0.8;
  const Delta standing(spec);
  std::vector<double> below(3), above(3);
  ASSERT_TRUE(hanging.actuator_values({std::vector<double>{0.05, -0.02, -0.7}, {}}, below));
  ASSERT_TRUE(standing.actuator_values({std::vector<double>{0.05, -0.02, 0.7}, {}}, above));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(above[i], -below[i], 1e-12);
    EXPECT_GT(std::cos(above[i]), 0);
  }
}

TEST(FiveBar, NearASingularityNothingIsMeasured) {
  // Distal links in line: the point can leave the line without the motors moving.
  FiveBarSpec spec = five_bar();
  spec.legs = {{{{-0.2, 0}, 0.3, 0.25, 1.0}, {{0.2, 0}, 0.3, 0.25, -1.0}}};
  MeasurementSpec pose;
  pose.instrument = PoseMeasurement{1e-8 * Eigen::Matrix<double, 6, 6>::Identity(), {0, 1}, {}, 0};
  const ExplicitModel model(std::make_unique<FiveBar>(spec), make_measurement(pose));
  EXPECT_EQ(model.unmeasurable_reason(), "near a singularity");
  // Elbows at (±0.25, h): in line with the point between them when both distal links lie along x.
  const double h = std::sqrt(0.3 * 0.3 - 0.05 * 0.05);
  EXPECT_FALSE(model.measurable(std::vector<double>{0.0, h + 1e-7}));
  EXPECT_TRUE(model.measurable(std::vector<double>{0.0, h + 0.1}));
}

TEST(SixLegs, DeformedPlatformNeedsOtherActuatorsAndStillClosesItsLoops) {
  Problem problem = telescope();
  VariantSpec variant = problem.variants.front();
  variant.nominal = {{{"K_11", 0}, 0.016, Quantity::number}, {{"K_12", 0}, -0.5, Quantity::number}};
  const auto rigid = make_model(problem), deforming = make_model({problem, variant});
  const std::vector<double> q = {1e-3, -5e-4, 1e-4, 2e-3, -1e-3, 3e-3};
  std::vector<double> a(6), b(6);
  ASSERT_TRUE(rigid->actuator_values(q, a));
  ASSERT_TRUE(deforming->actuator_values(q, b));
  EXPECT_GT(std::abs(a[0] - b[0]), 1e-6) << "leg 1's joint moves with the actuators";
  for (std::size_t i = 1; i < 6; ++i) EXPECT_EQ(a[i], b[i]);
}

TEST(FiveBar, SensorRowsEqualAutomaticDifferentiationThroughTheClosedLoops) {
  // y = ψ(x(ρ, ξ), ρ, ξ): dy = ψ_ξ − ψ_x F_x⁻¹ F_ξ with every part from Jets.
  const FiveBarSpec spec = five_bar();
  const FiveBar chain(spec);
  Random random(3, 0);
  for (int n = 0; n < 1000; ++n) {
    const std::vector<double> q = random_configuration(chain.coordinates(), random);
    std::vector<double> rho(2);
    if (!chain.actuator_values({q, {}}, rho)) continue;
    // 12 parameters, then x, y, then both actuators.
    const auto at = [&](const std::vector<Jet>& d, bool sensor) {
      std::vector<Jet> rows;
      for (std::size_t i = 0; i < 2; ++i) {
        const FiveBarSpec::Leg& leg = spec.legs[i];
        const Jet* c = d.data() + 6 * i;
        const Jet v[5] = {c[0] + leg.base.x(), c[1] + leg.base.y(), c[2] + leg.proximal, c[3] + leg.distal, c[4]};
        const Jet x = d[12] + q[0], y = d[13] + q[1], r = d[14 + i] + rho[i];
        rows.push_back(sensor ? five_bar_elbow<Jet>(x, y, r, v, c[5]) : five_bar_residual<Jet>(x, y, r, v));
      }
      return rows;
    };
    Eigen::MatrixXd f(2, 16), psi(2, 16);
    for (std::size_t j = 0; j < 16; ++j) {
      std::vector<Jet> d(16, Jet(0.0));
      d[j].v[0] = 1;
      const auto g = at(d, false), s = at(d, true);
      for (Eigen::Index r = 0; r < 2; ++r)
        f(r, Eigen::Index(j)) = g[std::size_t(r)].v[0], psi(r, Eigen::Index(j)) = s[std::size_t(r)].v[0];
    }
    const Eigen::Matrix2d solve = psi.middleCols<2>(12) * f.middleCols<2>(12).inverse();
    Eigen::MatrixXd rows, reading_rows;
    std::vector<int> all(chain.parameters().size());
    std::iota(all.begin(), all.end(), 0);
    ASSERT_TRUE(chain.sensor_rows({q, {}}, all, rows, reading_rows));
    EXPECT_LT((rows.middleCols(6, 12) - (psi.leftCols<12>() - solve * f.leftCols<12>())).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((reading_rows - (psi.rightCols<2>() - solve * f.rightCols<2>())).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_EQ(rows.leftCols<6>().norm() + rows.rightCols<6>().norm(), 0) << "base and tool have no effect on sensors";
  }
}

}  // namespace
}  // namespace posewright
