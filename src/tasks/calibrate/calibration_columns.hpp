#pragma once

#include <map>
#include <string>
#include <vector>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/calibration/fit.hpp"
#include "posewright/calibration/score_tests.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/tasks/calibrate_problem.hpp"

namespace posewright {

/// Parameters whose estimates are right only where something that is left out is nominal: they have neither σ nor
/// interval, and what is written has none.
class GivenParameters {
 public:
  /// Parameters that depend on those left out of `among`; none if a convention sets these to zero.
  void take(const std::vector<Dependency>& left_out, const VariantColumns& among);
  /// Parameters that an effect would move beyond their intervals, `stretch` standard deviations.
  /// @return a note for messages; empty if there are none
  std::string take(const ScoreTest& effect, const std::vector<Parameter>& fitted, const Eigen::MatrixXd& covariance,
                   double stretch);
  /// Note on parameters that depend on left-out ones; empty if there are none.
  std::string note(const std::vector<CalibratedParameter>& left_out) const;

  bool contains(const std::string& name) const { return on_.contains(name); }
  /// True if one of a frame's angles is among them.
  bool turn(const std::string& frame) const;
  /// Takes σ and interval from a parameter that is among them.
  void mark(CalibratedParameter& p) const;

 private:
  std::map<std::string, std::vector<std::string>> on_;  // by name: what it hangs on
};

/// Columns that a calibration estimates, and those of its variant that it holds or drops.
struct ChosenColumns {
  VariantColumns columns;
  std::vector<CalibratedParameter> left_out;  ///< nominal
  GivenParameters given;
};

/// Columns that these poses determine, judged where things stand: at the origin of the flange a target would say
/// nothing of the wrist.
/// @param all     of the variant
/// @param placed  corrections with base and tool alone
ChosenColumns chosen_columns(const IdentificationModel& model, const VariantColumns& all,
                             const std::vector<MeasuredPose>& poses, const std::vector<double>& placed, Prior prior);

}  // namespace posewright
