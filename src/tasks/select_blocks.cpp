#include "posewright/tasks/select_blocks.hpp"

#include <chrono>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "fill_plan.hpp"
#include "posewright/criterion/registry.hpp"
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

/// Blocks that are in the plan before the search: fixed ones, then measured ones.
std::vector<int> given_blocks(const BlockFile& file, const SelectOptions& options) {
  std::vector<int> all = options.fixed;
  all.insert(all.end(), options.measured.begin(), options.measured.end());
  std::set<int> seen;
  for (const int i : all) {
    if (i < 0 || std::size_t(i) >= file.blocks.count())
      throw InputError({}, "there is no block " + std::to_string(i),
                       "0 to " + std::to_string(file.blocks.count() - 1) + " are allowed");
    if (!seen.insert(i).second && options.repeats.most == 1)
      throw InputError({}, "block " + std::to_string(i) + " is fixed or measured twice", "--repeats allow, or once");
  }
  if (int(options.fixed.size()) >= options.poses)
    throw InputError({},
                     std::to_string(options.fixed.size()) + " of " + std::to_string(options.poses) + " poses are fixed",
                     "fix fewer than --poses");
  return all;
}

void require_enough(const BlockArray& blocks, const SelectOptions& options) {
  const int poses = options.poses + int(options.measured.size());
  const int m = blocks.columns(), r = blocks.rows();
  if (options.nuisance < 0 || options.nuisance >= m)
    throw InputError({}, "--nuisance " + std::to_string(options.nuisance),
                     "0 to " + std::to_string(m - 1) + " of the " + std::to_string(m) + " columns");
  if (poses * r < m)
    throw CannotDo(std::to_string(poses) + " poses give " + std::to_string(poses * r) + " equations for " +
                   std::to_string(m) + " parameters: at least " + std::to_string((m + r - 1) / r) +
                   " poses are needed");
}

/// The candidates that are left, the information of the blocks that are given, and the blocks themselves.
struct Start {
  std::vector<int> free;  // empty: all of the file
  Eigen::MatrixXd prior;
  BlockArray given;
};

Start start_of(const BlockFile& file, const std::vector<int>& given, const SelectOptions& options) {
  Start start{{}, {}, file.blocks.subset(given)};
  const std::set<int> taken(given.begin(), given.end());
  for (int i = 0; i < int(file.blocks.count()); ++i)
    if (options.repeats.most > 1 || taken.count(i) == 0) start.free.push_back(i);
  if (!given.empty()) start.prior = start.given.all().transpose() * start.given.all();
  return start;
}

/// Given blocks, then chosen ones.
BlockArray together(const BlockArray& given, const BlockArray& chosen) {
  BlockArray all(given.count() + chosen.count(), chosen.rows(), chosen.columns());
  if (given.count() > 0) all.all().topRows(given.all().rows()) = given.all();
  all.all().bottomRows(chosen.all().rows()) = chosen.all();
  return all;
}

/// Efficiency of the list without each of its first blocks, which no search computed.
std::vector<double> without_given(const BlockArray& all, std::size_t given, const SearchRequest& request,
                                  const SelectOptions& options, double degree) {
  std::vector<int> whole(all.count());
  std::iota(whole.begin(), whole.end(), 0);
  std::vector<SearchPart> parts(1);
  parts.front().blocks = all.subset(whole);
  parts.front().nuisance = options.nuisance;
  parts.front().scale = Eigen::VectorXd::Ones(all.columns());
  const auto measure = measure_of(std::move(parts), request, Monitor{});
  const double phi = measure->phi(all);
  std::vector<double> result;
  for (std::size_t i = 0; i < given; ++i) {
    std::vector<int> rest = whole;
    rest.erase(rest.begin() + std::ptrdiff_t(i));
    const double left = measure->phi(all.subset(rest));
    result.push_back(std::min(1.0, std::exp((left - phi) / (degree > 0 ? degree : 1.0))));
  }
  return result;
}

