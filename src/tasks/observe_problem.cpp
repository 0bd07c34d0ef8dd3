#include "posewright/tasks/observe_problem.hpp"

#include <algorithm>
#include <deque>
#include <memory>
#include <utility>

#include "posewright/calibration/given.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/planning/evaluate.hpp"
#include "posewright/study/columns.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/error.hpp"
#include "without_roadmap.hpp"

namespace posewright {
namespace {

// Nine tenths of an effect look like other parameters': worth a line.
constexpr double near_share = 0.1;

/// Poses that σ is predicted for: what is asked for, what the design says, but enough to determine everything.
int judged_poses(const Variant& variant, const ObserveOptions& options, int smallest) {
  const auto& stated = variant.problem->design.poses;
  const int wanted = options.poses ? *options.poses : stated ? stated->value : 2 * smallest;
  return std::max(wanted, smallest);
}

void add_practical(Observation& o, const BlockArray& pool, const Variant& variant, const ObserveOptions& options,
                   const Monitor& monitor) {
  if (!o.smallest_poses) return;
  try {
    o.practical =
        practical_identifiability(pool, o.kept, judged_poses(variant, options, *o.smallest_poses), near_share, monitor);
  } catch (const CannotDo&) {
    // Told apart by less than double precision can use: the dependencies above say so.
  }
}

Observation observe(const Variant& variant, const Configurations& configurations, const ObserveOptions& options,
                    const Monitor& monitor) {
  const VariantColumns columns = all_columns(variant);
  const BlockArray pool = build_blocks(*variant.model, columns.selected, configurations, options.threads);
  Observation result;
  result.variant = variant.spec->name;
  result.configurations = configurations.count();
  result.rows = variant.model->rows();
  result.parameters = columns.parameters;
  IdentifiabilityOptions structural;
  structural.tiers = columns.tiers;
  result.identifiability = identifiability(pool, columns.parameters, structural);
  result.given.resize(columns.parameters.size());
  if (!columns.automatic) result.given = given(result.identifiability.dependencies, columns.parameters);
  structural.threshold = 1e-9;
  result.exact_rank = identifiability(pool, columns.parameters, structural).rank;
  const VariantColumns kept = subset(columns, result.identifiability.kept);
  result.kept = kept.parameters;
  if (int(kept.selected.size()) == kept.nuisance) return result;
  const BlockArray kept_pool = build_blocks(*variant.model, kept.selected, configurations, options.threads);
  result.indices = evaluate(kept_pool, kept.parameters).indices;
  result.smallest_poses = smallest_number_of_poses(*variant.model, configurations, kept, options.threads);
  add_practical(result, kept_pool, variant, options, monitor);
  return result;
}

/// Configurations of the variants that came before: robots that stand alike reach and see the same.
class Draws {
 public:
  Draws(const Problem& problem, const ObserveOptions& options, const Monitor& monitor)
      : problem_(problem), without_roadmap_(without_roadmap(problem)), cell_(make_cell(problem)), monitor_(monitor) {
    sampling_.count = std::size_t(options.candidates);
    sampling_.seed = options.seed;
    sampling_.threads = options.threads;
  }

  /// The variant, and where it is looked at.
  std::pair<Variant, const Configurations*> of(const VariantSpec& spec) {
    const std::shared_ptr<const IdentificationModel> model = make_model({problem_, spec});
    for (const Drawn& known : drawn_)
      // What a variant estimates says how far its robots may be off that must be readable.
      if (problem_.workspace.readable_for == 0 && known.spec->convention == spec.convention &&
          stand_alike(*known.model, *model))
        return {place_variant({without_roadmap_, spec}, cell_, monitor_), &known.configurations};
    Variant variant = place_variant({problem_, spec}, cell_, monitor_);
    Configurations configurations = sample_configurations(*variant.workspace, sampling_, monitor_);
    drawn_.push_back({&spec, model, std::move(configurations)});
    return {std::move(variant), &drawn_.back().configurations};
  }

 private:
  static bool stand_alike(const IdentificationModel& a, const IdentificationModel& b) {
    const auto same = [](const Parameter& p, const Parameter& q) { return p.name == q.name && p.nominal == q.nominal; };
    const auto alike = [](const Coordinate& c, const Coordinate& d) {
      return c.name == d.name && c.values == d.values;
    };
    return std::equal(a.parameters().begin(), a.parameters().end(), b.parameters().begin(), b.parameters().end(),
                      same) &&
           std::equal(a.coordinates().begin(), a.coordinates().end(), b.coordinates().begin(), b.coordinates().end(),
                      alike);
  }

  struct Drawn {
    const VariantSpec* spec;
    std::shared_ptr<const IdentificationModel> model;
    Configurations configurations;
  };

  const Problem& problem_;
  const Problem without_roadmap_;
  std::shared_ptr<const Cell> cell_;
  const Monitor& monitor_;
  SamplingOptions sampling_;
  std::deque<Drawn> drawn_;  // whoever was handed one keeps it
};

}  // namespace

std::vector<Observation> observe_problem(const Problem& problem, const ObserveOptions& options,
                                         const Monitor& monitor) {
  if (!options.variant.empty()) find_variant(problem, options.variant);
  Draws draws(problem, options, monitor);
  std::vector<Observation> observations;
  for (const VariantSpec& spec : problem.variants) {
    if (!options.variant.empty() && spec.name != options.variant) continue;
    const auto [variant, configurations] = draws.of(spec);
    observations.push_back(observe(variant, *configurations, options, monitor));
  }
  return observations;
}

}  // namespace posewright
