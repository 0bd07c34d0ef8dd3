#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "posewright/criterion/determinant.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

Eigen::MatrixXd information_of(const BlockArray& blocks, std::size_t count) {
  const Eigen::MatrixXd J = blocks.all().topRows(Eigen::Index(count) * blocks.rows());
  return J.transpose() * J;
}

TEST(LogDetFunction, OneBlockMoreIsTheDeterminantOfTheSum) {
  const BlockArray blocks = random_blocks(40, 4, 11, 3);
  for (const int nuisance : {0, 5}) {
    const LogDetFunction function(nuisance, 11);
    const Eigen::MatrixXd rest = information_of(blocks, 6);
    const auto with_block = function.with_block(rest);
    for (std::size_t i = 6; i < 40; ++i) {
      const Eigen::MatrixXd J = blocks.block(i), M = rest + J.transpose() * J;
      const double nuisance_part = std::log(M.topLeftCorner(nuisance, nuisance).determinant());
      EXPECT_NEAR(with_block->value(blocks.block(i)), std::log(M.determinant()) - (nuisance > 0 ? nuisance_part : 0.0),
                  1e-10);
    }
  }
}

TEST(LogDetFunction, OneBlockMayMakeSingularInformationRegular) {
  const BlockArray blocks = random_blocks(40, 4, 11, 3);
  const LogDetFunction function(5, 11);
  const auto two = function.with_block(information_of(blocks, 2)), one = function.with_block(information_of(blocks, 1));
  const Eigen::MatrixXd J = blocks.block(2);
  EXPECT_NEAR(two->value(blocks.block(2)), function.value(information_of(blocks, 2) + J.transpose() * J), 1e-10);
  EXPECT_EQ(one->value(blocks.block(2)), -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace posewright
