#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "posewright/problem/problem.hpp"
#include "posewright/results/plan.hpp"

namespace posewright {

/// Score of a plan from one choice of stations.
struct StationRank {
  std::vector<StationSpec> stations;
  std::string why_not;           ///< why there is no plan from there; empty: there is one
  bool in_full = false;          ///< planned as `plan` does it; else with few candidates and one start
  bool stopped = false;          ///< not looked at, or only quickly, because the search was ended
  int parameters = 0;            ///< of interest that it identifies
  double phi = 0.0;              ///< criterion as it is maximised, larger is better
  double criterion_value = 0.0;  ///< in its own terms
  /// Ratio of σ to the best choice with as many parameters, if the criterion is a determinant, on the
  /// geometric mean.
  std::optional<double> sigma_ratio;
  double feasible_share = 0.0;  ///< of the configurations drawn
  std::string main_rejection;   ///< why most of the others are not feasible
  std::optional<ExpectedError> expected{};

  /// All but the stations, which whoever asks for it knows.
  static auto fields(auto& own) {
    return std::tie(own.why_not, own.main_rejection, own.parameters, own.stopped, own.phi, own.criterion_value,
                    own.feasible_share, own.expected);
  }
};

/// Text for the terminal of ranked stations, best first, and the best as a problem file has it.
/// @param ranks  at least one
std::string stations_text(const std::vector<StationRank>& ranks);

/// JSON: schema posewright/stations/1.
/// @param criterion  that the places are compared by
nlohmann::ordered_json stations_json(const Problem& problem, std::uint64_t seed, const std::string& criterion,
                                     const std::vector<StationRank>& ranks);

}  // namespace posewright
