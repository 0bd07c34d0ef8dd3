// How ⟨S, JᵀJ⟩ changes with the configuration: derivatives of robots, instruments and whitening against central
// differences of whole whitened blocks, extrapolated to the sixth order. That road knows the block alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "posewright/model/delta.hpp"
#include "posewright/model/dh_chain.hpp"
#include "posewright/model/elastic_chain.hpp"
#include "posewright/model/explicit_model.hpp"
#include "posewright/model/measurement_factory.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/serial_chain.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/support/dense.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/jets.hpp"
#include "tests/kit/random_chain.hpp"

namespace posewright {
namespace {

using Rows = BlockArray::RowMatrix;

Eigen::MatrixXd random_semidefinite(Eigen::Index m, Random& random) {
  Eigen::MatrixXd F(m, 3);
  for (double& x : F.reshaped()) x = random.uniform(-1, 1);
  return F * F.transpose();
}

/// f(q) = ⟨S, JᵀJ⟩ of one model; NaN where q has no block.
class OfBlock {
 public:
  OfBlock(const IdentificationModel& model, std::vector<int> selected, Random& random)
      : model_(model), selected_(std::move(selected)), J_(model.block_rows(selected_), Eigen::Index(selected_.size())) {
    // In units in which every column counts.
    tolerance_.resize(J_.cols());
    for (Eigen::Index c = 0; c < J_.cols(); ++c) {
      const auto i = std::size_t(selected_[std::size_t(c)]);
      tolerance_[c] = i < model.parameters().size() ? model.parameters()[i].tolerance : 1e-4;
    }
    S_ = tolerance_.asDiagonal() * random_semidefinite(J_.cols(), random) * tolerance_.asDiagonal();
  }

  double operator()(const std::vector<double>& q) {
    if (!whitened_block(model_, q, {}, selected_, scratch_, J_.data(), int(J_.cols()))) return NAN;
    return (J_ * S_).cwiseProduct(J_).sum();
  }

  bool gradient(const std::vector<double>& q, std::vector<double>& result) {
    (*this)(q);
    result.resize(q.size());
    return whitened_gradient(model_, q, selected_, J_, Rows(2 * J_ * S_), scratch_, result);
  }

  /// Romberg's table of central differences, three steps. The first step is wide: of a telescope whose range is 4 mm a
  /// hundredth of the range loses seven digits to rounding.
  double derivative(std::vector<double> q, std::size_t k, double h) {
    double D[3];
    for (double& d : D) {
      const double at = q[k];
      q[k] = at + h;
      const double up = (*this)(q);
      q[k] = at - h;
      d = (up - (*this)(q)) / (2 * h);
      q[k] = at;
      h /= 2;
    }
    const double a = (4 * D[1] - D[0]) / 3, b = (4 * D[2] - D[1]) / 3;
    return (16 * b - a) / 15;
  }

