#include "posewright/report/report_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "posewright/lists/parameters_file.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/problem/design_keys.hpp"
#include "posewright/report/report_result.hpp"
#include "posewright/study/accuracy_points.hpp"
#include "posewright/study/judgement.hpp"
#include "posewright/study/other_numbers.hpp"
#include "posewright/study/study.hpp"
#include "posewright/study/unmodelled.hpp"
#include "posewright/study/written_plan.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/text_file.hpp"
#include "report_scene.hpp"

namespace posewright {
namespace {

// Candidates that the page shows, and at least for each pose of the plan: a search may need ten times as many, and in a
// cell they are most of a report's work.
constexpr int shown_candidates = 1000, shown_per_pose = 5;
// Of what the page shows of candidates to three digits.
constexpr double shown_tolerance = 1e-4;
// Relative difference of log det and of a predicted error that rounding of written configurations cannot make.
constexpr double same_figure = 1e-6;

/// As the plan was made, with no more candidates than the page shows.
Problem reported_problem(const Problem& problem, const WrittenPlan& plan) {
  Problem searched = as_written(problem, plan);
  const int most = std::max(shown_candidates, shown_per_pose * plan.poses);
  if (searched.design.candidates.value > most) set(searched, "design.candidates", std::to_string(most), "report");
  return searched;
}

/// What was measured before is in the plan, wherever it came from.
Study reported_study(const Problem& problem, const WrittenPlan& plan, const PoseList& list, int threads,
                     const Monitor& monitor) {
  RunOptions run;
  run.seed = plan.seed;
  run.threads = threads;
  run.kept_parameters = plan.parameters;
  run.measured.emplace();
  for (std::size_t i = 0; i < list.configurations.size(); ++i)
    if (list.measured[i]) run.measured->configurations.push_back(list.configurations[i]);
  return choose_criterion(make_study(resolve(problem, run, monitor), monitor), plan.poses);
}

/// A plan's text with the poses of its route in the place of those that they replace.
struct DrivenPlan {
  std::string text;
  std::vector<std::string> notes;  ///< one a replaced pose
};

/// The pose of this id; null if there is none.
template <class Json>
Json* pose_of_id(Json& poses, const nlohmann::ordered_json& id) {
  for (auto& pose : poses)
    if (pose.at("id") == id) return &pose;
  return nullptr;
}

void take_over(nlohmann::ordered_json& pose, const nlohmann::ordered_json& stop) {
  pose.erase("listed");
  pose["candidate"] = nullptr;
  for (const auto& [key, value] : stop.items()) pose[key] = value;
}

DrivenPlan driven_plan(std::string plan, const std::string& route) {
  DrivenPlan driven{std::move(plan), {}};
  try {
    const auto way = parse_ordered_json(route);
    if (way.value("replaced", nlohmann::ordered_json::array()).empty()) return driven;
    auto json = parse_ordered_json(driven.text);
    for (const auto& lost : way.at("replaced")) {
      auto* pose = pose_of_id(json.at("poses"), lost.at("pose"));
      const auto* stop = pose_of_id(way.at("poses"), lost.at("by"));
      if (pose == nullptr || stop == nullptr) continue;
      take_over(*pose, *stop);
      driven.notes.push_back(fmt::format("Pose {} is replaced by pose {} of the route: {}.", lost.at("pose").get<int>(),
                                         lost.at("by").get<int>(), lost.at("reason").get<std::string>()));
    }
    driven.text = json_text(json);
  } catch (const nlohmann::json::exception&) {
    // Playing the route says what is wrong with it.
  }
  return driven;
}

class ReportBuilder {
 public:
  ReportBuilder(const Problem& problem, const std::filesystem::path& file, const ReportOptions& options,
                const Monitor& monitor)
      : options_(options),
        monitor_(monitor),
        plan_(read_written_plan(file)),
        problem_(reported_problem(problem, plan_)),
        list_(driven_list()),
        study_(reported_study(problem_, plan_, list_, options.threads, monitor)) {
    // A shortened set of candidates would be shown as if it were whole.
    if (monitor.should_stop()) throw CannotDo("the report was stopped before its first part was finished");
    all_.dimension = new_.dimension = study_.configurations.dimension;
    for (std::size_t i = 0; i < list_.configurations.size(); ++i) {
      append(all_, list_.configurations[i]);
      if (!list_.measured[i]) append(new_, list_.configurations[i]);
    }
    fill_pool();
  }

