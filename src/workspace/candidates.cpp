#include "posewright/workspace/candidates.hpp"

#include <fmt/format.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_set>

#include "low_discrepancy.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/random.hpp"
#include "valid_samples.hpp"
#include "view_sampler.hpp"

namespace posewright {
namespace {

constexpr std::size_t batch = 2048;
// Halvings of the way from a feasible point to an infeasible one: 2⁻³⁰ of the way is finer than any controller's step.
constexpr int bisections = 30;
// Where each step asks for collisions: 2⁻¹³ of the way.
constexpr int bisections_in_cell = 13;
// Draws that one OMPL sampler makes in a row; the next ones begin afresh, so that threads can share them out.
constexpr int ompl_run = 16;
// Share of its draws that an OMPL sampler must yield to go on.
constexpr double least_yield = 0.01;
// Corners of a box of more dimensions are drawn, not enumerated.
constexpr std::size_t max_enumerated = 10;
constexpr std::uint64_t interior_stream = 1, boundary_stream = 2, view_stream = 4;
// What an instrument sees is proposed where fewer of so many even draws are feasible.
constexpr std::size_t pilot_draws = 1024;
constexpr double scarce = 0.05;
// Views that nothing reaches are not tried as often as plain draws, which take a thousandth of their time.
constexpr std::size_t views_per_candidate = 40;
constexpr const char* out_of_reach_of_view = "no joint angles for a view of the targets";

/// Collects drawn configurations batch by batch; validity is judged in parallel, the order stays that of the draws.
class Sampler {
 public:
  Sampler(const Workspace& workspace, const SamplingOptions& options)
      : workspace_(workspace), options_(options), reasons_(workspace.reasons()) {
    result_.dimension = int(workspace.proposed().size());
    for (std::size_t k = 0; k < workspace.proposed().size(); ++k)
      if (const Coordinate& c = workspace.proposed()[k]; !c.periodic && !c.discrete()) bounded_.push_back(k);
    reasons_.push_back(out_of_reach_of_view);
    reasons_.push_back("drawn before");
    reasons_.push_back(passed_over_reason);
    rejected_.assign(reasons_.size(), 0);
  }

  void interior(std::size_t wanted, const Monitor& monitor) {
    // A second go must not draw the same again.
    LowDiscrepancy points(result_.dimension, result_.count() == 0 ? options_.seed : mix_bits(options_.seed + 3));
    draw(
        wanted, monitor, options_.draws_per_candidate, [&](std::size_t, std::span<double> q) { points.next(q); },
        [&](std::size_t, std::span<double> q) {
          scale(q);
          return workspace_.violation(q);
        });
  }

  /// Share of even draws that is feasible, by a few.
  double feasible_share() const {
    LowDiscrepancy points(result_.dimension, mix_bits(options_.seed + view_stream));
    const auto d = std::size_t(result_.dimension);
    std::vector<double> drawn(pilot_draws * d);
    for (std::size_t i = 0; i < pilot_draws; ++i) points.next(std::span(drawn).subspan(i * d, d));
    std::vector<char> good(pilot_draws, 0);
    parallel_for(pilot_draws / 64, thread_count(options_.threads), [&](std::size_t chunk, int) {
      for (std::size_t i = 64 * chunk; i < 64 * (chunk + 1); ++i) {
        const std::span<double> q = std::span(drawn).subspan(i * d, d);
        scale(q);
        good[i] = char(workspace_.violation(q) < 0);
      }
    });
    return double(std::count(good.begin(), good.end(), char(1))) / double(pilot_draws);
  }

  /// Where the instrument sees its targets: from even draws the joints go to views, drawn by (seed, draw) alone.
  void views(std::size_t wanted, const Monitor& monitor) {
    has_views_ = true;
    const std::uint64_t seed = mix_bits(options_.seed + view_stream + result_.count());
    LowDiscrepancy points(result_.dimension, seed);
    draw(
        wanted, monitor, std::min(options_.draws_per_candidate, views_per_candidate),
        [&](std::size_t, std::span<double> q) { points.next(q); },
        [&](std::size_t i, std::span<double> q) {
          scale(q);
          Random random(seed, mix_bits(i));
          const bool there = workspace_.views()->move_to_view(q, random);
          const int verdict = workspace_.violation(q);
          return verdict >= 0 && !there ? int(workspace_.reasons().size()) : verdict;
        });
  }

