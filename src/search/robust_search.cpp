#include "posewright/search/robust_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "planners/local_search.hpp"
#include "posewright/criterion/scenarios.hpp"
#include "posewright/criterion/sensitivity.hpp"
#include "posewright/planning/approximate_design.hpp"
#include "posewright/planning/whiten.hpp"
#include "posewright/support/bytes.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/tasks.hpp"

namespace posewright {
namespace {

// References a thousandth of an efficiency too high say nothing else of a plan, and cost half as much as exact ones.
constexpr double reference_tolerance = 1e-4;
// Scenarios that stand for all while many plans are tried.
constexpr int most_representatives = 20;
// Candidates of largest sensitivity that a plan is sought among; no more than fit into this memory.
constexpr std::size_t least_pool = 240;
constexpr double most_pool_bytes = 1.2e9;
constexpr int kicks = 8;
constexpr std::size_t searches = 4;
// Worst scenarios may be others for the plan that is found: so often they are taken up.
constexpr int most_rounds = 4;

using Indices = std::vector<int>;

class RobustSearch {
 public:
  RobustSearch(const RobustRequest& request, const Monitor& monitor)
      : request_(request),
        monitor_(monitor),
        columns_(request.nominal.columns()),
        interest_(columns_ - request.nuisance),
        function_(request.nuisance, columns_),
        weights_(std::size_t(request.scenarios), 1.0) {
    whiten_nominal();
  }

  RobustResult judge() {
    RobustResult result;
    result.plan = request_.plan;
    result.stopped = look_at_all(result);
    if (references_.empty()) return result;
    result.references = references_;
    for (double& reference : result.references) reference += offset_;
    result.nominal = result.robust = figures(start_values_);
    result.bound = bound(start_values_);
    return result;
  }

  RobustResult search() {
    RobustResult result = judge();
    if (result.stopped || references_.empty()) return result;
    take_pool();
    Indices best = in_pool(request_.plan);
    std::vector<double> values = start_values_;
    Indices looked_at;
    for (int round = 0; round < most_rounds && !monitor_.should_stop(); ++round) {
      const Indices chosen = representatives(values, looked_at);
      if (chosen == looked_at) break;
      looked_at = chosen;
      const Indices found = best_of_starts(criterion_of(looked_at), best, result.exchanges);
      take_if_better(found, best, values);
      if (looked_at.size() == weights_.size() || request_.aim.measure == RobustAim::Measure::mean) break;
    }
    result.searched = int(looked_at.size());
    if (looked_at.size() < weights_.size() && !monitor_.should_stop()) {
      Indices all(weights_.size());
      std::iota(all.begin(), all.end(), 0);
      const CandidateView view = view_of_pool();
      const auto state = criterion_of(all).start(view, best);
      result.exchanges += settle(*state, monitor_);
      take_if_better(state->members(), best, values);
    }
    result.stopped = monitor_.should_stop();
    result.robust = figures(values);
    result.bound = std::min(result.bound, bound(values));
    result.plan.clear();
    for (const int i : best) result.plan.push_back(pool_[std::size_t(i)]);
    std::sort(result.plan.begin(), result.plan.end());
    return result;
  }

 private:
  void whiten_nominal() {
    const double n = request_.poses;
    std::vector<int> all(request_.nominal.count());
    std::iota(all.begin(), all.end(), 0);
    nominal_ = request_.nominal.subset(all);
    const Whitening whitening =
        whiten(nominal_, request_.prior.size() > 0 ? Eigen::MatrixXd(request_.prior / n) : Eigen::MatrixXd());
    R_ = whitening.R;
    offset_ = whitening.log_det_offset(request_.nuisance);
    ApproximateDesignOptions options;
    options.cap = std::min(1.0, double(request_.repeats.most) / n);
    options.tolerance = reference_tolerance;
    options.threads = request_.planner.threads;
    options.prior = whitening.prior;
    optimum_ = solve_approximate_design(nominal_, function_, options, monitor_);
    options_ = options;
    options_.threads = 1;
    options_.start = optimum_.support;
  }

  void to_whitened(BlockArray& blocks) const {
    auto rows = blocks.all();
    R_.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(rows);
  }

  /// Per pose, in whitened coordinates; empty: none.
  Eigen::MatrixXd prior_of(int scenario) const {
    if (!request_.prior_of) return {};
    Eigen::MatrixXd prior = request_.prior_of(scenario) / double(request_.poses);
    R_.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(prior);
    R_.transpose().triangularView<Eigen::Lower>().solveInPlace(prior);
    return prior;
  }

