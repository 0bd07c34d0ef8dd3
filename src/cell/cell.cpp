#include "posewright/cell/cell.hpp"

#include <algorithm>

#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/pair_names.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/problem/structure.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/sha256.hpp"

namespace posewright {
namespace {

/// An instrument does not stand in a wall. The ways out of its own body are not judged.
void check_stations(const Problem& problem, const Cell& cell) {
  if (cell.collision == nullptr || !cell.sight_is_asked()) return;
  std::vector<double> home = home_configuration(problem.workspace.motion, problem, cell.model->coordinates());
  for (std::size_t k = 0; k < cell.sights.size(); ++k) {
    const auto& sight = cell.sights[k];
    if (cell.instrument) home[*cell.instrument] = double(k);
    for (std::size_t s = 0; sight != nullptr && sight->judges() && s < sight->stations().size(); ++s) {
      const std::string& name = sight->stations()[s];
      const std::string in = cell.collision->inside(home, sight->X_BodiesStation(home, int(s)).translation(), name);
      if (!in.empty())
        throw StationInside(problem.at(sight->line()), "station " + name + " stands inside " + in,
                            "move it, or give its own body the key station: " + name);
    }
  }
}

std::vector<std::vector<const LineOfSight*>> looking_for_each(
    const MeasurementSpec& measurement, const std::vector<std::unique_ptr<const LineOfSight>>& sights) {
  std::vector<std::vector<const LineOfSight*>> looking(sights.size());
  const std::vector<MeasurementSpec>* instruments = instruments_of(measurement);
  const auto add = [&](std::size_t reader, std::size_t instrument) {
    if (sights[instrument] != nullptr) looking[reader].push_back(sights[instrument].get());
  };
  for (std::size_t k = 0; k < sights.size(); ++k) {
    const std::vector<MeasurementSpec>* members = instruments == nullptr ? nullptr : members_of((*instruments)[k]);
    if (members == nullptr) {
      add(k, k);
      continue;
    }
    for (const MeasurementSpec& member : *members)
      add(k, std::size_t(std::ranges::find(*instruments, member.name, &MeasurementSpec::name) - instruments->begin()));
  }
  return looking;
}

void check_body_stations(const CollisionSpec& spec, const ProblemFile& file, const Cell& cell) {
  const auto check = [&](const BodySpec& body) {
    if (body.station.empty()) return;
    std::string names;
    for (const auto& sight : cell.sights)
      for (std::size_t s = 0; sight != nullptr && s < sight->stations().size(); ++s) {
        const std::string& name = sight->stations()[s];
        if (name == body.station) return;
        names += (names.empty() ? "allowed: " : ", ") + name;
      }
    throw InputError(file.at(body.line), "'" + body.station + "' is not a station",
                     names.empty() ? "there is none" : names);
  };
  for (const BodySpec& body : spec.obstacles) check(body);
  for (const BodySpec& body : spec.tool) check(body);
}

std::map<std::string, double> joint_margins(const ProblemVariant& variant, const IdentificationModel& model) {
  std::map<std::string, double> margins;
  const double sigmas = variant.problem.workspace.uncalibrated;
  if (!(sigmas > 0)) return margins;
  const VariantColumns columns = select_columns(model, variant);
  for (std::size_t c = 0; c < columns.selected.size(); ++c)
    for (const Coordinate& coordinate : model.coordinates())
      if (model.parameters()[std::size_t(columns.selected[c])].name == first_name(coordinate.name) + ".offset")
        margins[coordinate.name] = sigmas * columns.parameters[c].tolerance;
  return margins;
}

}  // namespace

std::vector<double> home_configuration(const MotionSpec& motion, const ProblemFile& file,
                                       const std::vector<Coordinate>& coordinates) {
  std::vector<double> home;
  home.reserve(coordinates.size());
  for (const Coordinate& c : coordinates)
    home.push_back(c.discrete() ? c.values.front() : std::clamp(0.0, c.lower, c.upper));
  for (const auto& [name, given] : motion.home) {
    const double value = given.value;
    bool found = false;
    for (std::size_t i = 0; i < home.size(); ++i) {
      const Coordinate& c = coordinates[i];
      if (c.choice() || first_name(c.name) != name.value) continue;
      if (!fits_unit(given.quantity, c.unit))
        throw InputError(file.at(name.line), "workspace.motion.home: '" + name.value + "' has the wrong unit",
                         "a value in " + c.unit + " is expected");
      if (value < c.lower - 1e-9 || value > c.upper + 1e-9)
        throw InputError(file.at(name.line),
                         "workspace.motion.home: '" + name.value + "' is beyond the limits in force",
                         "allowed: " + std::to_string(c.lower) + " to " + std::to_string(c.upper) + " " + c.unit);
      home[i] = std::clamp(value, c.lower, c.upper);
      found = true;
    }
    if (!found) throw_unknown_coordinate(file.at(name.line), name.value, coordinates);
  }
  return home;
}

std::shared_ptr<const Cell> make_cell(const Problem& problem, const Cell* same_robot) {
  const ReadDigest read;
  auto cell = std::make_shared<Cell>();
  const ProblemVariant variant{problem, find_variant(problem, "")};
  cell->model = make_model(variant);
  if (problem.workspace.collision)
    cell->collision = std::make_unique<Collision>(problem, *cell->model,
                                                  same_robot == nullptr ? nullptr : same_robot->collision.get());
  cell->sights = lines_of_sight(problem, *cell->model, cell->collision.get());
  cell->looking = looking_for_each(problem.measurement, cell->sights);
  cell->instrument = instrument_index(cell->model->coordinates());
  cell->joint_margin = joint_margins(variant, *cell->model);
  if (problem.workspace.collision) check_body_stations(*problem.workspace.collision, problem, *cell);
  check_stations(problem, *cell);
  const std::string files = read.hex();
  const bool known = !files.empty() && (same_robot == nullptr || !same_robot->identity.empty());
  if (known)
    cell->identity = sha256_hex(structure_of(problem) + files + (same_robot == nullptr ? "" : same_robot->identity));
  return cell;
}

}  // namespace posewright
