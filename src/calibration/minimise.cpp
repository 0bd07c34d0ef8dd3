#include "minimise.hpp"

#include <unsupported/Eigen/NonLinearOptimization>

#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

// What Levenberg–Marquardt sees of a step that no robot can take: it will try a shorter one.
constexpr double beyond_reach = 1e12;

/// The residuals as Eigen's port of MINPACK wants them, over all columns but the one that is held.
struct Functor {
  using Scalar = double;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;

  StackedReadings& stacked;
  const MinimiseOptions& options;
  Eigen::VectorXd& whole;  ///< with the column that is held
  Eigen::MatrixXd& all;    ///< scratch

  int inputs() const { return stacked.columns() - (options.held >= 0 ? 1 : 0); }
  int values() const { return stacked.rows(); }
  bool stopped() const { return options.monitor != nullptr && options.monitor->should_stop(); }

  void put(const Eigen::VectorXd& x) const {
    for (Eigen::Index j = 0, free = 0; j < whole.size(); ++j)
      if (j != options.held) whole[j] = x[free++];
  }
  Eigen::VectorXd free() const {
    Eigen::VectorXd x(inputs());
    for (Eigen::Index j = 0, k = 0; j < whole.size(); ++j)
      if (j != options.held) x[k++] = whole[j];
    return x;
  }

  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& f) const {
    if (stopped()) return -1;
    put(x);
    if (!stacked.residual(whole, f)) f.setConstant(stacked.rows(), beyond_reach);
    return 0;
  }
  /// Only asked for where the residual was found, unless the robot stands in a singularity there.
  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& J) const {
    if (stopped()) return -1;
    put(x);
    if (options.held < 0) return stacked.jacobian(whole, J) ? 0 : -1;
    if (!stacked.jacobian(whole, all)) return -1;
    J << all.leftCols(options.held), all.rightCols(all.cols() - options.held - 1);
    return 0;
  }
};

}  // namespace

bool minimise(StackedReadings& stacked, const MinimiseOptions& options, Eigen::VectorXd& x, int& evaluations) {
  Eigen::MatrixXd all;
  Functor functor{stacked, options, x, all};
  if (functor.inputs() == 0) return true;
  Eigen::VectorXd free = functor.free();
  Eigen::LevenbergMarquardt<Functor> solver(functor);
  solver.parameters.ftol = solver.parameters.xtol = options.tolerance;
  solver.parameters.maxfev = options.most_evaluations;
  const auto status = solver.minimize(free);
  functor.put(free);
  evaluations += int(solver.nfev);
  using namespace Eigen::LevenbergMarquardtSpace;
  return status != TooManyFunctionEvaluation && status != UserAsked && status != ImproperInputParameters;
}

}  // namespace posewright
