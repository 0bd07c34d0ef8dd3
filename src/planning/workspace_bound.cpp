#include "posewright/planning/workspace_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "posewright/criterion/sensitivity.hpp"
#include "posewright/planning/ascent.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

// A quick look gets so many rounds and no more.
constexpr int few_rounds = 8;
// Of rounds for starts alone, and local searches of each. With 30 poses of examples/cell as what is known, two more
// reach what settled weights find, in a third of their time.
constexpr int rounds_for_starts = 8, searches_for_starts = 16;
// Candidates that the weights are solved over at first, for each column: optimal weights sit on some two for each;
// those that turn out to be missing come in later.
constexpr int pool_per_column = 4;
// Largest d over its bound from which on the local searches are thorough.
constexpr double nearly = 1.02;
// Weights are settled where searches from drawn candidates alone find no d above h by more than this share.
constexpr double settled_within = 0.005;
// Starts of local searches are apart by this share of a coordinate's range, ends that count as two by that.
constexpr double start_distance = 0.1, end_distance = 1e-3;

/// d(q) for fixed weights.
class Sensitivity : public BlockObjective {
 public:
  explicit Sensitivity(const Eigen::MatrixXd& T) : T_(T), S_(T * T.transpose()) {}
  double value(const BlockArray::ConstMap& J) override {
    rotated_.noalias() = J * T_;
    return rotated_.squaredNorm();
  }
  const Eigen::MatrixXd& gradient(const BlockArray::ConstMap&) override { return S_; }

 private:
  Eigen::MatrixXd T_, S_;
  BlockArray::RowMatrix rotated_;
};

using Places = std::vector<std::vector<double>>;

/// Candidates worth keeping and configurations found.
struct PlacePool {
  BlockArray blocks;
  Places configurations;
  std::size_t candidates = 0;   // the first of the pool, all others were found
  std::vector<int> original{};  ///< indices of those candidates
};

void append(PlacePool& pool, const Places& found, ConfigurationSpace::Probe& probe) {
  BlockArray grown(pool.blocks.count() + found.size(), pool.blocks.rows(), pool.blocks.columns());
  std::copy_n(pool.blocks.data(), pool.blocks.count() * std::size_t(grown.rows() * grown.stride()), grown.data());
  for (std::size_t i = 0; i < found.size(); ++i) {
    probe.block(found[i], grown.row(pool.blocks.count() + i, 0), grown.stride());
    pool.configurations.push_back(found[i]);
  }
  pool.blocks = std::move(grown);
}

/// True if two configurations are equal for a local search: no coordinate differs by this share of its range or more.
bool is_same_place(const std::vector<ConfigurationSpace::Axis>& axes, std::span<const double> a,
                   std::span<const double> b, double share) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const double apart = std::abs(a[k] - b[k]);
    if (axes[k].continuous ? apart >= share * (axes[k].upper - axes[k].lower) && apart > 0 : apart > 0) return false;
  }
  return true;
}

/// Enters a configuration that is in no known one's place.
void enter(Places& places, std::span<const double> q, const ConfigurationSpace& space, double share) {
  if (std::none_of(places.begin(), places.end(),
                   [&](const auto& known) { return is_same_place(space.axes(), known, q, share); }))
    places.emplace_back(q.begin(), q.end());
}

/// Indices by value, largest first.
std::vector<std::size_t> largest_first(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return values[a] != values[b] ? values[a] > values[b] : a < b; });
  return order;
}

/// Places by d, largest first; those without a block or outside the limits fall away.
Places by_sensitivity(Places all, const PlacePool& pool, const Eigen::MatrixXd& T, ConfigurationSpace::Probe& probe) {
  Sensitivity sensitivity(T);
  ProbedBlock block(pool.blocks.rows(), pool.blocks.columns());
  std::vector<std::pair<double, std::vector<double>>> valued;
  for (std::vector<double>& q : all)
    if (probe.perhaps_feasible(q) && block.at(probe, q))
      valued.emplace_back(-sensitivity.value(block.map()), std::move(q));
  std::sort(valued.begin(), valued.end());
  all.clear();
  for (auto& [d, q] : valued) all.push_back(std::move(q));
  return all;
}

