#include "criterion_choice.hpp"

#include <fmt/format.h>

#include "assumed_effect.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/study/study.hpp"
#include "posewright/study/unmodelled.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

// From so many times the smallest number of poses on, an effect that the model lacks matters more than the noise; for
// fewer, plans by o1 are better on measured robots.
constexpr double enough_poses = 1.5;
constexpr std::size_t places_at_candidates = 200;

/// Number of poses against the smallest one.
struct EnoughPoses {
  int poses = 0;
  std::optional<int> smallest;
  bool enough() const { return smallest && poses >= enough_poses * *smallest; }
  std::string few() const {
    if (!smallest) return "no number of poses was found that determines the parameters";
    return fmt::format("{} {} few where {} determine the parameters", counted(poses, "pose"), poses == 1 ? "is" : "are",
                       *smallest);
  }
};

EnoughPoses enough_poses_of(const Study& study, int poses) {
  const Variant& variant = study.first();
  return {poses + int(study.measured.count()),
          smallest_number_of_poses(*variant.model, study.configurations, variant.columns, study.planner.threads)};
}

/// For `auto` and a variant without `unmodelled`.
std::string choose_bias(Study& study, const std::optional<int>& number) {
  const auto stays = [&](const std::string& why) {
    return fmt::format("Criterion {}, since {}.", study.criterion, why);
  };
  if (const std::string why = why_not_bias(study, *study.first().spec, number); !why.empty()) return stays(why);
  if (!moves_the_tip(study, study.planner.threads))
    return stays("the readings contain no tip position that an effect could move");
  const EnoughPoses poses = enough_poses_of(study, *number);
  if (!poses.enough()) return stays(poses.few());
  study.criterion = "bias";
  limit_search_with_effect(study);
  return fmt::format(
      "Criterion bias, since {} poses are enough where {} determine the parameters: least error of a plain fit if the "
      "robot has an effect that the model lacks (criterion: o1 has proofs).",
      poses.poses, *poses.smallest);
}

/// Accuracy at test poses, of a fit that estimates the stated effect.
std::string choose_accuracy(Study& study, const std::optional<int>& number) {
  Variant& variant = study.variants.front();
  if (!(variant.effect->size().translation > 0))
    return fmt::format("Criterion {}, since the unmodelled effect has size 0.", study.criterion);
  if (!number) return {};
  std::string why = "something is known before";
  if (!variant.known_before) {
    const EnoughPoses poses = enough_poses_of(study, *number);
    if (!poses.enough()) return fmt::format("Criterion {}, since {}.", study.criterion, poses.few());
    why = fmt::format("{} poses are enough where {} determine the parameters", poses.poses, *poses.smallest);
  }
  const bool stated = !variant.test_points.empty();
  // Two tips of one reading stand at no single place.
  if (!stated && variant.effect->tips() > 1) return {};
  study.criterion = "test_pose";
  if (!stated) variant.test_points = test_points_at_candidates(study.configurations, variant, variant.test_places);
  return fmt::format("Criterion test_pose, since {}: accuracy at {} {}, the effect estimated, too.", why,
                     variant.test_points.size(), stated ? "test poses" : "of the candidates");
}

}  // namespace

bool assumes_effect(const Setup& setup) {
  return find_criterion(setup.criterion)->needs_truth && setup.truth == nullptr;
}

std::string why_not_bias(const Setup& setup, const VariantSpec& first, const std::optional<int>& poses) {
  const std::string& method = setup.problem->design.method.value;
  if (!poses) return "the number of poses is searched";
  if (setup.problem->design.robust) return "plans over drawn robots (robust) are for the determinant";
  if (setup.truth != nullptr) return "a truth is named";
  if (method == "continuous" || method == "branch_and_bound") return fmt::format("method {} is not for bias", method);
  if (first.unmodelled) return "the effect is estimated, too";
  return {};
}

std::vector<TestPoint> test_points_at_candidates(const Configurations& candidates, const Variant& variant,
                                                 std::vector<TestPlace>& test_places) {
  const Configurations some = thinned(candidates, variant.model->coordinates(), places_at_candidates);
  std::vector<std::vector<double>> places;
  for (std::size_t i = 0; i < some.count(); ++i) {
    const std::span<const double> q = seen_configuration(*variant.model, some[i]);
    places.emplace_back(q.begin(), q.end());
  }
  return test_points_at(variant, places, test_places);
}

Study choose_criterion(Study study, const std::optional<int>& poses) {
  Variant& variant = study.variants.front();
  if (study.criterion_automatic) {
    study.why_criterion = variant.effect != nullptr ? choose_accuracy(study, poses) : choose_bias(study, poses);
  } else if (find_criterion(study.criterion)->needs_test_poses && variant.test_points.empty()) {
    variant.test_points = test_points_at_candidates(study.configurations, variant, variant.test_places);
    study.why_criterion = fmt::format("Accuracy counts at {} of the candidates.", variant.test_points.size());
  }
  return study;
}

}  // namespace posewright
