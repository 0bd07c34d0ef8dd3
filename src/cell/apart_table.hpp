#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace posewright {

struct BodyPair;
struct Scene;

/// Lower bounds of the distance beyond the clearance, for pairs that few coordinates move: cells of
/// these coordinates' ranges, each with what the pair has in its middle, less what it may lose on the way from there
/// (BodyPair::approach). A cell is measured when it is first asked for, at the same state whoever asks, so that answers
/// depend on nothing else. Const and callable from several threads.
class ApartTable {
 public:
  static constexpr std::size_t most_axes = 2;
  struct Axis {
    std::size_t coordinate;
    double lower, upper;  ///< rad or m
    double period;        ///< 0: none
    double approach;      ///< m per rad or m, of BodyPair
  };

  /// @param middle  a configuration, whose other coordinates the pair does not depend on
  /// @param room    m beyond its clearance that the pair hardly ever has: cells that would need more are left out
  ApartTable(std::vector<Axis> axes, std::vector<double> middle, double room);

  /// A lower bound (m) that is above `enough`, or −1: outside the table, or too near for its cells to tell.
  /// @param pair  the one of this table, of `scene`
  double spare_at_least(const Scene& scene, const BodyPair& pair, std::span<const double> q, double enough) const;

 private:
  /// Cells of one size. A pair that is far apart is told by the large ones, of which there are few.
  struct Level {
    std::vector<int> counts;  // per axis
    double reach;             // m that a pair may lose within a cell
    std::unique_ptr<std::atomic<float>[]> spare;
  };

  double measure(const Scene& scene, const BodyPair& pair, const Level& level, std::span<const int> cell) const;
  double middle_of(const Level& level, std::size_t axis, int cell) const;

  std::vector<Axis> axes_;
  std::vector<double> middle_;
  std::vector<Level> levels_;
};

}  // namespace posewright
