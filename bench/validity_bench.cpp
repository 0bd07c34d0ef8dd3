#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "posewright/problem/read_problem.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/random.hpp"

/// Full checks of a pose (limits, self-collision, obstacles, lines of sight) of the example cell, or of the problem
/// file named in POSEWRIGHT_CELL. One thread. Configurations are uniform over the limits, so most of them collide
/// early; `feasible` asks for those that pass everything, where every pair and every ray is looked at.
namespace {

using namespace posewright;

Variant site() {
  const char* given = std::getenv("POSEWRIGHT_CELL");
  static const Problem problem =
      read_problem(given != nullptr ? given : POSEWRIGHT_SOURCE_DIR "/examples/cell/problem.yaml");
  return place_variant({problem, problem.variants.front()}, make_cell(problem));
}

std::vector<std::vector<double>> configurations(const Workspace& workspace, bool feasible, std::size_t count) {
  Random random(1, 0);
  std::vector<std::vector<double>> list;
  while (list.size() < count) {
    std::vector<double> q;
    for (const Coordinate& c : workspace.coordinates())
      q.push_back(c.discrete() ? c.values[std::size_t(random.index(int(c.values.size())))]
                               : random.uniform(c.lower, c.upper));
    if (!feasible || workspace.violation(q) < 0) list.push_back(q);
  }
  return list;
}

void check_poses(benchmark::State& state, bool feasible) {
  const Variant s = site();
  const auto list = configurations(*s.workspace, feasible, 1000);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(s.workspace->violation(list[i++ % list.size()]));
  state.SetItemsProcessed(state.iterations());
}

void check_motions(benchmark::State& state) {
  const Variant s = site();
  const auto list = configurations(*s.workspace, true, 200);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        s.workspace->cell()->collision->motion_is_free(list[i % list.size()], list[(i + 1) % list.size()]));
    ++i;
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK_CAPTURE(check_poses, uniform, false);
BENCHMARK_CAPTURE(check_poses, feasible, true);
BENCHMARK(check_motions)->Unit(benchmark::kMillisecond);

}  // namespace
