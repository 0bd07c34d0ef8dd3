#include "measured_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/calibration/rigid_fit.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/lists/samples.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/instrument_view.hpp"
#include "posewright/model/rotation_vector.hpp"
#include "posewright/problem/units.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr double not_read = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<const char*, 3> point_axes = {".x", ".y", ".z"};
// What bends by more than this share of its size is another body, or its points are mixed up.
constexpr double largest_deformation = 0.05;

/// Component of an orientation, alone or in a list of instruments.
bool is_turn(const Reading& reading) { return reading.name.find("pose.r") != std::string::npos; }

}  // namespace

MeasuredColumns::MeasuredColumns(const std::string& bytes, const std::string& file, const MeasurementSpec& measurement,
                                 const IdentificationModel& model)
    : file_(file),
      model_(model),
      table_(samples_or_csv(bytes.starts_with("\xef\xbb\xbf") ? bytes.substr(3) : bytes, file)) {
  index_columns();
  if (InstrumentView view = view_of(measurement); view.fits_pose) markers_ = std::move(view.targets);
  find_joined(measurement);
  find_readings();
  read_configurations(bytes);
}

void MeasuredColumns::find_joined(const MeasurementSpec& measurement) {
  const auto* list = instruments_of(measurement);
  for (std::size_t k = 0; k < (list == nullptr ? 1 : list->size()); ++k) {
    const MeasurementSpec& one = list == nullptr ? measurement : (*list)[k];
    if (!joins_tips(one)) continue;
    for (const Reading& reading : model_.readings())
      if (list == nullptr || reading.name.starts_with(reading_in(one.name, ""))) joined_[reading.name] = double(k);
  }
}

void MeasuredColumns::index_columns() {
  for (std::size_t i = 0; i < table_.names.size(); ++i) {
    const std::string name = table_.names[i] == "pose" ? "id" : table_.names[i];
    if (!name.empty() && !column_.emplace(name, i).second)
      throw InputError(header(), "has column '" + name + "' twice", "each name once");
  }
}

void MeasuredColumns::find_readings() {
  int found = 0;
  std::string names;
  orientation_ = OrientationColumns("pose", table_.names, header());
  const auto given = [&](const Reading& reading) {
    return has(reading.name) || joined_.count(reading.name) > 0 || (turned() && reading.name.starts_with("pose.r"));
  };
  for (const Reading& reading : model_.readings()) {
    found += given(reading) ? 1 : 0;
    if (names.size() < 200) names += (names.empty() ? "" : ", ") + reading.name;
  }
  const bool by_points =
      !markers_.empty() && found == 0 && std::all_of(markers_.begin(), markers_.end(), [&](const TargetSpec& m) {
        return has(m.name + ".x") && has(m.name + ".y") && has(m.name + ".z");
      });
  if (!by_points) markers_.clear();
  if (found == 0 && !by_points) throw InputError(header(), "has no column of a reading", "names of readings: " + names);
  if (found < int(model_.readings().size()) && !by_points) {
    std::string missing;
    for (const Reading& reading : model_.readings())
      if (!given(reading)) missing += (missing.empty() ? "" : ", ") + reading.name;
    notes_.push_back("no column for " + missing + ": counted as not read");
  }
  const auto angles = std::ranges::count_if(model_.readings(), is_turn);
  if ((angles == 1 || angles == 2) && (by_points || turned()))
    throw InputError(header(), "has whole orientations, and the instrument reads some of rx, ry, rz",
                     "pose.rx, …: components of the rotation vector from the nominal orientation");
  if (by_points) notes_.push_back("poses are rigid fits to the photogrammetric points");
}

void MeasuredColumns::read_configurations(const std::string& bytes) {
  const auto& actuators = model_.actuators();
  const bool coordinates =
      std::all_of(model_.coordinates().begin(), model_.coordinates().end(),
                  [&](const Coordinate& c) { return has(c.name) || (c.choice() && c.labels.size() == 1); });
  if (!coordinates && !actuators.empty() &&
      std::all_of(actuators.begin(), actuators.end(), [&](const Coordinate& a) { return has(a.name); })) {
    from_actuators();
    return;
  }
  PoseList list = read_poses_text(bytes, file_, without_limits(model_.coordinates()), "");
  configurations_ = std::move(list.configurations);
  notes_.insert(notes_.end(), list.notes.begin(), list.notes.end());
  for (int i = 0; i < rows(); ++i)
    for (std::size_t k = 0; k < model_.coordinates().size(); ++k) {
      const Coordinate& c = model_.coordinates()[k];
      const double value = configurations_[std::size_t(i)][k];
      if (!c.choice() && c.discrete() && !std::binary_search(c.values.begin(), c.values.end(), value))
        throw InputError({file_, line(i)}, fmt::format("'{}' is {:.6g} {}", c.name, value, c.unit),
                         fmt::format("at one of the listed positions: {:.6g}", fmt::join(c.values, ", ")));
    }
}

