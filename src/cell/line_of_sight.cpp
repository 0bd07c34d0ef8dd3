#include "posewright/cell/line_of_sight.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "posewright/cell/collision.hpp"
#include "posewright/model/nominal_placement.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/near_words.hpp"

namespace posewright {
namespace {

/// Why a target may be hidden, in the order of cost.
enum Reason { range, elevation, azimuth, field_of_view, acceptance, occluded, reason_count };
constexpr const char* reason_names[reason_count] = {"out of range of",          "elevation at",     "azimuth at",
                                                    "outside field of view of", "facing away from", "occluded from"};

// Of a target that nobody looked for yet.
constexpr int not_known = -2;

bool outside(const std::optional<std::pair<double, double>>& limits, double value) {
  return limits && (value < limits->first || value > limits->second);
}

}  // namespace

/// One configuration: where its tip is, and what hides each target from each station.
struct LineOfSight::Looked {
  std::uint64_t sight = 0;
  std::vector<double> q;
  Eigen::Isometry3d X_MeasureTip;
  std::vector<int> hidden_by[2];  // bodies passed over, and with them
};

LineOfSight::Looked& LineOfSight::looked_at(std::span<const double> q) const {
  static thread_local Looked looked;
  if (looked.sight == number_ && std::equal(q.begin(), q.end(), looked.q.begin(), looked.q.end())) return looked;
  looked.sight = 0;
  looked.q.assign(q.begin(), q.end());
  looked.X_MeasureTip = model_.tool_pose(q);
  for (std::vector<int>& hidden : looked.hidden_by) hidden.assign(station_names_.size() * targets_.size(), not_known);
  looked.sight = number_;
  return looked;
}

std::unique_ptr<LineOfSight> LineOfSight::make(const ProblemFile& file, const MeasurementSpec& instrument,
                                               const std::optional<LineOfSightSpec>& asked,
                                               const IdentificationModel& model, const Collision* collision) {
  std::unique_ptr<LineOfSight> sight(new LineOfSight(file, instrument, asked, model, collision));
  if (!asked) return sight->station_names_.empty() ? nullptr : std::move(sight);
  const std::string key = instrument.name.empty() ? "workspace.line_of_sight" : instrument.name + ": line_of_sight";
  if (sight->station_names_.empty())
    throw InputError(
        file.at(asked->line), key + ": the instrument has no position",
        instrument.name.empty()
            ? "measurement.device.stations are needed (line_of_sight.stations for photogrammetry of a pose)"
            : "device.stations are needed");
  if (sight->targets_.empty())
    throw InputError(file.at(asked->line), key + ": the instrument has no targets to be seen",
                     "line_of_sight is for points, position, camera, and pose by photogrammetry");
  if (sight->all_stations_ && asked->visible > 0 && asked->visible < sight->targets())
    throw InputError(file.at(asked->line), key + ".visible is " + std::to_string(asked->visible),
                     "a pose is fitted to all its points: visible: all");
  if (asked->visible > sight->targets())
    throw InputError(file.at(asked->line), key + ".visible is " + std::to_string(asked->visible),
                     "there are " + std::to_string(sight->targets()) + " targets");
  return sight;
}

std::vector<std::unique_ptr<const LineOfSight>> lines_of_sight(const Problem& problem, const IdentificationModel& model,
                                                               const Collision* collision) {
  std::vector<std::unique_ptr<const LineOfSight>> sights;
  const auto& asked = problem.workspace.line_of_sight;
  const std::vector<MeasurementSpec>* instruments = instruments_of(problem.measurement);
  if (instruments == nullptr) {
    sights.push_back(LineOfSight::make(problem, problem.measurement, asked, model, collision));
    return sights;
  }
  if (asked)
    throw InputError(problem.at(asked->line), "workspace.line_of_sight stands beside a list of instruments",
                     "each instrument has its own key line_of_sight");
  for (const MeasurementSpec& one : *instruments) {
    // Those that read together look by the sights of each; with several tips what nobody asks for has no place.
    const bool looks = members_of(one) == nullptr && (one.line_of_sight || model.moving_coordinates().empty());
    sights.push_back(looks ? LineOfSight::make(problem, one, one.line_of_sight, model, collision) : nullptr);
  }
  return sights;
}

LineOfSight::LineOfSight(const ProblemFile& file, const MeasurementSpec& instrument,
                         const std::optional<LineOfSightSpec>& asked, const IdentificationModel& model,
                         const Collision* collision)
    : spec_(asked.value_or(LineOfSightSpec{})),
      model_(model),
      // What nobody asked for is not judged: places only.
      collision_(asked ? collision : nullptr),
      judges_(asked.has_value()) {
  static std::atomic<std::uint64_t> made{0};
  number_ = ++made;
  const InstrumentView view = view_of(instrument);
  if (view.has_places && !spec_.stations.empty())
    throw InputError(file.at(spec_.line),
                     "workspace.line_of_sight.stations cannot be combined with stations of the device",
                     "stations of trackers belong to measurement.device");
  if (!model.moving_coordinates().empty()) in_ = instrument.in ? instrument.in->value : "";
  all_stations_ = view.all_places;
  station_on_tip_ = view.places_on_tip;
  half_angle_ = spec_.field_of_view ? spec_.field_of_view : view.half_angle;
  if (!spec_.axis) spec_.axis = view.axis;
  std::vector<InstrumentView::Place> places = view.places;
  for (const StationSpec& station : spec_.stations)
    places.push_back({station, "station." + station.name, "station " + station.name});
  for (const InstrumentView::Place& place : places) add_station(place);
  add_points(view);
  for (std::size_t i = 0; i < model.coordinates().size(); ++i)
    if (model.coordinates()[i].choice() && model.coordinates()[i].name == "station") station_coordinate_ = int(i);
  for (const TargetSpec& reference : spec_.references)
    references_.push_back({reference.name, reference.position, std::nullopt});
  add_normals(file);
  take_necessary_places();
}

void LineOfSight::add_station(const InstrumentView::Place& place) {
  station_names_.push_back(place.station.name);
  X_CarrierStation_.push_back(
      nominal_placement(model_.parameters(), place.parameters, isometry(place.station.placement)));
  for (const char* reason : reason_names) reasons_.push_back(std::string(reason) + " " + place.words);
}

void LineOfSight::add_points(const InstrumentView& view) {
  targets_on_tip_ = view.points_on_tip;
  if (!view.points_parameters.empty())
    X_CarrierTarget_ = nominal_placement(model_.parameters(), view.points_parameters, isometry(view.points_at));
  for (const InstrumentView::Point& point : view.points) {
    Eigen::Vector3d p = point.position;
    if (!point.parameters.empty()) p = nominal_position(model_.parameters(), point.parameters, p);
    targets_.push_back({point.name, X_CarrierTarget_ * p, std::nullopt});
  }
}

void LineOfSight::add_normals(const ProblemFile& file) {
  for (const auto& [name, normal] : spec_.normals) {
    bool found = false;
    for (Target& target : targets_)
      if (name.value == "*" || name.value == target.name) {
        target.normal = X_CarrierTarget_.linear() * normal;
        found = true;
      }
    if (!found) {
      std::string names;
      std::vector<std::string> words;
      for (const Target& target : targets_) names += ", " + target.name, words.push_back(target.name);
      throw InputError(file.at(name.line), "'" + name.value + "' is not a target" + meant_instead(name.value, words),
                       "allowed: *" + names);
    }
  }
}

int LineOfSight::station_of(std::span<const double> q) const {
  return station_coordinate_ < 0 ? 0 : int(q[std::size_t(station_coordinate_)]);
}

std::pair<int, int> LineOfSight::stations_of(std::span<const double> q) const {
  if (all_stations_) return {0, int(station_names_.size()) - 1};
  return {station_of(q), station_of(q)};
}

Eigen::Isometry3d LineOfSight::X_MeasureStation(std::span<const double> q, int station) const {
  const Eigen::Isometry3d& X = X_CarrierStation_[std::size_t(station)];
  return station_on_tip_ ? model_.tool_pose(q) * X : X;
}

/// Of a robot with one tip bodies stand in the measurement frame.
Eigen::Isometry3d LineOfSight::X_BodiesMeasure(std::span<const double> q) const {
  return in_ ? collision_->measurement_frame(q, *in_) : Eigen::Isometry3d::Identity();
}

Eigen::Isometry3d LineOfSight::X_BodiesStation(std::span<const double> q, int station) const {
  return X_BodiesMeasure(q) * X_MeasureStation(q, station);
}

int LineOfSight::hidden_by(const Sight& s) const {
  if (outside(spec_.range, s.distance)) return range;
  if (outside(spec_.elevation, s.elevation)) return elevation;
  if (outside(spec_.azimuth, s.azimuth)) return azimuth;
  if (spec_.field_of_view && std::acos(std::clamp(s.p_StationTarget.dot(*spec_.axis) / std::max(s.distance, 1e-12),
                                                  -1.0, 1.0)) > *spec_.field_of_view)
    return field_of_view;
  if (s.incidence && spec_.acceptance && *s.incidence > *spec_.acceptance) return acceptance;
  return -1;
}

Sight LineOfSight::sight(std::span<const double> q, const Eigen::Isometry3d& X_MeasureTip, int station,
                         const Target& target, bool on_tip, bool past_bodies) const {
  const Eigen::Isometry3d& X_Carrier = X_CarrierStation_[std::size_t(station)];
  const Eigen::Isometry3d X_Station = station_on_tip_ ? Eigen::Isometry3d(X_MeasureTip * X_Carrier) : X_Carrier;
  const Eigen::Vector3d p = on_tip ? X_MeasureTip * target.position : target.position;
  Sight s;
  s.target = target.name;
  s.p_StationTarget = X_Station.inverse() * p;
  s.distance = s.p_StationTarget.norm();
  s.azimuth = std::atan2(s.p_StationTarget.y(), s.p_StationTarget.x());
  s.elevation = std::atan2(s.p_StationTarget.z(), s.p_StationTarget.head<2>().norm());
  const Eigen::Vector3d way = X_Station.translation() - p;
  if (target.normal) {
    const Eigen::Vector3d n = on_tip ? Eigen::Vector3d(X_MeasureTip.linear() * *target.normal) : *target.normal;
    s.incidence = std::atan2(n.cross(way).norm(), n.dot(way));
  }
  s.hidden_by = hidden_by(s);
  if (s.hidden_by < 0 && past_bodies && collision_ != nullptr && s.distance > spec_.target_radius) {
    const Eigen::Isometry3d X = X_BodiesMeasure(q);
    const Eigen::Vector3d front = p + way.normalized() * (spec_.target_radius + spec_.beam);
    if (collision_->blocked(q, X * X_Station.translation(), X * front, spec_.beam,
                            station_names_[std::size_t(station)]))
      s.hidden_by = occluded;
  }
  if (s.hidden_by >= 0) s.hidden_by += station * reason_count;
  return s;
}

bool LineOfSight::seen_from(std::span<const double> q, Looked& looked, int station, std::span<char> seen, int* reason,
                            bool past_bodies) const {
  const int needed = spec_.visible == 0 ? targets() : spec_.visible;
  int found = 0, hidden = 0;
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    int& why = looked.hidden_by[past_bodies ? 1 : 0][std::size_t(station) * targets_.size() + t];
    if (why == not_known)
      why = sight(q, looked.X_MeasureTip, station, targets_[t], targets_on_tip_, past_bodies).hidden_by;
    if (!seen.empty()) seen[t] = char(why < 0 && seen[t] != 0);
    found += why < 0;
    hidden += why >= 0;
    if (why >= 0 && reason != nullptr && *reason < 0) *reason = why;
    // Whether enough are seen is all that a constraint asks.
    if (seen.empty() && (found >= needed || hidden > targets() - needed)) break;
  }
  return found >= needed;
}

