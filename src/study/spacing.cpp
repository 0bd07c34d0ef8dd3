#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "posewright/model/instrument_choice.hpp"
#include "posewright/study/pose_distance.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

// Two poses that differ by less than this share of every range count as one.
constexpr double same_pose = 0.01;
// Nearer ones look like a slip to whoever drives them: of an angle, and as a share of a range.
constexpr double usual_angle = 5 * std::numbers::pi / 180, usual_share = 0.02;
constexpr int most_halvings = 6;
// Of poses whose number is not known yet.
constexpr std::size_t most_unknown = 500;

/// Units by coordinate; where a distance is 0, the coordinate does not make a pose another one.
template <class Distance>
Spacing spacing_by(const std::vector<Coordinate>& coordinates, const Distance& distance) {
  Spacing spacing;
  const auto d = Eigen::Index(coordinates.size());
  spacing.unit.resize(d);
  spacing.period = Eigen::VectorXd::Zero(d);
  for (Eigen::Index k = 0; k < d; ++k) {
    const Coordinate& c = coordinates[std::size_t(k)];
    if (c.periodic) spacing.period[k] = 2 * std::numbers::pi;
    // Another load case or station is another pose, however small the step between the numbers.
    const double unit = c.discrete() ? 1e-12 : distance(c);
    spacing.unit[k] = unit > 0 ? unit : std::numeric_limits<double>::infinity();
  }
  return spacing;
}

/// True if so many of the candidates keep the distance from each other and from what is measured. Ten times as many are
/// looked at, evenly among all.
bool holds(const Spacing& spacing, const Configurations& candidates, const Configurations& measured,
           std::size_t wanted) {
  std::vector<std::span<const double>> taken;
  for (std::size_t i = 0; i < measured.count(); ++i) taken.push_back(measured[i]);
  const std::size_t enough = taken.size() + wanted, step = std::max<std::size_t>(1, candidates.count() / (10 * wanted));
  for (std::size_t i = 0; i < candidates.count() && taken.size() < enough; i += step)
    if (std::none_of(taken.begin(), taken.end(), [&](const auto& q) { return spacing.too_near(candidates[i], q); }))
      taken.push_back(candidates[i]);
  return taken.size() >= enough;
}

}  // namespace

Spacing spacing_of(const std::vector<Coordinate>& coordinates,
                   const std::optional<DesignSpec::MinimumDistance>& distance, Repeats repeats) {
  Spacing spacing;
  // A limited number of repeats is kept for candidates; poses between them are then not repeated at all.
  if (!distance && repeats.most == Repeats::any_number) return spacing;
  return spacing_by(coordinates, [&](const Coordinate& c) {
    if (!distance) return same_pose * (c.upper - c.lower);
    return c.unit == "m" ? distance->length : distance->angle;
  });
}

Spacing usual_spacing(const std::vector<Coordinate>& coordinates, const Configurations& candidates,
                      const Configurations& measured, const std::optional<int>& poses) {
  // Whoever draws poses at random comes to fewer than fit: four times as many leave them room.
  const std::size_t wanted = poses ? 4 * std::size_t(*poses) : std::min(candidates.count() / 2, most_unknown);
  if (wanted == 0 || candidates.count() < wanted) return {};
  Spacing spacing = spacing_by(coordinates, [](const Coordinate& c) {
    const double share = usual_share * (c.upper - c.lower);
    return c.unit == "m" ? share : std::min(usual_angle, share);
  });
  for (int halvings = 0; halvings <= most_halvings; ++halvings, spacing.unit /= 2)
    if (holds(spacing, candidates, measured, wanted)) return spacing;
  return {};
}

