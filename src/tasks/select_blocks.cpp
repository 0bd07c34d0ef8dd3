#include "posewright/tasks/select_blocks.hpp"

#include <chrono>
#include <numeric>

#include "fill_plan.hpp"
#include "posewright/blocks/read_blocks.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/planning/evaluate.hpp"
#include "posewright/search/design_measure.hpp"
#include "posewright/search/search.hpp"

namespace posewright {
namespace {

std::vector<Parameter> labels(const std::vector<std::string>& names, int nuisance) {
  std::vector<Parameter> parameters;
  for (std::size_t j = 0; j < names.size(); ++j)
    parameters.push_back({names[j], "1", 0.0, 1.0, int(j) < nuisance ? Role::nuisance : Role::interest});
  return parameters;
}

void require_block_criterion(const std::string& criterion) {
  require_known(criterion, "exchange", {}, {});
  const CriterionEntry& entry = *find_criterion(criterion);
  if (entry.needs_test_poses || entry.several_variants || entry.needs_truth)
    throw InputError({}, "criterion '" + criterion + "' needs a robot", "with blocks alone: o1 to o5, ds, a");
}

void require_enough(const BlockFile& file, const SelectOptions& options) {
  const int m = file.blocks.columns(), r = file.blocks.rows();
  if (options.nuisance < 0 || options.nuisance >= m)
    throw InputError({}, "--nuisance " + std::to_string(options.nuisance),
                     "0 to " + std::to_string(m - 1) + " of the " + std::to_string(m) + " columns");
  if (options.poses * r < m)
    throw CannotDo(std::to_string(options.poses) + " poses give " + std::to_string(options.poses * r) +
                   " equations for " + std::to_string(m) + " parameters: at least " + std::to_string((m + r - 1) / r) +
                   " poses are needed");
}

void fill(Plan& plan, const SelectOptions& options, const Evaluation& evaluation, const SearchResult& found) {
  plan.log_det = evaluation.log_det;
  plan.log_det_full = evaluation.log_det_full;
  plan.indices = evaluation.indices;
  plan.condition = evaluation.condition;
  plan.certificate = found.certificate;
  const double phi = found.measure->phi(found.chosen.front());
  plan.criterion_value = find_criterion(options.criterion)->shown(phi, evaluation.indices);
  certify(plan.certificate, phi, found.degree);
  for (std::size_t i = 0; i < found.design.members.size(); ++i) {
    PlannedPose pose;
    pose.id = int(i) + 1;
    pose.candidate = found.design.members[i];
    pose.contribution = evaluation.contribution[Eigen::Index(i)];
    pose.without = found.without[i];
    plan.poses.push_back(std::move(pose));
  }
  plan.statistics.stages = found.stages;
  plan.proved_optimal = found.design.optimal;
}

}  // namespace

Plan select_blocks(BlockFile file, const SelectOptions& options, const Monitor& monitor) {
  const auto begin = std::chrono::steady_clock::now();
  require_known(options.criterion, options.method, {}, {});
  require_block_criterion(options.criterion);
  Plan plan;
  plan.seed = options.seed;
  name_criterion(plan, options.criterion);
  plan.method = options.method;
  plan.scaling = "none";
  plan.reserve = options.reserve;
  plan.problem_sha256 = file.sha256;
  require_enough(file, options);
  const std::vector<Parameter> parameters = labels(file.columns, options.nuisance);

  SearchRequest request;
  request.criterion = options.criterion;
  request.method = options.method;
  request.poses = options.poses;
  request.repeats = options.repeats;
  request.reserve = options.reserve;
  request.planner.restarts = options.restarts;
  request.planner.seed = options.seed;
  request.planner.threads = options.threads;
  std::vector<SearchPart> parts(1);
  parts.front().blocks = std::move(file.blocks);
  parts.front().nuisance = options.nuisance;
  parts.front().scale = Eigen::VectorXd::Ones(Eigen::Index(parameters.size()));
  const SearchResult found = search(std::move(parts), request, monitor);

  const Evaluation evaluation = evaluate(found.chosen.front(), parameters);
  fill(plan, options, evaluation, found);
  for (std::size_t j = 0; j < parameters.size(); ++j)
    plan.parameters.push_back({parameters[j], "", evaluation.sigma[Eigen::Index(j)], ""});
  plan.interrupted = found.stopped;
  plan.statistics.exchanges = found.design.exchanges;
  plan.statistics.restarts = found.design.restarts;
  plan.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return plan;
}

Plan select_blocks(const std::filesystem::path& path, const SelectOptions& options, const Monitor& monitor) {
  const auto begin = std::chrono::steady_clock::now();
  Plan plan = select_blocks(read_blocks(path, options.rows), options, monitor);
  plan.problem_file = path.string();
  plan.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return plan;
}

double value_of_blocks(const std::string& criterion, const BlockArray& blocks, const Evaluation& evaluation,
                       int nuisance, const Eigen::VectorXd& scale, const Eigen::MatrixXd& prior) {
  require_block_criterion(criterion);
  SearchRequest request;
  request.criterion = criterion;
  request.poses = int(blocks.count());
  std::vector<int> all(blocks.count());
  std::iota(all.begin(), all.end(), 0);
  std::vector<SearchPart> parts(1);
  parts.front().blocks = blocks.subset(all);
  parts.front().nuisance = nuisance;
  parts.front().scale = scale.size() > 0 ? scale : Eigen::VectorXd::Ones(blocks.columns());
  parts.front().prior = prior;
  const auto measure = measure_of(std::move(parts), request, Monitor{});
  return find_criterion(criterion)->shown(measure->phi(blocks), evaluation.indices);
}

}  // namespace posewright