 private:
  const IdentificationModel& model_;
  std::vector<int> selected_;
  Rows J_;
  Eigen::VectorXd tolerance_;
  Eigen::MatrixXd S_;
  Linearisation scratch_;
};

/// Largest difference of both roads in units of the largest derivative, lengths and angles by their ranges.
double worst_difference(const IdentificationModel& model, const std::vector<int>& selected, int configurations) {
  Random random(11, 3);
  OfBlock f(model, selected, random);
  const std::vector<Coordinate>& coordinates = model.coordinates();
  double worst = 0;
  std::vector<double> gradient;
  for (int done = 0, drawn = 0; done < configurations; ++drawn) {
    if (drawn > 2000 * configurations) return INFINITY;
    const std::vector<double> q = random_configuration(coordinates, random);
    if (!model.measurable(q) || !std::isfinite(f(q))) continue;
    std::vector<double> expected(q.size(), 0.0);
    double largest = 0;
    for (std::size_t k = 0; k < q.size(); ++k) {
      if (coordinates[k].discrete()) continue;
      const double range = coordinates[k].upper - coordinates[k].lower;
      expected[k] = f.derivative(q, k, std::min(4e-3, 0.04 * range)) * range;
      largest = std::max(largest, std::abs(expected[k]));
    }
    if (!std::isfinite(largest) || largest == 0) continue;
    if (!f.gradient(q, gradient)) return INFINITY;
    for (std::size_t k = 0; k < q.size(); ++k) {
      if (coordinates[k].discrete()) continue;
      const double range = coordinates[k].upper - coordinates[k].lower;
      worst = std::max(worst, std::abs(gradient[k] * range - expected[k]) / largest);
    }
    ++done;
  }
  return worst;
}

double worst_difference(const IdentificationModel& model, int configurations = 10) {
  return worst_difference(model, all_parameters(model), configurations);
}

// Robots and instruments that have derivatives of their own are right to rounding, others to that of differences.
constexpr double tolerance = 2e-7;

class GradientOf : public testing::TestWithParam<const char*> {};

TEST_P(GradientOf, ProblemIsThatOfItsWhitenedBlocks) {
  const Problem problem = example(GetParam());
  for (const VariantSpec& variant : problem.variants) {
    const auto model = make_model({problem, variant});
    EXPECT_LT(worst_difference(*model, 5), tolerance) << variant.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, GradientOf,
                         testing::Values("kr270/problem.yaml", "kr270/elastostatic.yaml", "kr270/compensator.yaml",
                                         "telescope/within_stroke.yaml", "gough/problem.yaml", "delta/problem.yaml",
                                         "instruments/cables.yaml", "instruments/camera_on_hand.yaml",
                                         "instruments/photogrammetry.yaml", "instruments/tracker_two_stations.yaml",
                                         "instruments/tracker_and_camera.yaml", "instruments/read_together.yaml"),
                         [](const auto& example_file) { return test_name(example_file.param); });

MeasurementSpec tracker() {
  PointsMeasurement measurement;
  measurement.targets = {{"A", {0.1, 0.2, -0.3}, 0}, {"B", {-0.2, 0.05, 0.4}, 0}, {"C", {0.3, -0.1, 0.1}, 0}};
  measurement.noise = TrackerNoise{1e-5, 2e-6, 3e-6, 2e-5};
  StationSpec a, b;
  a.name = "a", a.placement.position = {3, 1, -2}, a.placement.rpy = {0.3, -0.4, 2};
  b.name = "b", b.placement.position = {-2, 4, 1}, b.placement.rpy = {-0.2, 0.9, 1};
  measurement.stations = {a, b};
  MeasurementSpec spec;
  spec.instrument = measurement;
  return spec;
}

TEST(Gradient, OfRandomChainsSeenByATrackerWithEveryKindOfNoise) {
  for (std::uint64_t seed = 0; seed < 9; ++seed) {
    ChainDescription chain = random_chain(100 + seed, seed % 2 == 1, seed % 3 == 1, seed >= 3);
    for (double& sigma : chain.encoder_noise) sigma = 2e-5;
    const MeasurementSpec spec = tracker();
    ExplicitModel model(std::make_unique<SerialChain>(chain), make_measurement(spec), {2e-5, 4e-5, 1e-5});
    std::vector<int> selected = all_parameters(model);
    for (int k = 0; k < 6; ++k) selected.push_back(model.tip_column(0, k));
    EXPECT_LT(worst_difference(model, selected, 4), tolerance) << seed;
    // Away from the nominal parameters too: displaced frames, a gear that is off.
    Random random(seed, 9);
    for (std::size_t i = 0; i < model.parameters().size(); ++i)
      model.set_nominal(int(i), model.parameters()[i].nominal + random.uniform(-0.2, 0.2));
    EXPECT_LT(worst_difference(model, selected, 4), tolerance) << seed;
  }
}

TEST(Gradient, OfATouchedPlaneAnInclinometerAndAProfiler) {
  PlaneMeasurement plane;
  plane.probe = {"probe", {0.1, 0.2, -0.3}, 0};
  plane.normal = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  plane.radius = 100, plane.range_lower = -100, plane.range_upper = 100, plane.sigma = 1e-5;
  InclinationMeasurement inclination;
  inclination.rpy = {0.4, -0.3, 1.2};
  inclination.range = 1.4, inclination.sigma = 1e-4;
  LineMeasurement line;
  line.sensor.position = {0.1, 0.2, -0.3};
  line.sensor.rpy = {0.4, -0.3, 1.2};
  line.direction = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  line.length = 100, line.width = 100, line.range_lower = -100, line.range_upper = 100, line.sigma = 1e-5;
  for (const InstrumentSpec& instrument : {InstrumentSpec(plane), InstrumentSpec(inclination), InstrumentSpec(line)}) {
    MeasurementSpec spec;
    spec.instrument = instrument;
    ExplicitModel model(std::make_unique<SerialChain>(random_chain(31, true, false)), make_measurement(spec),
                        {2e-5, 4e-5, 0});
    EXPECT_LT(worst_difference(model), tolerance) << instrument.index();
    Random random(4, 9);
    for (std::size_t i = 0; i < model.parameters().size(); ++i)
      model.set_nominal(int(i), model.parameters()[i].nominal + random.uniform(-0.2, 0.2));
    EXPECT_LT(worst_difference(model), tolerance) << instrument.index();
  }
}

TEST(Gradient, OfADenavitHartenbergChainWithNoisyEncoders) {
  ChainDescription chain = random_chain(7, true, false);
  for (double& sigma : chain.encoder_noise) sigma = 2e-5;
  for (const DhConvention convention : {DhConvention::distal, DhConvention::proximal}) {
    ExplicitModel model(std::make_unique<DhChain>(denavit_hartenberg(chain, convention)), make_measurement(tracker()));
    EXPECT_LT(worst_difference(model), tolerance);
    for (int i = 0; i < int(model.parameters().size()); ++i)
      model.set_nominal(i, model.parameters()[std::size_t(i)].nominal + 0.03 * (i % 5));
    EXPECT_LT(worst_difference(model), tolerance);
  }
}

JointEffectsSpec every_effect(const std::string& joint, const std::string& other) {
  return {{joint, 1}, true, 20.0, {{other, 1}}, true, {}, true};
}

TEST(Gradient, OfJointEffectsOnRigidAndElasticArms) {
  for (const char* file : {"kr270/problem.yaml", "kr270/elastostatic.yaml"}) {
    Problem problem = example(file);
    auto& arm = std::get<SerialArmSpec>(problem.robot);
    arm.joint_effects = {every_effect("joint_a2", "joint_a1"), every_effect("joint_a4", "joint_a2")};
    arm.temperature = TemperatureSpec{20.0, {18.0, 20.0, 25.0}};
    arm.encoder_noise = 1e-4;
    const auto model = make_model(problem);
    EXPECT_LT(worst_difference(*model, 4), tolerance) << file;
    problem.measurement.loaded_minus_unloaded = false;
    const auto corrected = make_model(problem);
    for (std::size_t i = 0; i < corrected->parameters().size(); ++i)
      if (const std::string& name = corrected->parameters()[i].name; name.starts_with("joint_a"))
        corrected->set_nominal(int(i), corrected->parameters()[i].nominal + 10 * corrected->parameters()[i].tolerance);
    EXPECT_LT(worst_difference(*corrected, 4), tolerance) << file;
  }
}

TEST(Gradient, OfClosedChainsAwayFromTheirNominalParametersWithNoisyActuators) {
  for (const char* file :
       {"telescope/within_stroke.yaml", "gough/problem.yaml", "delta/problem.yaml", "five_bar/problem.yaml"}) {
    Problem problem = example(file);
    if (std::holds_alternative<JointsMeasurement>(problem.measurement.instrument)) problem.measurement = tracker();
    set_joint_noise(problem.robot, 3e-5);
    for (const double size : {0.0, 1.0}) {
      const auto model = make_model(problem);
      Random random(5, 2);
      for (int i = 0; i < int(model->parameters().size()); ++i) {
        const Parameter& p = model->parameters()[std::size_t(i)];
        if (size > 0) model->set_nominal(i, p.nominal + size * random.uniform(-1, 1) * p.tolerance);
      }
      EXPECT_LT(worst_difference(*model, 5), tolerance) << file << " " << size;
    }
  }
}

TEST(Gradient, OfDistancesBetweenTwoConfigurationsWithNoiseOfBoth) {
  Problem problem = example("instruments/ball_bar.yaml");
  problem.measurement.repeatability = {2e-5, 4e-5, 0};
  std::get<SerialArmSpec>(problem.robot).encoder_noise = 2e-5;
  auto& bar = std::get<DistanceMeasurement>(problem.measurement.instrument);
  bar.targets.push_back({"second", {0.1, -0.2, 0.1}, 0});
  bar.sigma_per_m = 1e-5;
  const auto model = make_model(problem);
  std::vector<int> selected = all_parameters(*model);
  for (const int tip : {0, 1})
    for (int k = 0; k < 6; ++k) selected.push_back(model->tip_column(tip, k));
  EXPECT_LT(worst_difference(*model, selected, 5), tolerance);
}

TEST(Gradient, OfAModelWithoutDerivativesIsNotClaimed) {
  const auto model = make_model(example("five_bar/problem.yaml"));
  Random random(1, 1);
  OfBlock f(*model, all_parameters(*model), random);
  std::vector<double> q, gradient;
  do q = random_configuration(model->coordinates(), random);
  while (!model->measurable(q));
  EXPECT_FALSE(f.gradient(q, gradient));
}

}  // namespace
}  // namespace posewright
