#include "compared_plans.hpp"

#include <algorithm>

#include "posewright/criterion/registry.hpp"
#include "posewright/lists/parameters_file.hpp"
#include "posewright/study/space.hpp"
#include "posewright/support/bytes.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/tasks.hpp"

namespace posewright {

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

SearchRequest request_for(const Study& study, const Variant& variant, int poses) {
  SearchRequest request = spaced_request(study, poses);
  if (!study.list.empty()) return request;
  request.make_space = [&study, &variant](const Eigen::MatrixXd& R) {
    return make_configuration_space({{variant.model.get(), variant.workspace.get(), variant.columns.selected, {}}},
                                    study.configurations, study.measured, study.distance.spacing, R);
  };
  return request;
}

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

}  // namespace posewright
