#include "posewright/criterion/registry.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Columns of an assumed effect make each candidate several times as costly, and more of them gain little: what the
// robot's effect is like is not known so well.
constexpr int candidates_with_effect = 1000, restarts_with_effect = 2;

/// Whether the criterion counts an effect that nobody stated.
bool assumes_effect(const Settings& s) { return find_criterion(s.criterion)->needs_truth && s.truth.value.empty(); }

std::vector<DesignSpec::Weighted> variants_of(const Problem& problem, const PlanOptions& options, bool several) {
  const DesignSpec& design = problem.design;
  if (!several) return {{{find_variant(problem, options.variant).name, 0}, 1.0}};
  if (!options.variant.empty())
    throw InputError({}, "--variant names one variant", "the criterion is over several: design: variants");
  if (!design.variants.empty()) return design.variants;
  std::vector<DesignSpec::Weighted> all;
  for (const VariantSpec& variant : problem.variants) all.push_back({{variant.name, variant.line}, 1.0});
  return all;
}

Located<std::string> truth_of(const Problem& problem, const PlanOptions& options, const std::string& criterion) {
  const DesignSpec& design = problem.design;
  const Located<std::string> truth =
      options.truth.empty() ? design.truth.value_or(Located<std::string>{}) : Located<std::string>{options.truth, 0};
  const CriterionEntry& entry = *find_criterion(criterion);
  const SourcePlace asked = options.criterion.empty() ? problem.at(design.criterion.line) : SourcePlace{};
  // Without a truth, bias counts an effect that is assumed.
  if (entry.needs_residual && truth.value.empty())
    throw InputError(asked, "criterion '" + criterion + "' needs an alternative model to test",
                     "set design: truth or --truth");
  if (!truth.value.empty()) find_variant(problem, truth.value);
  if (entry.several_variants && !truth.value.empty())
    throw InputError(truth.line > 0 ? problem.at(truth.line) : asked,
                     "--truth needs a single fitted variant; criterion '" + criterion + "' is over several",
                     "leave out the truth, or another criterion");
  return truth;
}

}  // namespace

Settings settings_of(const Problem& problem, const PlanOptions& options) {
  const DesignSpec& design = problem.design;
  Settings s;
  s.criterion = options.criterion.empty() ? design.criterion.value : options.criterion;
  s.criterion_stated = !options.criterion.empty() || design.criterion.line > 0;
  s.method = options.method.empty() ? design.method.value : options.method;
  require_known(s.criterion, s.method, options.criterion.empty() ? problem.at(design.criterion.line) : SourcePlace{},
                options.method.empty() ? problem.at(design.method.line) : SourcePlace{});
  const bool smallest = options.poses ? false : options.smallest || design.smallest;
  if (!options.poses && !design.poses && !smallest)
    throw InputError(problem.at(design.line), "has no number of poses", "set design: poses or --poses");
  if (!smallest) s.poses = options.poses ? *options.poses : design.poses->value;
  const bool of_poses = design.require.accuracy || design.require.of_axes();
  if (smallest && !of_poses && design.require.sigma.empty())
    throw InputError(problem.at(design.line), "poses: auto needs a requirement",
                     "set design: require: accuracy, position, rotation or sigma");
  if (smallest && of_poses && !design.test_poses)
    throw InputError(problem.at(design.require.line), "an accuracy is required but there are no test poses",
                     "set design: test_poses");
  s.candidates = options.candidates.value_or(design.candidates.value);
  s.candidates_from = options.candidates_from;
  if (!s.candidates_from && !options.candidates) s.candidates_file = design.candidates_from.value_or("");
  s.prior = options.prior.value_or(design.prior);
  s.reserve = options.reserve || design.reserve;
  s.repeats = options.repeats.value_or(design.repeats);
  s.scaling = options.scaling.value_or(design.scaling);
  s.variants = variants_of(problem, options, find_criterion(s.criterion)->several_variants);
  s.truth = truth_of(problem, options, s.criterion);
  // Candidates of a user's list are places that count, and so are those of a variant that lacks an effect.
  const bool places = design.test_poses || s.candidates_from || !s.candidates_file.empty() ||
                      find_variant(problem, s.variants.front().name.value).unmodelled;
  if (find_criterion(s.criterion)->needs_test_poses && !places)
    throw CannotDo("the criterion needs places where accuracy matters: set design: test_poses");
  s.measured = options.measured;
  if (!s.measured) s.measured_file = design.measured.value_or("");
  s.planner.restarts = options.restarts.value_or(design.restarts.value);
  s.planner.restarts_stated = options.restarts || design.restarts.line > 0;
  if (assumes_effect(s)) {
    if (!options.candidates && design.candidates.line == 0) s.candidates = candidates_with_effect;
    if (!s.planner.restarts_stated) s.planner.restarts = restarts_with_effect;
    if (options.method.empty() && design.method.line == 0) s.method = "exchange";
    s.planner.kicks = 0;
  }
  s.planner.seed = options.seed;
  s.candidates_alone = options.candidates_alone;
  s.same_robot = options.same_robot;
  s.proof = options.proof;
  s.planner.threads = options.threads;
  return s;
}

void take_robust(const Problem& problem, const PlanOptions& options, Settings& settings) {
  const std::optional<RobustSpec> robust = options.robust ? options.robust : problem.design.robust;
  if (!robust || robust->draws == 0) return;
  const auto refuse = [&](const std::string& why, const std::string& allowed) {
    throw InputError(robust->line > 0 ? problem.at(robust->line) : SourcePlace{},
                     "a plan over drawn robots (robust) " + why, allowed);
  };
  if (find_criterion(settings.criterion)->several_variants)
    refuse("is for one variant, not for the several of criterion '" + settings.criterion + "'",
           "criterion: o1 or ds, and variant: one of them");
  if (settings.criterion != "o1" && settings.criterion != "ds")
    refuse("is for the determinant, not for criterion '" + settings.criterion + "'", "criterion: o1 or ds");
  if (settings.poses == 0) refuse("needs a number of poses", "set poses to a number, not auto");
  if (settings.reserve) refuse("cannot be combined with reserve", "leave one of them out");
  if (find_variant(problem, settings.variants.front().name.value).unmodelled)
    refuse("does not support a variant with an unmodelled effect", "a variant without unmodelled");
  settings.robust = robust;
}

}  // namespace posewright
