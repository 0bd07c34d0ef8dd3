#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posewright/model/serial_chain.hpp"
#include "posewright/model/urdf_ways.hpp"

namespace posewright {

/// One way of an arm with several tips: a serial chain with the configuration and the parameters of all ways, so that
/// joints that these share are there once. What is not on its own way does not move its tip. Parameters: of each way
/// where its measurement frame is, base.* or base@IN.*, and its joints; then tool@TIP.* of each tip whose pose some
/// instrument reads without targets of its own.
class ForkedChain : public TipModel {
 public:
  /// @param own    index of its way
  /// @param tools  per way: an instrument on it depends on where the tool is
  /// @param tool   that of this chain does
  ForkedChain(const WayChains& all, std::size_t own, const std::vector<char>& tools, bool tool);

  /// Per coordinate: it is on this way.
  const std::vector<char>& moving() const { return moving_; }

  bool linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X_MeasureTip, Twists& twists,
                 Twists* reading_twists) const override;
  bool pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                 std::span<double> gradient) const override;
  int offset_of(int coordinate) const override { return offsets_[std::size_t(coordinate)]; }

 private:
  std::vector<double> configuration(std::span<const double> q) const;
  std::vector<double> corrections(std::span<const double> correction) const;
  std::vector<int> own_columns(std::span<const int> selected) const;

  SerialChain chain_;
  std::vector<std::size_t> coordinates_at_;  // of each coordinate of the chain: among all
  std::vector<int> own_;                     // per parameter: its index in the chain; beyond its own: none of it
  std::vector<char> moving_;
  std::vector<int> offsets_;  // per coordinate
};

/// Names of a way's frames among the parameters.
std::string base_name(const WaySpec& way);  ///< "base" or "base@eye"
std::string tool_name(const WaySpec& way);  ///< "tool@left"

}  // namespace posewright