/// Poses that weights use, each with one coordinate at an end of its range or at another choice.
Places at_the_ends(const ApproximateDesign& design, const PlacePool& pool, const ConfigurationSpace& space) {
  Places ends;
  for (const int i : design.weighted()) {
    std::vector<double> q = pool.configurations[std::size_t(i)];
    for (std::size_t k = 0; k < q.size(); ++k) {
      const ConfigurationSpace::Axis& axis = space.axes()[k];
      const double own = std::exchange(q[k], axis.lower);
      for (const double end : axis.continuous ? std::vector<double>{axis.lower, axis.upper} : axis.choices)
        if (end != own) {
          q[k] = end;
          ends.push_back(q);
        }
      q[k] = own;
    }
  }
  return by_sensitivity(std::move(ends), pool, design.factor, *space.probe());
}

/// Fills up with candidates that are drawn.
void add_drawn(Places& starts, std::size_t candidates, const ConfigurationSpace& space, int count, Random& random) {
  for (int draw = 0; draw < 2 * count && int(starts.size()) < count; ++draw)
    enter(starts, space.candidate(random.index(int(candidates))), space, start_distance);
}

/// Starts of the local searches, no two in one place: the candidates' largest d, the largest d at ends of coordinates
/// and of all candidates, and candidates that are drawn. What is drawn depends on the seed and the round alone: not on
/// an order of d that the last bit may turn.
Places starts_of(const ApproximateDesign& design, const PlacePool& pool, const std::vector<double>& of_candidates,
                 const ConfigurationSpace& space, int count, Random& random) {
  Places starts;
  const auto room = [&](double share) { return double(starts.size()) < share * count; };
  for (const std::size_t i : largest_first(design.sensitivity))
    if (room(0.3)) enter(starts, pool.configurations[i], space, start_distance);
  for (const auto& q : at_the_ends(design, pool, space))
    if (room(0.5)) enter(starts, q, space, start_distance);
  for (const std::size_t i : largest_first(of_candidates))
    if (room(0.7)) enter(starts, space.candidate(int(i)), space, start_distance);
  add_drawn(starts, of_candidates.size(), space, count, random);
  return starts;
}

std::vector<AscentResult> search_from(const Places& starts, const PlacePool& pool, const Eigen::MatrixXd& T,
                                      const ConfigurationSpace& space, int evaluations,
                                      const WorkspaceBoundOptions& options) {
  std::vector<AscentResult> results(starts.size());
  parallel_for(starts.size(), thread_count(options.threads), [&](std::size_t i, int) {
    const auto probe = space.probe();
    Sensitivity d(T);
    results[i] = ascend(space, *probe, d, pool.blocks.rows(), pool.blocks.columns(), starts[i], evaluations);
  });
  return results;
}

std::vector<double> sensitivities(const BlockArray& blocks, const Eigen::MatrixXd& T) {
  Sensitivity sensitivity(T);
  std::vector<double> d(blocks.count());
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = sensitivity.value(blocks.block(i));
  return d;
}

/// Candidates whose d exceeds `limit`, largest first, no two in one place.
Places candidates_above(double limit, const std::vector<double>& d, const ConfigurationSpace& space,
                        int most_returned) {
  Places result;
  for (const std::size_t i : largest_first(d)) {
    if (!(d[i] > limit) || int(result.size()) == most_returned) break;
    enter(result, space.candidate(int(i)), space, start_distance);
  }
  return result;
}

/// The mean of the pool's candidates, if it is feasible; else one of them.
std::vector<double> inner_place(const PlacePool& pool, ConfigurationSpace::Probe& probe) {
  std::vector<double> mean(pool.configurations.front().size(), 0.0);
  for (std::size_t i = 0; i < pool.candidates; ++i)
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += pool.configurations[i][k] / double(pool.candidates);
  return probe.feasible(mean) ? mean : pool.configurations.front();
}

