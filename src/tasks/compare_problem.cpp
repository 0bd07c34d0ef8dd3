#include "posewright/tasks/compare_problem.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "posewright/criterion/registry.hpp"
#include "posewright/lists/parameters_file.hpp"
#include "posewright/study/accuracy_points.hpp"
#include "posewright/study/expected_error.hpp"
#include "posewright/study/space.hpp"
#include "posewright/study/study.hpp"
#include "posewright/study/unmodelled.hpp"
#include "posewright/support/bytes.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/tasks.hpp"
#include "variant_alias.hpp"

namespace posewright {
namespace {

struct PlansToCompare {
  std::vector<ComparedPlan> plans;
  std::vector<Configurations> poses;  ///< of each, without those that the problem names as measured
  std::vector<std::string> notes;
  std::vector<std::string> not_planned{};  ///< variants whose plan was not done when the search was ended
};

/// Progress with a name before it.
class NamedMonitor {
 public:
  NamedMonitor(const Monitor& monitor, const std::string& name) {
    monitor_.stop_with(monitor);
    monitor_.on_progress = [&monitor, name](Progress progress) {
      progress.stage = name + ": " + progress.stage;
      monitor.report(progress);
    };
  }
  NamedMonitor(const NamedMonitor&) = delete;
  NamedMonitor& operator=(const NamedMonitor&) = delete;
  operator const Monitor&() const { return monitor_; }

 private:
  Monitor monitor_;
};

/// The problem with the design of a comparison: each variant is planned for alone. Throws InputError.
Problem compared_problem(Problem problem, bool given) {
  DesignSpec& design = problem.design;
  if (!given && design.smallest)
    throw InputError(problem.at(design.line), "poses: auto gives no number of poses for the comparison",
                     "--poses N, or plans");
  if (!given) require_number_of_poses(problem);
  // What the file states is for its own plan; an option is for the comparison.
  if (design.method.line >= 0) design.method = {"exchange", 0};
  if (const CriterionEntry* entry = find_criterion(design.criterion.value);
      design.criterion.value == automatic_criterion ||
      (entry != nullptr && (entry->several_variants || entry->needs_truth)))
    design.criterion = {"o1", design.criterion.line};
  design.truth.reset();
  if (given) design.poses.reset();  // lists bring their own numbers
  return problem;
}

/// All compared variants with their candidates. Throws InputError.
/// @param problem  by compared_problem()
Study comparison_study(const Problem& problem, const CompareOptions& options, const Monitor& monitor) {
  RunOptions run = options.run;
  run.variants = options.variants;
  std::vector<std::string>& names = run.variants;
  if (names.empty())
    for (const VariantSpec& variant : problem.variants) names.push_back(variant.name);
  if (!options.truth.empty() && std::find(names.begin(), names.end(), options.truth) == names.end())
    names.push_back(options.truth);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::find(names.begin(), names.begin() + long(i), names[i]) != names.begin() + long(i))
      throw InputError({}, "variant '" + names[i] + "' is named twice", "each once");
  return make_study(resolve(problem, run, monitor), monitor, Unidentifiable::keep);
}

/// Request for a search or bound for one variant alone.
SearchRequest request_for(const Study& study, const Variant& variant, int poses) {
  SearchRequest request = spaced_request(study, poses);
  if (!study.list.empty()) return request;
  request.make_space = [&study, &variant](const Eigen::MatrixXd& R) {
    return make_configuration_space({{variant.model.get(), variant.workspace.get(), variant.columns.selected, {}}},
                                    study.configurations, study.measured, study.distance.spacing, R);
  };
  return request;
}

/// The best plan for each variant that can be identified. CannotDo if the search is ended before one is done.
PlansToCompare searched_plans(const Study& study, const Monitor& monitor) {
  const Configurations& candidates = study.configurations;
  std::vector<const Variant*> variants;
  for (const Variant& variant : study.variants)
    if (variant.why_not.empty()) variants.push_back(&variant);
  PlansToCompare result;
  const auto values_of = [&](const Variant& variant) {
    const SearchResult found =
        search(search_parts(variant, candidates, study.planner.threads), request_for(study, variant, *study.poses),
               NamedMonitor(monitor, variant.spec->name));
    ByteWriter bytes;
    bytes.put(found.stopped || monitor.was_interrupted());
    bytes.put(chosen_by(found.design, candidates).values);
    return bytes.take();
  };
  std::vector<bool> planned(variants.size(), false);
  // One at a time in each process: the parts of a plan keep its threads busy.
  run_tasks(
      {"variants", variants.size(), 1, [](std::size_t, std::string_view) {}},
      [&](std::size_t v, int) { return values_of(*variants[v]); },
      [&](std::size_t v, std::string_view bytes) {
        Configurations poses;
        poses.dimension = candidates.dimension;
        ByteReader from(bytes);
        // Cut short it would look worse than another variant's, and is not.
        if (from.get<bool>()) return;
        from.get(poses.values);
        planned[v] = true;
        const std::string& name = variants[v]->spec->name;
        result.plans.push_back({"best for " + name, name, int(poses.count())});
        result.poses.push_back(std::move(poses));
      },
      monitor);
  for (std::size_t v = 0; v < variants.size(); ++v)
    if (!planned[v]) result.not_planned.push_back(variants[v]->spec->name);
  if (result.plans.empty() && !variants.empty()) throw CannotDo("the comparison was stopped before a plan was done");
  return result;
}

/// Lists as they are. Throws InputError if one cannot be read.
PlansToCompare given_plans(const Study& study, const std::vector<CompareOptions::List>& lists) {
  PlansToCompare result;
  for (const CompareOptions::List& list : lists) {
    const PoseList& read = list.poses;
    require_fits(read, study.first().workspace->coordinates());
    Configurations poses;
    poses.dimension = study.configurations.dimension;
    for (std::size_t i = 0; i < read.configurations.size(); ++i) {
      // What the problem names as measured counts once.
      if (study.measured.count() > 0 && !read.measured.empty() && read.measured[i]) continue;
      append(poses, read.configurations[i]);
    }
    if (poses.count() == 0) throw InputError({read.name, 0}, "has no poses to measure", "at least one is needed");
    result.notes.insert(result.notes.end(), read.notes.begin(), read.notes.end());
    note_parameters(read, parameters_of(*study.problem), result.notes);
    result.plans.push_back({list.name, "", int(poses.count())});
    result.poses.push_back(std::move(poses));
  }
  return result;
}

class ComparisonRun {
 public:
  ComparisonRun(const Problem& problem, const CompareOptions& options, const Monitor& monitor)
      : problem_(compared_problem(problem, !options.plans.empty())),
        options_(options),
        monitor_(monitor),
        study_(comparison_study(problem_, options, monitor)),
        pool_(study_.configurations) {}

