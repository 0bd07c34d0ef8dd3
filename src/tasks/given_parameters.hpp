#pragma once

#include <map>
#include <string>
#include <vector>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/calibration/score_tests.hpp"
#include "posewright/model/variant.hpp"
#include "posewright/tasks/calibrate_problem.hpp"

namespace posewright {

/// Parameters whose estimates are right only where something that is left out is nominal: they have neither σ nor
/// interval, and what is written has none.
class GivenParameters {
 public:
  /// Those that hang on what was left out of `among`; none where a convention left it out, by which it is zero.
  void take(const std::vector<Dependency>& left_out, const VariantColumns& among);
  /// Those that an effect would move farther than their intervals reach, `stretch` standard deviations.
  /// @return a note for people; empty if there are none
  std::string take(const ScoreTest& effect, const std::vector<Parameter>& fitted, const Eigen::MatrixXd& covariance,
                   double stretch);
  /// What people must know of those that hang on what is left out; empty if there are none.
  std::string note(const std::vector<CalibratedParameter>& left_out) const;

  bool contains(const std::string& name) const { return on_.contains(name); }
  /// Whether one of a frame's angles is among them.
  bool turn(const std::string& frame) const;
  /// Takes σ and interval from a parameter that is among them.
  void mark(CalibratedParameter& p) const;

 private:
  std::map<std::string, std::vector<std::string>> on_;  // by name: what it hangs on
};

}  // namespace posewright