std::string distance_text(const std::vector<Coordinate>& coordinates, const Spacing& spacing) {
  std::string text;
  for (const char* unit : {"rad", "m"}) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      const double apart = spacing.unit[Eigen::Index(k)];
      if (coordinates[k].unit != unit || coordinates[k].discrete() || std::isinf(apart)) continue;
      least = std::min(least, apart);
      most = std::max(most, apart);
    }
    if (most == 0) continue;
    const bool angle = unit == std::string("rad");
    const double shown = angle ? 180 / std::numbers::pi : 1000;
    text += (text.empty() ? "" : " or ") + (least < most ? fmt::format("{:.3g} to ", shown * least) : "") +
            fmt::format("{:.3g} {}", shown * most, angle ? "deg" : "mm");
  }
  return text;
}

namespace {

/// Poses that each instrument may still read; empty where none is limited.
std::vector<int> left_for_instruments(const std::vector<MeasurementSpec>& instruments, std::size_t instrument,
                                      const Configurations& known) {
  std::vector<int> left;
  left.reserve(instruments.size());
  for (const MeasurementSpec& one : instruments) left.push_back(one.most.value_or(std::numeric_limits<int>::max()));
  if (std::ranges::none_of(instruments, [](const MeasurementSpec& one) { return one.most.has_value(); })) return {};
  for (std::size_t i = 0; i < known.count(); ++i)
    if (int& own = left[std::size_t(known[i][instrument])]; own > 0) --own;
  return left;
}

void limit_instruments(const Study& study, const Configurations& known, Spacing& spacing) {
  const std::vector<MeasurementSpec>* instruments = instruments_of(study.problem->measurement);
  if (instruments == nullptr) return;
  const std::size_t instrument = *instrument_index(study.first().workspace->coordinates());
  spacing.limited = Eigen::Index(instrument);
  spacing.most = left_for_instruments(*instruments, instrument, known);
}

}  // namespace

PoseDistance pose_distance(const Study& study, const Configurations& known, const std::optional<int>& poses) {
  const std::vector<Coordinate>& coordinates = study.first().workspace->coordinates();
  const auto& stated = study.problem->design.minimum_distance;
  PoseDistance distance{spacing_of(coordinates, stated, study.repeats), stated.has_value()};
  if (!stated && study.repeats.most == 1 && study.list.empty()) {
    Spacing usual = usual_spacing(coordinates, study.configurations, known, poses);
    distance.kept = distance.usual = usual.keeps_distance();
    if (distance.usual) distance.spacing = std::move(usual);
  }
  limit_instruments(study, known, distance.spacing);
  return distance;
}

void PoseDistance::require_room(int poses) const {
  if (spacing.most.empty()) return;
  const auto left = std::accumulate(spacing.most.begin(), spacing.most.end(), std::int64_t{0});
  if (left < poses)
    throw CannotDo(fmt::format("measurement: by their `most`, the instruments may read {} of {} wanted",
                               counted(long(left), "further pose"), poses));
}

std::optional<Spacing> PoseDistance::among(const Configurations& candidates) const {
  if (!kept && spacing.most.empty()) return std::nullopt;
  Spacing own = spacing;
  if (!kept) own.unit.resize(0);
  own.points = Eigen::Map<const BlockArray::RowMatrix>(candidates.values.data(), Eigen::Index(candidates.count()),
                                                       candidates.dimension);
  return own;
}

Configurations PoseDistance::away_from(const Configurations& known, const Configurations& candidates,
                                       Repeats repeats) const {
  const auto taken = [&](std::span<const double> q) {
    for (std::size_t i = 0; i < known.count(); ++i) {
      const auto other = known[i];
      const bool same = std::equal(q.begin(), q.end(), other.begin());
      if (kept ? spacing.too_near(other, q) : repeats.most == 1 && same) return true;
    }
    return false;
  };
  Configurations left = candidates;
  left.values.clear();
  left.rows.clear();
  for (std::size_t i = 0; i < candidates.count(); ++i)
    if (!taken(candidates[i])) append(left, candidates, i);
  if (left.count() == 0) throw CannotDo("every candidate is too near to a fixed or measured pose");
  return left;
}

}  // namespace posewright
