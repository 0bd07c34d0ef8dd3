#pragma once

#include <algorithm>
#include <vector>

namespace posewright {

/// Candidates by what each can gain at most, largest first: an exact search looks at them in this order and ends at the
/// first that cannot beat the best so far. A heap, because few of many are asked for.
class ByBound {
 public:
  struct Entry {
    double bound;
    int candidate;
    /// Equal bounds: the earlier candidate first.
    bool operator<(const Entry& other) const {
      return bound != other.bound ? bound < other.bound : candidate > other.candidate;
    }
  };

  void clear() { entries_.clear(); }
  void add(double bound, int candidate) { entries_.push_back({bound, candidate}); }
  /// After the last add().
  void order() { std::make_heap(entries_.begin(), entries_.end()); }
  bool empty() const { return entries_.empty(); }
  /// Takes the first away.
  Entry next() {
    std::pop_heap(entries_.begin(), entries_.end());
    const Entry first = entries_.back();
    entries_.pop_back();
    return first;
  }

 private:
  std::vector<Entry> entries_;
};

}  // namespace posewright