void fill(Plan& plan, const SelectOptions& options, const Evaluation& evaluation, const SearchResult& found,
          const Start& start, const std::vector<int>& given, const std::vector<double>& without) {
  plan.log_det = evaluation.log_det;
  plan.log_det_full = evaluation.log_det_full;
  plan.indices = evaluation.indices;
  plan.condition = evaluation.condition;
  plan.certificate = found.certificate;
  const double phi = found.measure->phi(found.chosen.front());
  plan.criterion_value = find_criterion(options.criterion)->shown(phi, evaluation.indices);
  certify(plan.certificate, phi, found.degree);
  for (std::size_t i = 0; i < given.size() + found.design.members.size(); ++i) {
    PlannedPose pose;
    pose.id = int(i) + 1;
    const bool chosen = i >= given.size();
    const int member = chosen ? found.design.members[i - given.size()] : 0;
    pose.candidate = !chosen ? given[i] : start.free.empty() ? member : start.free[std::size_t(member)];
    pose.measured = !chosen && i >= options.fixed.size();
    pose.fixed = !chosen && !pose.measured;
    pose.contribution = evaluation.contribution[Eigen::Index(i)];
    pose.without = chosen ? found.without[i - given.size()] : without[i];
    plan.poses.push_back(std::move(pose));
  }
  plan.statistics.stages = found.stages;
  plan.proved_optimal = found.design.optimal;
}

void fill(Plan& plan, const std::vector<Parameter>& parameters, const Evaluation& evaluation,
          const SearchResult& found) {
  for (std::size_t j = 0; j < parameters.size(); ++j)
    plan.parameters.push_back({parameters[j], "", evaluation.sigma[Eigen::Index(j)], ""});
  plan.interrupted = found.stopped;
  plan.statistics.exchanges = found.design.exchanges;
  plan.statistics.restarts = found.design.restarts;
}

Plan begun_plan(const SelectOptions& options, const std::string& sha256) {
  Plan plan;
  plan.seed = options.seed;
  name_criterion(plan, options.criterion);
  plan.method = options.method;
  plan.scaling = "none";
  plan.reserve = options.reserve;
  plan.problem.sha256 = sha256;
  return plan;
}

/// Refuses options without support for spread candidates, before anything is read.
void require_spread(const SelectOptions& options) {
  const auto refuse = [](const std::string& what, const std::string& instead) {
    throw InputError({}, what + " with --spread", instead);
  };
  if (const CriterionEntry* entry = find_criterion(options.criterion); entry == nullptr || !entry->determinant)
    refuse("--criterion " + options.criterion, determinant_names());
  if (options.method != "exchange" && options.method != "greedy")
    refuse("--method " + options.method, "exchange or greedy");
  if (options.nuisance > 0) refuse("--nuisance", "all columns count; without --spread they may be eliminated");
  if (!options.fixed.empty()) refuse("--fixed", "all blocks are chosen; leave it out");
  if (!options.measured.empty()) refuse("--augment", "all blocks are chosen; leave it out");
  if (options.reserve) refuse("--reserve", "leave it out");
  if (options.restarts) refuse("--restarts", "it starts from the optimal weights and from an empty set; leave it out");
}

/// read_block_share(); what a process finds wrong is thrown on all, the first candidate's error first.
BlockShare share_of(const std::filesystem::path& file, const SelectOptions& options, Workers& workers) {
  BlockShare share;
  std::string wrong;
  try {
    share = read_block_share(file, options.rows, workers.rank(), workers.processes(), std::size_t(options.poses) + 1);
  } catch (const InputError& error) {
    wrong = error.what();
  }
  workers.combine(wrong, [](std::string_view lower, std::string_view higher) {
    return std::string(lower.empty() ? higher : lower);
  });
  if (!wrong.empty()) throw InputError({}, wrong, "");
  workers.share_from(0, share.sha256);
  return share;
}

}  // namespace

