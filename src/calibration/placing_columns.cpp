#include "posewright/calibration/placing_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr std::array<const char*, 3> turns = {".rx", ".ry", ".rz"};
// Root mean square of whitened residuals that a robot before its calibration may leave: millimetres at micrometres.
constexpr double plausible = 1000.0;
// The placing fit is a start for another: a few steps show which orientation is right.
constexpr int few_evaluations = 60;

/// Least whitened cost of the placing columns from this start; infinite if nothing was found.
double cost_from(const IdentificationModel& model, const VariantColumns& columns,
                 const std::vector<MeasuredPose>& poses, FitOptions options, const std::vector<double>& start,
                 std::vector<double>& found) {
  options.start = start;
  options.weighting = Weighting::weighted;
  try {
    const Fit result = fit(model, columns, poses, options);
    found = result.correction;
    return result.chi_square / result.readings;
  } catch (const CannotDo&) {
    return std::numeric_limits<double>::infinity();
  }
}

/// rx, ry, rz of the 24 rotations that take a cube to itself.
std::vector<std::array<double, 3>> cube_rotations() {
  constexpr double quarter = std::numbers::pi / 2;
  std::vector<std::array<double, 3>> rotations;
  for (int z = 0; z < 4; ++z) {
    for (int x = 0; x < 4; ++x) rotations.push_back({x * quarter, 0, z * quarter});
    // Near ±90° about y the other two are one; a degree less keeps them apart and is as good a start.
    for (const double y : {-0.99 * quarter, 0.99 * quarter}) rotations.push_back({0, y, z * quarter});
  }
  return rotations;
}

/// Indices of a frame's angles in the catalogue; none where one of them is not free.
std::optional<std::array<std::size_t, 3>> angles_of(const IdentificationModel& model, const VariantColumns& columns,
                                                    const std::string& frame) {
  std::array<std::size_t, 3> at{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto turn = std::find_if(columns.selected.begin(), columns.selected.end(),
                                   [&](int i) { return model.parameters()[std::size_t(i)].name == frame + turns[k]; });
    if (turn == columns.selected.end()) return std::nullopt;
    at[k] = std::size_t(*turn);
  }
  return at;
}

/// The best of the starts, by the stated noise.
/// @param frame  that may be turned any way: base, base@NAME
/// @param from   corrections of what is not placed
std::vector<double> placed_from_any_side(const IdentificationModel& model, const VariantColumns& place,
                                         const std::vector<MeasuredPose>& poses, const FitOptions& quick,
                                         const std::string& frame, const std::vector<double>& from) {
  std::vector<double> best = from, found;
  double least = cost_from(model, place, poses, quick, best, found);
  if (std::isfinite(least)) best = found;
  const auto at = angles_of(model, place, frame);
  if (!at || least < plausible * plausible) return best;
  for (const std::array<double, 3>& rotation : cube_rotations()) {
    std::vector<double> start = from;
    for (std::size_t k = 0; k < 3; ++k) start[(*at)[k]] = rotation[k];
    const double cost = cost_from(model, place, poses, quick, start, found);
    if (!(cost < 0.999 * least)) continue;
    least = cost;
    best = found;
  }
  return best;
}

}  // namespace

VariantColumns placing_columns(const VariantColumns& columns) {
  std::vector<int> kept;
  for (std::size_t j = 0; j < columns.parameters.size(); ++j)
    if (columns.parameters[j].places || columns.parameters[j].role == Role::nuisance) kept.push_back(int(j));
  return subset(columns, kept);
}

VariantColumns determined(const IdentificationModel& model, const VariantColumns& columns,
                          const std::vector<MeasuredPose>& poses, const std::vector<double>& at, Prior prior,
                          std::vector<Dependency>* dependencies, double threshold) {
  const BlockArray read = blocks_of(model, columns, poses, at);
  const auto m = Eigen::Index(columns.parameters.size());
  const Eigen::Index rows = read.rows(), extra = (m + rows - 1) / rows;
  BlockArray blocks(int(Eigen::Index(read.count()) + extra), int(rows), int(m));
  blocks.all().setZero();
  blocks.all().topRows(read.all().rows()) = read.all();
  for (Eigen::Index j = 0; j < m; ++j)
    if (counts(columns.parameters[std::size_t(j)], prior))
      blocks.all()(read.all().rows() + j, j) = 1 / columns.parameters[std::size_t(j)].tolerance;
  IdentifiabilityOptions options;
  options.tiers = columns.tiers;
  if (threshold > 0) options.threshold = threshold;
  Identifiability found = identifiability(blocks, columns.parameters, options);
  if (dependencies != nullptr) *dependencies = std::move(found.dependencies);
  return subset(columns, found.kept);
}

std::vector<double> placed(const IdentificationModel& model, const VariantColumns& columns,
                           const std::vector<MeasuredPose>& poses, const FitOptions& options) {
  VariantColumns place = placing_columns(columns);
  if (!place.selected.empty()) place = determined(model, place, poses, {}, options.prior);
  if (place.selected.empty()) return std::vector<double>(model.parameters().size(), 0.0);
  FitOptions quick = options;
  quick.most_evaluations = few_evaluations;
  const std::vector<double> best =
      placed_from_any_side(model, place, poses, quick, "base", std::vector<double>(model.parameters().size(), 0.0));
  if (options.weighting == Weighting::weighted) return best;
  // What readings count by decides where things come to stand.
  try {
    quick.start = best;
    return fit(model, place, poses, quick).correction;
  } catch (const CannotDo&) {
    return best;
  }
}

std::vector<double> placed_moved(const IdentificationModel& model, const VariantColumns& moved,
                                 const std::vector<MeasuredPose>& poses, const FitOptions& options,
                                 const std::vector<double>& from) {
  const std::string& name = moved.parameters.front().name;
  FitOptions quick = options;
  quick.most_evaluations = few_evaluations;
  const VariantColumns place = determined(model, moved, poses, from, options.prior);
  if (place.selected.empty()) return from;
  return placed_from_any_side(model, place, poses, quick, name.substr(0, name.rfind('.')), from);
}

bool take_canonical_angles(const IdentificationModel& model, const VariantColumns& columns,
                           std::vector<double>& correction) {
  bool changed = false;
  for (const Parameter& p : columns.parameters) {
    if (!p.places || !p.name.ends_with(turns[0])) continue;
    const auto at = angles_of(model, columns, p.name.substr(0, p.name.rfind('.')));
    if (!at) continue;
    const Eigen::Vector3d angles(correction[(*at)[0]], correction[(*at)[1]], correction[(*at)[2]]);
    const Eigen::Vector3d canonical = rpy_of(rotation_of_rpy(angles));
    // Another branch is half a turn off at least: less is rounding.
    if ((canonical - angles).cwiseAbs().maxCoeff() < 1.0) continue;
    changed = true;
    for (std::size_t k = 0; k < 3; ++k) correction[(*at)[k]] = canonical[Eigen::Index(k)];
  }
  return changed;
}

}  // namespace posewright