  void boundary(std::size_t wanted, const Monitor& monitor) {
    LowDiscrepancy points(result_.dimension, mix_bits(options_.seed + boundary_stream));
    anchors_ = result_.count();
    draw(
        wanted, monitor, options_.draws_per_candidate,
        [&](std::size_t i, std::span<double> q) {
          points.next(q);
          pin(i, q);
        },
        [&](std::size_t i, std::span<double> q) {
          scale(q);
          const int verdict = workspace_.violation(q);
          return verdict < 0 || anchors_ == 0 ? verdict : draw_back(i, q);
        });
  }

  /// What samplers did not find is drawn evenly.
  void fill_up(std::size_t count, const Monitor& monitor) {
    if (result_.count() == 0 || result_.count() >= count) return;
    if (has_views_) views(count - result_.count(), monitor);
    else if (has_ompl_) interior(count - result_.count(), monitor);
  }

  /// Valid states by one of OMPL's samplers, in runs that depend on (seed, kind, run) alone.
  void valid_states(SamplerKind kind, std::size_t wanted, const Monitor& monitor) {
    has_ompl_ = true;
    const std::size_t target = result_.count() + wanted;
    const long limit = result_.drawn + long(wanted * options_.draws_per_candidate);
    constexpr std::size_t runs = 32;
    std::vector<Run> batch_of_runs(runs);
    for (std::size_t first = 0; result_.count() < target && result_.drawn < limit && !monitor.should_stop();
         first += runs) {
      parallel_for(runs, thread_count(options_.threads),
                   [&](std::size_t r, int) { batch_of_runs[r] = run(kind, first + r); });
      const std::size_t before = result_.count();
      for (const Run& done : batch_of_runs) {
        if (result_.count() >= target) break;
        add(done, target);
      }
      // Where little is near, a sampler that looks for obstacles finds none: the rest is drawn evenly.
      if (double(result_.count() - before) < least_yield * runs * ompl_run) break;
      monitor.report({"candidates", double(result_.count()), double(options_.count), {}, {}, {}});
    }
  }

  bool is_empty() const { return result_.count() == 0; }

  Configurations take() {
    for (std::size_t r = 0; r < rejected_.size(); ++r)
      if (rejected_[r] > 0) result_.rejected.emplace_back(reasons_[r], rejected_[r]);
    if (result_.count() == 0) fail();
    return std::move(result_);
  }

 private:
  struct Run {
    std::vector<double> values;
    std::vector<long> rejected;
    long drawn = 0;
  };

  std::size_t drawn_before() const { return rejected_.size() - 2; }

  Run run(SamplerKind kind, std::size_t number) const {
    namespace ob = ompl::base;
    Random random(options_.seed, mix_bits(mix_bits(number) + 17 * (1 + std::size_t(kind))));
    SamplingSession session(random, workspace_.reasons().size());
    const auto& space = workspace_.space_information();
    const ob::ValidStateSamplerPtr sampler = make_valid_sampler(kind, space.get());
    ob::ScopedState<ob::RealVectorStateSpace> state(space);
    Run result;
    for (int i = 0; i < ompl_run; ++i) {
      session.fixed.clear();
      for (const Coordinate& c : workspace_.proposed())
        session.fixed.push_back(c.discrete() ? c.values[std::size_t(random.index(int(c.values.size())))] : 0.0);
      if (!sampler->sample(state.get())) continue;
      const double* values = state->values;
      if (workspace_.violation({values, std::size_t(result_.dimension)}) < 0)
        result.values.insert(result.values.end(), values, values + result_.dimension);
    }
    result.drawn = session.draws();
    result.rejected = session.rejected();
    return result;
  }

  void add(const Run& done, std::size_t target) {
    result_.drawn += done.drawn;
    long open = done.drawn;
    for (std::size_t r = 0; r < done.rejected.size(); ++r) {
      rejected_[r] += done.rejected[r];
      open -= done.rejected[r];
    }
    const auto d = std::size_t(result_.dimension);
    for (std::size_t i = 0; i < done.values.size() && result_.count() < target; i += d) {
      const std::span<const double> q = std::span(done.values).subspan(i, d);
      --open;
      if (is_new(q)) result_.values.insert(result_.values.end(), q.begin(), q.end());
      else ++rejected_[drawn_before()];
    }
    rejected_.back() += open;
  }

  /// Moves unit coordinates to 0 or 1: all of them for the first draws (every corner once, if they are not too many),
  /// then 1, 2, … of them in turn. Periodic coordinates have no ends.
  void pin(std::size_t i, std::span<double> q) const {
    const std::size_t ends = bounded_.size();
    const bool all_corners = ends <= max_enumerated;
    if (all_corners && i < (std::size_t(1) << ends)) {
      for (std::size_t k = 0; k < ends; ++k) q[bounded_[k]] = double((i >> k) & 1U);
      return;
    }
    Random random(options_.seed, mix_bits(i + interior_stream));
    const std::size_t most = all_corners && ends > 1 ? ends - 1 : ends;
    std::size_t pinned = most == 0 ? 0 : 1 + i % most;
    for (std::size_t k = 0; k < ends; ++k) {
      // Selection sampling: coordinate k is among those still to be pinned with the right probability.
      if (random.uniform() * double(ends - k) >= double(pinned)) continue;
      q[bounded_[k]] = random.bits() >> 63 ? 1.0 : 0.0;
      --pinned;
    }
  }

