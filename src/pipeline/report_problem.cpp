#include "posewright/pipeline/report_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "fill_plan.hpp"
#include "judgement.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "preparation.hpp"
#include "read_poses.hpp"
#include "report_scene.hpp"

namespace posewright {
namespace {

using Json = nlohmann::json;

constexpr std::uintmax_t size_limit = 200'000'000;
// Other numbers of poses, as shares of the plan's own.
constexpr double shares[] = {0.6, 0.8, 1.25, 1.6, 2.0};
// Enough for a curve that shows what a few poses more bring.
constexpr int curve_restarts = 1;
// Relative difference of log det that rounding of written configurations cannot make.
constexpr double same_log_det = 1e-6;

/// What the plan was made with, as far as it says.
PlanOptions options_of(const Json& plan, int poses) {
  PlanOptions options;
  options.poses = poses;
  options.method = "exchange";
  const Json& criterion = plan.at("criterion");
  options.criterion = criterion.at("name").get<std::string>();
  if (plan.value("variants", Json::array()).empty()) options.variant = plan.at("variant").get<std::string>();
  if (const auto test = plan.find("discrimination"); test != plan.end() && test->is_object())
    options.truth = test->at("truth").get<std::string>();
  options.reserve = criterion.value("reserve", false);
  options.prior = criterion.at("prior").get<std::string>() == "tolerance";
  const std::string scaling = criterion.at("scaling").get<std::string>();
  options.scaling = scaling == "norm" ? Scaling::norm : scaling == "none" ? Scaling::none : Scaling::tolerance;
  options.candidates = int(plan.at("statistics").at("candidates_feasible").get<long>());
  options.restarts = curve_restarts;
  options.seed = plan.at("seed").get<std::uint64_t>();
  if (const Json& certificate = plan.at("certificate").at("candidates"); certificate.is_object()) {
    const std::string repeats = certificate.at("repeats").get<std::string>();
    if (repeats == "allow") options.repeats = Repeats{Repeats::any_number};
    else options.repeats = Repeats{repeats == "forbid" ? 1 : std::stoi(repeats)};
  }
  return options;
}

class Reporting {
 public:
  Reporting(const Problem& problem, const std::filesystem::path& file, const ReportOptions& options,
            const Monitor& monitor)
      : problem_(problem), file_(file), options_(options), monitor_(monitor) {
    // The time limit is for other numbers of poses: a shortened set of candidates would be shown as if it were whole.
    whole_.interrupted = monitor.interrupted;
    whole_.on_progress = monitor.on_progress;
    report_.plan_json = read_file(file, size_limit);
    if (!options.route.empty()) report_.route_json = read_file(options.route, size_limit);
    try {
      plan_ = Json::parse(report_.plan_json);
      if (plan_.value("schema", "") != "posewright/plan/1") throw_no_plan();
      settle(plan_.at("poses"));
    } catch (const Json::exception&) {
      throw_no_plan();
    } catch (const std::logic_error&) {  // a number that is none
      throw_no_plan();
    }
    prepared_ = prepare(problem, settings_, whole_);
    if (whole_.should_stop()) throw CannotDo("the report was stopped before it had anything to show");
    read_list();
  }

  Report make() {
    report_.title = problem_.file.parent_path().filename().string();
    if (report_.title.empty()) report_.title = problem_.file.stem().string();
    const Judgement judgement = judge(prepared_, new_, settings_);
    note_changes(judgement);
    fill_information(judgement);
    std::vector<std::pair<int, std::vector<double>>> poses;
    for (std::size_t i = 0; i < all_.count(); ++i) {
      const auto q = all_[i];
      poses.emplace_back(ids_[i], std::vector<double>(q.begin(), q.end()));
    }
    const auto& coordinates = prepared_.first().workspace->coordinates();
    fill_scene(report_, problem_, *prepared_.cell, poses, coordinates, options_.route);
    for (const Coordinate& c : prepared_.first().model->actuators()) report_.actuators.emplace_back(c.name, c.unit);
    fill_prefix();
    if (options_.candidates) fill_candidates();
    if (options_.sizes) fill_curve();
    return std::move(report_);
  }

 private:
  [[noreturn]] void throw_no_plan() const {
    throw InputError({file_.string(), 0}, "is no plan of a robot", "plan.json as posewright plan writes it");
  }

