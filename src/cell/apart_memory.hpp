#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene.hpp"

namespace posewright {

/// Cache of one thread for pairs at earlier states: a pair that had s to spare beyond its clearance at
/// q₀ keeps it at every q with Σ approach_k |q_k − q₀_k| < s (the bound that motions are followed with; Schwarzer, Saha
/// & Latombe 2005). Searches and bisections ask for states next to each other, so most pairs are not looked at again.
class ApartMemory {
 public:
  /// Cache of the calling thread for this scene; empty if its last scene was another.
  static ApartMemory& of(const Scene& scene);

  /// True if the pair is known to keep its clearance at q, with `certain` to spare. `certain` is the possible error
  /// of a distance, so the verdict equals that of a measurement.
  bool covers(const BodyPair& pair, std::size_t place, int pose, std::span<const double> q) const {
    return spare_[place] > certain && moved(pair, place, pose, q) < spare_[place] - certain;
  }
  /// True if the state that the pair was last looked at is so near that it pays to know how much more than its
  /// clearance it has.
  bool is_near(const BodyPair& pair, std::size_t place, int pose, std::span<const double> q) const {
    return looked_at(place) && moved(pair, place, pose, q) < look_ahead;
  }
  /// True if the pair is known to be nearer than its clearance at q: it lacked s of it at q₀.
  bool is_too_near(const BodyPair& pair, std::size_t place, int pose, std::span<const double> q) const {
    return looked_at(place) && spare_[place] < -certain && moved(pair, place, pose, q) < -spare_[place] - certain;
  }
  void keep(std::size_t place, std::span<const double> q, double spare);

 private:
  static constexpr double never = -1e9;

  bool looked_at(std::size_t place) const { return spare_[place] > never; }
  double moved(const BodyPair& pair, std::size_t place, int pose, std::span<const double> q) const;
  void forget(const Scene& scene);

  std::uint64_t scene_ = 0;
  std::size_t dimension_ = 0;
  std::vector<double> spare_;   // per pair and pose, m; negative: what it lacks of its clearance
  std::vector<double> states_;  // per pair and pose, a configuration
};

}  // namespace posewright
