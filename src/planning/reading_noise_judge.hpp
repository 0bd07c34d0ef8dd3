#pragma once

#include <vector>

#include "box_sum.hpp"
#include "box_tensor.hpp"
#include "fitted_readings.hpp"
#include "harmonic_limits.hpp"
#include "posewright/planning/reading_noise_bound.hpp"
#include "random_products.hpp"
#include "refuting_places.hpp"

namespace posewright {

/// Bounds ‖B T − Z U‖² + ‖U‖² on boxes, U of each box its own (theory.md eq. (61)). One thread's.
class ReadingNoiseJudge : public BoxJudge {
 public:
  ReadingNoiseJudge(const ReadingNoiseSensitivity& function, const Refutation* refutation);
  void judge(SearchBox& box, double enough, LargestFound& found) override;

 private:
  /// Records a place in the box with this d.
  void look(const SearchBox& box, const std::vector<double>& values, double d, LargestFound& found);
  /// All terms of the sum for the fitted U. @return more than they are off by
  double combine();
  /// Σ U_iᵀ A U_k of the term's power of y.
  double put_squares(std::size_t term, BoxSum::Term& to);
  /// −2 tr(U_iᵀ R) as well.
  double add_mixed(std::size_t term);
  double add_products(const ReadingNoiseSensitivity::Kind& kind, BoxSum::Term& to);

  const ReadingNoiseSensitivity& function_;
  RandomProducts products_;
  FittedReadings fitted_;
  BoxLimits limits_;
  RefutingPlaces refuting_;
  BoxSum sum_;
  BoxTensor tensor_;
  std::vector<std::vector<std::size_t>> term_of_;  ///< of U_i and U_k
  std::vector<Eigen::MatrixXd> W_, W_sizes_;       ///< Σ U_i U_kᵀ of each term, and of sizes
  std::vector<double> middle_;                     ///< of the box
  std::vector<double> factors_, sizes_;            ///< of each product, and without cancellation
  Eigen::VectorXd own_, low_;
  Eigen::MatrixXd V_, V_sizes_;
  BoxSum::Term squares_, mixed_;
};

}  // namespace posewright
