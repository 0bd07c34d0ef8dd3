// Commands for a calibrated robot a second, one core: the KR 270 with every frame off by about a tolerance, poses
// within nine tenths of the limits.

#include <benchmark/benchmark.h>

#include <filesystem>

#include "posewright/model/apply_parameters.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"
#include "posewright/tasks/compensate_problem.hpp"

namespace posewright {
namespace {

void commands(benchmark::State& state) {
  Problem problem = read_problem(std::filesystem::path(POSEWRIGHT_SOURCE_DIR) / "examples/kr270/problem.yaml");
  Random random(1, 0);
  CalibratedParameters parameters;
  parameters.variant.value = problem.variants.front().name;
  const auto model = make_model(problem);
  for (const Parameter& p : model->parameters())
    if (p.name.starts_with("joint") && p.unit != "1")
      parameters.values.push_back({{p.name, 0}, p.unit, p.nominal + random.uniform(-1, 1) * p.tolerance});
  apply_parameters(problem, parameters, {});
  PoseList list;
  const std::vector<Coordinate> coordinates = compensation_coordinates(problem);
  for (int i = 0; i < 100'000; ++i) {
    list.configurations.emplace_back();
    for (const Coordinate& c : coordinates)
      list.configurations.back().push_back(0.5 * (c.lower + c.upper) +
                                           0.45 * (c.upper - c.lower) * random.uniform(-1, 1));
  }
  CompensateOptions options;
  options.threads = 1;
  std::size_t solved = 0;
  double worst = 0;
  for (auto _ : state) {
    const Compensation c = compensate_problem(problem, {list}, options, Monitor{});
    solved = c.compensated;
    worst = c.after.position_largest;
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t(list.configurations.size()));
  state.counters["compensated"] = double(solved);
  state.counters["worst_after_m"] = worst;
}
BENCHMARK(commands)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace posewright
