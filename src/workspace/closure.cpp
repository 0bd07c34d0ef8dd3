#include "closure.hpp"

#include <algorithm>
#include <utility>

namespace posewright {
namespace {

// Far below what any joint repeats; damped steps reach it, rad and m by TipMover's unit.
constexpr double closed = 1e-10;

void add_goal(const MeasurementSpec& instrument, std::optional<double> index, std::vector<TipGoal>& goals) {
  if (!joins_tips(instrument)) return;
  const auto& components = std::get<PoseMeasurement>(instrument.instrument).components;
  TipGoal goal;
  goal.components.assign(components.begin(), components.end());
  goal.instrument = index;
  goals.push_back(std::move(goal));
}

}  // namespace

std::unique_ptr<Closure> Closure::make(const IdentificationModel& model, const MeasurementSpec& measurement,
                                       const std::vector<Coordinate>& coordinates) {
  std::vector<TipGoal> goals;
  if (const auto* list = instruments_of(measurement))
    for (std::size_t i = 0; i < list->size(); ++i) add_goal((*list)[i], double(i), goals);
  else add_goal(measurement, {}, goals);
  if (goals.empty()) return nullptr;
  return std::unique_ptr<Closure>(new Closure(model, coordinates, std::move(goals)));
}

Closure::Closure(const IdentificationModel& model, const std::vector<Coordinate>& coordinates,
                 std::vector<TipGoal> goals)
    : coordinates_(coordinates), goals_(std::move(goals)), mover_(model, coordinates) {}

bool Closure::close(std::span<double> q) const {
  std::vector<char> held(q.size(), 0);
  for (std::size_t k = 0; k < q.size(); ++k)
    held[k] = char(!coordinates_[k].discrete() && (q[k] == coordinates_[k].lower || q[k] == coordinates_[k].upper));
  if (std::ranges::find(held, char(1)) != held.end()) {
    std::vector<double> trial(q.begin(), q.end());
    if (mover_.move(trial, goals_, closed, held)) {
      std::ranges::copy(trial, q.begin());
      return true;
    }
  }
  return mover_.move(q, goals_, closed);
}

}  // namespace posewright
