// A criterion of one's own: Kiefer's phi_2, the root sum of squares of the variances, for a parabola on [-1, 1].
#include <cmath>
#include <iostream>
#include <limits>
#include <posewright/criterion/criterion_data.hpp>
#include <posewright/criterion/information_function.hpp>
#include <posewright/criterion/registry.hpp>
#include <posewright/support/dense.hpp>
#include <posewright/tasks/select_blocks.hpp>

namespace {

/// Phi(M) = -ln tr(M^-2) / 2, maximised. M is whitened; C^T M C is in units of the columns.
class SquaredVariances : public posewright::InformationFunction {
 public:
  explicit SquaredVariances(const posewright::CriterionData& data) : C_(data.to_scaled()) {}
  double value(const Eigen::MatrixXd& M) const override {
    const Eigen::LLT<Eigen::MatrixXd> factor(C_.transpose() * M * C_);
    if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
    return -0.5 * std::log(factor.solve(Eigen::MatrixXd::Identity(C_.cols(), C_.cols())).squaredNorm());
  }
  Eigen::MatrixXd gradient(const Eigen::MatrixXd& M) const override {
    const Eigen::MatrixXd V = (C_.transpose() * M * C_).inverse();
    return C_ * (V * V * V / V.squaredNorm()) * C_.transpose();
  }
  bool concave() const override { return true; }

 private:
  Eigen::MatrixXd C_;
};

std::unique_ptr<posewright::Criterion> make(const posewright::CriterionData& data) {
  return std::make_unique<posewright::FunctionCriterion>("phi2", std::make_shared<SquaredVariances>(data));
}

}  // namespace

int main() {
  posewright::register_criterion({.name = "phi2",
                                  .summary = "root sum of squares of the variances (Kiefer's phi_2)",
                                  .make = make,
                                  .shown = posewright::shown_variance,
                                  .scaled = true});
  constexpr int points = 41;
  posewright::BlockFile own{posewright::BlockArray(points, 1, 3), {"1", "x", "x2"}, ""};
  for (int i = 0; i < points; ++i) {
    const double x = -1 + 2.0 * i / (points - 1);
    own.blocks.all().row(i) << 1, x, x * x;
  }
  posewright::SelectOptions options;
  options.poses = 8;
  options.criterion = "phi2";
  options.repeats.most = 8;
  const posewright::Plan plan = posewright::select_blocks(std::move(own), options, posewright::Monitor{});
  for (const posewright::PlannedPose& pose : plan.poses) std::cout << -1 + 2.0 * *pose.candidate / (points - 1) << " ";
  std::cout << "phi2 " << plan.criterion_value << "\n";
}