  /// A configuration that is there already would be a repeat under another name.
  bool is_new(std::span<const double> q) {
    std::uint64_t hash = 0;
    for (const double x : q) hash = mix_bits(hash ^ std::bit_cast<std::uint64_t>(x));
    return seen_.insert(hash).second;
  }

  /// @param generate  a point of the unit box, draw after draw
  /// @param judge     makes it a configuration and says what forbids it; in several threads
  template <class Generate, class Judge>
  void draw(std::size_t wanted, const Monitor& monitor, std::size_t draws_per_candidate, const Generate& generate,
            const Judge& judge) {
    const auto d = std::size_t(result_.dimension);
    const std::size_t target = result_.count() + wanted;
    const std::size_t limit = wanted * draws_per_candidate;
    std::vector<double> points(batch * d);
    std::vector<int> verdict(batch);
    for (std::size_t first = 0;
         result_.count() < target && first < limit && (result_.drawn == 0 || !monitor.should_stop()); first += batch) {
      for (std::size_t i = 0; i < batch; ++i) generate(first + i, std::span(points).subspan(i * d, d));
      parallel_for(batch / 64, thread_count(options_.threads), [&](std::size_t chunk, int) {
        for (std::size_t i = 64 * chunk; i < 64 * (chunk + 1); ++i)
          verdict[i] = judge(first + i, std::span(points).subspan(i * d, d));
      });
      for (std::size_t i = 0; i < batch && result_.count() < target; ++i) {
        ++result_.drawn;
        const std::span<const double> q = std::span(points).subspan(i * d, d);
        if (verdict[i] >= 0) ++rejected_[std::size_t(verdict[i])];
        else if (!is_new(q)) ++rejected_[drawn_before()];
        else
          result_.values.insert(result_.values.end(), points.begin() + std::ptrdiff_t(i * d),
                                points.begin() + std::ptrdiff_t((i + 1) * d));
      }
      monitor.report({"candidates", double(result_.count()), double(options_.count), {}, {}, {}});
    }
  }

  /// From the unit box to the limits.
  void scale(std::span<double> q) const {
    for (std::size_t k = 0; k < q.size(); ++k) {
      const Coordinate& c = workspace_.proposed()[k];
      if (c.discrete()) q[k] = c.values[std::min(std::size_t(q[k] * double(c.values.size())), c.values.size() - 1)];
      else q[k] = q[k] >= 1.0 ? c.upper : c.lower + q[k] * (c.upper - c.lower);
    }
  }

  /// Draws an infeasible boundary point back to the feasible set, towards a candidate.
  int draw_back(std::size_t index, std::span<double> q) const {
    Random random(options_.seed, mix_bits(index) + boundary_stream);
    const std::span<const double> inside = result_[std::size_t(random.index(int(anchors_)))];
    std::vector<double> trial(q.size());
    const auto along = [&](double t) {
      for (std::size_t k = 0; k < q.size(); ++k)
        trial[k] = workspace_.proposed()[k].discrete() ? inside[k] : inside[k] + t * (q[k] - inside[k]);
    };
    const int steps = workspace_.cut_by_cell() ? bisections_in_cell : bisections;
    double feasible = 0.0, infeasible = 1.0;
    for (int i = 0; i < steps; ++i) {
      const double middle = 0.5 * (feasible + infeasible);
      along(middle);
      (workspace_.is_free_at(trial) ? feasible : infeasible) = middle;
    }
    along(feasible);
    std::copy(trial.begin(), trial.end(), q.begin());
    return workspace_.violation(q);
  }

  /// What helps where views were proposed and this rejects most of them.
  static std::string cure_of(const std::string& reason) {
    if (reason == out_of_reach_of_view)
      return "; no joint angles lead to where the targets would be seen: move them or the instrument into reach, or "
             "widen "
             "line_of_sight: range and acceptance";
    if (reason.starts_with("occluded"))
      return "; a body stands before the instrument: mark its own with station: NAME, or move it";
    return "; this was drawn where the targets would be seen: " + reason + " is what to change";
  }

