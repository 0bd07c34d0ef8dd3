// A loop over configurations must not allocate: counts calls of malloc during whitened_block() once its scratch is
// warm.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>

#include "posewright/model/command_solver.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/problem/read_problem.hpp"

#ifndef __SANITIZE_ADDRESS__

namespace {
std::atomic<long> allocations{0};
}

extern "C" void* __libc_malloc(std::size_t);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

namespace posewright {
namespace {

long allocations_of_blocks(const std::string& example) {
  const Problem problem = read_problem(std::filesystem::path(POSEWRIGHT_SOURCE_DIR) / "examples" / example);
  const VariantSpec& variant = problem.variants.front();
  const auto model = make_model({problem, variant});
  const VariantColumns columns = select_columns(*model, {problem, variant});
  const int stride = (int(columns.selected.size()) + 7) / 8 * 8;
  std::vector<double> out(std::size_t(model->block_rows(columns.selected) * stride)), q;
  for (const Coordinate& c : model->coordinates())
    q.push_back(c.discrete() ? c.values.back() : 0.45 * c.lower + 0.55 * c.upper);
  Linearisation scratch;
  for (int i = 0; i < 2; ++i)
    EXPECT_TRUE(whitened_block(*model, q, {}, columns.selected, scratch, out.data(), stride)) << example;
  const long before = allocations;
  for (int i = 0; i < 100; ++i) whitened_block(*model, q, {}, columns.selected, scratch, out.data(), stride);
  return allocations - before;
}

long allocations_of_commands() {
  const Problem problem = read_problem(std::filesystem::path(POSEWRIGHT_SOURCE_DIR) / "examples/kr270/problem.yaml");
  const VariantSpec& variant = problem.variants.front();
  auto arm = make_tip({problem, variant});
  std::vector<double> correction(arm->parameters().size(), 1e-4), q, command(6), change(6);
  const std::vector<Coordinate> limits = arm->coordinates();
  for (const Coordinate& c : limits) q.push_back(0.45 * c.lower + 0.55 * c.upper);
  const CommandSolver solver(make_tip({problem, variant}), std::move(arm), correction, limits, {});
  const auto reached = [&] { return solver.solve(q, command, change).outcome == CommandSolver::Outcome::reached; };
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(reached());
  EXPECT_NE(command, q);
  const long before = allocations;
  for (int i = 0; i < 100; ++i) reached();
  return allocations - before;
}

TEST(Allocation, TheCounterCounts) {
  const long before = allocations;
  std::free(std::malloc(100));
  EXPECT_GT(allocations, before);
}

TEST(Allocation, BlocksOfAnArmAreBuiltWithoutTheHeap) { EXPECT_EQ(allocations_of_blocks("kr270/problem.yaml"), 0); }
TEST(Allocation, BlocksOfAParallelRobotAreBuiltWithoutTheHeap) {
  EXPECT_EQ(allocations_of_blocks("telescope/problem.yaml"), 0);
}

TEST(Allocation, CommandsOfAnArmAreFoundWithoutTheHeap) { EXPECT_EQ(allocations_of_commands(), 0); }

}  // namespace
}  // namespace posewright

#else
TEST(Allocation, IsCountedInOtherBuildsOnly) { GTEST_SKIP() << "the address sanitizer has its own malloc"; }
#endif
