// Readings and their derivatives belong together: for every model of the examples.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <numeric>

#include "posewright/model/model_factory.hpp"
#include "posewright/model/six_legs.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

/// Random corrections of the size of a fraction of the tolerances.
std::vector<double> random_corrections(const IdentificationModel& model, double fraction, Random& random) {
  std::vector<double> correction;
  for (const Parameter& p : model.parameters()) correction.push_back(fraction * p.tolerance * random.uniform(-1, 1));
  return correction;
}

/// Step of a central difference in units of the tolerance: rounding and curvature are both small there.
constexpr double step = 1e-2;

/// Worst relative difference between columns of G and differences of the readings; −1 where q cannot be measured.
double worst_column(const IdentificationModel& model, const std::vector<double>& q, std::vector<double> correction) {
  const int count = int(model.parameters().size());
  std::vector<int> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), 0);
  Linearisation at;
  Eigen::VectorXd y, ahead, behind, change;
  if (!model.predict_and_linearise(q, correction, all, at, y)) return -1;
  const Eigen::VectorXd noise = at.covariance.diagonal().cwiseSqrt();
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const double h = step * model.parameters()[std::size_t(i)].tolerance, kept = correction[std::size_t(i)];
    correction[std::size_t(i)] = kept + h;
    const bool up = model.predict(q, correction, ahead);
    correction[std::size_t(i)] = kept - h;
    if (!up || !model.predict(q, correction, behind)) return -1;
    correction[std::size_t(i)] = kept;
    model.difference(ahead, behind, change);
    const Eigen::VectorXd column = at.G.col(i).cwiseQuotient(noise);
    // What nobody reads is not told and does not change.
    const Eigen::VectorXd told = change.array().isNaN().select(0.0, change);
    const Eigen::VectorXd numeric = told.cwiseQuotient(noise) / (2 * h);
    // What changes no reading by a hundredth of its noise over ten tolerances is rounding.
    const double floor = 1e-3 / model.parameters()[std::size_t(i)].tolerance;
    worst = std::max(worst, (column - numeric).norm() / (column.norm() + floor));
  }
  return worst;
}

class Predictions : public testing::TestWithParam<std::string> {};

TEST_P(Predictions, ChangeAsTheLinearisationSays) {
  const Problem problem = example(GetParam());
  for (const VariantSpec& variant : problem.variants) {
    const auto model = make_model({problem, variant});
    ASSERT_EQ(int(model->readings().size()), model->rows());
    Random random(7, 1);
    int seen = 0;
    for (int i = 0; i < 20000 && seen < 8; ++i) {
      const std::vector<double> q = random_configuration(*model, random);
      if (!model->measurable(q)) continue;
      const double worst = worst_column(*model, q, random_corrections(*model, 0.3, random));
      if (worst < 0) continue;
      ++seen;
      EXPECT_LT(worst, 2e-5) << variant.name;
    }
    EXPECT_GE(seen, 4) << variant.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Files, Predictions, testing::ValuesIn(example_files()),
                         [](const auto& row) { return test_name(row.param); });

TEST(Prediction, AParallelRobotSettlesWhereItsActuatorsHoldIt) {
  const Problem problem = example("telescope/problem.yaml");
  const auto model = make_model({problem, problem.variants.front()});
  // A longer first leg pushes the platform away; the readings say so although the actuators are where they were.
  std::vector<double> correction(model->parameters().size(), 0.0);
  const auto at = std::find_if(model->parameters().begin(), model->parameters().end(),
                               [](const Parameter& p) { return p.name == "leg_1.l"; });
  correction[std::size_t(at - model->parameters().begin())] = 1e-3;
  const std::vector<double> q(model->coordinates().size(), 0.0);
  Eigen::VectorXd nominal, changed;
  ASSERT_TRUE(model->predict(q, {}, nominal));
  ASSERT_TRUE(model->predict(q, correction, changed));
  EXPECT_GT((changed - nominal).norm(), 1e-4);
  std::vector<double> actuators(model->actuators().size()), back(q.size());
  ASSERT_TRUE(model->actuator_values(q, actuators));
  ASSERT_TRUE(model->configuration_at(actuators, q, back));
  for (std::size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(back[i], q[i], 1e-12);
}

TEST(Prediction, OrientationsDifferByTheRotationBetweenThem) {
  const Problem problem = example("instruments/photogrammetry.yaml");
  const auto model = make_model({problem, problem.variants.front()});
  const Eigen::AngleAxisd a(3.0, Eigen::Vector3d::UnitX()), b(0.3, Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd sum(b * a);  // 3.3 rad about x: the other way round it is 2π − 3.3
  Eigen::VectorXd measured(6), predicted(6), out;
  measured << 1, 2, 3, sum.angle() * sum.axis();
  predicted << 0.5, 2, 3, a.angle() * a.axis();
  model->difference(measured, predicted, out);
  Eigen::VectorXd expected(6);
  expected << 0.5, 0, 0, 0.3, 0, 0;
  EXPECT_LT((out - expected).norm(), 1e-12);
  model->shifted(predicted, expected, measured);
  model->difference(measured, predicted, out);
  EXPECT_LT((out - expected).norm(), 1e-12);
}

}  // namespace
}  // namespace posewright
