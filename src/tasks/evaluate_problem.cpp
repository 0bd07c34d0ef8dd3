#include "posewright/tasks/evaluate_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <variant>

#include "fill_plan.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/criterion/trace.hpp"
#include "posewright/lists/parameters_file.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/study/discrepancy.hpp"
#include "posewright/study/expected_error.hpp"
#include "posewright/study/judgement.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/error.hpp"
#include "robust_plan.hpp"

namespace posewright {
namespace {

// Sets that branch and bound tries before it would take too long; above, the search is good but not proved.
constexpr double proved_drop = 5e4;
// Bounds and each pose's worth take seconds by the square of their number: some minutes of this many.
constexpr std::size_t most_judged = 2000;

class ListEvaluation {
 public:
  ListEvaluation(Setup setup, const PoseList& list, const EvaluateOptions& options, const Monitor& monitor)
      : options_(options), monitor_(monitor), study_(prepared(std::move(setup), list, monitor)) {
    if (monitor.should_stop()) throw CannotDo("stopped before all candidates for the comparison were drawn");
    const std::vector<Coordinate>& coordinates = study_.first().workspace->coordinates();
    notes_ = study_.notes;
    notes_.insert(notes_.end(), list.notes.begin(), list.notes.end());
    note_parameters(list, parameters_of(*study_.problem), notes_);
    poses_.dimension = int(coordinates.size());
    std::vector<int> near;  // ids
    for (std::size_t i = 0; i < list.configurations.size(); ++i) {
      if (is_known(study_, list, i)) continue;
      if (list.measured.empty() || !list.measured[i]) require_feasible(list.configurations[i], i, list);
      append(poses_, list.configurations[i]);
      if (!study_.first().workspace->within_margin(list.configurations[i]).empty())
        near.push_back(i < list.ids.size() ? list.ids[i] : int(i) + 1);
    }
    if (!near.empty()) notes_.push_back(margin_note(list.name, near));
    fill_pool();
    limits_ = limits_of_list();
    if (!study_.why_criterion.empty()) notes_.push_back(study_.why_criterion);
  }

  PoseListEvaluation evaluate() {
    const Problem& problem = *study_.problem;
    PoseListEvaluation result;
    result.notes = notes_;
    const Judgement judgement = judge(study_, poses_);
    Plan& plan = result.plan;
    plan.seed = study_.planner.seed;
    plan.problem = origin_of(problem);
    plan.method = "given";
    fill_judgement(plan, judgement, study_);
    plan.expected = expected_error(study_.configurations, study_.first(), with_measured(study_, poses_),
                                   judgement.evaluations.front().covariance, study_.planner.threads);
    const std::vector<double> references = score_all(result, judgement);
    const double phi = phi_of(*measure_, study_.criterion, study_, poses_);
    plan.criterion_value = find_criterion(study_.criterion)->shown(phi, judgement.evaluations.front().indices);
    fill_variants(plan, judgement, study_, references);
    fill_poses(plan, study_, poses_, {}, without_each(phi), judgement);
    fill_instruments(plan, study_, poses_, *measure_, phi, degree_);
    fill_candidates(plan.statistics, study_);
    const bool stopped = monitor_.should_stop();
    if (study_.robust && !stopped) plan.robust = judge_robust_list(study_, pool_, in_pool_, monitor_);
    if (options_.drop && !stopped) result.drop = drop(*options_.drop, phi, references);
    if (options_.add && !monitor_.should_stop()) result.add = add(*options_.add, phi, references);
    plan.interrupted = monitor_.should_stop();
    if (stopped)
      result.notes.emplace_back(
          "ended early: efficiencies are lower bounds; other criteria, drop and add are left out");
    else if (plan.interrupted)
      result.notes.emplace_back("ended early: poses to drop and to add are the best so far, or left out");
    return result;
  }

 private:
  /// What the problem names as measured counts once.
  static bool is_known(const Setup& setup, const PoseList& list, std::size_t i) {
    return setup.measured.count() > 0 && !list.measured.empty() && list.measured[i];
  }

  static Study prepared(Setup setup, const PoseList& list, const Monitor& monitor) {
    require_fits(list, setup.first().workspace->coordinates());
    int poses = 0;
    for (std::size_t i = 0; i < list.configurations.size(); ++i) poses += is_known(setup, list, i) ? 0 : 1;
    return choose_criterion(make_study(std::move(setup), monitor), poses);
  }

