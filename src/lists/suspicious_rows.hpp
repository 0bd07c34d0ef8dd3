#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "posewright/model/identification_model.hpp"

namespace posewright {

/// Rows of a file of readings that look like no reading: a lost target as 0, 0, 0, a code such as −9999 for nothing,
/// the numbers of the row before at other joints, an id that another configuration has.
class SuspiciousRows {
 public:
  explicit SuspiciousRows(const IdentificationModel& model) : model_(model) {}

  /// @param id  0: the row has none
  /// @param y   SI, NaN: not read
  void add(int id, int line, const std::vector<double>& q, const Eigen::VectorXd& y);
  /// One for each kind that was found, with the lines.
  std::vector<std::string> notes(const std::string& file) const;

 private:
  void look_for_codes(int line, const Eigen::VectorXd& y);
  bool moved(const std::vector<double>& from, const std::vector<double>& to) const;

  const IdentificationModel& model_;
  std::map<std::string, std::vector<int>> lines_;      ///< of each kind
  std::map<int, std::vector<double>> configurations_;  ///< of each id
  std::vector<double> last_q_;
  Eigen::VectorXd last_y_;
};

}  // namespace posewright
