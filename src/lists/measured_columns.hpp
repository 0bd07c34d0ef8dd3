#pragma once

#include <map>
#include <string>
#include <vector>

#include "orientation_columns.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Columns of a file of readings: where coordinates and readings of a model are, and their values in SI.
class MeasuredColumns {
 public:
  /// Throws InputError if a coordinate or all readings are missing, a name stands twice, a cell is not a value.
  MeasuredColumns(const std::string& bytes, const std::string& file, const MeasurementSpec& measurement,
                  const IdentificationModel& model);

  int rows() const { return int(table_.rows.size()); }
  int line(int row) const { return table_.rows[std::size_t(row)].line; }
  const std::vector<double>& configuration(int row) const { return configurations_[std::size_t(row)]; }
  Eigen::VectorXd readings(int row) const;
  /// Columns NAME.x, NAME.y, NAME.z as a point (m); NaN if one is not there or not read.
  Eigen::Vector3d point(int row, const std::string& name) const;
  /// The cell of a column, empty if there is none.
  std::string text(int row, const std::string& column) const;
  const OrientationForm& orientation() const { return orientation_.form(); }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void index_columns();
  void find_joined(const MeasurementSpec& measurement);
  void find_readings();
  void read_configurations(const std::string& bytes);
  void from_actuators();
  bool has(const std::string& name) const { return column_.count(name) > 0; }
  /// NaN for an empty cell.
  double value(int row, const std::string& column, const std::string& unit) const;
  /// 0 for joined tips without a column.
  double reading_of(int row, const Reading& reading) const;
  /// Columns of an orientation in another form.
  Eigen::Vector3d rotation_vector(int row) const;
  bool turned() const { return orientation_.found() && orientation().kind != OrientationForm::vector; }
  Eigen::VectorXd pose_of_points(int row) const;
  SourcePlace header() const { return {file_, table_.header}; }

  std::string file_;
  const IdentificationModel& model_;
  PoseTable table_;
  std::map<std::string, std::size_t> column_;
  std::vector<std::vector<double>> configurations_;
  std::vector<TargetSpec> markers_;       ///< of a photogrammetric pose that is given by its points; else empty
  OrientationColumns orientation_;        ///< of the readings
  std::map<std::string, double> joined_;  ///< readings of joined tips, 0 without a column: their instrument
  std::vector<std::string> notes_;
};

}  // namespace posewright
