#include "posewright/pipeline/plan_problem.hpp"

#include <algorithm>
#include <chrono>

#include "posewright/planning/evaluate.hpp"
#include "search.hpp"
#include "study.hpp"
#include "test_points.hpp"

namespace posewright {
namespace {

/// Options over the problem file's design block.
struct Settings {
  std::string criterion, method;
  int poses, candidates;
  bool prior;
  SearchRequest request;
};

Settings settings_of(const Problem& problem, const PlanOptions& options) {
  const DesignSpec& design = problem.design;
  Settings s;
  s.criterion = options.criterion.empty() ? design.criterion.value : options.criterion;
  s.method = options.method.empty() ? design.method.value : options.method;
  require_known(s.criterion, s.method, options.criterion.empty() ? problem.at(design.criterion.line) : SourcePlace{},
                options.method.empty() ? problem.at(design.method.line) : SourcePlace{});
  if (!options.poses && !design.poses)
    throw InputError(problem.at(design.line), "does not say how many poses to plan", "set design: poses or --poses");
  s.poses = options.poses ? *options.poses : design.poses->value;
  s.candidates = options.candidates.value_or(design.candidates.value);
  s.prior = options.prior.value_or(design.prior);
  s.request = {s.criterion, s.method, s.poses, 0, options.repeats.value_or(design.repeats), {}, {}, {}, {}};
  s.request.planner.restarts = options.restarts.value_or(design.restarts.value);
  s.request.planner.seed = options.seed;
  s.request.planner.threads = options.threads;
  return s;
}

Eigen::VectorXd tolerances_of(const VariantColumns& columns) {
  Eigen::VectorXd tolerance(Eigen::Index(columns.parameters.size()));
  for (std::size_t j = 0; j < columns.parameters.size(); ++j)
    tolerance[Eigen::Index(j)] = columns.parameters[j].tolerance;
  return tolerance;
}

std::vector<NamedValue> named(const std::vector<Coordinate>& coordinates, std::span<const double> values) {
  std::vector<NamedValue> result;
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (!coordinates[i].choice()) result.push_back({coordinates[i].name, coordinates[i].unit, values[i]});
  return result;
}

/// What a choice among named things says at q, e.g. the load case; empty where there is no such coordinate.
std::string chosen_label(const std::vector<Coordinate>& coordinates, std::span<const double> q, const char* name) {
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const Coordinate& c = coordinates[i];
    if (!c.choice() || c.name != name) continue;
    const auto at = std::lower_bound(c.values.begin(), c.values.end(), q[i]) - c.values.begin();
    return c.labels[std::size_t(at)];
  }
  return {};
}

void fill_poses(Plan& plan, const Study& study, const Design& design, const Evaluation& evaluation) {
  double on_boundary = 0, on_limits = 0;
  for (std::size_t i = 0; i < design.members.size(); ++i) {
    const auto q = study.configurations[std::size_t(design.members[i])];
    PlannedPose pose;
    pose.id = int(i) + 1;
    pose.candidate = design.members[i];
    pose.configuration = named(study.model->coordinates(), q);
    pose.load_case = chosen_label(study.model->coordinates(), q, "load_case");
    pose.station = chosen_label(study.model->coordinates(), q, "station");
    std::vector<double> actuators(study.model->actuators().size());
    if (study.model->actuator_values(q, actuators)) pose.actuators = named(study.model->actuators(), actuators);
    pose.tool_pose = study.model->tool_pose(q);
    pose.contribution = evaluation.contribution[Eigen::Index(i)];
    plan.poses.push_back(std::move(pose));
    on_boundary += study.workspace->on_boundary(q) ? 1 : 0;
    on_limits += study.workspace->share_of_coordinates_on_limits(q);
  }
  plan.statistics.poses_on_boundary = on_boundary / double(design.members.size());
  plan.statistics.coordinates_on_limits = on_limits / double(design.members.size());
}

void fill_parameters(Plan& plan, const ResolvedColumns& resolved, const Evaluation& evaluation) {
  const VariantColumns& columns = resolved.columns;
  for (const Role role : {Role::interest, Role::nuisance})
    for (std::size_t j = 0; j < columns.parameters.size(); ++j)
      if (columns.parameters[j].role == role)
        plan.parameters.push_back({columns.parameters[j], evaluation.sigma[Eigen::Index(j)], ""});
  for (std::size_t j = 0; j < resolved.dropped.size(); ++j)
    plan.parameters.push_back({resolved.dropped[j], std::nullopt, resolved.reasons[j]});
}

}  // namespace

Plan plan_problem(const Problem& problem, const PlanOptions& options, const Monitor& monitor) {
  const auto begin = std::chrono::steady_clock::now();
  Settings settings = settings_of(problem, options);
  const VariantSpec& variant = find_variant(problem, options.variant);
  SamplingOptions sampling;
  sampling.count = std::size_t(settings.candidates);
  sampling.seed = options.seed;
  sampling.threads = options.threads;
  const Study study = make_study(problem, variant, sampling, monitor);
  const ResolvedColumns resolved = resolve_columns(study, problem, variant, settings.prior, options.threads);
  const VariantColumns& columns = resolved.columns;
  settings.request.scale = tolerances_of(columns);
  settings.request.test_points = test_points_of(problem, variant, *study.model, columns, options.seed);
  if (settings.prior) settings.request.prior_sigma = tolerances_of(columns);
  else require_enough_poses(study, columns, settings.poses, options.threads);

  settings.request.nuisance = columns.nuisance;
  SearchResult found = search(build_blocks(*study.model, columns.selected, study.configurations, options.threads),
                              settings.request, monitor);

  // Judged from the configurations that will be written, not from anything the search kept.
  Configurations chosen;
  chosen.dimension = study.configurations.dimension;
  for (const int i : found.design.members) {
    const auto q = study.configurations[std::size_t(i)];
    chosen.values.insert(chosen.values.end(), q.begin(), q.end());
  }
  const Evaluation evaluation = evaluate(build_blocks(*study.model, columns.selected, chosen, options.threads),
                                         columns.parameters, settings.prior);

  Plan plan;
  plan.seed = options.seed;
  plan.problem_file = problem.file.string();
  plan.problem_sha256 = problem.sha256;
  plan.variant = columns.name;
  plan.criterion = settings.criterion;
  plan.prior = settings.prior;
  if (!settings.request.test_points.empty())
    plan.rho0 = predicted_error(settings.request.test_points, evaluation.covariance, plan.test_errors);
  plan.criterion_value = criterion_value(plan, evaluation, settings.request);
  plan.log_det = evaluation.log_det;
  plan.log_det_full = evaluation.log_det_full;
  plan.indices = evaluation.indices;
  plan.condition = evaluation.condition;
  plan.certificate = found.certificate;
  certify(plan.certificate, plan.log_det, int(columns.selected.size()) - columns.nuisance);
  fill_parameters(plan, resolved, evaluation);
  plan.statistics = {study.configurations.drawn,
                     long(study.configurations.count()),
                     study.configurations.rejected,
                     found.design.exchanges,
                     found.design.restarts,
                     0.0,
                     {},
                     {}};
  fill_poses(plan, study, found.design, evaluation);
  plan.interrupted = found.stopped;
  plan.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return plan;
}

}  // namespace posewright