  Report make() {
    report_.title = title_of(problem_.file);
    const Judgement judgement = judge(study_, new_);
    note_changes(judgement);
    note_effect(judgement);
    fill_information(judgement);
    std::vector<std::pair<int, std::vector<double>>> poses;
    for (std::size_t i = 0; i < list_.ids.size(); ++i) poses.emplace_back(list_.ids[i], list_.configurations[i]);
    const auto& coordinates = study_.first().workspace->coordinates();
    const Drawing drawing(problem_, *study_.cell);
    fill_scene(report_, drawing, poses, coordinates, options_.route);
    fill_pictures();
    for (const Coordinate& c : study_.first().model->actuators()) report_.actuators.emplace_back(c.name, c.unit);
    fill_prefix();
    fill_position_errors(judgement);
    if (options_.candidates || options_.sizes) find_gains();
    if (options_.candidates) fill_candidates();
    if (options_.sizes || stated_curve()) fill_curve(judgement);
    return std::move(report_);
  }

 private:
  /// The poses of the plan, as the route has them; takes its text into the report.
  PoseList driven_list() {
    if (!options_.route.empty()) report_.route_json = read_text(options_.route, plan_size_limit);
    DrivenPlan driven = driven_plan(std::move(plan_.text), report_.route_json);
    report_.plan_json = std::move(driven.text);
    report_.notes = std::move(driven.notes);
    return read_poses_text(report_.plan_json, plan_.file.string(), pose_coordinates(problem_));
  }

  void note_changes(const Judgement& judgement) {
    const double stated = plan_.log_det;
    const double found = judgement.evaluations.front().log_det;
    if (plan_.problem_sha256 != problem_.sha256)
      report_.notes.push_back(
          "The problem file has changed since the plan was made: figures of the plan are for the old file, recomputed "
          "ones for the new file.");
    else if (std::string note = parameters_note("The plan", plan_.parameters_file, parameters_of(problem_));
             !note.empty())
      report_.notes.push_back(note + ".");
    else if (!report_.notes.empty())
      report_.notes.push_back("Figures of the plan are for its own poses, recomputed ones for those of the route.");
    else if (!(std::abs(found - stated) <= same_figure * std::max(1.0, std::abs(stated))))
      report_.notes.push_back(fmt::format(
          "The plan states log det {:.9g}, its poses give {:.9g}: files that the problem names may have changed.",
          stated, found));
    else if (std::string note = test_poses_note(judgement); !note.empty()) report_.notes.push_back(std::move(note));
    as_planned_ = report_.notes.empty();
    if (study_.variants.size() > 1)
      report_.notes.push_back("The plan serves several variants; recomputed figures are for '" +
                              study_.first().spec->name + "'.");
  }

  /// A file of test poses may change and leave log det as it is. Test poses among the candidates are others here than
  /// in the plan, which has more of them.
  std::string test_poses_note(const Judgement& judgement) const {
    if (!problem_.design.test_poses || !plan_.rho0 || !judgement.rho0 ||
        std::abs(*judgement.rho0 - *plan_.rho0) <= same_figure * *plan_.rho0)
      return {};
    return fmt::format(
        "The plan states a predicted error of {:.9g} m, its poses give {:.9g} m: files that the problem names may have "
        "changed.",
        *plan_.rho0, *judgement.rho0);
  }

  void note_effect(const Judgement& judgement) {
    if (judgement.unmodelled)
      report_.notes.push_back(
          "The plan includes an unmodelled effect. Figures of the plan include it; figures recomputed for a part of "
          "the poses do not.");
  }

