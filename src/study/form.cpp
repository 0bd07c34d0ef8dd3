#include <fmt/format.h>

#include "posewright/criterion/registry.hpp"
#include "posewright/study/study.hpp"
#include "posewright/study/unmodelled.hpp"

namespace posewright {
namespace {

// From so many times the smallest number of poses on there is enough to choose by what is predicted.
constexpr double enough_to_predict = 1.5;
constexpr std::size_t places_at_candidates = 200;

}  // namespace

std::vector<TestPoint> test_points_at_candidates(const Problem& problem, const Configurations& candidates,
                                                 const Variant& variant, std::vector<TestPlace>& test_places) {
  const Configurations some = thinned(candidates, places_at_candidates);
  std::vector<std::vector<double>> places;
  for (std::size_t i = 0; i < some.count(); ++i)
    places.emplace_back(some[i].begin(), some[i].begin() + std::ptrdiff_t(variant.model->tip_coordinates()));
  return test_points_at(problem, *variant.spec, *variant.model, variant.columns, places, &test_places);
}

std::string choose_form(const Problem& problem, Study& study, Settings& settings) {
  Variant& variant = study.first();
  const bool stated = !variant.test_points.empty();
  const std::string where = stated ? "test poses" : "of the candidates";
  if (settings.criterion_stated || variant.effect == nullptr) {
    if (!find_criterion(settings.criterion)->needs_test_poses || stated) return {};
    variant.test_points = test_points_at_candidates(problem, study.configurations, variant, variant.test_places);
    return fmt::format("Accuracy counts at {} {}.", variant.test_points.size(), where);
  }
  if (settings.poses == 0) return {};
  std::string why = "something is known before";
  if (!variant.known_before) {
    const auto smallest =
        smallest_number_of_poses(*variant.model, study.configurations, variant.columns, settings.planner.threads);
    if (!smallest || settings.poses < enough_to_predict * *smallest)
      return fmt::format("Criterion {}, since {} poses are few where {} determine the parameters.", settings.criterion,
                         settings.poses, smallest.value_or(settings.poses));
    why = fmt::format("{} poses are enough where {} determine the parameters", settings.poses, *smallest);
  }
  // Two tips of one reading stand at no single place.
  if (!stated && variant.effect->tips() > 1) return {};
  settings.criterion = "test_pose";
  if (!stated)
    variant.test_points = test_points_at_candidates(problem, study.configurations, variant, variant.test_places);
  return fmt::format("Criterion test_pose, since {}: accuracy at {} {}, the effect estimated, too.", why,
                     variant.test_points.size(), where);
}

}  // namespace posewright