  void require_feasible(const std::vector<double>& q, std::size_t i, const PoseList& list) const {
    for (const Variant& variant : study_.variants)
      if (const int reason = variant.workspace->violation(q); reason >= 0)
        throw InputError(
            {list.name, 0},
            fmt::format("pose {} is not feasible: {}", i + 1, variant.workspace->reasons()[std::size_t(reason)]),
            notes_.size() > study_.notes.size() + list.notes.size() ? notes_.back()
                                                                    : "poses within the workspace of the problem");
  }

  double degree() const { return degree_ > 0 ? degree_ : 1.0; }

  /// Bounds for as many candidates by every criterion; the references of the criterion in use.
  std::vector<double> score_all(PoseListEvaluation& result, const Judgement& judgement) {
    std::vector<double> references;
    Bound bound;
    bool of_determinant = false;
    for (const CriterionEntry& entry : criterion_registry()) {
      if (entry.several_variants != (study_.variants.size() > 1) && entry.name != study_.criterion) continue;
      if (entry.needs_truth && entry.name != study_.criterion &&
          (study_.discrepancy == nullptr || study_.discrepancy->group.columns == 0))
        continue;
      const bool chosen = entry.name == study_.criterion;
      if (entry.needs_test_poses && !any_is_moved(study_.first().test_points) && !chosen) continue;
      if (!chosen && monitor_.should_stop()) continue;
      // Two names of the determinant have one bound.
      if (!(entry.determinant && of_determinant)) bound = bound_of(entry);
      of_determinant = entry.determinant;
      const double phi = phi_of(*bound.measure, entry.name, study_, poses_);
      CriterionScore score{entry.name, entry.shown(phi, judgement.evaluations.front().indices), std::nullopt};
      if (bound.certificate.proved) {
        Certificate certificate = bound.certificate;
        certify(certificate, phi, bound.degree);
        score.efficiency = certificate.efficiency;
        if (chosen) result.plan.certificate = certificate;
      } else if (chosen) {
        result.plan.certificate.proved = false;
      }
      if (chosen) {
        references = bound.references;
        measure_ = bound.measure;
        degree_ = bound.degree;
      }
      result.scores.push_back(score);
    }
    return references;
  }

  /// The candidates and what the list has beside them, so that bounds hold for the list too.
  void fill_pool() {
    pool_ = study_.configurations;
    for (std::size_t i = 0; i < poses_.count(); ++i) {
      const auto q = poses_[i];
      std::size_t j = 0;
      while (j < pool_.count() && !std::equal(q.begin(), q.end(), pool_[j].begin())) ++j;
      if (j == pool_.count()) append(pool_, q);
      in_pool_.push_back(int(j));
    }
  }

  Bound bound_of(const CriterionEntry& entry) {
    const int threads = study_.planner.threads;
    SearchRequest wanted = search_request(study_, int(poses_.count()));
    wanted.criterion = entry.name;
    if (limits_) wanted.spacing = &*limits_;
    if (entry.needs_truth) return bound_only(search_parts(study_, entry.name, pool_, threads), wanted, monitor_);
    // Those of one variant and those of several have coordinates of their own.
    std::optional<CandidateBounds>& bounds = bounds_[entry.several_variants ? 1 : 0];
    if (!bounds) bounds.emplace(search_parts(study_, entry.name, pool_, threads), wanted);
    return bounds->of(entry.name, monitor_);
  }

  /// Limits of the instruments among the pool; none where the list itself breaks them.
  std::optional<Spacing> limits_of_list() const {
    std::optional<Spacing> limits = study_.distance.among(pool_);
    if (!limits || limits->most.empty()) return std::nullopt;
    limits->unit.resize(0);
    return limits->allows(in_pool_) ? limits : std::nullopt;
  }

  /// Φ of another list; −∞ where it leaves parameters open.
  std::optional<std::pair<Judgement, double>> judged(const Configurations& list) const {
    try {
      Judgement judgement = judge(study_, list);
      return std::pair{std::move(judgement), phi_of(*measure_, study_.criterion, study_, list)};
    } catch (const CannotDo&) {
      return std::nullopt;
    }
  }

  /// e^{(Φ without each pose − Φ)/h}; 0 where it is indispensable.
  std::vector<double> without_each(double phi) const {
    if (poses_.count() == 1) return {0.0};
    const std::vector<SearchPart> parts = search_parts(study_, study_.criterion, poses_, study_.planner.threads);
    std::vector<double> result = measure_->phi_without(parts, parts);
    for (double& left : result) left = std::isfinite(left) ? std::min(1.0, std::exp((left - phi) / degree())) : 0.0;
    return result;
  }