  void fill_information(const Judgement& judgement) {
    const Variant& variant = study_.first();
    const VariantColumns& columns = variant.columns;
    ReportInformation& information = report_.information;
    const auto m = Eigen::Index(columns.selected.size());
    Eigen::VectorXd tolerance(m);
    for (Eigen::Index j = 0; j < m; ++j) {
      information.columns.push_back(
          {columns.parameters[std::size_t(j)], study_.variants.size() > 1 ? variant.spec->name : "", {}, {}});
      tolerance[j] = columns.parameters[std::size_t(j)].tolerance;
    }
    const BlockArray blocks = build_blocks(*variant.model, columns.selected, all_, options_.threads);
    for (std::size_t i = 0; i < blocks.count(); ++i)
      information.poses.emplace_back(list_.ids[i], blocks.block(i) * tolerance.asDiagonal());
    if (study_.prior) information.prior = Eigen::MatrixXd::Identity(m, m);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(blocks.all().rows() + m, m);
    all.topRows(blocks.all().rows()) = blocks.all() * tolerance.asDiagonal();
    if (study_.prior) all.bottomRows(m).setIdentity();
    information.triangle =
        Eigen::HouseholderQR<Eigen::MatrixXd>(all).matrixQR().topRows(m).triangularView<Eigen::Upper>();
    for (const TestPoint& point : variant.test_points)
      information.test.emplace_back(point.weight, point.A * tolerance.asDiagonal());
    information.singular_values = judgement.evaluations.front().singular_values;
  }

  std::optional<CurvePoint> point_of(const Configurations& list, int poses) const {
    try {
      return figures_of(study_, judge(study_, list), poses);
    } catch (const CannotDo&) {
      return std::nullopt;
    }
  }

  /// After the first, second, … new pose in measuring order.
  void fill_prefix() {
    std::vector<std::size_t> order;  // of all_
    // A closed tour shows its first pose twice.
    std::set<int> seen;
    for (const ReportKeyframe& keyframe : report_.keyframes) {
      if (!keyframe.pose || *keyframe.pose < 1 || !seen.insert(*keyframe.pose).second) continue;
      const auto i = std::size_t(std::find(list_.ids.begin(), list_.ids.end(), *keyframe.pose) - list_.ids.begin());
      if (!list_.measured[i]) order.push_back(i);
    }
    const bool effect = std::any_of(study_.variants.begin(), study_.variants.end(),
                                    [](const Variant& v) { return v.effect != nullptr; });
    if (effect) fill_prefix_by_lists(order);
    else fill_prefix_by_rows(order);
  }

  /// An effect makes readings of all poses depend on each other: every part of the list is judged by itself.
  void fill_prefix_by_lists(const std::vector<std::size_t>& order) {
    Configurations list;
    list.dimension = new_.dimension;
    for (const std::size_t i : order) {
      append(list, all_[i]);
      report_.prefix.push_back(point_of(list, int(list.count())));
    }
  }

  void fill_prefix_by_rows(const std::vector<std::size_t>& order) {
    std::vector<GrowingEvaluation> growing;
    std::vector<BlockArray> blocks;  // of all_
    for (const Variant& variant : study_.variants) {
      growing.emplace_back(variant.columns.parameters, study_.prior ? Prior::every : Prior::none);
      blocks.push_back(build_blocks(*variant.model, variant.columns.selected, all_, options_.threads));
      for (std::size_t i = 0; i < all_.count(); ++i)
        if (list_.measured[i]) growing.back().add(blocks.back().block(i));
    }
    for (const std::size_t i : order) {
      for (std::size_t v = 0; v < growing.size(); ++v) growing[v].add(blocks[v].block(i));
      report_.prefix.push_back(point_of(growing, int(report_.prefix.size()) + 1));
    }
  }

  /// None where the poses do not identify all parameters of all variants.
  std::optional<CurvePoint> point_of(const std::vector<GrowingEvaluation>& growing, int poses) const {
    try {
      Judgement judgement;
      for (const GrowingEvaluation& one : growing) judgement.evaluations.push_back(one.figures());
      const std::vector<TestPoint>& points = study_.first().test_points;
      if (!points.empty())
        judgement.rho0 = predicted_error(points, judgement.evaluations.front().covariance, judgement.test_errors);
      return figures_of(study_, judgement, poses);
    } catch (const CannotDo&) {
      return std::nullopt;
    }
  }

  /// Predicted pixels of the board's points.
  void fill_pictures() {
    for (ReportCamera& camera : report_.cameras)
      for (std::size_t i = 0; i < list_.ids.size(); ++i) {
        auto pixels =
            predicted_pixels(*study_.first().model, camera.instrument, camera.points.size(), list_.configurations[i]);
        if (!pixels.empty()) camera.pictures.emplace_back(list_.ids[i], std::move(pixels));
      }
  }

