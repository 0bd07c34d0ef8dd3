#include <fmt/format.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <algorithm>
#include <bit>

#include "closure.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/random.hpp"
#include "sampler.hpp"
#include "valid_samples.hpp"

namespace posewright {
namespace {

// Draws that one OMPL sampler makes in a row; the next ones begin afresh, so that threads can share them out.
constexpr int ompl_run = 16;
// Share of its draws that an OMPL sampler must yield to go on.
constexpr double least_yield = 0.01;
constexpr const char* out_of_reach_of_view = "no joint angles for a view of the targets";

/// Advice for a reason that rejects most proposed views.
std::string cure_of(const std::string& reason) {
  if (reason == out_of_reach_of_view)
    return "; no joint angles bring the targets into view: move targets or instrument into reach, or widen "
           "line_of_sight: range and acceptance";
  if (reason.starts_with("occluded"))
    return "; a body hides the instrument: mark the instrument's own body with station: NAME, or move it";
  return "; these were drawn in view of the targets: change " + reason;
}

}  // namespace

Sampler::Sampler(const Workspace& workspace, const SamplingOptions& options)
    : workspace_(workspace),
      options_(options),
      reasons_(workspace.reasons()),
      instrument_(instrument_index(workspace.proposed())) {
  result_.dimension = int(workspace.proposed().size());
  for (std::size_t k = 0; k < workspace.proposed().size(); ++k)
    if (const Coordinate& c = workspace.proposed()[k]; !c.periodic && !c.discrete()) bounded_.push_back(k);
  reasons_.push_back(out_of_reach_of_view);
  reasons_.push_back(open_loop_reason);
  reasons_.push_back("drawn before");
  reasons_.push_back(passed_over_reason);
  rejected_.assign(reasons_.size(), 0);
}

void Sampler::valid_states(SamplerKind kind, std::size_t wanted, const Monitor& monitor) {
  has_ompl_ = true;
  const std::size_t target = result_.count() + wanted;
  const long limit = result_.drawn + long(wanted * options_.draws_per_candidate);
  constexpr std::size_t runs = 32;
  std::vector<DrawnBatch> batches(runs);
  for (std::size_t first = 0; result_.count() < target && result_.drawn < limit && !monitor.should_stop();
       first += runs) {
    parallel_for(runs, thread_count(options_.threads), [&](std::size_t r, int) { batches[r] = run(kind, first + r); });
    const std::size_t before = result_.count();
    for (const DrawnBatch& done : batches) {
      if (result_.count() >= target) break;
      add(done, target);
    }
    // Where little is near, a sampler that looks for obstacles finds none: the rest is drawn evenly.
    if (double(result_.count() - before) < least_yield * runs * ompl_run) break;
    monitor.report({"candidates", double(result_.count()), double(options_.count), {}, {}, {}});
  }
}

Sampler::DrawnBatch Sampler::run(SamplerKind kind, std::size_t number) const {
  namespace ob = ompl::base;
  Random random(options_.seed, mix_bits(mix_bits(number) + 17 * (1 + std::size_t(kind))));
  SamplingSession session(random, workspace_.reasons().size());
  const auto& space = workspace_.space_information();
  const ob::ValidStateSamplerPtr sampler = make_valid_sampler(kind, space.get());
  ob::ScopedState<ob::RealVectorStateSpace> state(space);
  DrawnBatch result;
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

void Sampler::add(const DrawnBatch& done, std::size_t target) {
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

bool Sampler::is_new(std::span<const double> q) {
  std::uint64_t hash = 0;
  for (const double x : q) hash = mix_bits(hash ^ std::bit_cast<std::uint64_t>(x));
  return seen_.insert(hash).second;
}

Configurations Sampler::take() {
  for (std::size_t r = 0; r < rejected_.size(); ++r)
    if (rejected_[r] > 0) result_.rejected.emplace_back(reasons_[r], rejected_[r]);
  if (result_.count() == 0) fail();
  return std::move(result_);
}

void Sampler::fail() const {
  if (result_.drawn == 0) throw CannotDo("stopped before a feasible configuration was found");
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

}  // namespace posewright