/// The nominal robot with these actuators: what the model takes for the configuration.
void MeasuredColumns::from_actuators() {
  std::vector<double> start;
  for (const Coordinate& c : model_.coordinates())
    start.push_back(c.discrete() ? c.values.front() : std::clamp(0.0, c.lower, c.upper));
  std::vector<double> actuators, q(start.size());
  for (int i = 0; i < rows(); ++i) {
    actuators.clear();
    for (const Coordinate& a : model_.actuators()) {
      actuators.push_back(value(i, a.name, a.unit));
      if (!std::isfinite(actuators.back()))
        throw InputError({file_, line(i)}, "'" + a.name + "' is empty", "every actuator of a pose");
    }
    if (!model_.configuration_at(actuators, start, q))
      throw InputError({file_, line(i)}, "no pose of the nominal robot has these actuators", "are their units right?");
    for (std::size_t k = 0; k < q.size(); ++k) {
      const Coordinate& c = model_.coordinates()[k];
      if (!c.choice() || c.labels.size() < 2) continue;
      const auto at = std::find(c.labels.begin(), c.labels.end(), text(i, c.name));
      if (at == c.labels.end())
        throw InputError({file_, line(i)}, "'" + text(i, c.name) + "' is no " + c.name,
                         fmt::format("allowed: {}", fmt::join(c.labels, ", ")));
      q[k] = c.values[std::size_t(at - c.labels.begin())];
    }
    configurations_.push_back(q);
  }
}

std::string MeasuredColumns::text(int row, const std::string& column) const {
  const auto at = column_.find(column);
  if (at == column_.end()) return {};
  return std::get<std::string>(table_.rows[std::size_t(row)].cells[at->second]);
}

double MeasuredColumns::value(int row, const std::string& column, const std::string& unit) const {
  std::string cell = text(row, column);
  // Tables of numbers write nan for what is missing.
  if (cell.empty() || cell == "nan" || cell == "NaN" || cell == "NA") return not_read;
  const std::string written = table_.units.empty() ? "" : table_.units[column_.at(column)];
  if (!written.empty() && written != "px") cell += " " + written;
  const Quantity quantity = unit == "m" ? Quantity::length : unit == "rad" ? Quantity::angle : Quantity::number;
  try {
    return parse_value(cell, quantity);
  } catch (const InputError&) {
    throw InputError({file_, line(row)}, fmt::format("'{}' of '{}' is not a value", cell.substr(0, 40), column),
                     unit == "px" ? "a number" : "a number; in the header, a unit: " + allowed_units({quantity}));
  }
}

Eigen::Vector3d MeasuredColumns::rotation_vector(int row) const {
  const auto R = orientation_.rotation(
      [&](const std::string& column, const std::string& unit) { return value(row, column, unit); }, {file_, line(row)});
  return R ? posewright::rotation_vector(*R) : Eigen::Vector3d::Constant(not_read);
}

Eigen::Vector3d MeasuredColumns::point(int row, const std::string& name) const {
  Eigen::Vector3d p = Eigen::Vector3d::Constant(not_read);
  for (Eigen::Index k = 0; k < 3; ++k)
    if (const std::string column = name + point_axes[std::size_t(k)]; has(column)) p[k] = value(row, column, "m");
  return p;
}

Eigen::VectorXd MeasuredColumns::pose_of_points(int row) const {
  std::vector<Eigen::Vector3d> body, measured;
  for (const TargetSpec& marker : markers_) {
    const Eigen::Vector3d p = point(row, marker.name);
    if (!p.allFinite()) continue;
    body.push_back(marker.position);
    measured.push_back(p);
  }
  Eigen::VectorXd pose = Eigen::VectorXd::Constant(6, not_read);
  // The covariance of a pose is that of all its points; one of fewer would be trusted too much.
  if (body.size() < markers_.size()) return pose;
  const RigidFit fit = rigid_fit(body, measured);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : body) centre += p / double(body.size());
  double size = 0;
  for (const Eigen::Vector3d& p : body) size += (p - centre).squaredNorm() / double(body.size());
  if (fit.rms > largest_deformation * std::sqrt(size))
    throw InputError({file_, line(row)},
                     fmt::format("the points fit no rigid body: {:.4g} mm are left of one of {:.4g} mm", 1e3 * fit.rms,
                                 1e3 * std::sqrt(size)),
                     "points in the order, units and places of measurement: device: points");
  pose << fit.X.translation(), posewright::rotation_vector(fit.X.linear());
  return pose;
}

double MeasuredColumns::reading_of(int row, const Reading& reading) const {
  const auto joined = joined_.find(reading.name);
  if (has(reading.name) || joined == joined_.end()) return value(row, reading.name, reading.unit);
  const auto instrument = instrument_index(model_.coordinates());
  return !instrument || configuration(row)[*instrument] == joined->second ? 0.0 : not_read;
}

Eigen::VectorXd MeasuredColumns::readings(int row) const {
  const auto count = Eigen::Index(model_.readings().size());
  Eigen::VectorXd all(6);
  if (!markers_.empty()) all = pose_of_points(row);
  else if (turned()) all << Eigen::Vector3d::Constant(not_read), rotation_vector(row);
  const bool whole = !markers_.empty();
  static constexpr std::array<const char*, 6> pose_names = {"pose.x",  "pose.y",  "pose.z",
                                                            "pose.rx", "pose.ry", "pose.rz"};
  Eigen::VectorXd y(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Reading& reading = model_.readings()[std::size_t(i)];
    const auto at = std::find(pose_names.begin(), pose_names.end(), reading.name) - pose_names.begin();
    if (at < 6 && (whole || (turned() && at > 2))) y[i] = all[at];
    else y[i] = reading_of(row, reading);
  }
  // A whole rotation vector is one reading of three numbers.
  for (Eigen::Index i = 2; i < count; ++i)
    if (model_.readings()[std::size_t(i)].name.ends_with(pose_names[5]) &&
        is_turn(model_.readings()[std::size_t(i) - 2]) && !y.segment<3>(i - 2).allFinite())
      y.segment<3>(i - 2).setConstant(not_read);
  return y;
}

}  // namespace posewright