  /// One scenario with all candidates, which are forgotten again.
  std::string look_at(int scenario) const {
    BlockArray blocks = request_.blocks(scenario, {});
    to_whitened(blocks);
    ApproximateDesignOptions options = options_;
    options.prior = prior_of(scenario);
    const double log_poses = interest_ * std::log(double(request_.poses));
    ByteWriter out;
    out.put(solve_approximate_design(blocks, function_, options, Monitor()).bound_for(request_.poses));
    Eigen::MatrixXd own = information(blocks, request_.plan);
    if (options.prior.size() > 0) own += options.prior * double(request_.poses);
    out.put(function_.value(own));
    Eigen::MatrixXd M = options.prior.size() > 0 ? options.prior : Eigen::MatrixXd::Zero(columns_, columns_);
    for (std::size_t i = 0; i < optimum_.support.size(); ++i) {
      const auto block = blocks.block(std::size_t(optimum_.support[i]));
      M.noalias() += optimum_.weights[i] * block.transpose() * block;
    }
    const auto expansion = function_.expand(M);
    out.put(expansion == nullptr ? -std::numeric_limits<double>::infinity() : expansion->value + log_poses);
    std::vector<double> d(blocks.count(), 0.0);
    double of_prior = 0.0;
    if (expansion != nullptr) {
      sensitivities(blocks, expansion->factor, 1, d);
      if (options.prior.size() > 0)
        of_prior = (expansion->factor.transpose() * options.prior * expansion->factor).trace();
    }
    out.put(of_prior);
    out.put(d);
    std::int64_t unreached = 0;
    for (std::size_t i = 0; i < blocks.count(); ++i) unreached += blocks.block(i).isZero(0.0) ? 1 : 0;
    out.put(unreached);
    return out.take();
  }

  static Eigen::MatrixXd information(const BlockArray& blocks, const Indices& members) {
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(blocks.columns(), blocks.columns());
    for (const int i : members) {
      const auto block = blocks.block(std::size_t(i));
      M.noalias() += block.transpose() * block;
    }
    return M;
  }

  /// @return whether it was stopped before all scenarios were seen
  bool look_at_all(RobustResult& result) {
    std::vector<double> references, start, at_optimum, of_prior;
    const bool stopped = run_tasks(
        {"drawn robots", weights_.size(), request_.planner.threads}, [&](std::size_t k, int) { return look_at(int(k)); },
        [&](std::size_t, std::string_view bytes) {
          ByteReader in(bytes);
          references.push_back(in.get<double>());
          start.push_back(in.get<double>());
          at_optimum.push_back(in.get<double>());
          of_prior.push_back(in.get<double>());
          sensitivity_.emplace_back();
          in.get(sensitivity_.back());
          result.unreached += long(in.get<std::int64_t>());
        },
        monitor_);
    if (references.size() < weights_.size()) return true;
    references_ = references;
    of_prior_ = of_prior;
    for (std::size_t k = 0; k < references.size(); ++k) {
      start_values_.push_back((start[k] - references[k]) / interest_);
      at_optimum_.push_back((at_optimum[k] - references[k]) / interest_);
    }
    return stopped;
  }

  RobustFigures figures(const std::vector<double>& values) const {
    RobustFigures result;
    for (const double value : values) result.efficiency.push_back(std::min(1.0, std::exp(value)));
    result.combined = std::exp(combine(values));
    return result;
  }
  double combine(const std::vector<double>& values) const {
    return combined(request_.aim, values, weights_, double(weights_.size()));
  }

  /// Of the combined efficiency of any plan, as far as weights that support the aim at `values` tell.
  double bound(const std::vector<double>& values) const {
    double least = bound_by(supporting_weights(request_.aim, values, weights_, double(weights_.size())));
    if (request_.aim.measure != RobustAim::Measure::worst) return std::exp(std::min(0.0, least));
    // Any weights are valid; those of a soft minimum spread over all that are nearly worst.
    const double lowest = *std::min_element(values.begin(), values.end());
    for (const double sharpness : {30.0, 100.0, 300.0, 1000.0}) {
      std::vector<double> lambda;
      for (const double value : values) lambda.push_back(std::exp(-sharpness * (value - lowest)));
      const double sum = std::accumulate(lambda.begin(), lambda.end(), 0.0);
      for (double& weight : lambda) weight /= sum;
      least = std::min(least, bound_by(lambda));
    }
    return std::exp(std::min(0.0, least));
  }
  double bound_by(const std::vector<double>& lambda) const {
    double value = 0.0, of_prior = 0.0;
    for (std::size_t k = 0; k < lambda.size(); ++k) {
      if (!(lambda[k] > 0)) continue;
      value += lambda[k] * at_optimum_[k];
      of_prior += lambda[k] * of_prior_[k];
    }
    if (!std::isfinite(value)) return 0.0;
    return value + std::log((best_mean(mean_sensitivity(lambda), options_.cap) + of_prior) / interest_);
  }

