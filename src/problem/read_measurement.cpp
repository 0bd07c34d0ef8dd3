#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "posewright/support/dense.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/text.hpp"
#include "sections.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

TargetSpec read_target(std::string name, const Value& value) {
  return {std::move(name), value.vector(Quantity::length), value.line()};
}

/// n × n, SI, symmetric and positive definite.
Eigen::MatrixXd read_covariance(const Value& value, Eigen::Index n) {
  const std::string expected = fmt::format("{} rows of {} numbers in SI are expected", n, n);
  const std::vector<Value> rows = value.items(std::size_t(n), expected);
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::vector<Value> numbers = rows[std::size_t(i)].items(std::size_t(n), expected);
    for (Eigen::Index j = 0; j < n; ++j) matrix(i, j) = numbers[std::size_t(j)].number(Quantity::number);
  }
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > 1e-9 * matrix.cwiseAbs().maxCoeff())
    value.fail("is not symmetric", "a covariance matrix is needed");
  // Positive definite in units of its own standard deviations, so that mm and rad may stand side by side.
  const Eigen::VectorXd sigma = matrix.diagonal().cwiseMax(0.0).cwiseSqrt();
  if (!(sigma.minCoeff() > 0)) value.fail("is not positive definite", "every variance must be > 0");
  const Eigen::MatrixXd correlation = sigma.cwiseInverse().asDiagonal() * matrix * sigma.cwiseInverse().asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> factor(correlation);
  if (factor.info() != Eigen::Success || factor.matrixLLT().diagonal().minCoeff() < 1e-6)
    value.fail("is not positive definite", "a covariance matrix is needed");
  return matrix;
}

/// Sigmas of three axes: one for all or a list of three.
GaussianNoise read_axes(const Value& noise) {
  const Eigen::Vector3d sigma = noise.is_list()
                                    ? noise.vector(Quantity::length, Sign::positive)
                                    : Eigen::Vector3d::Constant(noise.number(Quantity::length, Sign::positive));
  return {sigma.cwiseAbs2().asDiagonal()};
}

TrackerNoise read_tracker(const Value* value) {
  TrackerNoise noise;
  if (value == nullptr) return noise;
  const Section section(*value);
  section.allow({"range", "range_per_m", "transverse", "angle"});
  // What is left out is zero once something is written: a data sheet's line is taken as it stands.
  noise = {0, 0, 0, 0};
  const auto read = [&](const char* key, std::initializer_list<Quantity> quantity, double& into) {
    if (const Value* found = section.find(key)) into = found->measured(quantity, Sign::not_negative).value;
  };
  read("range", {Quantity::length}, noise.range);
  read("range_per_m", {Quantity::length}, noise.range_per_m);
  read("transverse", {Quantity::length}, noise.transverse);
  read("angle", {Quantity::angle}, noise.angle);
  if (!(noise.range + noise.range_per_m > 0)) value->fail("has no noise along the beam", "range or range_per_m > 0");
  if (!(noise.transverse + noise.angle > 0)) value->fail("has no noise across the beam", "transverse or angle > 0");
  return noise;
}

/// A device that measures points: its noise and where it stands.
void read_point_device(const Value& value, PointNoise& noise, std::vector<StationSpec>& stations) {
  const Section device(value);
  // Devices have different keys, so the type is judged before the keys.
  const std::string type =
      device.at("type").choice({"isotropic", "diagonal", "covariance", "laser_tracker", "photogrammetry"});
  if (type == "covariance") {
    device.allow({"type", "matrix", "stations"});
    noise = GaussianNoise{read_covariance(device.at("matrix"), 3)};
  } else {
    device.allow({"type", "noise", "stations"});
    if (type == "laser_tracker") noise = read_tracker(device.find("noise"));
    else noise = read_axes(device.at("noise"));
  }
  if (const Value* found = device.find("stations")) stations = read_stations(*found);
}