  Comparison compare() {
    describe_variants();
    take(options_.plans.empty() ? searched_plans(study_, monitor_) : given_plans(study_, options_.plans));
    for (const Configurations& poses : poses_)
      for (std::size_t i = 0; i < poses.count(); ++i)
        if (!holds(pool_, poses[i])) append(pool_, poses[i]);
    judged_.resize(poses_.size());
    for (std::size_t p = 0; p < poses_.size(); ++p)
      for (const Variant& variant : study_.variants) result_.scores.push_back(score(p, variant));
    for (std::size_t p = 0; p < poses_.size() && !monitor_.should_stop(); ++p) alias(p);
    result_.interrupted = monitor_.should_stop();
    // A part of them would read as if the others had none.
    if (result_.interrupted) {
      result_.aliases.clear();
      result_.worths.clear();
    }
    return std::move(result_);
  }

 private:
  static bool holds(const Configurations& list, std::span<const double> q) {
    for (std::size_t i = 0; i < list.count(); ++i)
      if (std::equal(q.begin(), q.end(), list[i].begin())) return true;
    return false;
  }

  void take(PlansToCompare plans) {
    result_.criterion = options_.plans.empty() ? study_.criterion : "";
    result_.method = options_.plans.empty() ? study_.method : "";
    result_.plans = std::move(plans.plans);
    result_.notes = std::move(plans.notes);
    result_.not_planned = std::move(plans.not_planned);
    poses_ = std::move(plans.poses);
  }

  void describe_variants() {
    result_.candidates = study_.configurations.count();
    for (const Variant& v : study_.variants) {
      const int all = int(v.columns.selected.size()), nuisance = v.columns.nuisance;
      result_.variants.push_back({v.spec->name, all - nuisance, nuisance, v.reasons, v.why_not});
    }
  }