  ListChange changed(const Configurations& list, double phi) const {
    ListChange change;
    const auto other = judged(list);
    if (!other) return change;
    change.efficiency = std::exp((other->second - phi) / degree());
    change.log_det = other->first.evaluations.front().log_det;
    change.rho0 = other->first.rho0;
    return change;
  }

  /// Of the list's i-th pose, as the plan's table has it: poses that were measured before stand first.
  int id_of(int i) const { return int(known_before(study_).count()) + i + 1; }

  /// The best N − k of the N: a search over the list itself.
  ListChange drop(int k, double phi, const std::vector<double>& references) {
    const int n = int(poses_.count());
    if (k >= n) throw CannotDo(fmt::format("{} of {} poses cannot be dropped: at least one must be left", k, n));
    SearchRequest wanted = search_request(study_, n - k);
    double sets = 1.0;
    for (int i = 0; i < k; ++i) sets *= double(n - i) / (i + 1);
    wanted.method = sets <= proved_drop && degree_ > 0 ? "branch_and_bound" : "exchange";
    wanted.repeats = Repeats{1};
    wanted.references = references;
    wanted.certificate = false;
    const SearchResult found =
        search(search_parts(study_, study_.criterion, poses_, study_.planner.threads), wanted, monitor_);
    std::vector<int> dropped;
    for (int i = 0; i < n; ++i)
      if (!std::binary_search(found.design.members.begin(), found.design.members.end(), i)) dropped.push_back(i);
    ListChange change = changed(without(poses_, dropped), phi);
    for (const int i : dropped) change.poses.push_back(id_of(i));
    return change;
  }

  /// k more with the list as what is known already.
  ListChange add(int k, double phi, const std::vector<double>& references) {
    const int threads = study_.planner.threads;
    const Configurations known = with_measured(study_, poses_);
    const PoseDistance distance = pose_distance(study_, known, k);
    distance.require_room(k);
    const Configurations candidates = distance.away_from(known, study_.configurations, study_.repeats);
    std::vector<SearchPart> parts = search_parts(study_, study_.criterion, candidates, threads);
    // Parts know what was measured before the list; the list's own information comes on top of it, once.
    const std::vector<SearchPart> list = search_parts(study_, study_.criterion, poses_, threads);
    for (std::size_t v = 0; v < parts.size(); ++v) {
      const Eigen::MatrixXd own = list[v].blocks.all().transpose() * list[v].blocks.all();
      parts[v].prior = parts[v].prior.size() > 0 ? Eigen::MatrixXd(parts[v].prior + own) : own;
    }
    SearchRequest wanted = search_request(study_, k);
    const std::optional<Spacing> spacing = distance.among(candidates);
    if (spacing) wanted.spacing = &*spacing;
    wanted.make_space = space_maker(study_, study_.criterion, candidates, known, distance.spacing);
    // Rough starts between the candidates lose nothing with arms; with closed chains one pose was 0.1 worse in log det.
    wanted.certificate = !std::holds_alternative<SerialArmSpec>(study_.problem->robot);
    wanted.references = references;
    const SearchResult found = search(std::move(parts), wanted, monitor_);
    const Configurations added = chosen_by(found.design, candidates);
    Configurations longer = poses_;
    longer.values.insert(longer.values.end(), added.values.begin(), added.values.end());
    ListChange change = changed(longer, phi);
    for (std::size_t i = 0; i < added.count(); ++i) {
      change.added.push_back(pose_of(*study_.first().model, added[i]));
      change.added.back().id = id_of(int(poses_.count() + i));
    }
    return change;
  }

  const EvaluateOptions& options_;
  const Monitor& monitor_;
  const Study study_;
  Configurations poses_, pool_;
  std::optional<Spacing> limits_;  ///< of the instruments among the pool
  std::array<std::optional<CandidateBounds>, 2> bounds_;
  std::vector<int> in_pool_;  ///< the list's poses, by index in the pool
  std::vector<std::string> notes_;
  std::shared_ptr<const DesignMeasure> measure_;  ///< by the criterion in use
  double degree_ = 0.0;
};

}  // namespace

PoseListEvaluation evaluate_problem(const Problem& problem, const PoseList& list, const EvaluateOptions& options,
                                    const Monitor& monitor) {
  const auto begin = std::chrono::steady_clock::now();
  require_at_most(list, most_judged, "evaluate scores");
  Setup setup = resolve(problem, options.run, monitor, Purpose::list);
  PoseListEvaluation result = ListEvaluation(std::move(setup), list, options, monitor).evaluate();
  result.plan.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace posewright