Plan select_blocks(BlockFile file, const SelectOptions& options, const Monitor& monitor) {
  const auto begin = std::chrono::steady_clock::now();
  require_known(options.criterion, options.method, {}, {});
  require_block_criterion(options.criterion);
  Plan plan = begun_plan(options, file.sha256);
  const std::vector<int> given = given_blocks(file, options);
  if (options.reserve && !options.fixed.empty())
    throw InputError({}, "--reserve and --fixed cannot be combined",
                     "leave one of them out: a fixed block may be lost, too");
  if (options.gap > 0 && options.method != "branch_and_bound")
    throw InputError({}, "a gap does not go with method " + options.method, "it is for branch_and_bound");
  require_enough(file.blocks, options);
  const std::vector<Parameter> parameters = labels(file.columns, options.nuisance);

  SearchRequest request;
  request.criterion = options.criterion;
  request.method = options.method;
  request.poses = options.poses - int(options.fixed.size());
  request.repeats = options.repeats;
  request.reserve = options.reserve;
  request.planner.restarts = options.restarts.value_or(request.planner.restarts);
  request.planner.restarts_stated = options.restarts.has_value();
  request.planner.gap = options.gap;
  request.planner.seed = options.seed;
  request.planner.threads = options.threads;
  Start start = start_of(file, given, options);
  std::vector<SearchPart> parts(1);
  parts.front().blocks = given.empty() ? std::move(file.blocks) : file.blocks.subset(start.free);
  parts.front().nuisance = options.nuisance;
  parts.front().prior = start.prior;
  parts.front().scale = Eigen::VectorXd::Ones(Eigen::Index(parameters.size()));
  const SearchResult found = search(std::move(parts), request, monitor);

  const BlockArray all = together(start.given, found.chosen.front());
  const Evaluation evaluation = evaluate(all, parameters);
  const std::vector<double> without =
      given.empty() ? std::vector<double>{} : without_given(all, given.size(), request, options, found.degree);
  fill(plan, options, evaluation, found, start, given, without);
  fill(plan, parameters, evaluation, found);
  plan.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return plan;
}

Plan select_blocks(const std::filesystem::path& path, const SelectOptions& options, const Monitor& monitor) {
  const auto begin = std::chrono::steady_clock::now();
  Plan plan = select_blocks(read_blocks(path, options.rows), options, monitor);
  plan.problem.file = path.string();
  plan.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return plan;
}

Plan select_spread(const std::filesystem::path& file, const SelectOptions& options, Workers& workers,
                   const Monitor& monitor, SpreadTraffic& traffic) {
  const auto begin = std::chrono::steady_clock::now();
  require_known(options.criterion, options.method, {}, {});
  require_spread(options);
  BlockShare share = share_of(file, options, workers);
  require_enough(share.blocks, options);
  if (double(options.poses) >= double(share.total) * options.repeats.most)
    throw CannotDo(std::to_string(options.poses) + " of " + std::to_string(share.total) +
                   " candidates leave no choice");
  if (share.total > std::size_t(std::numeric_limits<int>::max()))
    throw CannotDo(std::to_string(share.total) + " candidates are more than can be numbered");
  Plan plan = begun_plan(options, share.sha256);
  plan.problem.file = file.string();
  std::vector<std::string> names(std::size_t(share.blocks.columns()));
  for (std::size_t j = 0; j < names.size(); ++j) names[j] = "column " + std::to_string(j);
  const std::vector<Parameter> parameters = labels(names, 0);
  const SearchResult found = search_spread(
      std::move(share), {options.method, options.poses, options.repeats, options.threads}, workers, monitor, traffic);
  const Evaluation evaluation = evaluate(found.chosen.front(), parameters);
  fill(plan, options, evaluation, found, {}, {}, {});
  fill(plan, parameters, evaluation, found);
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
