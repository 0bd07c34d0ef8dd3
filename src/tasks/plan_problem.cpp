#include "posewright/tasks/plan_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "fill_plan.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/readable.hpp"
#include "posewright/problem/design_keys.hpp"
#include "posewright/study/expected_error.hpp"
#include "posewright/study/judgement.hpp"
#include "posewright/study/other_numbers.hpp"
#include "posewright/study/pose_distance.hpp"
#include "posewright/study/study.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/study/written_plan.hpp"
#include "posewright/support/error.hpp"
#include "posewright/workspace/candidates.hpp"
#include "robust_plan.hpp"

namespace posewright {
namespace {

constexpr int robots = 200;
// A pose that fewer lose is no worse than readings that are missed by accident.
constexpr double worth_saying = 0.05;
constexpr std::size_t most_named = 4;
constexpr std::uint64_t risk_stream = 0x715c;

struct Risk {
  int id = 0;
  double share = 0.0;
};

std::vector<Risk> risks(const Variant& variant, const Configurations& poses, int first, std::uint64_t seed) {
  std::vector<Risk> found;
  for (std::size_t i = 0; i < poses.count(); ++i) found.push_back({first + int(i), 0.0});
  std::vector<double> stands(variant.model->coordinates().size());
  for (int k = 0; k < robots; ++k) {
    Random random(seed ^ risk_stream, std::uint64_t(k));
    const std::vector<double> robot = drawn_correction(variant.columns, variant.model->parameters().size(), random);
    for (std::size_t i = 0; i < poses.count(); ++i)
      if (!readable(*variant.model, poses[i], robot, stands)) found[i].share += 1.0 / robots;
  }
  std::erase_if(found, [](const Risk& risk) { return risk.share < worth_saying; });
  std::ranges::stable_sort(found, [](const Risk& a, const Risk& b) { return a.share > b.share; });
  return found;
}

/// A sentence on poses of a plan that robots drawn from the tolerances cannot take, or that the instrument cannot
/// read there (the board leaves the picture, the distance the instrument's range); empty: none is lost by one in
/// twenty.
/// @param first  what the first of the poses is called; the others follow
std::string poses_at_risk(const Variant& variant, const Configurations& poses, int first, std::uint64_t seed) {
  if (variant.model->unmeasurable_reason().empty()) return "";
  const std::vector<Risk> found = risks(variant, poses, first, seed);
  if (found.empty()) return "";
  std::string which;
  for (std::size_t i = 0; i < std::min(found.size(), most_named); ++i)
    which += fmt::format("{}pose {} by {:.0f} %", i == 0 ? "" : ", ", found[i].id, 100 * found[i].share);
  if (found.size() > most_named) which += fmt::format(", {} more by fewer", found.size() - most_named);
  return fmt::format(
      "Some of {} robots drawn from the tolerances cannot be read at these poses ({}): {}. `workspace: readable_for: "
      "20` avoids such poses; smaller tolerances of base and tool help, too.",
      robots, variant.model->unmeasurable_reason(), which);
}

// Nobody measures more in one go; a requirement that needs more is out of reach.
constexpr int most_poses = 2000;
// Half a 95 % interval of a normal error in σ.
constexpr double axis_interval = 1.96;

/// A plan with what a search beside it begins with.
struct Searched {
  Plan plan;
  Configurations chosen;           // its poses without fixed and measured ones
  std::vector<double> references;  // as SearchResult
};

/// A prepared problem and plans of it.
class PlanSearch {
 public:
  PlanSearch(Setup setup, const Monitor& monitor)
      : problem_(*setup.problem), monitor_(monitor), study_(prepared(std::move(setup), monitor)), notes_(study_.notes) {
    if (study_.distance.kept)
      minimum_distance_ = distance_text(study_.first().workspace->coordinates(), study_.distance.spacing);
    if (study_.distance.usual)
      notes_.push_back(
          fmt::format("Poses are kept apart: two differ by at least {} in one coordinate (the default; "
                      "minimum_distance changes it).",
                      minimum_distance_));
    if (!study_.why_criterion.empty()) notes_.push_back(study_.why_criterion);
  }

