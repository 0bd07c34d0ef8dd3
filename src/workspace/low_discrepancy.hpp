#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace posewright {

/// Sobol points in [0, 1)^d, Owen-scrambled by a hash of the seed (Laine & Karras 2011; Burley 2020, JCGT 9(4)).
class LowDiscrepancy {
 public:
  /// 1 ≤ dimension ≤ 3667.
  LowDiscrepancy(int dimension, std::uint64_t seed);
  ~LowDiscrepancy();
  /// The next point; size of `point` = dimension.
  void next(std::span<double> point);

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace posewright
