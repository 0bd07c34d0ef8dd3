// Whitened blocks a second, one core, and the same rows by automatic differentiation for the ratio.

#include <benchmark/benchmark.h>
#include <ceres/jet.h>

#include <filesystem>

#include "posewright/model/model_factory.hpp"
#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/residuals.hpp"

namespace posewright {
namespace {

Problem example(const char* name) {
  return read_problem(std::filesystem::path(POSEWRIGHT_SOURCE_DIR) / "examples" / name / "problem.yaml");
}

void whitened_blocks(benchmark::State& state, const char* name) {
  const Problem problem = example(name);
  const auto model = make_model(problem);
  const VariantColumns columns = select_columns(*model, {problem, problem.variants.front()});
  const int stride = (int(columns.selected.size()) + 7) / 8 * 8;
  std::vector<double> out(std::size_t(model->block_rows(columns.selected) * stride)), q(model->coordinates().size());
  Linearisation scratch;
  Random random(1, 0);
  for (auto _ : state) {
    for (double& x : q) x = random.uniform(-1e-3, 1e-3);
    benchmark::DoNotOptimize(whitened_block(*model, q, {}, columns.selected, scratch, out.data(), stride));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(whitened_blocks, kr270_33_columns_9_rows, "kr270");
BENCHMARK_CAPTURE(whitened_blocks, telescope_42_columns_6_rows, "telescope");

/// The KR 270's 33 columns by one Jet<double, 33> through the same kinematics; not whitened.
void automatic_differentiation(benchmark::State& state) {
  using Jet = ceres::Jet<double, 33>;
  const Problem problem = example("kr270");
  const auto& arm = std::get<SerialArmSpec>(problem.robot);
  const ChainDescription chain = read_urdf_chain(arm, {});
  const ChainLayout layout(chain);
  const auto model = make_model(problem);
  const VariantColumns columns = select_columns(*model, {problem, problem.variants.front()});
  const auto& targets = std::get<PointsMeasurement>(problem.measurement.instrument).targets;
  std::vector<double> q(6);
  Random random(1, 0);
  for (auto _ : state) {
    for (double& x : q) x = random.uniform(-1e-3, 1e-3);
    std::vector<Jet> correction(std::size_t(layout.count) + 9, Jet(0.0));
    for (int c = 0; c < 33; ++c) {
      const int index = columns.selected[std::size_t(c)];
      // The model leaves tool.* out: targets follow the chain's other parameters.
      correction[std::size_t(index < layout.tool ? index : index - layout.tool + layout.count)].v[c] = 1;
    }
    const Frame<Jet> tip = tip_pose<Jet>(chain, layout, q.data(), correction.data());
    for (std::size_t t = 0; t < 3; ++t) {
      Eigen::Matrix<Jet, 3, 1> p = targets[t].position.cast<Jet>();
      for (int k = 0; k < 3; ++k) p[k] += correction[std::size_t(layout.count) + 3 * t + std::size_t(k)];
      const Eigen::Matrix<Jet, 3, 1> x = tip.R * p + tip.p;
      benchmark::DoNotOptimize(x);
    }
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(automatic_differentiation);

}  // namespace
}  // namespace posewright
