// The estimator against Ceres: another solver, derivatives by differences, covariance by its own decomposition.

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <cmath>

#include "posewright/calibration/fit.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

/// Whitened residual of one pose of parameters in units of tolerance, by the readings alone.
struct PoseResidual {
  const IdentificationModel* model;
  const VariantColumns* columns;
  const MeasuredPose* pose;
  Eigen::LLT<Eigen::MatrixXd> root;

  bool operator()(double const* const* x, double* residual) const {
    std::vector<double> correction(model->parameters().size(), 0.0);
    for (std::size_t j = 0; j < columns->selected.size(); ++j)
      correction[std::size_t(columns->selected[j])] = x[0][j] * columns->parameters[j].tolerance;
    Eigen::VectorXd y, difference;
    if (!model->predict(pose->q, correction, y)) return false;
    model->difference(pose->y, y, difference);
    root.matrixL().solveInPlace(difference);
    Eigen::Map<Eigen::VectorXd>(residual, difference.size()) = difference;
    return true;
  }
};

struct Named {
  const char *file, *variant;
  int poses;
};

class AgainstCeres : public testing::TestWithParam<Named> {};

TEST_P(AgainstCeres, SameMinimumSameCovariance) {
  const Problem problem = example(GetParam().file);
  const VariantSpec& spec = find_variant(problem, GetParam().variant);
  const auto model = make_model({problem, spec});
  const VariantColumns columns = select_columns(*model, {problem, spec});
  Random random(11, 1);
  std::vector<MeasuredPose> poses = random_poses(*model, GetParam().poses, random);
  read_poses_of(*model, random_truth(*model, columns, 0.2, random), 1.0, random, poses);
  const Fit own = fit(*model, columns, poses, {});

  const int m = int(columns.selected.size());
  std::vector<double> x(std::size_t(m), 0.0);
  ceres::Problem oracle;
  Linearisation at;
  Eigen::VectorXd y;
  for (const MeasuredPose& pose : poses) {
    // Weights at the solution, as the estimator takes them.
    ASSERT_TRUE(model->predict_and_linearise(pose.q, own.correction, {}, at, y));
    auto* cost = new ceres::DynamicNumericDiffCostFunction<PoseResidual, ceres::RIDDERS>(
        new PoseResidual{model.get(), &columns, &pose, Eigen::LLT<Eigen::MatrixXd>(at.covariance)});
    cost->AddParameterBlock(m);
    cost->SetNumResiduals(int(model->readings().size()));
    oracle.AddResidualBlock(cost, nullptr, x.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.function_tolerance = options.parameter_tolerance = options.gradient_tolerance = 1e-14;
  options.max_num_iterations = 200;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &oracle, &summary);
  ASSERT_TRUE(summary.IsSolutionUsable());
  EXPECT_NEAR(2 * summary.final_cost, own.chi_square, 1e-5 * own.chi_square);

  ceres::Covariance::Options by_svd;
  by_svd.algorithm_type = ceres::DENSE_SVD;
  ceres::Covariance covariance(by_svd);
  const std::vector<std::pair<const double*, const double*>> blocks = {{x.data(), x.data()}};
  ASSERT_TRUE(covariance.Compute(blocks, &oracle));
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> found(m, m);
  covariance.GetCovarianceBlock(x.data(), x.data(), found.data());
  for (int j = 0; j < m; ++j) {
    const double tolerance = columns.parameters[std::size_t(j)].tolerance, sigma = std::sqrt(own.covariance(j, j));
    EXPECT_NEAR(x[std::size_t(j)] * tolerance, own.change[j], 0.01 * sigma) << columns.parameters[std::size_t(j)].name;
    EXPECT_NEAR(std::sqrt(found(j, j)) * tolerance, sigma, 1e-3 * sigma) << columns.parameters[std::size_t(j)].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, AgainstCeres,
                         testing::Values(Named{"kr270/problem.yaml", "geometric", 18},
                                         Named{"kr270/elastostatic.yaml", "", 30},
                                         Named{"telescope/problem.yaml", "linear", 20},
                                         Named{"kr270/compensator_geometry.yaml", "", 12}),
                         [](const auto& row) { return test_name(row.param.file); });

}  // namespace
}  // namespace posewright