  Plan plan() {
    Searched found = study_.poses ? plan(*study_.poses) : smallest();
    if (study_.other_numbers && is_thorough() && !monitor_.should_stop()) {
      std::vector<CurvePoint> points =
          other_numbers(study_, found.chosen, study_.configurations, found.references, monitor_);
      // Some of them would look as if more poses did not fit.
      if (!monitor_.should_stop()) found.plan.other_numbers = std::move(points);
    }
    return std::move(found.plan);
  }

 private:
  /// Searches for other numbers of poses take a few per cent of a search with as many restarts as nobody asked for, and
  /// up to half of a quick one: then report carries them out.
  bool is_thorough() const { return study_.planner.restarts >= PlannerOptions{}.restarts; }

  static Study prepared(Setup setup, const Monitor& monitor) {
    const std::optional<int> poses = setup.poses;
    return choose_criterion(make_study(std::move(setup), monitor), poses);
  }

  Searched plan(int poses) {
    SearchRequest request = spaced_request(study_, poses - fixed());
    if (!study_.candidates_alone) request.make_space = space_maker(study_, study_.criterion);
    request.prove = study_.poses.has_value();
    request.proof = study_.proof;
    SearchResult found = search(search_parts(study_, study_.criterion, study_.configurations, study_.planner.threads),
                                request, monitor_);
    if (!study_.robust) return assemble(std::move(found));
    // Last, so that whoever stops it has the plan of the nominal robot.
    RobustPlan robust = plan_robust(study_, found, monitor_);
    Searched searched = assemble(std::move(found));
    searched.plan.interrupted = searched.plan.interrupted || robust.stopped;
    searched.plan.robust = std::move(robust);
    return searched;
  }

  /// Doubles the number of poses until everything required is reached, then halves the interval.
  Searched smallest() {
    std::vector<CurvePoint> curve;
    int enough = 0, too_few = std::max(fewest(), fixed() + 1) - 1, unfit = limit() + 1;
    Searched best;
    for (int poses = std::min(too_few + 1, limit()); enough == 0;) {
      std::optional<Searched> trial = try_plan(poses, curve.empty() && poses == too_few + 1);
      if (!trial) {
        // At the minimum distance so many do not fit.
        unfit = poses;
        if (unfit - too_few <= 1) fail(curve, false);
        poses = (too_few + unfit) / 2;
        continue;
      }
      best = std::move(*trial);
      curve.push_back(judge_requirement(best.plan));
      if (curve.back().enough) {
        enough = poses;
      } else {
        too_few = poses;
        if (poses + 1 >= unfit || best.plan.interrupted) fail(curve, best.plan.interrupted);
        poses = unfit > limit() ? std::min(2 * poses, limit()) : (poses + unfit) / 2;
      }
    }
    while (enough - too_few > 1 && !monitor_.should_stop()) {
      const int middle = (enough + too_few) / 2;
      Searched trial = plan(middle);
      curve.push_back(judge_requirement(trial.plan));
      if (curve.back().enough) {
        enough = middle;
        best = std::move(trial);
      } else {
        too_few = middle;
      }
    }
    std::sort(curve.begin(), curve.end(), [](const auto& a, const auto& b) { return a.poses < b.poses; });
    best.plan.curve = std::move(curve);
    best.plan.interrupted = best.plan.interrupted || enough - too_few > 1;
    return best;
  }

  /// Number of poses in any plan.
  int fixed() const { return int(study_.fixed.count()); }

  int limit() const {
    if (study_.repeats.most > 1) return most_poses;
    return std::min<int>(most_poses, int(study_.configurations.count()) + fixed());
  }

  int fewest() const {
    int most = 1;
    for (const Variant& v : study_.variants) {
      if (v.known_before) continue;
      const auto number = smallest_number_of_poses(*v.model, study_.configurations, v.columns, study_.planner.threads);
      if (!number) throw CannotDo("the candidates do not determine all parameters; more candidates are needed");
      most = std::max(most, *number);
    }
    return most;
  }

