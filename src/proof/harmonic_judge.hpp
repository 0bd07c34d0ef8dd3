#pragma once

#include <utility>
#include <vector>

#include "box_tensor.hpp"
#include "harmonic_limits.hpp"
#include "part_squares.hpp"
#include "posewright/proof/harmonic_bound.hpp"
#include "refuting_places.hpp"

namespace posewright {

/// Bounds Σ_k s_k(r_k) ‖B_k T‖² on boxes (theory.md eq. (39), (56)). One thread's.
class HarmonicJudge : public BoxJudge {
 public:
  HarmonicJudge(const HarmonicSensitivity& function, const Refutation* refutation);
  void judge(SearchBox& box, double enough, LargestFound& found) override;

 private:
  /// Limits of distances, of their differences to the mean, and of the multiplier. False: the instrument may stand in
  /// this box, for all that is known.
  bool put_distances(SearchBox& box);
  /// All terms with the bounds of their factors. @return sum of the sizes of what was added
  double combine();
  /// Values of all axes, by the axis.
  template <class Axis>
  void place(const Axis& value_of);
  /// The sensitivity at those values; `found` takes it if no limit forbids them.
  double look(const SearchBox& box, LargestFound& found);
  /// Excess of the sensitivity by the bounds of factors at the last place. @param loosest  term of the most
  double loose_bound(std::size_t& loosest) const;
  void choose_axis(SearchBox& box, double middle);

  const HarmonicSensitivity& function_;
  BoxTensor tensor_, multiplier_;
  BoxTensor mean_, other_;  ///< of the multiplier, with the degrees of distances; of one distance
  std::vector<DistanceRanges> ranges_;
  std::vector<double> gaps_;  ///< of the terms' factors
  struct Varied {
    int distance = 0, difference = 0;
  };
  std::vector<Varied> varied_;  ///< axes along which distances and differences vary most
  std::vector<int> axes_;       ///< along which a term's factor becomes tighter
  PartSquares parts_;
  BoxLimits limits_;
  RefutingPlaces refuting_;
  using Added = std::vector<std::pair<double, const double*>>;
  Added added_, added_low_;  ///< tensors, and how many times each is added
  std::vector<double> low_, values_;
};

}  // namespace posewright
