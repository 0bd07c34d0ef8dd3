// Which configurations stand for a long list: counted one by one.

#include "posewright/study/columns.hpp"

#include <gtest/gtest.h>

#include "posewright/study/study.hpp"

namespace posewright {
namespace {

/// n configurations of a joint and an instrument; instruments take turns.
Configurations taking_turns(int n, int instruments) {
  Configurations list;
  list.dimension = 2;
  for (int i = 0; i < n; ++i) append(list, std::vector<double>{double(i), double(i % instruments)});
  return list;
}

TEST(Thinned, HasEachInstrumentsShareWhereTheyTakeTurns) {
  const std::vector<Coordinate> coordinates = {{"q", "rad", 0, 1e4},
                                               make_choice("instrument", {"a", "b", "c", "d", "e", "f"})};
  for (const int instruments : {1, 2, 3, 6})
    for (const int n : {800, 1200, 2401}) {
      const Configurations few = thinned(taking_turns(n, instruments), coordinates, 400);
      ASSERT_EQ(few.count(), 400U);
      std::vector<int> reads(6);
      for (std::size_t i = 0; i < few.count(); ++i) {
        ++reads[std::size_t(few[i][1])];
        if (i > 0) EXPECT_LT(few[i - 1][0], few[i][0]) << "in the order of the list";
      }
      for (int k = 0; k < instruments; ++k) EXPECT_NEAR(reads[std::size_t(k)], 400.0 / instruments, 1.01);
    }
}

TEST(Thinned, IsEvenWithoutChoices) {
  const std::vector<Coordinate> coordinates = {{"q", "rad", 0, 1e4}, {"r", "rad", 0, 10}};
  const Configurations few = thinned(taking_turns(1000, 7), coordinates, 250);
  for (std::size_t i = 0; i < few.count(); ++i) EXPECT_EQ(few[i][0], 4.0 * double(i));
  EXPECT_EQ(thinned(taking_turns(10, 7), coordinates, 250).count(), 10U);
}

}  // namespace
}  // namespace posewright