  CurvePoint judge_requirement(const Plan& plan) const {
    const RequirementSpec& require = problem_.design.require;
    CurvePoint point{
        int(std::count_if(plan.poses.begin(), plan.poses.end(), [](const auto& p) { return !p.measured; })),
        plan.log_det, plan.rho0, std::nullopt, true};
    if (require.accuracy) point.enough = *plan.rho0 <= *require.accuracy;
    for (const std::array<double, 6>& sigma : plan.test_axes)
      for (std::size_t k = 0; k < sigma.size(); ++k)
        if (require.axes[k])
          point.worst_axis = std::max(point.worst_axis.value_or(0), axis_interval * sigma[k] / *require.axes[k]);
    if (point.worst_axis) point.enough = point.enough && *point.worst_axis <= 1.0;
    if (require.sigma.empty()) return point;
    const VariantColumns& columns = study_.first().columns;
    const auto wanted = values_by_pattern(columns, require.sigma, problem_, "the required σ");
    point.worst_sigma = 0.0;
    for (std::size_t j = 0; j < wanted.size(); ++j)
      for (const PlannedParameter& p : plan.parameters)
        if (wanted[j] && p.sigma && p.label.name == columns.parameters[j].name)
          point.worst_sigma = std::max(*point.worst_sigma, *p.sigma / *wanted[j]);
    point.enough = point.enough && *point.worst_sigma <= 1.0;
    return point;
  }

  /// None if so many poses do not fit, unless that is to be told.
  std::optional<Searched> try_plan(int poses, bool tell) {
    try {
      return plan(poses);
    } catch (const CannotDo&) {
      if (tell) throw;
      return std::nullopt;
    }
  }

  [[noreturn]] void fail(const std::vector<CurvePoint>& curve, bool interrupted) const {
    const CurvePoint& last = curve.back();
    std::string text = fmt::format("design: require is not met with {} poses", last.poses);
    if (last.rho0 && problem_.design.require.accuracy)
      text += fmt::format("; accuracy {:.4g} mm, required {:.4g} mm", 1e3 * *last.rho0,
                          1e3 * *problem_.design.require.accuracy);
    if (last.worst_axis)
      text += fmt::format("; 95 % of the error along or about an axis {:.3g} times the required one", *last.worst_axis);
    if (last.worst_sigma) text += fmt::format("; largest σ {:.3g} times the required one", *last.worst_sigma);
    if (interrupted) text += "; the search ended before more poses were tried";
    throw CannotDo(text);
  }

  Searched assemble(SearchResult found) const {
    // Judged from the configurations that will be written, not from anything the search kept.
    order_by_instrument(found);
    const Configurations chosen = chosen_by(found.design, study_.configurations);
    const Configurations poses = with_fixed(chosen);
    const Judgement judgement = judge(study_, poses);
    Plan plan;
    plan.seed = study_.planner.seed;
    plan.problem = origin_of(problem_);
    plan.method = study_.method;
    plan.minimum_distance = minimum_distance_;
    fill_judgement(plan, judgement, study_);
    plan.expected = expected_error(study_.configurations, study_.first(), with_measured(study_, poses),
                                   judgement.evaluations.front().covariance, study_.planner.threads);
    const double phi = phi_of(*found.measure, study_.criterion, study_, chosen);
    plan.criterion_value = find_criterion(study_.criterion)->shown(phi, judgement.evaluations.front().indices);
    plan.certificate = found.certificate;
    certify(plan.certificate, phi, found.degree);
    if (auto& whole = plan.certificate.workspace)
      whole->within = proposed_within(*study_.first().workspace, *study_.first().model);
    // References of everything are none of the parameters'.
    if (!study_.first().nuisance_counts) fill_variants(plan, judgement, study_, found.references);
    fill_poses(plan, study_, chosen, found.design.members, found.without, judgement);
    fill_without_fixed(plan, chosen, found, phi);
    fill_instruments(plan, study_, chosen, *found.measure, phi, found.degree);
    fill_candidates(plan.statistics, study_);
    plan.statistics.notes = notes_;
    plan.statistics.cell = cell_notes(*study_.cell);
    plan.statistics.limit_margins = limit_margins(study_.first());
    plan.statistics.exchanges = found.design.exchanges;
    plan.statistics.restarts = found.design.restarts;
    plan.statistics.stages = found.stages;
    if (problem_.workspace.readable_for == 0) warn_of_lost_poses(plan, poses);
    plan.proved_optimal = found.design.optimal;
    // A search that had its say before the signal came is not distinguished: the run was ended.
    plan.interrupted = found.stopped || monitor_.was_interrupted();
    return {std::move(plan), chosen, std::move(found.references)};
  }