  std::vector<double> mean_sensitivity(const std::vector<double>& lambda) const {
    std::vector<double> mean(nominal_.count(), 0.0);
    for (std::size_t k = 0; k < lambda.size(); ++k)
      if (lambda[k] > 0)
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += lambda[k] * sensitivity_[k][i];
    return mean;
  }

  /// The plan, where optimal weights are, and what is worth most to the scenarios that count.
  void take_pool() {
    std::vector<char> taken(nominal_.count(), 0);
    const auto take = [&](int i) {
      if (std::exchange(taken[std::size_t(i)], 1) == 0) pool_.push_back(i);
    };
    for (const int i : request_.plan) take(i);
    for (const int i : optimum_.weighted()) take(i);
    const std::vector<double> mean = mean_sensitivity(
        supporting_weights(request_.aim, start_values_, weights_, double(weights_.size())));
    Indices order(mean.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return mean[std::size_t(a)] > mean[std::size_t(b)]; });
    const double each = double(weights_.size()) * request_.nominal.rows() * nominal_.stride() * sizeof(double);
    const std::size_t size =
        std::min(std::max(least_pool, std::size_t(6 * request_.poses)), std::size_t(most_pool_bytes / each));
    for (const int i : order) {
      if (pool_.size() >= size) break;
      take(i);
    }
    std::sort(pool_.begin(), pool_.end());
    blocks_.resize(weights_.size());
    priors_.resize(weights_.size());
    parallel_for(weights_.size(), thread_count(request_.planner.threads), [&](std::size_t k, int) {
      auto blocks = std::make_shared<BlockArray>(request_.blocks(int(k), pool_));
      to_whitened(*blocks);
      blocks_[k] = std::move(blocks);
      priors_[k] = prior_of(int(k)) * double(request_.poses);
    });
    pool_nominal_ = nominal_.subset(pool_);
    if (request_.spacing == nullptr) return;
    pool_spacing_ = *request_.spacing;
    pool_spacing_.points.resize(Eigen::Index(pool_.size()), request_.spacing->points.cols());
    for (std::size_t i = 0; i < pool_.size(); ++i)
      pool_spacing_.points.row(Eigen::Index(i)) = request_.spacing->points.row(pool_[i]);
  }

  Indices in_pool(const Indices& members) const {
    Indices result;
    for (const int i : members)
      result.push_back(int(std::lower_bound(pool_.begin(), pool_.end(), i) - pool_.begin()));
    return result;
  }

  CandidateView view_of_pool() const {
    CandidateView view;
    view.blocks = &pool_nominal_;
    view.nuisance = request_.nuisance;
    view.max_repeats = std::min(request_.repeats.most, request_.poses);
    view.spacing = request_.spacing == nullptr ? nullptr : &pool_spacing_;
    return view;
  }

  ScenarioCriterion criterion_of(const Indices& scenarios) const {
    std::vector<Scenario> some;
    for (const int k : scenarios)
      some.push_back({blocks_[std::size_t(k)], 1.0, references_[std::size_t(k)], priors_[std::size_t(k)]});
    // Representatives of a mean stand for all; of the worst, those that are left out have their weight, too.
    const bool mean = request_.aim.measure == RobustAim::Measure::mean;
    return {std::move(some), request_.nuisance, request_.aim, mean ? double(scenarios.size()) : double(weights_.size())};
  }

  Indices best_of_starts(const ScenarioCriterion& criterion, const Indices& start, long& exchanges) const {
    const CandidateView view = view_of_pool();
    std::vector<Outcome> outcomes(searches);
    parallel_for(searches, thread_count(request_.planner.threads), [&](std::size_t i, int) {
      Random random(request_.planner.seed, i);
      const auto state = criterion.start(view, start);
      long count = settle(*state, monitor_);
      Outcome best = outcome_of(*state, count);
      for (int n = 0; n < kicks && !monitor_.should_stop(); ++n) {
        kick(*state, int(pool_.size()), random);
        count += settle(*state, monitor_);
        if (state->value() > best.value + smallest_gain) best = outcome_of(*state, count);
        else restore(*state, best.members);
      }
      best.exchanges = count;
      outcomes[i] = std::move(best);
    });
    const Outcome* best = &outcomes.front();
    for (const Outcome& outcome : outcomes) {
      exchanges += outcome.exchanges;
      if (outcome.value > best->value + smallest_gain) best = &outcome;
    }
    return best->members;
  }