  /// Says what rejects most, a view's reasons each with its share, and what helps.
  [[noreturn]] void fail() const {
    std::vector<std::size_t> order;
    for (std::size_t r = 0; r + 1 < rejected_.size(); ++r)
      if (rejected_[r] > 0) order.push_back(r);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return rejected_[a] > rejected_[b]; });
    constexpr std::size_t most = 4;
    std::string text;
    for (std::size_t i = 0; i < std::min(most, order.size()); ++i)
      text += fmt::format("{}'{}' rejects {:.0f} %", i == 0 ? "" : ", ", reasons_[order[i]],
                          100.0 * double(rejected_[order[i]]) / double(result_.drawn));
    std::string cure;
    if (has_views_ && !order.empty()) {
      // What was reached and still not feasible says more than what was not reached.
      const bool reached = order.size() > 1 && rejected_[order[1]] > result_.drawn / 100;
      const bool unreached_first = reasons_[order.front()] == out_of_reach_of_view;
      cure = cure_of(reasons_[order[reached && unreached_first ? 1 : 0]]);
    }
    throw CannotDo(fmt::format("no feasible configuration among {} drawn: {} of them{}", result_.drawn, text, cure));
  }

  const Workspace& workspace_;
  const SamplingOptions& options_;
  Configurations result_;
  std::vector<std::string> reasons_;
  std::vector<long> rejected_;
  std::vector<std::size_t> bounded_;        // coordinates with ends
  std::unordered_set<std::uint64_t> seen_;  // hashes of accepted configurations
  std::size_t anchors_ = 0;
  bool has_ompl_ = false, has_views_ = false;
};

}  // namespace

namespace {

/// Where little is feasible and the instrument says where to look from, that comes first; the boundary is drawn from
/// what is found.
std::vector<std::pair<SamplerKind, double>> shares_of(const Workspace& workspace, const Sampler& sampler) {
  using Kind = SamplerKind;
  if (workspace.samplers_are_given() || workspace.views() == nullptr || sampler.feasible_share() >= scarce)
    return workspace.sampler_shares();
  return {{Kind::look_at, 3}, {Kind::boundary, 2}};
}

}  // namespace

Configurations sample_configurations(const Workspace& workspace, const SamplingOptions& options,
                                     const Monitor& monitor) {
  Sampler sampler(workspace, options);
  const auto shares = shares_of(workspace, sampler);
  double open_share = 0;
  for (const auto& [kind, share] : shares) open_share += share;
  std::size_t open = options.count;
  for (const auto& [kind, share] : shares) {
    const auto wanted = std::size_t(std::lround(double(open) * share / open_share));
    open -= wanted;
    open_share -= share;
    if (kind == SamplerKind::even) sampler.interior(wanted, monitor);
    else if (kind == SamplerKind::boundary) sampler.boundary(wanted, monitor);
    else if (kind == SamplerKind::look_at) {
      sampler.views(wanted, monitor);
      // Other samplers start from what is feasible, or draw what views have shown not to be.
      if (sampler.is_empty()) break;
    } else sampler.valid_states(kind, wanted, monitor);
  }
  sampler.fill_up(options.count, monitor);
  return sampler.take();
}

namespace {

/// A block that is not finite would turn every figure into nothing.
[[noreturn]] void throw_not_finite(const IdentificationModel& model, std::span<const int> selected,
                                   std::span<const double> q, const BlockArray& blocks, std::size_t i) {
  std::size_t column = 0;
  while (blocks.block(i).col(Eigen::Index(column)).allFinite()) ++column;
  throw CannotDo(fmt::format("the effect of '{}' on {} … is not a finite number at the configuration {}",
                             model.parameters()[std::size_t(selected[column])].name, model.readings().front().name,
                             fmt::join(q, ", ")));
}

}  // namespace

BlockArray build_blocks(const IdentificationModel& model, std::span<const int> selected,
                        const Configurations& configurations, int threads) {
  const std::size_t n = configurations.count();
  BlockArray blocks(n, model.block_rows(selected), int(selected.size()));
  const int workers = thread_count(threads);
  std::vector<Linearisation> scratch(static_cast<std::size_t>(workers));
  constexpr std::size_t chunk = 256;
  parallel_for((n + chunk - 1) / chunk, workers, [&](std::size_t c, int worker) {
    for (std::size_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i)
      if (!whitened_block(model, configurations[i], {}, selected, scratch[std::size_t(worker)], blocks.row(i, 0),
                          blocks.stride()))
        throw CannotDo("configuration " + std::to_string(i) + " is out of reach");
      else if (!blocks.block(i).allFinite()) throw_not_finite(model, selected, configurations[i], blocks, i);
  });
  return blocks;
}

}  // namespace posewright