  /// Poses of one instrument stand together: whoever measures mounts it once.
  void order_by_instrument(SearchResult& found) const {
    const auto instrument = instrument_index(study_.first().model->coordinates());
    if (!instrument) return;
    const Configurations chosen = chosen_by(found.design, study_.configurations);
    std::vector<std::size_t> order(chosen.count());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return chosen[i][*instrument]; });
    const auto ordered = [&](auto& of_each) {
      const auto before = of_each;
      for (std::size_t i = 0; i < of_each.size(); ++i) of_each[i] = before[order[i]];
    };
    ordered(found.design.members);
    ordered(found.without);
  }

  void warn_of_lost_poses(Plan& plan, const Configurations& poses) const {
    std::string risk = poses_at_risk(study_.first(), poses, int(study_.measured.count()) + 1, study_.planner.seed);
    if (!risk.empty()) plan.statistics.notes.push_back(std::move(risk));
  }

  /// Fixed poses, then what the search chose.
  Configurations with_fixed(const Configurations& chosen) const {
    Configurations all = study_.fixed;
    all.values.insert(all.values.end(), chosen.values.begin(), chosen.values.end());
    return all;
  }

  /// Efficiency without each fixed pose, which no search computed.
  void fill_without_fixed(Plan& plan, const Configurations& chosen, const SearchResult& found, double phi) const {
    if (fixed() == 0) return;
    const int threads = study_.planner.threads;
    const std::vector<double> left =
        found.measure->phi_without(search_parts(study_, study_.criterion, chosen, threads),
                                   search_parts(study_, study_.criterion, study_.fixed, threads));
    for (std::size_t i = 0; i < left.size(); ++i)
      plan.poses[study_.measured.count() + i].without =
          std::min(1.0, std::exp((left[i] - phi) / (found.degree > 0 ? found.degree : 1.0)));
  }

  const Problem& problem_;
  const Monitor& monitor_;
  const Study study_;
  std::vector<std::string> notes_;
  std::string minimum_distance_;  // for people; empty: none
};

}  // namespace

namespace {

/// By o1 where nobody chose a criterion and none of those that count an effect finds poses: it starts from sets that
/// others do not reach.
Plan plan_by_some_criterion(const Problem& problem, const RunOptions& run, const Monitor& monitor) {
  try {
    return PlanSearch(resolve(problem, run, monitor, Purpose::plan), monitor).plan();
  } catch (const NothingIdentifies&) {
    if (problem.design.criterion.value != automatic_criterion) throw;
  }
  Problem with_o1 = problem;
  with_o1.design.criterion.value = "o1";
  Plan plan = PlanSearch(resolve(with_o1, run, monitor, Purpose::plan), monitor).plan();
  plan.statistics.notes.emplace_back("Criterion o1, since no poses were found by a criterion that counts effects.");
  return plan;
}

}  // namespace

Plan plan_problem(const Problem& problem, const RunOptions& run, const Monitor& monitor) {
  const auto begin = std::chrono::steady_clock::now();
  Plan plan = plan_by_some_criterion(problem, run, monitor);
  plan.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return plan;
}

Plan plan_validation(Problem problem, RunOptions run, const Plan& plan, int poses, const Monitor& monitor) {
  const bool told_apart = problem.design.truth.has_value();
  const bool effect = find_variant(problem, "").unmodelled.has_value();
  set(problem, "design.criterion", told_apart ? "discriminate" : effect ? "ds" : "o1", "validation");
  set(problem, "design.poses", std::to_string(poses), "validation");
  problem.design.reserve = false;
  problem.design.robust.reset();
  // Of poses whose readings tell most of effect and parameters together, the plan tells least (maximum entropy).
  run.nuisance_counts = effect && !told_apart;
  run.measured = poses_of(plan, pose_coordinates(problem));
  run.fixed = PoseList{};
  return plan_problem(problem, run, monitor);
}

}  // namespace posewright
