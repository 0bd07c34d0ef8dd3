#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "posewright/support/monitor.hpp"

namespace posewright {

/// A part of a box of variables, and what is proved of a function there.
struct SearchBox {
  std::vector<double> lower, upper;
  int function = 0;  ///< of several over boxes of their own
  double bound = std::numeric_limits<double>::infinity();
  int longest = 0;  ///< axis along which it is halved
  int also = -1;    ///< another one, where one is certainly not enough; −1: none
  bool operator<(const SearchBox& other) const { return bound < other.bound; }
};

struct FoundPlace {
  double value = -std::numeric_limits<double>::infinity();
  std::vector<double> where{};
  int function = 0;
};

/// Largest value found so far, and where.
struct LargestFound : FoundPlace {
  FoundPlace refuting{};  ///< the largest of those that a judge is told to look for beside it
};

/// Bounds a function on boxes. One a thread.
class BoxJudge {
 public:
  virtual ~BoxJudge() = default;
  /// Fills the box's bound and, where that exceeds `enough`, the axis to halve it along; values that exceed `found`
  /// take its place. The result must not depend on what was judged before.
  virtual void judge(SearchBox& box, double enough, LargestFound& found) = 0;
  /// So many boxes take little longer together than one.
  virtual std::size_t together() const { return 1; }
  /// Judges each; those of one call may share rounding. @param found  one a box
  virtual void judge_together(std::span<SearchBox> boxes, double enough, std::span<LargestFound> found) {
    for (std::size_t i = 0; i < boxes.size(); ++i) judge(boxes[i], enough, found[i]);
  }
};

struct BoxSearchOptions {
  double slack = 0.0;       ///< of values of the function itself, added to the bound
  double tolerance = 1e-3;  ///< stop where the bound is at most (1 + tolerance) times the largest value found
  double enough = -std::numeric_limits<double>::infinity();  ///< or where the bound is at most this
  long most_boxes = 20000;                                   ///< stop then, with the bound reached
  int threads = 0;
  /// Boxes take a millisecond or more each: worth sharing with other processes. Then a judge says all by box and found.
  bool shared = false;
};

struct BoxSearchResult {
  double bound = 0.0;     ///< no value in the boxes is larger
  double largest = 0.0;   ///< found
  LargestFound found{};   ///< where
  long boxes = 0;         ///< judged
  bool complete = false;  ///< not stopped before its tolerance
  bool stopped = false;   ///< by the monitor
};

/// Branch and bound: the boxes of the largest bound are halved until no bound exceeds the largest value found by more
/// than the tolerance. Stopped at any time it leaves a bound. Boxes are judged in rounds of a fixed number, each by
/// what the rounds before found, so that threads and processes (support/tasks.hpp) do not matter.
/// @param first  boxes to begin with, together everything
BoxSearchResult largest_value(std::vector<SearchBox> first, const std::function<std::unique_ptr<BoxJudge>()>& make,
                              const BoxSearchOptions& options, const Monitor& monitor);

}  // namespace posewright