  PlanScore score(std::size_t plan, const Variant& variant) {
    PlanScore score;
    score.variant = variant.spec->name;
    score.plan = result_.plans[plan].name;
    score.why_not = variant.why_not;
    if (!score.why_not.empty()) return score;
    for (std::size_t i = 0; i < poses_[plan].count(); ++i)
      if (const int reason = variant.workspace->violation(poses_[plan][i]); reason >= 0 && ++score.infeasible == 1)
        score.infeasible_because = variant.workspace->reasons()[std::size_t(reason)];
    try {
      const VariantColumns& columns = variant.columns;
      const Configurations all = with_measured(study_, poses_[plan]);
      AdjustedEvaluation worth =
          effect_adjusted_evaluation(variant, all, study_.prior ? Prior::every : Prior::none, study_.planner.threads);
      const Evaluation& e = judged_[plan][&variant] = std::move(worth.evaluation);
      score.log_det = e.log_det;
      score.condition = e.condition;
      if (!monitor_.should_stop())
        score.expected = expected_error(study_.configurations, variant, all, e.covariance, study_.planner.threads);
      fill_sigma(score, columns, e);
      std::vector<double> each;
      if (!variant.test_points.empty()) score.rho0 = predicted_error(variant.test_points, worth.errors, each);
      if (const auto bound = bound_of(variant, int(poses_[plan].count())))
        score.efficiency = std::min(
            1.0, std::exp((e.log_det - *bound) / double(columns.selected.size() - std::size_t(columns.nuisance))));
    } catch (const CannotDo& error) {
      score.why_not = error.what();
    }
    return score;
  }

  static void fill_sigma(PlanScore& score, const VariantColumns& columns, const Evaluation& e) {
    double sum = 0;
    for (std::size_t j = std::size_t(columns.nuisance); j < columns.parameters.size(); ++j) {
      const double ratio = e.sigma[Eigen::Index(j)] / columns.parameters[j].tolerance;
      sum += std::log(ratio);
      if (ratio > score.worst) {
        score.worst = ratio;
        score.worst_parameter = columns.parameters[j].name;
      }
    }
    score.mean = std::exp(sum / double(columns.parameters.size() - std::size_t(columns.nuisance)));
  }

  /// log det that no plan of so many of the common candidates and of the poses compared exceeds; none if so many
  /// cannot be chosen.
  std::optional<double> bound_of(const Variant& variant, int poses) {
    const auto key = std::pair(&variant, poses);
    if (const auto known = bounds_.find(key); known != bounds_.end()) return known->second;
    if (monitor_.should_stop()) return std::nullopt;
    SearchRequest wanted = request_for(study_, variant, poses);
    wanted.criterion = "o1";
    wanted.spacing = nullptr;  // poses that were given need not keep it
    std::optional<double> bound;
    if (double(poses) <= double(pool_.count()) * wanted.repeats.most)
      bound = bound_only(search_parts(variant, pool_, study_.planner.threads), wanted,
                         NamedMonitor(monitor_, variant.spec->name))
                  .certificate.bound;
    return bounds_[key] = bound;
  }

  /// A plan that was searched tells of its own variant, one that was given of all.
  void alias(std::size_t plan) {
    for (const auto& fitted : study_.variants) {
      const std::string& own = result_.plans[plan].own_of;
      const auto evaluation = judged_[plan].find(&fitted);
      if (evaluation == judged_[plan].end() || (!own.empty() && own != fitted.spec->name)) continue;
      for (const auto& truth : study_.variants) {
        if (&truth == &fitted || !truth.why_not.empty()) continue;
        if (!options_.truth.empty() && options_.truth != truth.spec->name) continue;
        if (monitor_.should_stop()) return;
        VariantAlias found =
            variant_alias(study_, fitted, truth, with_measured(study_, poses_[plan]), evaluation->second);
        found.plan = result_.plans[plan].name;
        add_worth(truth, {&fitted, &evaluation->second, found.plan}, found, plan);
        result_.aliases.push_back(std::move(found));
      }
    }
  }

  void add_worth(const Variant& with, const JudgedVariant& without, const VariantAlias& alias, std::size_t plan) {
    // Each with its own best plan, or both with the one that was given.
    for (std::size_t p = 0; p < poses_.size(); ++p) {
      if (result_.plans[p].own_of.empty() ? p != plan : result_.plans[p].own_of != with.spec->name) continue;
      const auto evaluation = judged_[p].find(&with);
      if (evaluation == judged_[p].end()) continue;
      ExtraWorth worth = extra_worth({&with, &evaluation->second, result_.plans[p].name}, without, alias);
      if (!worth.extra.empty() || !worth.why_not.empty()) result_.worths.push_back(std::move(worth));
    }
  }

  const Problem problem_;  ///< as it is compared
  const CompareOptions& options_;
  const Monitor& monitor_;
  const Study study_;
  Configurations pool_;
  std::vector<Configurations> poses_;                         ///< of each plan
  std::vector<std::map<const Variant*, Evaluation>> judged_;  ///< of each plan
  std::map<std::pair<const Variant*, int>, std::optional<double>> bounds_;
  Comparison result_;
};

}  // namespace

Comparison compare_problem(const Problem& problem, const CompareOptions& options, const Monitor& monitor) {
  return ComparisonRun(problem, options, monitor).compare();
}

}  // namespace posewright
