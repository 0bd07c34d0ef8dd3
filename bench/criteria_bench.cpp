// Exchanges under criteria of several variants and of effects, and the same exchanges with every swap refactorised:
// what their swap formulas bring. Gaussian blocks from the project's own generator, 300 candidates, 20 poses, one
// thread.

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "planners/local_search.hpp"
#include "posewright/criterion/information_function.hpp"
#include "posewright/criterion/registry.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

constexpr int candidates = 300, poses = 20, effects = 3;

/// Two variants as the search holds them, columns side by side and rows below each other; or one variant, its trailing
/// columns being those of effects.
struct Case {
  explicit Case(const std::string& name)
      : several(name != "discriminate"),
        blocks(random_blocks(candidates, several ? 6 : 3, several ? 50 : 33, 20240002)) {
    const int m = blocks.columns();
    data.R = Eigen::MatrixXd::Identity(m, m);
    data.scale = Eigen::VectorXd::Ones(m);
    if (several) {
      data.variants = {{0, 30, 6, 1.0, 60.0}, {30, 20, 6, 2.0, 40.0}};
      for (std::size_t i = 0; i < blocks.count(); ++i) {
        blocks.block(i).topRightCorner(3, 20).setZero();
        blocks.block(i).bottomLeftCorner(3, 30).setZero();
      }
    } else {
      data.effects = {effects, Eigen::MatrixXd::Identity(effects, effects)};
    }
    criterion = make_criterion(name, data);
    for (int i = 0; i < poses; ++i) start.push_back(i);
  }

  CandidateView view() const { return {&blocks, 0, 1}; }

  bool several;
  BlockArray blocks;
  CriterionData data;
  std::unique_ptr<Criterion> criterion;
  std::vector<int> start;
};

/// Best exchanges of all positions once; returns how many there were.
int pass_by_formula(const Case& c) {
  const auto state = c.criterion->start(c.view(), c.start);
  int swaps = 0;
  for (int position = 0; position < poses; ++position) {
    const Swap swap = state->best_swap(position, smallest_gain);
    if (swap.enter < 0) continue;
    state->apply(position, swap.enter);
    ++swaps;
  }
  return swaps;
}

/// The same from Φ of the information of every set with one member exchanged.
int pass_by_factors(const Case& c) {
  const auto square = [&](int i) -> Eigen::MatrixXd {
    return c.blocks.block(std::size_t(i)).transpose() * c.blocks.block(std::size_t(i));
  };
  const InformationFunction& function = c.criterion->function();
  std::vector<int> members = c.start;
  std::vector<bool> used(candidates, false);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(c.blocks.columns(), c.blocks.columns());
  for (const int i : members) {
    M += square(i);
    used[std::size_t(i)] = true;
  }
  int swaps = 0;
  for (int& member : members) {
    const Eigen::MatrixXd rest = M - square(member);
    double best = function.value(M) + smallest_gain;
    int enter = -1;
    for (int j = 0; j < candidates; ++j) {
      if (used[std::size_t(j)]) continue;
      const double value = function.value(rest + square(j));
      if (!(value > best)) continue;
      best = value;
      enter = j;
    }
    if (enter < 0) continue;
    used[std::size_t(member)] = false;
    used[std::size_t(enter)] = true;
    M = rest + square(enter);
    member = enter;
    ++swaps;
  }
  return swaps;
}

void exchange_by_formula(benchmark::State& state, const std::string& name) {
  const Case c(name);
  int swaps = 0;
  for (auto _ : state) swaps = pass_by_formula(c);
  state.counters["swaps"] = swaps;
}

void exchange_by_factors(benchmark::State& state, const std::string& name) {
  const Case c(name);
  int swaps = 0;
  for (auto _ : state) swaps = pass_by_factors(c);
  state.counters["swaps"] = swaps;
}

/// From the start to a local optimum.
void settle_by_formula(benchmark::State& state, const std::string& name) {
  const Case c(name);
  for (auto _ : state) {
    const auto design = c.criterion->start(c.view(), c.start);
    benchmark::DoNotOptimize(settle(*design, Monitor{}));
  }
}

#define CRITERION_BENCHMARKS(name)                                                    \
  BENCHMARK_CAPTURE(exchange_by_formula, name, #name)->Unit(benchmark::kMillisecond); \
  BENCHMARK_CAPTURE(exchange_by_factors, name, #name)->Unit(benchmark::kMillisecond); \
  BENCHMARK_CAPTURE(settle_by_formula, name, #name)->Unit(benchmark::kMillisecond)
CRITERION_BENCHMARKS(compound);
CRITERION_BENCHMARKS(maximin);
CRITERION_BENCHMARKS(discriminate);

}  // namespace
}  // namespace posewright
