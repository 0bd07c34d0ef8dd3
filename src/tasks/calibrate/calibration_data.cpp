#include "calibration_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "posewright/calibration/gross_errors.hpp"
#include "posewright/calibration/mixed_targets.hpp"
#include "posewright/model/instrument_view.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

std::vector<std::filesystem::path> files_of(const CalibrateOptions& options) {
  std::vector<std::filesystem::path> files{options.data};
  files.insert(files.end(), options.campaigns.begin(), options.campaigns.end());
  return files;
}

/// Rows that were averaged are the repeats, whatever the problem planned.
void note_repeats(const MeasuredData& data, const MeasurementSpec& measurement, const std::string& before,
                  std::vector<std::string>& notes) {
  if (data.repeated.empty()) return;
  if (!data.same_repeats)
    notes.push_back(fmt::format("{}poses have different numbers of readings (harmonic mean {:.3g}); each is averaged",
                                before, data.repeats));
  // A mean of whole numbers, with the rounding of one.
  else if (instruments_of(measurement) == nullptr && std::lround(data.repeats) != measurement.repeats)
    notes.push_back(fmt::format("{}{:.0f} readings a pose are averaged, but the problem states {}", before,
                                data.repeats, measurement.repeats));
}

/// Standard deviation of every reading within poses of all files.
void add_spread(const MeasuredData& data, std::vector<double>& squares, std::vector<double>& files) {
  squares.resize(std::max(squares.size(), data.spread.size()), 0.0);
  files.resize(squares.size(), 0.0);
  for (std::size_t i = 0; i < data.spread.size(); ++i)
    if (std::isfinite(data.spread[i])) {
      squares[i] += std::pow(data.spread[i], 2) * data.rows;
      files[i] += data.rows;
    }
}

constexpr std::size_t most_listed = 8;

}  // namespace

std::vector<std::string> campaigns_of(const CalibrateOptions& options) {
  std::vector<std::string> names;
  if (options.campaigns.empty()) return names;
  for (const std::filesystem::path& file : files_of(options)) {
    std::string name = file.stem().string();
    if (std::find(names.begin(), names.end(), name) != names.end()) name += "_" + std::to_string(names.size() + 1);
    names.push_back(std::move(name));
  }
  return names;
}

Moved moved_between(const std::string& text) {
  constexpr std::array<std::pair<std::string_view, Moved>, 5> words = {{{"auto", Moved::automatic},
                                                                        {"base", Moved::base},
                                                                        {"tool", Moved::tool},
                                                                        {"both", Moved::both},
                                                                        {"nothing", Moved::nothing}}};
  for (const auto& [word, moved] : words)
    if (word == text) return moved;
  throw InputError({}, "moved is '" + text + "'", "allowed: auto, base, tool, both, nothing");
}

std::vector<std::string> moved_frames(const MeasurementSpec& measurement, Moved moved) {
  std::vector<std::string> frames;
  if (moved == Moved::base || moved == Moved::both) frames.push_back("base");
  if (moved != Moved::tool && moved != Moved::both) return frames;
  frames.push_back("tool");
  const InstrumentView view = view_of(measurement);
  if (view.places_on_tip)
    for (const InstrumentView::Place& place : view.places) frames.push_back(place.parameters);
  if (!view.points_on_tip) return frames;
  if (!view.points_parameters.empty()) frames.push_back(view.points_parameters);
  for (const InstrumentView::Point& point : view.points)
    if (!point.parameters.empty()) frames.push_back(point.parameters);
  return frames;
}

CalibrationData read_calibration_data(const Problem& problem, const CalibrateOptions& options,
                                      const IdentificationModel& model, Calibration& result) {
  CalibrationData all;
  const std::vector<std::filesystem::path> files = files_of(options);
  const bool several = files.size() > 1;
  if (several) require_one_instrument(problem, "calibrate of several files");
  const auto of_campaign = [&](std::vector<double>& q, std::size_t campaign) {
    if (several) q.push_back(double(campaign));
  };
  double inverse_repeats = 0;
  std::size_t poses = 0;
  std::vector<double> squares, counted;
  for (std::size_t f = 0; f < files.size(); ++f) {
    MeasuredData data = f == 0 && options.text ? parse_measured_data(*options.text, files[f], problem, model)
                                               : read_measured_data(files[f], problem, model);
    if (f == 0) all.orientation = data.orientation;
    const std::string before = several ? files[f].string() + ": " : "";
    for (const std::string& note : data.notes) result.notes.push_back(before + note);
    note_repeats(data, problem.measurement, before, result.notes);
    result.rows += data.rows;
    poses += data.poses.size();
    inverse_repeats += double(data.poses.size()) / data.repeats;
    add_spread(data, squares, counted);
    for (RepeatedReadings& visit : data.repeated) {
      of_campaign(visit.q, f);
      all.repeated.push_back(std::move(visit));
    }
    std::move(data.images.begin(), data.images.end(), std::back_inserter(all.images));
    const std::size_t fitted_before = all.fitted.size();
    for (std::size_t k = 0; k < data.poses.size(); ++k) {
      of_campaign(data.poses[k].q, f);
      const bool back = data.held_back[k] || (options.hold_back > 0 && (k + 1) % std::size_t(options.hold_back) == 0);
      (back ? all.held_back : all.fitted).push_back(std::move(data.poses[k]));
    }
    if (all.fitted.size() == fitted_before) throw InputError({files[f].string(), 0}, "has no pose to fit", "use: fit");
  }
  result.repeats = double(poses) / inverse_repeats;
  for (std::size_t i = 0; i < squares.size(); ++i)
    result.spread.push_back(counted[i] > 0 ? std::sqrt(squares[i] / counted[i])
                                           : std::numeric_limits<double>::quiet_NaN());
  if (!options.validate.empty()) {
    MeasuredData more = read_measured_data(options.validate, problem, model);
    for (const std::string& note : more.notes) result.notes.push_back(options.validate.string() + ": " + note);
    for (MeasuredPose& pose : more.poses) {
      of_campaign(pose.q, 0);
      all.validation.push_back(pose);
      all.held_back.push_back(std::move(pose));
    }
  }
  result.readings = model.readings();
  result.poses = int(all.fitted.size());
  result.held_back = int(all.held_back.size());
  return all;
}

