#include "criterion_choice.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Columns of an assumed effect make each candidate several times as costly, and more of them gain little.
constexpr int candidates_with_effect = 3000, restarts_with_effect = 2;

std::vector<DesignSpec::Weighted> variants_of(const Problem& problem, bool several) {
  const DesignSpec& design = problem.design;
  if (!several) return {{{find_variant(problem, "").name, 0}, 1.0}};
  if (design.variant && design.variant->line < 0)
    throw InputError(problem.at(design.variant->line), "names one variant",
                     "the criterion is over several: design: variants");
  if (!design.variants.empty()) return design.variants;
  std::vector<DesignSpec::Weighted> all;
  for (const VariantSpec& variant : problem.variants) all.push_back({{variant.name, variant.line}, 1.0});
  return all;
}

Located<std::string> truth_of(const Problem& problem, const std::string& criterion) {
  const DesignSpec& design = problem.design;
  const Located<std::string> truth = design.truth.value_or(Located<std::string>{});
  const CriterionEntry& entry = *find_criterion(criterion);
  // Without a truth, bias counts an effect that is assumed.
  if (entry.needs_residual && truth.value.empty())
    throw InputError(problem.at(design.criterion.line),
                     "criterion '" + design.criterion.value + "' needs an alternative model to test",
                     "set design: truth or --truth");
  if (!truth.value.empty()) find_variant(problem, truth.value);
  if (entry.several_variants && !truth.value.empty())
    throw InputError(
        problem.at(truth.line),
        "--truth needs a single fitted variant; criterion '" + design.criterion.value + "' is over several",
        "leave out the truth, or another criterion");
  return truth;
}

}  // namespace

void require_number_of_poses(const Problem& problem) {
  const DesignSpec& design = problem.design;
  if (!design.poses && !design.smallest)
    throw InputError(problem.at(design.line), "has no number of poses", "set design: poses or --poses");
  if (!design.smallest) return;
  const bool of_poses = design.require.accuracy || design.require.of_axes();
  if (!of_poses && design.require.sigma.empty())
    throw InputError(problem.at(design.line), "poses: auto needs a requirement",
                     "set design: require: accuracy, position, rotation or sigma");
  if (of_poses && !design.test_poses)
    throw InputError(problem.at(design.require.line), "an accuracy is required but there are no test poses",
                     "set design: test_poses");
  if (design.robust)
    throw InputError(problem.at(design.robust->line), "a plan over drawn robots (robust) needs a number of poses",
                     "set poses to a number, not auto");
}

Settings settings_of(const Problem& problem, const RunOptions& run) {
  const DesignSpec& design = problem.design;
  Settings s;
  s.criterion_automatic = design.criterion.value == automatic_criterion;
  s.criterion = s.criterion_automatic ? "o1" : design.criterion.value;
  s.method = design.method.value;
  require_known(s.criterion, s.method, problem.at(design.criterion.line), problem.at(design.method.line),
                automatic_criterion);
  if (design.poses) s.poses = design.poses->value;
  s.candidates = design.candidates.value;
  s.candidates_from = run.candidates_from;
  if (!s.candidates_from && design.candidates_from) s.candidates_file = design.candidates_from->value;
  s.prior = design.prior;
  s.reserve = design.reserve;
  s.repeats = design.repeats;
  s.scaling = design.scaling;
  s.variants = variants_of(problem, find_criterion(s.criterion)->several_variants);
  s.truth = truth_of(problem, s.criterion);
  // Candidates of a user's list are places that count, and so are those of a variant that lacks an effect.
  const bool places = design.test_poses || s.candidates_from || !s.candidates_file.empty() ||
                      find_variant(problem, s.variants.front().name.value).unmodelled;
  if (find_criterion(s.criterion)->needs_test_poses && !places)
    throw CannotDo("the criterion needs places where accuracy matters: set design: test_poses");
  s.measured = run.measured;
  if (!s.measured) s.measured_file = design.measured.value_or("");
  s.planner.restarts = design.restarts.value;
  s.planner.restarts_stated = design.restarts.line != 0;
  s.planner.seed = run.seed;
  s.candidates_alone = run.candidates_alone;
  s.same_robot = run.same_robot;
  s.everything_counts = run.everything_counts;
  s.proof = run.proof;
  s.planner.threads = run.threads;
  const bool with_effect = assumes_effect(s);
  if (with_effect) limit_search_with_effect(design, s);
  const bool may_be = with_effect || (s.criterion_automatic && why_not_bias(problem, s).empty());
  if (may_be && design.candidates.line == 0) s.candidates = candidates_with_effect;
  return s;
}

void limit_search_with_effect(const DesignSpec& design, Settings& settings) {
  if (!settings.planner.restarts_stated) settings.planner.restarts = restarts_with_effect;
  if (design.method.line == 0) settings.method = "exchange";
  settings.planner.kicks = 0;
}

void take_robust(const Problem& problem, Settings& settings) {
  const std::optional<RobustSpec>& robust = problem.design.robust;
  if (!robust) return;
  const auto refuse = [&](const std::string& why, const std::string& allowed) {
    throw InputError(problem.at(robust->line), "a plan over drawn robots (robust) " + why, allowed);
  };
  if (find_criterion(settings.criterion)->several_variants)
    refuse("is for one variant, not for the several of criterion '" + settings.criterion + "'",
           "criterion: o1 or ds, and variant: one of them");
  if (settings.criterion != "o1" && settings.criterion != "ds")
    refuse("is for the determinant, not for criterion '" + settings.criterion + "'", "criterion: o1 or ds");
  if (settings.reserve) refuse("cannot be combined with reserve", "leave one of them out");
  if (find_variant(problem, settings.variants.front().name.value).unmodelled)
    refuse("does not support a variant with an unmodelled effect", "a variant without unmodelled");
  settings.robust = robust;
}

}  // namespace posewright
