#include "posewright/planning/evaluate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "posewright/support/error.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

std::vector<Parameter> labels(int count, int nuisance) {
  std::vector<Parameter> parameters;
  for (int j = 0; j < count; ++j)
    parameters.push_back(
        {"p" + std::to_string(j), "m", 0, 0.01 * (j + 1), j < nuisance ? Role::nuisance : Role::interest});
  return parameters;
}

TEST(Evaluate, AgreesWithTheInverseOfTheInformation) {
  const BlockArray blocks = random_blocks(8, 3, 7, 1);
  const Eigen::MatrixXd m = blocks.all().transpose() * blocks.all();
  const Eigen::MatrixXd covariance = m.inverse();
  const Evaluation e = evaluate(blocks, labels(7, 2));
  for (int j = 0; j < 7; ++j) EXPECT_NEAR(e.sigma[j], std::sqrt(covariance(j, j)), 1e-12);
  EXPECT_NEAR(e.log_det_full, std::log(m.determinant()), 1e-10);
  const Eigen::MatrixXd schur = covariance.bottomRightCorner(5, 5).inverse();
  EXPECT_NEAR(e.log_det, std::log(schur.determinant()), 1e-10);
  EXPECT_NEAR(e.contribution.sum(), 1, 1e-12);
}

TEST(Evaluate, MeasuringEverythingTwiceHalvesEveryVariance) {
  const BlockArray once = random_blocks(8, 3, 7, 2);
  const BlockArray twice = once.subset({0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7});
  const Evaluation a = evaluate(once, labels(7, 0)), b = evaluate(twice, labels(7, 0));
  for (int j = 0; j < 7; ++j) EXPECT_NEAR(b.sigma[j] * b.sigma[j] * 2, a.sigma[j] * a.sigma[j], 1e-12);
  EXPECT_NEAR(b.indices.o1, a.indices.o1, 1e-12);
}

TEST(Evaluate, OrderOfPosesDoesNotMatter) {
  const BlockArray blocks = random_blocks(8, 2, 7, 3);
  const Evaluation a = evaluate(blocks, labels(7, 3)),
                   b = evaluate(blocks.subset({7, 3, 1, 0, 2, 6, 5, 4}), labels(7, 3));
  EXPECT_NEAR(a.log_det, b.log_det, 1e-11);
}

TEST(Evaluate, RankDeficiencyNamesAParameter) {
  BlockArray blocks = random_blocks(8, 2, 4, 4);
  for (std::size_t i = 0; i < 8; ++i) blocks.block(i).col(2) = 3 * blocks.block(i).col(1);
  try {
    evaluate(blocks, labels(4, 0));
    FAIL() << "accepted";
  } catch (const CannotDo& error) {
    EXPECT_NE(std::string(error.what()).find("p2"), std::string::npos) << error.what();
  }
  EXPECT_THROW(evaluate(random_blocks(1, 2, 4, 4), labels(4, 0)), CannotDo);
}

TEST(Evaluate, AListThatGrowsHasAtEveryPoseTheFiguresOfTheWhole) {
  const BlockArray blocks = random_blocks(12, 2, 7, 5);
  for (const Prior prior : {Prior::none, Prior::every}) {
    GrowingEvaluation growing(labels(7, 2), prior);
    std::vector<int> before;
    for (int i = 0; i < 12; ++i) {
      growing.add(blocks.block(std::size_t(i)));
      before.push_back(i);
      if (prior == Prior::none && i < 3) {
        EXPECT_THROW(growing.figures(), CannotDo) << i;
        continue;
      }
      const Evaluation now = growing.figures(), whole = evaluate(blocks.subset(before), labels(7, 2), prior);
      EXPECT_NEAR(now.log_det, whole.log_det, 1e-10) << i;
      EXPECT_NEAR(now.log_det_full, whole.log_det_full, 1e-10) << i;
      EXPECT_LT((now.sigma - whole.sigma).norm(), 1e-11 * whole.sigma.norm()) << i;
      EXPECT_LT((now.covariance - whole.covariance).norm(), 1e-10 * whole.covariance.norm()) << i;
    }
  }
}

}  // namespace
}  // namespace posewright