void LineOfSight::visible(std::span<const double> q, std::span<char> seen) const {
  std::fill(seen.begin(), seen.end(), char(1));
  Looked& looked = looked_at(q);
  const auto [first, last] = stations_of(q);
  for (int s = first; s <= last; ++s) seen_from(q, looked, s, seen, nullptr, true);
}

int LineOfSight::violation(std::span<const double> q, bool past_bodies) const {
  Looked& looked = looked_at(q);
  const auto [first, last] = stations_of(q);
  for (int s = first; s <= last; ++s) {
    int reason = -1;
    if (!seen_from(q, looked, s, {}, &reason, past_bodies)) return reason;
  }
  return -1;
}

std::vector<Sight> LineOfSight::sights(std::span<const double> q, int station) const {
  const Eigen::Isometry3d X_Tip = model_.tool_pose(q);
  std::vector<Sight> result;
  for (const Target& target : targets_) result.push_back(sight(q, X_Tip, station, target, targets_on_tip_, true));
  return result;
}

std::vector<Sight> LineOfSight::reference_sights(std::span<const double> q, int station) const {
  const Eigen::Isometry3d X_Tip = model_.tool_pose(q);
  std::vector<Sight> result;
  for (const Target& target : references_) result.push_back(sight(q, X_Tip, station, target, false, true));
  return result;
}

}  // namespace posewright