PoseMeasurement read_pose(const Section& section) {
  allow_instrument(section, {"mount", "components", "joined"});
  PoseMeasurement pose;
  const Value* mount = section.find("mount");
  pose.on_hand = mount != nullptr && mount->choice({"hand", "fixed"}) == "hand";
  const Section device(section.at("device"));
  const std::string type = device.at("type").choice({"isotropic", "covariance", "photogrammetry"});
  if (type == "isotropic") {
    device.allow({"type", "noise"});
    const Section noise(device.at("noise"));
    noise.allow({"position", "rotation"});
    const double position = noise.at("position").number(Quantity::length, Sign::positive);
    const double rotation = noise.at("rotation").number(Quantity::angle, Sign::positive);
    pose.covariance.diagonal() << Eigen::Vector3d::Constant(position * position),
        Eigen::Vector3d::Constant(rotation * rotation);
  } else if (type == "covariance") {
    device.allow({"type", "matrix"});
    pose.covariance = read_covariance(device.at("matrix"), 6);
  } else {
    device.allow({"type", "noise", "points"});
    if (pose.on_hand) mount->fail("is hand with photogrammetry", "its points are on the tip: fixed");
    pose.point_sigma = device.at("noise").number(Quantity::length, Sign::positive);
    pose.photogrammetry = read_targets(device.at("points"));
    if (pose.photogrammetry.size() < 3) device.at("points").fail("has too few points", "at least 3 not in line");
    Eigen::Matrix3Xd points(3, Eigen::Index(pose.photogrammetry.size()));
    for (std::size_t i = 0; i < pose.photogrammetry.size(); ++i)
      points.col(Eigen::Index(i)) = pose.photogrammetry[i].position;
    const Eigen::Matrix3Xd spread = points.colwise() - points.rowwise().mean();
    const Eigen::Vector3d extent = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(spread * spread.transpose())
                                       .eigenvalues()
                                       .cwiseMax(0.0)
                                       .cwiseSqrt();
    if (!(extent[1] > 1e-6 * extent[2])) device.at("points").fail("lie in line", "three points not in line fix a pose");
  }
  if (const Value* components = section.find("components"))
    pose.components = read_components(*components, pose_components);
  if (const Value* joined = section.find("joined")) pose.joined = joined->flag();
  if (pose.joined && pose.on_hand) mount->fail("is hand with joined tips", "tips have no instrument: fixed");
  return pose;
}

PointsMeasurement read_points(const Section& section, bool single) {
  const std::string_view key = single ? "target" : "targets";
  allow_instrument(section, {key, "components"});
  PointsMeasurement points;
  if (single) points.targets.push_back(read_target("target", section.at(key)));
  else points.targets = read_targets(section.at(key));
  read_point_device(section.at("device"), points.noise, points.stations);
  if (const Value* components = section.find("components"))
    points.components = read_components(*components, std::span(pose_components).first(3));
  return points;
}

/// Instruments by the word under `type`; a new one is one row.
struct InstrumentReader {
  std::string_view name;
  InstrumentSpec (*read)(const Section& measurement);
};
constexpr InstrumentReader instruments[] = {
    {"pose", [](const Section& measurement) -> InstrumentSpec { return read_pose(measurement); }},
    {"points", [](const Section& measurement) -> InstrumentSpec { return read_points(measurement, false); }},
    {"position", [](const Section& measurement) -> InstrumentSpec { return read_points(measurement, true); }},
    {"distance", [](const Section& measurement) -> InstrumentSpec { return read_distance(measurement); }},
    {"plane", [](const Section& measurement) -> InstrumentSpec { return read_plane_distance(measurement); }},
    {"line", [](const Section& measurement) -> InstrumentSpec { return read_line(measurement); }},
    {"inclination", [](const Section& measurement) -> InstrumentSpec { return read_inclination(measurement); }},
    {"camera", [](const Section& measurement) -> InstrumentSpec { return read_camera(measurement); }},
    {"joints", [](const Section& measurement) -> InstrumentSpec { return read_joint_sensors(measurement); }},
};

std::vector<std::string_view> instrument_names() {
  std::vector<std::string_view> names;
  for (const InstrumentReader& reader : instruments) names.push_back(reader.name);
  return names;
}

/// {position, rotation}, or the position alone. Beside a noise in pixels a plain number may be meant in those, so it
/// needs its unit.
Repeatability read_repeatability(const Value& value, const std::string& type) {
  if (value.is_mapping()) {
    const Section section(value);
    section.allow({"position", "rotation"});
    Repeatability both = read_repeatability(section.at("position"), type);
    if (const Value* rotation = section.find("rotation"))
      both.rotation = rotation->number(Quantity::angle, Sign::not_negative);
    return both;
  }
  const Measured given = value.measured({Quantity::length}, Sign::not_negative);
  if (type == "camera" && given.quantity == Quantity::number && given.value > 0)
    value.fail("is a plain number beside a noise in pixels",
               "random offset of the robot, with its unit: " + allowed_units({Quantity::length}));
  return {given.value, 0.0, 0.0};
}

}  // namespace

void allow_instrument(const Section& section, std::initializer_list<std::string_view> own) {
  std::vector<std::string_view> keys{"type", "name", "of", "in"};
  keys.insert(keys.end(), own.begin(), own.end());
  keys.insert(keys.end(), {"device", "repeats", "repeatability", "line_of_sight", "most", "reading", "setup",
                           "unmodelled", "load"});
  section.allow(keys);
}

