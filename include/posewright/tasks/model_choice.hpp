#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/tasks/calibrate_problem.hpp"

namespace posewright {

/// One model of several that were fitted to the same data.
struct JudgedModel {
  std::string variant;
  double parameters = 0.0;  ///< that the readings pay for: tr(H), less than estimated where tolerances count
  double left_out = 0.0;    ///< root mean square of whitened residuals of poses left out; infinite: none
  /// n ln(Σr²/n) + 2k + 2k(k + 1)/(n − k − 1), k = parameters + 1 for the size of the noise (Hurvich & Tsai 1989,
  /// Biometrika 76(2)); none where readings are too few, or count as correlated or robustly.
  std::optional<double> aicc{};
  /// The largest of the others that estimates some of this one's parameters and no others; empty: none.
  std::string against;
  /// F test of the parameters beyond it; none as for aicc.
  std::optional<double> f{}, probability{};
};

struct ModelChoice {
  std::vector<JudgedModel> models;  ///< in the order given
  std::string recommended;          ///< empty: none
  std::string why;
};

/// The model of the fewest parameters that predicts poses left out no worse than the best one does: its loss, paired
/// over the poses, is within one standard error (Breiman et al. 1984). Models that did not converge or predict no
/// better than base and tool alone are out.
ModelChoice choose_model(const std::vector<Calibration>& models);

}  // namespace posewright
