// What stays at a pose: one displacement of the tip, common to all that is read there. The second road displaces the
// tip and reads again; it knows neither twists nor the model's derivatives.

#include <gtest/gtest.h>

#include "posewright/blocks/block_array.hpp"
#include "posewright/model/measurement_factory.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/rotation_vector.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/support/dense.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/jets.hpp"

namespace posewright {
namespace {

constexpr double translation = 6e-5, rotation = 2e-4;

Eigen::Isometry3d displaced(const Eigen::Isometry3d& X, int component, double length) {
  Eigen::Isometry3d moved = X;
  if (component < 3) moved.translation()[component] += length;
  else moved.linear() = rotation_by(length * Eigen::Vector3d::Unit(component - 3)) * X.linear();
  return moved;
}

/// Σ over the six components of (dy/de · σ)(dy/de · σ)ᵀ by central differences of what the instrument reads.
Eigen::MatrixXd covariance_by_displacing(const MeasurementModel& instrument, const Eigen::Isometry3d& X) {
  constexpr double h = 1e-6;
  const Eigen::Index rows = instrument.rows();
  Eigen::MatrixXd A(rows, 6);
  Eigen::VectorXd ahead(rows), behind(rows), change(rows);
  for (int k = 0; k < 6; ++k) {
    const Eigen::Isometry3d forward = displaced(X, k, h), back = displaced(X, k, -h);
    instrument.read({forward, {}, 0}, ahead);
    instrument.read({back, {}, 0}, behind);
    instrument.difference(ahead, behind, change);
    A.col(k) = change / (2 * h) * (k < 3 ? translation : rotation);
  }
  return A * A.transpose();
}

struct Case {
  const char* problem;
  double scale;  ///< of the largest entry, what differences may be off by
};
class RepeatabilityOf : public testing::TestWithParam<Case> {};

TEST_P(RepeatabilityOf, InstrumentIsWhatADisplacedTipReads) {
  Problem problem = example(GetParam().problem);
  problem.measurement.repeatability = {};
  const auto without = make_model(problem);
  problem.measurement.repeatability = {translation, rotation, 0.0};
  const auto with = make_model(problem);
  const auto instrument = make_measurement(problem.measurement);
  Random random(3, 1);
  Linearisation a, b;
  int found = 0;
  for (int i = 0; i < 200 && found < 20; ++i) {
    std::vector<double> q = random_configuration(with->coordinates(), random);
    for (std::size_t k = 0; k < q.size(); ++k)
      if (with->coordinates()[k].choice()) q[k] = 0;
    if (!with->linearise(q, {}, {}, a) || !without->linearise(q, {}, {}, b)) continue;
    ++found;
    const Eigen::MatrixXd expected = covariance_by_displacing(*instrument, with->tool_pose(q));
    EXPECT_LT((a.covariance - b.covariance - expected).cwiseAbs().maxCoeff(),
              GetParam().scale * expected.cwiseAbs().maxCoeff());
  }
  EXPECT_EQ(found, 20);
}
TEST_P(RepeatabilityOf, InstrumentHasUnitTwistsOfTheTipAsColumns) {
  const auto model = make_model(example(GetParam().problem));
  std::vector<int> selected;
  for (int k = 0; k < 6; ++k) selected.push_back(model->tip_column(0, k));
  const auto instrument = make_measurement(example(GetParam().problem).measurement);
  Random random(4, 1);
  Linearisation out;
  int found = 0;
  for (int i = 0; i < 200 && found < 10; ++i) {
    std::vector<double> q = random_configuration(model->coordinates(), random);
    for (std::size_t k = 0; k < q.size(); ++k)
      if (model->coordinates()[k].choice()) q[k] = 0;
    if (!model->linearise(q, {}, selected, out)) continue;
    ++found;
    for (int k = 0; k < 6; ++k) out.G.col(k) *= k < 3 ? translation : rotation;
    const Eigen::MatrixXd expected = covariance_by_displacing(*instrument, model->tool_pose(q));
    EXPECT_LT((out.G * out.G.transpose() - expected).cwiseAbs().maxCoeff(),
              GetParam().scale * expected.cwiseAbs().maxCoeff());
  }
  EXPECT_EQ(found, 10);
}

TEST(Repeatability, EitherEndOfADistanceHasItsOwnTwists) {
  // What moves both ends alike changes no distance; one end alone does.
  const auto model = make_model(example("instruments/ball_bar.yaml"));
  ASSERT_EQ(model->tips(), 2);
  std::vector<int> selected;
  for (int tip = 0; tip < 2; ++tip)
    for (int k = 0; k < 3; ++k) selected.push_back(model->tip_column(tip, k));
  Random random(5, 1);
  Linearisation out;
  int found = 0;
  for (int i = 0; i < 2000 && found < 10; ++i) {
    const std::vector<double> q = random_configuration(model->coordinates(), random);
    if (!model->linearise(q, {}, selected, out)) continue;
    ++found;
    EXPECT_LT((out.G.leftCols<3>() + out.G.rightCols<3>()).cwiseAbs().maxCoeff(), 1e-12);
    for (Eigen::Index t = 0; t < out.G.rows(); ++t) EXPECT_NEAR(out.G.row(t).head<3>().norm(), 1, 1e-12);
  }
  EXPECT_GT(found, 0);
}

INSTANTIATE_TEST_SUITE_P(Every, RepeatabilityOf,
                         testing::Values(Case{"kr270/problem.yaml", 1e-6}, Case{"telescope/problem.yaml", 1e-6},
                                         Case{"instruments/cables.yaml", 1e-5},
                                         Case{"instruments/camera_on_hand.yaml", 1e-5}));

TEST(Repeatability, BlocksOfManyReadingsCarryIt) {
  // The board's blocks are written with fewer rows than readings.
  Problem problem = example("instruments/camera_on_hand.yaml");
  problem.measurement.repeatability = {translation, rotation, 0.0};
  const auto model = make_model(problem);
  const std::vector<int> selected = {0, 4, 9};
  ASSERT_LT(model->block_rows(selected), model->rows());
  Random random(4, 1);
  Linearisation scratch;
  std::vector<double> out(std::size_t(model->block_rows(selected)) * 3);
  int found = 0;
  for (int i = 0; i < 500 && found < 5; ++i) {
    const std::vector<double> q = random_configuration(model->coordinates(), random);
    if (!model->measurable(q) || !whitened_block(*model, q, {}, selected, scratch, out.data(), 3)) continue;
    ++found;
    const BlockArray::Map block(out.data(), model->block_rows(selected), 3, Eigen::OuterStride<>(3));
    ASSERT_TRUE(model->linearise(q, {}, selected, scratch));
    const Eigen::MatrixXd expected = scratch.G.transpose() * scratch.covariance.llt().solve(scratch.G);
    EXPECT_LT((block.transpose() * block - expected).norm(), 1e-8 * expected.norm());
  }
  EXPECT_EQ(found, 5);
}

TEST(Repeatability, OfSixtyMicrometresLeavesABaseFromNinePosesTwentyHoweverManyReflectors) {
  Problem problem = example("kr270/problem.yaml");
  auto& points = std::get<PointsMeasurement>(problem.measurement.instrument);
  // All noise but that of the pose is negligible.
  points.noise = GaussianNoise{1e-16 * Eigen::Matrix3d::Identity()};
  problem.measurement.repeatability = {6e-5, 0.0, 0.0};
  for (const std::size_t reflectors : {std::size_t(1), std::size_t(3)}) {
    points.targets.resize(reflectors, points.targets.front());
    for (std::size_t t = 0; t < reflectors; ++t) points.targets[t].name = std::string(1, char('A' + t));
    const auto model = make_model(problem);
    std::vector<int> base;
    for (int i = 0; i < int(model->parameters().size()); ++i) {
      const std::string& name = model->parameters()[std::size_t(i)].name;
      if (name == "base.x" || name == "base.y" || name == "base.z") base.push_back(i);
    }
    Random random(5, 1);
    Linearisation at;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (int k = 0; k < 9; ++k) {
      ASSERT_TRUE(model->linearise(random_configuration(model->coordinates(), random), {}, base, at));
      information += at.G.transpose() * at.covariance.llt().solve(at.G);
    }
    const Eigen::Matrix3d covariance = information.inverse();
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::sqrt(covariance(k, k)), 2e-5, 1e-9) << reflectors << " reflectors";
    points.targets = std::get<PointsMeasurement>(example("kr270/problem.yaml").measurement.instrument).targets;
  }
}

TEST(Repeatability, BetweenTwoConfigurationsStandsOffAtEitherEnd) {
  Problem problem = example("instruments/ball_bar.yaml");
  ASSERT_TRUE(std::get<DistanceMeasurement>(problem.measurement.instrument).anchors.empty());
  problem.measurement.repeatability = {};
  const auto without = make_model(problem);
  problem.measurement.repeatability = {translation, 0.0, 0.0};
  const auto with = make_model(problem);
  Random random(6, 1);
  Linearisation a, b;
  int found = 0;
  for (int i = 0; i < 2000 && found < 10; ++i) {
    const std::vector<double> q = random_configuration(with->coordinates(), random);
    if (!with->linearise(q, {}, {}, a) || !without->linearise(q, {}, {}, b)) continue;
    ++found;
    // A distance changes by what either end moves along it.
    EXPECT_NEAR(a.covariance(0, 0) - b.covariance(0, 0), 2 * translation * translation, 1e-16);
  }
  EXPECT_EQ(found, 10);
}

TEST(Repeatability, CancelsBetweenLoadedAndUnloaded) {
  Problem problem = example("kr270/elastostatic.yaml");
  ASSERT_TRUE(problem.measurement.loaded_minus_unloaded);
  Linearisation a, b;
  const auto without = make_model(problem);
  problem.measurement.repeatability = {translation, rotation, 0.0};
  const auto with = make_model(problem);
  Random random(7, 1);
  const std::vector<double> q = random_configuration(with->coordinates(), random);
  ASSERT_TRUE(with->linearise(q, {}, {}, a));
  ASSERT_TRUE(without->linearise(q, {}, {}, b));
  EXPECT_EQ(a.covariance, b.covariance);
}

TEST(Repeatability, OfEachTargetOnItsOwnIsForVirtualTruthsOnly) {
  Problem problem = example("kr270/problem.yaml");
  problem.measurement.repeatability = {0.0, 0.0, translation};
  const auto model = make_model(problem);
  Linearisation at;
  ASSERT_TRUE(model->linearise(std::vector<double>{0.1, -1, 0.5, 0, 0.3, 0}, {}, {}, at));
  EXPECT_NEAR(at.covariance(4, 4), 1e-8 / problem.measurement.repeats + translation * translation, 1e-20);
  EXPECT_EQ(at.covariance(4, 1), 0);
}

}  // namespace
}  // namespace posewright