Components read_components(const Value& value, std::span<const std::string_view> names) {
  const std::string expected = fmt::format("allowed: {}", fmt::join(names, ", "));
  Components components;
  for (const Value& item : value.items("a list is expected, " + expected)) {
    const std::string name = item.text(expected);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      item.fail("is " + in_quotes(name) + meant_instead(name, {names.begin(), names.end()}), expected);
    const int index = static_cast<int>(found - names.begin());
    if (std::find(components.begin(), components.end(), index) != components.end())
      item.fail("is " + in_quotes(name), "it is already in the list");
    components.push_back(index);
  }
  if (components.empty()) value.fail("is empty", expected);
  std::sort(components.begin(), components.end());
  return components;
}

std::vector<StationSpec>* stations_of(MeasurementSpec& measurement) {
  return std::visit(
      [](auto& instrument) -> std::vector<StationSpec>* {
        if constexpr (requires { instrument.stations; }) return &instrument.stations;
        else return nullptr;
      },
      measurement.instrument);
}

std::vector<StationSpec> read_stations(const Value& value) {
  std::vector<StationSpec> stations;
  for (const yaml::Entry& entry : Section(value).entries()) {
    StationSpec station{entry.key.value, {}};
    if (entry.value.is_mapping()) station.placement = read_placement(Section(entry.value));
    else station.placement.position = entry.value.vector(Quantity::length);
    stations.push_back(std::move(station));
  }
  if (stations.empty()) value.fail("is empty", "at least one station is needed");
  return stations;
}

std::vector<TargetSpec> read_targets(const Value& value) {
  std::vector<TargetSpec> targets;
  for (const yaml::Entry& entry : Section(value).entries()) {
    if (entry.key.value.find_first_of("*?") != std::string::npos)
      entry.value.fail("is a name with * or ?", "a plain name is expected");
    targets.push_back(read_target(entry.key.value, entry.value));
  }
  if (targets.empty()) value.fail("is empty", "at least one target is needed");
  return targets;
}