/// Moves q to the last feasible place on the way to it from a feasible one.
bool towards(const std::vector<double>& inside, ConfigurationSpace::Probe& probe, std::vector<double>& q) {
  if (probe.feasible(q)) return true;
  const std::vector<double> end = q;
  double feasible = 0, beyond = 1;
  for (int step = 0; step < 30; ++step) {
    const double t = 0.5 * (feasible + beyond);
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = inside[k] + t * (end[k] - inside[k]);
    (probe.feasible(q) ? feasible : beyond) = t;
  }
  for (std::size_t k = 0; k < q.size(); ++k) q[k] = inside[k] + feasible * (end[k] - inside[k]);
  return probe.feasible(q);
}

/// The further starts of largest d, each moved to the last feasible place on the way to it.
Places further_starts(double limit, const PlacePool& pool, const Eigen::MatrixXd& T, const ConfigurationSpace& space,
                      const WorkspaceBoundOptions& options, const Monitor& monitor) {
  Places places = options.further_starts(T, limit, monitor);
  const auto probe = space.probe();
  const std::vector<double> inside = inner_place(pool, *probe);
  std::erase_if(places, [&](std::vector<double>& q) { return !towards(inside, *probe, q); });
  Places starts;
  for (const auto& q : by_sensitivity(std::move(places), pool, T, *probe))
    if (int(starts.size()) < options.starts) enter(starts, q, space, start_distance);
  return starts;
}

PlacePool first_pool(const BlockArray& blocks, const ApproximateDesign& design, const ConfigurationSpace& space,
                     std::size_t room) {
  std::vector<int> order(blocks.count());
  std::iota(order.begin(), order.end(), 0);
  keep_largest(order, design.sensitivity, room);
  order.insert(order.end(), design.support.begin(), design.support.end());
  std::sort(order.begin(), order.end());
  order.erase(std::unique(order.begin(), order.end()), order.end());
  PlacePool pool{blocks.subset(order), {}, order.size(), order};
  for (const int i : order) pool.configurations.emplace_back(space.candidate(i).begin(), space.candidate(i).end());
  return pool;
}

/// Column generation: weights, searches by their d, and what was found enters.
class ColumnGeneration {
 public:
  ColumnGeneration(const BlockArray& blocks, const ApproximateDesign& on_candidates,
                   const InformationFunction& function, const ConfigurationSpace& space,
                   const WorkspaceBoundOptions& options, const Monitor& monitor)
      : blocks_(blocks),
        function_(function),
        space_(space),
        options_(options),
        monitor_(monitor),
        pool_(first_pool(blocks, on_candidates, space, std::size_t(pool_per_column * blocks.columns()))),
        random_(options.seed, 0),
        evaluations_(options.evaluations / 4) {
    weights_.prior = options.prior;
    weights_.tolerance = 0.1 * options.tolerance;
    weights_.threads = options.threads;
    for (const int i : on_candidates.weighted())
      weights_.start.push_back(
          int(std::lower_bound(pool_.original.begin(), pool_.original.end(), i) - pool_.original.begin()));
    take(options.known);
    result_.degree = function.degree();
  }

  WorkspaceBound run() {
    if (options_.starts_alone) return starts_alone();
    const bool quick = blocks_.count() < few_candidates;
    const int rounds = quick ? std::min(few_rounds, options_.rounds) : options_.rounds;
    const bool goes_further = !quick && options_.proof.seconds != 0.0 && !space_.is_box() && options_.further_starts;
    for (int round = 0; round < rounds; ++round) {
      weigh();
      search(starts_of(design_, pool_, of_candidates_, space_, options_.starts, random_));
      if (goes_further && is_done() && !monitor_.should_stop())
        search(further_starts(limit_, pool_, design_.factor, space_, options_, monitor_));
      result_.stopped = monitor_.should_stop();
      monitor_.report({"workspace bound", double(round + 1), double(rounds), {}, {}, 1 / result_.max_ratio});
      if (result_.stopped) break;
      if (is_done() || round + 1 == rounds) confirm();
      if (is_done()) break;
      if (result_.max_ratio <= nearly || found_.empty()) evaluations_ = options_.evaluations;
      // Each round begins with the weights of the one before and what came in.
      weights_.start = design_.weighted();
      take(found_);
    }
    tell_support();
    return result_;
  }