  /// The candidates and what the plan has beside them.
  void fill_pool() {
    pool_ = study_.configurations;
    for (std::size_t k = 0; k < new_.count(); ++k) {
      const auto q = new_[k];
      std::size_t i = 0;
      while (i < pool_.count() && !std::equal(q.begin(), q.end(), pool_[i].begin())) ++i;
      if (i == pool_.count()) append(pool_, q);
      chosen_.push_back(int(i));
    }
    std::sort(chosen_.begin(), chosen_.end());
    chosen_.erase(std::unique(chosen_.begin(), chosen_.end()), chosen_.end());
  }

  std::vector<SearchPart> parts_of(const Configurations& candidates) const {
    return search_parts(study_, study_.criterion, candidates, options_.threads);
  }

  /// Gain of each of the pool, divided by what one must reach to be worth measuring; none if the criterion has no
  /// bound.
  void find_gains() {
    if (double(plan_.poses) > double(pool_.count()) * study_.repeats.most) return;
    SearchRequest request = search_request(study_, plan_.poses);
    request.bound_tolerance = shown_tolerance;
    Bound bound = bound_only(parts_of(pool_), request, monitor_);
    if (monitor_.should_stop() || !(bound.price > 0)) return;
    gains_ = std::move(bound.sensitivity);
    for (double& gain : gains_) gain /= bound.price;
  }

  void fill_position_errors(const Judgement& judgement) {
    const Variant& variant = study_.first();
    // With an unmodelled effect parameters are not all that the error comes from.
    if (variant.effect != nullptr || variant.model->tips() != 1) return;
    std::vector<TestPlace> places;
    const std::vector<TestPoint> points = test_points_at_candidates(study_.configurations, variant, places);
    predicted_error(points, judgement.evaluations.front().covariance, report_.position_errors);
    // Where only the instrument is estimated (a camera and its board) nothing is said of where the tip goes.
    std::vector<double>& errors = report_.position_errors;
    if (std::none_of(errors.begin(), errors.end(), [](double e) { return e > 0; })) errors.clear();
  }

  void fill_candidates() {
    if (monitor_.should_stop()) report_.notes.emplace_back("Stopped early: the gain of each candidate is left out.");
    // Places of tips in several measurement frames are no cloud in one picture.
    if (gains_.empty() || !study_.first().model->moving_coordinates().empty()) return;
    ReportCandidates candidates;
    candidates.sensitivity = gains_;
    candidates.chosen = chosen_;
    for (std::size_t i = 0; i < pool_.count(); ++i)
      candidates.positions.push_back(study_.first().model->tool_pose(pool_[i]).translation());
    report_.candidates = std::move(candidates);
  }

  bool stated_curve() const { return as_planned_ && plan_.other_numbers; }

  /// What other numbers of poses reach, as the plan states it if it is still of these poses and this problem.
  void fill_curve(const Judgement& judgement) {
    CurvePoint own = figures_of(study_, judgement, int(new_.count()));
    if (stated_curve()) {
      report_.curve = *plan_.other_numbers;
      // At the same test poses as the others.
      if (own.rho0 && plan_.rho0) own.rho0 = plan_.rho0;
    } else {
      report_.curve = other_numbers(study_, new_, study_.configurations, {}, monitor_);
      if (monitor_.should_stop())
        report_.notes.emplace_back("Stopped early: some numbers of poses are left out of the curve.");
    }
    report_.curve.push_back(own);
    std::sort(report_.curve.begin(), report_.curve.end(),
              [](const auto& a, const auto& b) { return a.poses < b.poses; });
  }

  const ReportOptions& options_;
  const Monitor& monitor_;
  Report report_;
  WrittenPlan plan_;  // its text is in the report
  const Problem problem_;
  const PoseList list_;  // the poses of the plan
  const Study study_;
  Configurations all_, new_, pool_;
  bool as_planned_ = false;    // poses, problem and parameters are those that the plan states
  std::vector<int> chosen_;    // of the pool, in the plan; ascending
  std::vector<double> gains_;  // of the pool
};

}  // namespace

Report report_problem(const Problem& problem, const std::filesystem::path& plan, const ReportOptions& options,
                      const Monitor& monitor) {
  return ReportBuilder(problem, plan, options, monitor).make();
}

}  // namespace posewright