  /// ln e in every scenario, from a fresh sum of the blocks.
  std::vector<double> values_of(const Indices& members) const {
    std::vector<double> values(weights_.size());
    parallel_for(values.size(), thread_count(request_.planner.threads), [&](std::size_t k, int) {
      Eigen::MatrixXd M = information(*blocks_[k], members);
      if (priors_[k].size() > 0) M += priors_[k];
      values[k] = (function_.value(M) - references_[k]) / interest_;
    });
    return values;
  }

  void take_if_better(const Indices& found, Indices& best, std::vector<double>& values) const {
    std::vector<double> theirs = values_of(found);
    if (!(combine(theirs) > combine(values) + smallest_gain)) return;
    best = found;
    values = std::move(theirs);
  }

  /// Ascending. For the mean those whose mean sensitivities among the pool are nearest to that of all; else the worst,
  /// beside those that were looked at before.
  Indices representatives(const std::vector<double>& values, const Indices& before) const {
    const std::size_t count = std::min(weights_.size(), std::size_t(most_representatives));
    if (count == weights_.size()) {
      Indices all(count);
      std::iota(all.begin(), all.end(), 0);
      return all;
    }
    Indices chosen = request_.aim.measure == RobustAim::Measure::mean ? herded(count) : before;
    if (request_.aim.measure == RobustAim::Measure::mean) return chosen;
    Indices order(values.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return values[std::size_t(a)] < values[std::size_t(b)]; });
    const auto tail = request_.aim.measure == RobustAim::Measure::tail
                          ? std::size_t(std::ceil(request_.aim.share * double(weights_.size())))
                          : std::size_t(1);
    order.resize(std::min(order.size(), std::max(count, tail + tail / 2)));
    for (const int k : order)
      if (std::find(chosen.begin(), chosen.end(), k) == chosen.end()) chosen.push_back(k);
    std::sort(chosen.begin(), chosen.end());
    return chosen;
  }

  Indices herded(std::size_t count) const {
    Eigen::MatrixXd features(Eigen::Index(pool_.size()), Eigen::Index(weights_.size()));
    for (Eigen::Index k = 0; k < features.cols(); ++k)
      for (Eigen::Index i = 0; i < features.rows(); ++i)
        features(i, k) = sensitivity_[std::size_t(k)][std::size_t(pool_[std::size_t(i)])];
    features.colwise() -= features.rowwise().mean().eval();
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(features.rows());
    std::vector<char> taken(weights_.size(), 0);
    Indices chosen;
    while (chosen.size() < count) {
      int best = -1;
      double least = std::numeric_limits<double>::infinity();
      for (Eigen::Index k = 0; k < features.cols(); ++k) {
        if (taken[std::size_t(k)] != 0) continue;
        const double distance = (sum + features.col(k)).squaredNorm();
        if (distance < least) {
          least = distance;
          best = int(k);
        }
      }
      sum += features.col(best);
      taken[std::size_t(best)] = 1;
      chosen.push_back(best);
    }
    std::sort(chosen.begin(), chosen.end());
    return chosen;
  }

  const RobustRequest& request_;
  const Monitor& monitor_;
  int columns_;
  double interest_;
  LogDetFunction function_;
  std::vector<double> weights_;
  BlockArray nominal_;
  Eigen::MatrixXd R_;
  double offset_ = 0.0;
  ApproximateDesign optimum_;
  ApproximateDesignOptions options_;
  // Of every scenario: bound (whitened), ln e of the plan given and of the optimal nominal weights; at these, d of every
  // candidate and of the prior.
  std::vector<double> references_, start_values_, at_optimum_, of_prior_;
  std::vector<std::vector<double>> sensitivity_;
  Indices pool_;  // ascending
  BlockArray pool_nominal_;
  Spacing pool_spacing_;
  std::vector<std::shared_ptr<const BlockArray>> blocks_;  // of the pool, whitened
  std::vector<Eigen::MatrixXd> priors_;
};

}  // namespace

RobustResult judge_robust(const RobustRequest& request, const Monitor& monitor) {
  return RobustSearch(request, monitor).judge();
}

RobustResult search_robust(const RobustRequest& request, const Monitor& monitor) {
  return RobustSearch(request, monitor).search();
}

}  // namespace posewright