  void settle(const Json& poses) {
    const auto fresh =
        std::count_if(poses.begin(), poses.end(), [](const Json& p) { return !p.value("measured", false); });
    if (fresh == 0 || plan_.at("variant").get<std::string>().empty()) throw_no_plan();
    PlanOptions options = options_of(plan_, int(fresh));
    options.threads = options_.threads;
    settings_ = settings_of(problem_, options);
    // What was measured before is in the plan, wherever it came from.
    settings_.measured = [file = file_](const std::vector<Coordinate>& coordinates) {
      const PoseList list = read_poses(file, coordinates);
      PoseList before;
      for (std::size_t i = 0; i < list.configurations.size(); ++i)
        if (list.measured[i]) before.configurations.push_back(list.configurations[i]);
      return before;
    };
  }

  void read_list() {
    const PoseList list = read_poses(file_, prepared_.first().workspace->coordinates());
    all_.dimension = new_.dimension = prepared_.configurations.dimension;
    for (std::size_t i = 0; i < list.configurations.size(); ++i) {
      append(all_, list.configurations[i]);
      ids_.push_back(list.ids[i]);
      if (!list.measured[i]) append(new_, list.configurations[i]);
    }
  }

  void note_changes(const Judgement& judgement) {
    const double stated = plan_.at("criterion").at("log_det").get<double>();
    const double found = judgement.evaluations.front().log_det;
    if (plan_.at("problem").value("sha256", "") != problem_.sha256)
      report_.notes.push_back(
          "The problem file has changed since the plan was made: the plan's own figures are those of the old file, "
          "everything that this page recomputes those of the new one.");
    else if (!(std::abs(found - stated) <= same_log_det * std::max(1.0, std::abs(stated))))
      report_.notes.push_back(fmt::format(
          "The plan states log det {:.9g}, its poses give {:.9g}: files that the problem names may have changed.",
          stated, found));
    if (prepared_.variants.size() > 1)
      report_.notes.push_back("The plan serves several variants; what this page recomputes is of '" +
                              prepared_.first().spec->name + "'.");
  }

  void fill_information(const Judgement& judgement) {
    const PreparedVariant& variant = prepared_.first();
    const VariantColumns& columns = variant.columns();
    ReportInformation& information = report_.information;
    const auto m = Eigen::Index(columns.selected.size());
    Eigen::VectorXd tolerance(m);
    for (Eigen::Index j = 0; j < m; ++j) {
      information.columns.push_back(
          {columns.parameters[std::size_t(j)], prepared_.variants.size() > 1 ? variant.spec->name : "", {}, {}});
      tolerance[j] = columns.parameters[std::size_t(j)].tolerance;
    }
    const BlockArray blocks = build_blocks(*variant.model, columns.selected, all_, options_.threads);
    for (std::size_t i = 0; i < blocks.count(); ++i) {
      const Eigen::MatrixXd scaled = blocks.block(i) * tolerance.asDiagonal();
      information.poses.emplace_back(ids_[i], scaled.transpose() * scaled);
    }
    if (settings_.prior) information.prior = Eigen::MatrixXd::Identity(m, m);
    for (const TestPoint& point : variant.test_points) {
      const Eigen::MatrixXd scaled = point.A * tolerance.asDiagonal();
      information.test.emplace_back(point.weight, scaled.transpose() * scaled);
    }
    information.singular_values = judgement.evaluations.front().singular_values;
  }

  std::optional<CurvePoint> point_of(const Configurations& list, int poses) const {
    try {
      const Judgement judgement = judge(prepared_, list, settings_);
      const Evaluation& e = judgement.evaluations.front();
      CurvePoint point{poses, e.log_det, judgement.rho0, 0.0, false};
      const VariantColumns& columns = prepared_.first().columns();
      for (std::size_t j = std::size_t(columns.nuisance); j < columns.parameters.size(); ++j)
        point.worst_sigma = std::max(*point.worst_sigma, e.sigma[Eigen::Index(j)] / columns.parameters[j].tolerance);
      return point;
    } catch (const CannotDo&) {
      return std::nullopt;
    }
  }

