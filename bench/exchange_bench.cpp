// Exchange, bound and their kernels on the sizes of the shared instances: Gaussian blocks from the project's own
// generator, so that the figures need no files. One thread.

#include <benchmark/benchmark.h>

#include "planners/planner_registry.hpp"
#include "posewright/criterion/determinant.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/planning/whiten.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

struct Size {
  std::size_t count;
  int rows, columns, nuisance, poses;
};
// b and c: 5,000 × 1 × 30 and 100,000 × 1 × 20; f: 5,000 × 3 × 30; an arm with three reflectors.
constexpr Size sizes[] = {{5000, 1, 30, 0, 60}, {100000, 1, 20, 0, 40}, {5000, 3, 30, 0, 25}, {5000, 9, 33, 15, 18}};

struct Prepared {
  explicit Prepared(const Size& s) : size(s), blocks(random_blocks(s.count, s.rows, s.columns, 20240002)) {
    whiten(blocks);
  }
  Size size;
  BlockArray blocks;
  std::unique_ptr<Criterion> criterion = make_criterion("o1", {});
};

ApproximateDesign bound_of(const Prepared& p) {
  ApproximateDesignOptions options;
  options.cap = 1.0 / p.size.poses;
  return solve_approximate_design(p.blocks, LogDetFunction(p.size.nuisance, p.size.columns), options, Monitor{});
}

Design restart(const Prepared& p, const ApproximateDesign* approximate, int kicks, std::uint64_t seed) {
  PlannerOptions options;
  options.restarts = 1;
  options.kicks = kicks;
  options.threads = 1;
  options.seed = seed;
  return find_planner("exchange")
      ->plan({{&p.blocks, p.size.nuisance, 1}, p.criterion.get(), p.size.poses, approximate}, options, Monitor{});
}

/// One start from uniform draws to a local optimum over all candidates.
void local_optimum_over_all(benchmark::State& state) {
  const Prepared prepared(sizes[state.range(0)]);
  std::uint64_t seed = 0;
  for (auto _ : state) benchmark::DoNotOptimize(restart(prepared, nullptr, 0, seed++).value);
}

/// One start as the program does it: promising candidates, kicks, then all candidates.
void whole_restart(benchmark::State& state) {
  const Prepared prepared(sizes[state.range(0)]);
  const ApproximateDesign approximate = bound_of(prepared);
  std::uint64_t seed = 0;
  for (auto _ : state) benchmark::DoNotOptimize(restart(prepared, &approximate, PlannerOptions().kicks, seed++).value);
}

/// Certificate to 1 − efficiency ≤ 1e-9.
void certificate(benchmark::State& state) {
  const Prepared prepared(sizes[state.range(0)]);
  double ratio = 0;
  for (auto _ : state) ratio = bound_of(prepared).max_sensitivity_ratio;
  state.counters["gap"] = ratio - 1;
}

BENCHMARK(local_optimum_over_all)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);
BENCHMARK(whole_restart)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);
BENCHMARK(certificate)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace posewright