void refuse_mixed_targets(const MeasurementSpec& measurement, const std::vector<MeasuredPose>& poses,
                          Weighting weighting) {
  const auto* points = std::get_if<PointsMeasurement>(&measurement.instrument);
  if (points == nullptr || points->components.size() != 3 || measurement.loaded_minus_unloaded ||
      weighting == Weighting::robust)
    return;
  std::vector<std::string> names;
  for (const TargetSpec& target : points->targets) names.push_back(target.name);
  const std::vector<MixedTargets> mixed = mixed_targets(names, poses);
  if (mixed.empty()) return;
  std::string list;
  for (std::size_t k = 0; k < std::min(most_listed, mixed.size()); ++k)
    list += fmt::format("{}{} ({} are {})", k == 0 ? "" : ", ", mixed[k].id, fmt::join(names, ", "),
                        fmt::join(mixed[k].are, ", "));
  if (mixed.size() > most_listed) list += fmt::format(" and {} more", mixed.size() - most_listed);
  throw CannotDo(
      fmt::format("targets are mixed up at pose{} {}: only so they are as far from each other as at the other "
                  "poses. Exchange their readings, or use --weights robust",
                  mixed.size() == 1 ? "" : "s", list));
}

void refuse_gross_poses(const IdentificationModel& model, const VariantColumns& columns,
                        const std::vector<MeasuredPose>& poses, const std::vector<double>& placed, FitOptions options,
                        const std::vector<std::string>& notes) {
  if (options.weighting == Weighting::robust) return;
  options.start = placed;
  const std::vector<GrossPose> gross = gross_poses(model, columns, poses, options);
  if (gross.empty()) return;
  std::string list;
  for (std::size_t k = 0; k < std::min(most_listed, gross.size()); ++k)
    list += fmt::format("{}{} ({:.3g} times the stated noise)", k == 0 ? "" : ", ", gross[k].id, gross[k].size);
  if (gross.size() > most_listed) list += fmt::format(" and {} more", gross.size() - most_listed);
  std::string noted;
  for (const std::string& note : notes) noted += "; " + note;
  throw CannotDo(fmt::format(
      "gross errors at pose{} {}; noise and tolerances explain {:.3g} times, and the other poses fit: "
      "check for a lost target or a wrong row. Leave {} out, or use --weights robust{}",
      gross.size() == 1 ? "" : "s", list, gross.front().explained, gross.size() == 1 ? "it" : "them", noted));
}

namespace {

void refuse_found(const ConventionSearch& search) {
  if (search.found.empty()) return;
  std::string list;
  for (const Convention& convention : search.found)
    list += fmt::format("{}{} if {}: {}", list.empty() ? "" : "; or ", shown_value(convention.left, "m"),
                        convention.condition, convention.remedy);
  throw CannotDo(fmt::format("base and tool alone leave {}, too much for errors of a robot, and {}",
                             shown_value(search.left, "m"), list));
}

}  // namespace

void refuse_conventions(const Problem& problem, const IdentificationModel& model, const VariantColumns& columns,
                        const std::vector<MeasuredPose>& poses, const std::vector<double>& placed,
                        const OrientationForm& orientation) {
  const ResidualSize size{residual_rms(model, poses, placed),
                          explained_rms(problem.measurement, model, columns, poses, placed)};
  if (size.unusual()) refuse_found(find_conventions(problem, model, poses, orientation));
}

void refuse_unplaced(const Problem& problem, const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                     const OrientationForm& orientation) {
  refuse_found(find_conventions(problem, model, poses, orientation));
}

}  // namespace posewright
