#include "posewright/blocks/identifiability.hpp"

#include <gtest/gtest.h>

#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

std::vector<Parameter> labels(int count) {
  std::vector<Parameter> parameters;
  for (int j = 0; j < count; ++j) parameters.push_back({"p" + std::to_string(j), "m", 0, 1e-3, Role::interest});
  return parameters;
}

TEST(Identifiability, IndependentColumnsAreAllKept) {
  const Identifiability found = identifiability(random_blocks(30, 2, 6, 1), labels(6));
  EXPECT_EQ(found.rank, 6);
  EXPECT_TRUE(found.dependencies.empty());
}

TEST(Identifiability, DependencyIsFoundWithItsCoefficientsInPhysicalUnits) {
  BlockArray blocks = random_blocks(30, 2, 5, 2);
  // p3 = 2 p0 − 0.5 p1, with tolerances that differ a thousandfold.
  for (std::size_t i = 0; i < 30; ++i)
    blocks.block(i).col(3) = 2 * blocks.block(i).col(0) - 0.5 * blocks.block(i).col(1);
  auto parameters = labels(5);
  parameters[0].tolerance = 1;
  parameters[3].unit = "rad";
  const Identifiability found = identifiability(blocks, parameters);
  EXPECT_EQ(found.rank, 4);
  ASSERT_EQ(found.dependencies.size(), 1U);
  const Dependency& d = found.dependencies[0];
  // The largest tolerance is kept first; of p1 and what p0 leaves of p3 the larger effect stays.
  EXPECT_EQ(d.dropped, 3);
  ASSERT_EQ(d.terms.size(), 2U);
  EXPECT_NEAR(d.terms[0].coefficient, 2, 1e-9);
  EXPECT_NEAR(d.terms[1].coefficient, -0.5, 1e-9);
  EXPECT_LT(d.remainder, 1e-12);
  EXPECT_EQ(describe(d, parameters), "p3 = 2 m/rad·p0 − 0.5 m/rad·p1");
}

TEST(Identifiability, TiersDecideWhoStays) {
  BlockArray blocks = random_blocks(30, 2, 4, 3);
  for (std::size_t i = 0; i < 30; ++i) blocks.block(i).col(3) = blocks.block(i).col(0);
  IdentifiabilityOptions options;
  options.tiers = {1, 0, 0, 0};
  const Identifiability found = identifiability(blocks, labels(4), options);
  EXPECT_EQ(found.kept, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(describe(found.dependencies[0], labels(4)), "p0 = p3");
}

TEST(Identifiability, EqualColumnsKeepTheFirst) {
  BlockArray blocks = random_blocks(30, 2, 4, 3);
  for (std::size_t i = 0; i < 30; ++i) blocks.block(i).col(3) = (1 + 1e-9) * blocks.block(i).col(0);
  EXPECT_EQ(identifiability(blocks, labels(4)).kept, (std::vector<int>{0, 1, 2}));
}

TEST(Identifiability, NearDependenceCountsByTheThreshold) {
  BlockArray blocks = random_blocks(200, 2, 4, 5);
  for (std::size_t i = 0; i < 200; ++i) blocks.block(i).col(3) = blocks.block(i).col(0) + 1e-6 * blocks.block(i).col(3);
  IdentifiabilityOptions strict;
  strict.threshold = 1e-9;
  EXPECT_EQ(identifiability(blocks, labels(4), strict).rank, 4);
  const Identifiability found = identifiability(blocks, labels(4));
  EXPECT_EQ(found.rank, 3);
  EXPECT_NEAR(found.dependencies[0].remainder, 1e-6, 5e-7);
}

TEST(Identifiability, ParameterWithoutEffectIsNamed) {
  BlockArray blocks = random_blocks(30, 2, 3, 6);
  for (std::size_t i = 0; i < 30; ++i) blocks.block(i).col(1).setZero();
  const Identifiability found = identifiability(blocks, labels(3));
  EXPECT_EQ(found.rank, 2);
  EXPECT_EQ(describe(found.dependencies[0], labels(3)), "p1 has no effect on the measurement");
}

}  // namespace
}  // namespace posewright