  /// After the first, second, … new pose in measuring order.
  void fill_prefix() {
    Configurations list;
    list.dimension = new_.dimension;
    // A closed tour shows its first pose twice.
    std::set<int> seen;
    for (const ReportKeyframe& keyframe : report_.keyframes) {
      if (!keyframe.pose || *keyframe.pose < 1 || !seen.insert(*keyframe.pose).second) continue;
      const auto i = std::size_t(std::find(ids_.begin(), ids_.end(), *keyframe.pose) - ids_.begin());
      if (plan_.at("poses").at(i).value("measured", false)) continue;
      append(list, all_[i]);
      report_.prefix.push_back(point_of(list, int(list.count())));
    }
  }

  SearchRequest request(int poses) const {
    SearchRequest request;
    request.criterion = settings_.criterion;
    request.method = settings_.method;
    request.poses = poses;
    request.repeats = settings_.repeats;
    request.reserve = settings_.reserve;
    request.planner = settings_.planner;
    if (prepared_.has_minimum_distance) request.spacing = &prepared_.minimum_distance;
    return request;
  }

  void fill_candidates() {
    const Configurations& pool = prepared_.configurations;
    if (double(settings_.poses) > double(pool.count()) * settings_.repeats.most) return;
    Bound bound = bound_only(search_parts(prepared_, settings_.criterion, pool, options_.threads),
                             request(settings_.poses), whole_);
    if (whole_.should_stop()) {
      report_.notes.emplace_back("Stopped early: what each candidate could tell is left out.");
      return;
    }
    if (bound.sensitivity.empty() || !(bound.price > 0)) return;
    ReportCandidates candidates;
    for (const double d : bound.sensitivity) candidates.sensitivity.push_back(d / bound.price);
    for (std::size_t i = 0; i < pool.count(); ++i) {
      candidates.positions.push_back(prepared_.first().model->tool_pose(pool[i]).translation());
      for (std::size_t k = 0; k < new_.count(); ++k)
        if (std::equal(pool[i].begin(), pool[i].end(), new_[k].begin())) {
          candidates.chosen.push_back(int(i));
          break;
        }
    }
    report_.candidates = std::move(candidates);
  }

  void add_to_curve(int poses) {
    const Configurations& pool = prepared_.configurations;
    try {
      const SearchResult found =
          search(search_parts(prepared_, settings_.criterion, pool, options_.threads), request(poses), whole_);
      if (whole_.should_stop()) return;  // not the best plan of so many
      Configurations list;
      list.dimension = pool.dimension;
      for (const int i : found.design.members) append(list, pool[std::size_t(i)]);
      if (const auto point = point_of(list, poses)) report_.curve.push_back(*point);
    } catch (const CannotDo&) {
      return;  // so few poses do not determine the parameters
    }
  }

  void fill_curve() {
    const int own = int(new_.count());
    const Configurations& pool = prepared_.configurations;
    std::set<int> tried = {own};
    for (const double share : shares) {
      const int poses = int(std::lround(share * own));
      whole_.report({"other numbers of poses", double(&share - shares), double(std::size(shares)), {}, {}, {}});
      if (poses < 1 || double(poses) > double(pool.count()) * settings_.repeats.most || !tried.insert(poses).second)
        continue;
      if (!monitor_.should_stop()) add_to_curve(poses);
      if (!monitor_.should_stop()) continue;
      report_.notes.emplace_back("Stopped early: some numbers of poses are left out of the curve.");
      break;
    }
    if (const auto point = point_of(new_, own)) report_.curve.push_back(*point);
    std::sort(report_.curve.begin(), report_.curve.end(),
              [](const auto& a, const auto& b) { return a.poses < b.poses; });
  }

  const Problem& problem_;
  const std::filesystem::path& file_;
  const ReportOptions& options_;
  const Monitor& monitor_;
  Monitor whole_;  // without the time limit
  Json plan_;
  Settings settings_;
  Preparation prepared_;
  Configurations all_, new_;
  std::vector<int> ids_;  // of all poses
  Report report_;
};

}  // namespace

Report report_problem(const Problem& problem, const std::filesystem::path& plan, const ReportOptions& options,
                      const Monitor& monitor) {
  return Reporting(problem, plan, options, monitor).make();
}

}  // namespace posewright
