#include "search.hpp"

#include <algorithm>
#include <cmath>

#include "planners/registry.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/planning/whiten.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

Certificate certificate_of(const ApproximateDesign& approximate, const SearchRequest& request, std::size_t count,
                           int interest, double offset) {
  Certificate certificate;
  certificate.log_det_bound = approximate.log_det_bound_for(request.poses, interest) + offset;
  certificate.max_sensitivity_ratio = approximate.max_sensitivity_ratio;
  certificate.count = count;
  certificate.repeats = request.repeats == Repeats::allow;
  return certificate;
}

}  // namespace

void require_known(const std::string& criterion, const std::string& method, const SourcePlace& criterion_place,
                   const SourcePlace& method_place) {
  if (find_criterion(criterion) == nullptr)
    throw InputError(criterion_place, "unknown criterion '" + criterion + "'", "available: " + criterion_names());
  if (make_planner(method) == nullptr)
    throw InputError(method_place, "unknown method '" + method + "'", "available: " + planner_names());
}

SearchResult search(BlockArray blocks, const SearchRequest& request, const Monitor& monitor) {
  const int interest = blocks.columns() - request.nuisance;
  const bool repeats = request.repeats == Repeats::allow;
  if (!repeats && std::size_t(request.poses) > blocks.count())
    throw CannotDo(std::to_string(request.poses) + " poses without repeats cannot be chosen from " +
                   std::to_string(blocks.count()) + " candidates");
  const Eigen::MatrixXd raw_prior = request.prior_sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  const Whitening whitening = whiten(blocks, raw_prior / double(request.poses));
  const Eigen::MatrixXd prior = whitening.prior * double(request.poses);
  ApproximateDesignOptions bound_options;
  bound_options.cap = repeats ? 1.0 : 1.0 / request.poses;
  bound_options.prior = whitening.prior;
  ApproximateDesign approximate = solve_approximate_design(blocks, request.nuisance, bound_options, monitor);

  const BoundKind kind = find_criterion(request.criterion)->bound;
  if (kind != BoundKind::log_det) approximate.sensitivity.clear();
  const auto criterion =
      make_criterion(request.criterion, {whitening.R, request.scale, request.nuisance, request.test_points});
  const auto planner = make_planner(request.method);
  DesignTask task;
  task.candidates = {&blocks, request.nuisance, repeats ? request.poses : 1, prior.size() > 0 ? &prior : nullptr};
  task.criterion = criterion.get();
  task.poses = request.poses;
  task.approximate = &approximate;
  if (kind == BoundKind::log_det) task.bound = approximate.log_det_bound_for(request.poses, interest);

  SearchResult result;
  Monitor shifted;
  shifted.interrupted = monitor.interrupted;
  shifted.deadline = monitor.deadline;
  // People see the log det that will be in the plan, not that of whitened coordinates.
  const double shown_offset = kind == BoundKind::log_det ? whitening.log_det_offset(request.nuisance) : 0.0;
  shifted.on_progress = [&, offset = shown_offset](Progress progress) {
    if (progress.best) *progress.best += offset;
    if (progress.bound) *progress.bound += offset;
    monitor.report(progress);
  };
  result.design = planner->plan(task, request.planner, shifted);
  result.stopped = approximate.stopped || result.design.stopped;
  result.certificate =
      certificate_of(approximate, request, blocks.count(), interest, whitening.log_det_offset(request.nuisance));
  // Weights that are optimal for the determinant bound nothing else.
  result.certificate.proved = kind == BoundKind::log_det;
  result.chosen = blocks.subset(result.design.members);
  for (std::size_t i = 0; i < result.chosen.count(); ++i) {
    auto block = result.chosen.block(i);
    block = (block * whitening.R).eval();
  }
  return result;
}

double criterion_value(const Plan& plan, const Evaluation& evaluation, const SearchRequest& request) {
  const ObservabilityIndices& o = evaluation.indices;
  if (plan.criterion == "ds") return evaluation.log_det;
  if (plan.criterion == "o2") return o.o2;
  if (plan.criterion == "o3") return o.o3;
  if (plan.criterion == "o4") return o.o4;
  if (plan.criterion == "o5") return o.o5;
  if (plan.criterion == "a") {
    const Eigen::Index interest = evaluation.sigma.size() - request.nuisance;
    return -(evaluation.sigma.array() / request.scale.array()).tail(interest).square().sum();
  }
  if (plan.criterion == "test_pose") return -*plan.rho0 * *plan.rho0;
  if (plan.criterion == "test_pose_max") {
    const double worst = *std::max_element(plan.test_errors.begin(), plan.test_errors.end());
    return -worst * worst;
  }
  return o.o1;
}

void certify(Certificate& certificate, double log_det, int interest) {
  certificate.efficiency = std::min(1.0, std::exp((log_det - certificate.log_det_bound) / interest));
}

}  // namespace posewright
