#include <gtest/gtest.h>

#include <numeric>

#include "posewright/search/search.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

std::vector<SearchPart> part_of(const BlockArray& blocks, int nuisance) {
  std::vector<int> all(blocks.count());
  std::iota(all.begin(), all.end(), 0);
  std::vector<SearchPart> parts;
  parts.push_back({blocks.subset(all), nuisance, 1.0, Eigen::VectorXd::Ones(blocks.columns())});
  return parts;
}

SearchRequest request_for(const char* criterion) {
  SearchRequest request;
  request.criterion = criterion;
  request.method = "exchange";
  request.poses = 8;
  request.planner.threads = 1;
  return request;
}

TEST(CandidateBounds, OneAfterTheOtherIsEachByItself) {
  for (const int nuisance : {0, 2}) {
    const BlockArray blocks = random_blocks(300, 2, 6, std::uint64_t(60 + nuisance));
    CandidateBounds bounds(part_of(blocks, nuisance), request_for("o1"));
    // Backwards, too: whatever came before leaves each bound what it is.
    for (const char* criterion : {"o1", "a", "o3", "o4", "o5", "o2", "o3", "a", "o1"}) {
      const Bound expected = bound_only(part_of(blocks, nuisance), request_for(criterion), Monitor{});
      const Bound found = bounds.of(criterion, Monitor{});
      ASSERT_EQ(found.certificate.proved, expected.certificate.proved) << criterion;
      if (!expected.certificate.proved) continue;
      EXPECT_NEAR(found.certificate.bound, expected.certificate.bound, 1e-7) << criterion << ", " << nuisance;
      EXPECT_EQ(found.degree, expected.degree);
    }
  }
}

}  // namespace
}  // namespace posewright