namespace {

/// Of an instrument of a list: how many poses it may read, and its times.
void read_limits(const Section& section, MeasurementSpec& instrument) {
  if (const Value* most = section.find("most")) instrument.most = most->integer(1, most_stated_poses);
  if (const Value* reading = section.find("reading"))
    instrument.reading = reading->number(Quantity::time, Sign::not_negative);
  if (const Value* setup = section.find("setup")) instrument.setup = setup->number(Quantity::time, Sign::not_negative);
}

MeasurementSpec read_instrument(const Section& section) {
  MeasurementSpec measurement;
  measurement.line = section.value().line();
  const std::string type = section.at("type").choice(instrument_names());
  for (const InstrumentReader& reader : instruments)
    if (reader.name == type) measurement.instrument = reader.read(section);
  if (const Value* of = section.find("of")) measurement.of = of->exact_name();
  if (const Value* in = section.find("in")) measurement.in = in->exact_name();
  if (const Value* repeats = section.find("repeats"))
    measurement.repeats = repeats->integer(1, std::numeric_limits<int>::max());
  if (const Value* repeatability = section.find("repeatability"))
    measurement.repeatability = read_repeatability(*repeatability, type);
  if (const Value* unmodelled = section.find("unmodelled"))
    measurement.unmodelled = unmodelled->number(Quantity::length, Sign::positive);
  if (const Value* sight = section.find("line_of_sight")) measurement.line_of_sight = read_line_of_sight(*sight);
  read_limits(section, measurement);
  if (const Value* load = section.find("load"))
    measurement.loaded_minus_unloaded = load->choice({"absolute", "loaded_minus_unloaded"}) != "absolute";
  return measurement;
}

/// What a list does not have: instruments that do not read one tip, and choices of their own.
void require_fits_list(const Section& section, MeasurementSpec& instrument) {
  const auto* distance = std::get_if<DistanceMeasurement>(&instrument.instrument);
  if (std::holds_alternative<JointsMeasurement>(instrument.instrument) ||
      (distance != nullptr && distance->anchors.empty()))
    section.at("type").fail(
        "does not read where the tip is, and stands in a list of instruments",
        "allowed there: pose, points, position, plane, line, inclination, camera, distance with anchors");
  if (const auto& sight = instrument.line_of_sight)
    if (sight->visible > 0 || sight->every > 0 || !sight->stations.empty())
      section.at("line_of_sight")
          .fail("has visible, stations, or references",
                "those of an instrument of a list must see all its targets from its own place");
  if (instrument.loaded_minus_unloaded)
    section.at("load").fail("is loaded_minus_unloaded in a list of instruments", "allowed there: absolute");
  if (const std::vector<StationSpec>* stations = stations_of(instrument); stations != nullptr && stations->size() > 1)
    section.at("device").fail("has several stations in a list of instruments",
                              "one station each; a further one is another instrument");
}

/// A word in names of parameters and columns: what ends one there is refused.
std::string read_instrument_name(const Value& value) {
  const std::string name = value.exact_name().value;
  if (name.find_first_of(".@,;\"'[]#") != std::string::npos)
    value.fail("is " + in_quotes(name), "a name without any of . @ , ; \" ' [ ] # is expected");
  return name;
}

bool same_name(const std::optional<Located<std::string>>& a, const std::optional<Located<std::string>>& b) {
  return a.has_value() == b.has_value() && (!a || a->value == b->value);
}

/// What members share is theirs alone to say: one visit of one tip.
void require_common(const Value& item, const MeasurementSpec& first, const MeasurementSpec& other) {
  if (!same_name(first.of, other.of) || !same_name(first.in, other.in))
    item.fail("does not read the tip that " + first.name + " reads",
              "of and in are the same of all that read together");
  if (!(other.repeatability == first.repeatability))
    item.fail("has another repeatability than " + first.name, "one visit has one repeatability");
  if (other.repeats != first.repeats)
    item.fail("has other repeats than " + first.name, "the same repeats for all that read together");
}

/// {name: both, together: [tracker, camera]}
/// @param list  the instruments before it
MeasurementSpec read_together(const Section& section, const std::vector<MeasurementSpec>& list) {
  section.allow({"name", "together", "most", "reading", "setup"});
  MeasurementSpec measurement;
  measurement.line = section.value().line();
  std::vector<std::string> names;
  for (const MeasurementSpec& one : list)
    if (members_of(one) == nullptr) names.push_back(one.name);
  const std::string allowed = fmt::format("instruments before it in the list: {}", fmt::join(names, ", "));
  TogetherMeasurement together;
  for (const Value& item : section.at("together").items("a list of names is expected")) {
    const std::string name = item.exact_name().value;
    const auto found = std::ranges::find(list, name, &MeasurementSpec::name);
    if (found == list.end() || members_of(*found) != nullptr)
      item.fail("is " + in_quotes(name) + meant_instead(name, names), allowed);
    if (std::ranges::find(together.members, name, &MeasurementSpec::name) != together.members.end())
      item.fail("is " + in_quotes(name) + " once more", allowed);
    if (found->unmodelled > 0)
      item.fail("has an unmodelled effect of its own", "instruments that read together have none");
    if (!together.members.empty()) require_common(item, together.members.front(), *found);
    together.members.push_back(*found);
  }
  if (together.members.size() < 2) section.at("together").fail("is of one instrument", "two or more, " + allowed);
  const MeasurementSpec& first = together.members.front();
  measurement.of = first.of;
  measurement.in = first.in;
  measurement.repeatability = first.repeatability;
  measurement.repeats = first.repeats;
  measurement.instrument = std::move(together);
  read_limits(section, measurement);
  return measurement;
}

InstrumentList read_instruments(const Value& value) {
  InstrumentList list;
  for (const Value& item : value.items("a list of instruments is expected")) {
    const Section section(item);
    const Value& name = section.at("name");
    const bool together = section.has("together");
    MeasurementSpec instrument = together ? read_together(section, list.instruments) : read_instrument(section);
    instrument.name = read_instrument_name(name);
    for (const MeasurementSpec& other : list.instruments)
      if (other.name == instrument.name)
        name.fail("is " + in_quotes(instrument.name), "another instrument of the list has this name");
    if (!together) require_fits_list(section, instrument);
    list.instruments.push_back(std::move(instrument));
  }
  if (list.instruments.empty()) value.fail("is empty", "at least one instrument is needed");
  return list;
}

}  // namespace

MeasurementSpec read_measurement(const Value& value) {
  MeasurementSpec measurement;
  if (!value.is_list()) {
    const Section section(value);
    measurement = read_instrument(section);
    constexpr std::pair<const char*, const char*> elsewhere[] = {{"line_of_sight", "workspace: line_of_sight"},
                                                                 {"most", "design: poses"},
                                                                 {"reading", "workspace: motion: reading"},
                                                                 {"setup", "workspace: motion: station_change"},
                                                                 {"unmodelled", "unmodelled of a variant"}};
    for (const auto& [key, one] : elsewhere)
      if (const Value* found = section.find(key))
        found->fail("is for an instrument of a list", std::string("of one alone: ") + one);
    // There is nothing to tell it from.
    if (const Value* name = section.find("name")) read_instrument_name(*name);
    return measurement;
  }
  measurement.line = value.line();
  measurement.instrument = read_instruments(value);
  return measurement;
}

}  // namespace posewright