 private:
  /// Rough searches, and neither thorough ones at the end nor a second look.
  WorkspaceBound starts_alone() {
    for (int round = 0; round < rounds_for_starts && !monitor_.should_stop(); ++round) {
      weigh();
      search(starts_of(design_, pool_, of_candidates_, space_, searches_for_starts, random_));
      if (found_.empty()) break;
      weights_.start = design_.weighted();
      take(found_);
    }
    weigh();
    tell_support();
    return result_;
  }

  void take(const Places& found) {
    for (std::size_t i = 0; i < found.size(); ++i) weights_.start.push_back(int(pool_.blocks.count() + i));
    if (!found.empty()) append(pool_, found, *space_.probe());
  }

  /// Optimal weights of the pool, and which candidates they miss.
  void weigh() {
    design_ = solve_approximate_design(pool_.blocks, function_, weights_, monitor_);
    of_candidates_ = sensitivities(blocks_, design_.factor);
    // What the prior adds to every d, so that Σ w d is the degree.
    extra_ = weights_.prior.size() > 0 ? (design_.factor.transpose() * weights_.prior * design_.factor).trace() : 0.0;
    limit_ = design_.degree * (1 + options_.tolerance) - extra_;
    const double own = *std::max_element(design_.sensitivity.begin(), design_.sensitivity.end());
    larger_ = own * (1 + 1e-6);
    found_ = candidates_above(std::max(limit_, larger_), of_candidates_, space_, options_.starts);
    judge(std::max(own, *std::max_element(of_candidates_.begin(), of_candidates_.end())));
  }

  void search(const Places& starts) {
    double most = most_;
    for (const AscentResult& end : search_from(starts, pool_, design_.factor, space_, evaluations_, options_)) {
      most = std::max(most, end.value);
      if (end.value > std::min(limit_, larger_)) enter(found_, end.q, space_, end_distance);
    }
    result_.searches += int(starts.size());
    judge(most);
  }

  void judge(double most) {
    most_ = most;
    result_.value = design_.value;
    result_.max_ratio = std::max(1.0, (most + extra_) / design_.degree);
    result_.bound = design_.value + design_.degree * std::log(result_.max_ratio);
  }

  bool is_done() const {
    return evaluations_ == options_.evaluations && (result_.max_ratio <= 1 + options_.tolerance || found_.empty());
  }

  /// True if searches from drawn candidates alone have the same result.
  void confirm() {
    if (result_.max_ratio > 1 + settled_within) return;
    evaluations_ = options_.evaluations;
    Places starts;
    add_drawn(starts, blocks_.count(), space_, options_.starts, random_);
    search(starts);
    result_.confirmed = result_.max_ratio <= 1 + settled_within ? int(starts.size()) : 0;
  }

  void tell_support() {
    result_.factor = design_.factor;
    for (std::size_t i = 0; i < design_.support.size(); ++i)
      if (const auto at = std::size_t(design_.support[i]); design_.weights[i] > 1e-6) {
        if (at < pool_.candidates) {
          result_.candidates.push_back(pool_.original[at]);
          result_.candidate_weights.push_back(design_.weights[i]);
        } else {
          result_.support.push_back(pool_.configurations[at]);
          result_.weights.push_back(design_.weights[i]);
        }
      }
  }

  const BlockArray& blocks_;
  const InformationFunction& function_;
  const ConfigurationSpace& space_;
  const WorkspaceBoundOptions& options_;
  const Monitor& monitor_;
  PlacePool pool_;
  Random random_;
  int evaluations_;  // the first rounds bring in whatever is larger than the rest; only the last must find each top
  ApproximateDesignOptions weights_;
  ApproximateDesign design_;
  WorkspaceBound result_;
  std::vector<double> of_candidates_;  // d
  Places found_;                       // to enter the weights
  double extra_ = 0.0, limit_ = 0.0, larger_ = 0.0, most_ = 0.0;
};

}  // namespace

double WorkspaceBound::bound_for(int poses) const { return bound + degree * std::log(double(poses)); }

WorkspaceBound workspace_bound(const BlockArray& blocks, const ApproximateDesign& on_candidates,
                               const InformationFunction& function, const ConfigurationSpace& space,
                               const WorkspaceBoundOptions& options, const Monitor& monitor) {
  return ColumnGeneration(blocks, on_candidates, function, space, options, monitor).run();
}

}  // namespace posewright
