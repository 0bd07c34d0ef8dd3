#include "fill_plan.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/criterion/registry.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/problem/design_words.hpp"
#include "posewright/study/expected_error.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

void fill_parameters(Plan& plan, const Variant& variant, const Evaluation& evaluation, const std::string& name) {
  const VariantColumns& columns = variant.columns;
  for (const Role role : {Role::interest, Role::nuisance})
    for (std::size_t j = 0; j < columns.parameters.size(); ++j)
      if (columns.parameters[j].role == role)
        plan.parameters.push_back({columns.parameters[j], name, evaluation.sigma[Eigen::Index(j)], ""});
  for (std::size_t j = 0; j < variant.dropped.size(); ++j)
    plan.parameters.push_back({variant.dropped[j], name, std::nullopt, variant.reasons[j]});
}

}  // namespace

void name_criterion(Plan& plan, const std::string& name) {
  const CriterionEntry& entry = *find_criterion(name);
  plan.criterion = name;
  plan.determinant = entry.determinant;
  plan.by_test_poses = entry.needs_test_poses;
}

namespace {

/// Margin of proposed configurations to the nearer end.
double margin_of(const Coordinate& in_force, const Coordinate& proposed) {
  return std::min(proposed.lower - in_force.lower, in_force.upper - proposed.upper);
}

}  // namespace

std::vector<LimitMargin> limit_margins(const Variant& variant) {
  const Workspace& workspace = *variant.workspace;
  const WorkspaceSpec& spec = variant.problem->workspace;
  std::vector<LimitMargin> margins;
  for (std::size_t i = 0; i < workspace.coordinates().size(); ++i) {
    const Coordinate &all = workspace.coordinates()[i], &inner = workspace.proposed()[i];
    const double margin = margin_of(all, inner);
    const auto& asked = all.unit == "rad" ? spec.joint_margin : spec.joint_margin_length;
    if (margin > 0) margins.push_back({all.name, all.unit, margin, !asked});
  }
  return margins;
}

std::string proposed_within(const Workspace& workspace, const IdentificationModel& model) {
  std::string text =
      model.actuators().empty() ? "within the joint limits" : "within the platform's ranges and the actuators' travel";
  std::string_view lead = " less ";
  for (const std::string unit : {"rad", "m"}) {
    double least = INFINITY, most = 0;
    for (std::size_t i = 0; i < workspace.coordinates().size(); ++i) {
      const Coordinate &all = workspace.coordinates()[i], &inner = workspace.proposed()[i];
      if (all.periodic || all.choice() || all.unit != unit) continue;
      const double margin = margin_of(all, inner);
      least = std::min(least, margin);
      most = std::max(most, margin);
    }
    if (most <= 0) continue;
    text += lead;
    if (least < most) text += shown_value(least, unit) + " to ";
    text += shown_value(most, unit);
    lead = " and ";
  }
  return text;
}

CellNotes cell_notes(const Cell& cell) {
  CellNotes notes;
  if (cell.collision != nullptr) {
    notes.always_touching = cell.collision->always_touching();
    for (const ReducedClearance& pair : cell.collision->reduced())
      notes.reduced.push_back({pair.clearance, pair.first, pair.second});
    notes.margin = cell.collision->margin();
  }
  for (const Coordinate& c : cell.model->coordinates())
    if (const auto margin = cell.joint_margin.find(c.name); margin != cell.joint_margin.end())
      notes.joint_margins.push_back({c.name, c.unit, margin->second});
  return notes;
}

void fill_judgement(Plan& plan, const Judgement& judgement, const Study& study) {
  const Evaluation& first = judgement.evaluations.front();
  for (const Variant& variant : study.variants)
    plan.variant += (plan.variant.empty() ? "" : " + ") + variant.spec->name;
  name_criterion(plan, study.criterion);
  plan.scaling = scaling_text(study.scaling);
  plan.prior = study.prior;
  plan.reserve = study.reserve;
  plan.rho0 = judgement.rho0;
  plan.test_errors = judgement.test_errors;
  plan.turn = judgement.turn;
  plan.test_axes = judgement.test_axes;
  plan.discrimination = judgement.discrimination;
  plan.unmodelled = judgement.unmodelled;
  plan.log_det = first.log_det;
  plan.log_det_full = first.log_det_full;
  plan.indices = first.indices;
  plan.condition = first.condition;
  for (std::size_t v = 0; v < study.variants.size(); ++v)
    fill_parameters(plan, study.variants[v], judgement.evaluations[v],
                    study.variants.size() > 1 ? study.variants[v].spec->name : "");
}

void fill_candidates(PlanStatistics& statistics, const Study& study) {
  const Configurations& candidates = study.configurations;
  statistics.drawn = candidates.drawn;
  statistics.feasible = long(candidates.count());
  statistics.rejected = candidates.rejected;
  statistics.list = study.list;
  statistics.notes = study.notes;
}

void fill_variants(Plan& plan, const Judgement& judgement, const Study& study, const std::vector<double>& references) {
  const std::vector<double> efficiency = log_efficiencies(judgement, study, references);
  for (std::size_t v = 0; v < references.size(); ++v)
    plan.variants.push_back({study.variants[v].spec->name, study.variants[v].weight, judgement.evaluations[v].log_det,
                             references[v], std::min(1.0, std::exp(efficiency[v]))});
}

void fill_poses(Plan& plan, const Study& study, const Configurations& chosen, const std::vector<int>& members,
                const std::vector<double>& without, const Judgement& judgement) {
  const IdentificationModel& model = *study.first().model;
  const Workspace& workspace = *study.first().workspace;
  const Eigen::VectorXd& contribution = judgement.evaluations.front().contribution;
  const Configurations known = known_before(study);
  const std::size_t before = known.count();
  for (std::size_t i = 0; i < before + chosen.count(); ++i) {
    const std::span<const double> q = i < before ? known[i] : chosen[i - before];
    PlannedPose pose = pose_of(model, q);
    pose.id = int(i) + 1;
    pose.measured = i < study.measured.count();
    pose.fixed = i < before && !pose.measured;
    pose.sights = sights_of(*study.cell, q);
    pose.nearest = nearest_at(*study.cell, q);
    pose.contribution = contribution[Eigen::Index(i)];
    if (i >= before) {
      const std::size_t candidates = members.empty() ? 0 : study.configurations.count();
      if (const auto member = std::size_t(members.empty() ? 0 : members[i - before]); member < candidates) {
        pose.candidate = int(member);
        if (!study.configurations.rows.empty()) {
          const ListedRow& row = study.configurations.rows[member];
          pose.candidate = row.index;
          pose.listed = PlannedPose::Listed{row.id, row.line};
        }
      }
      pose.without = without[i - before];
    }
    plan.poses.push_back(std::move(pose));
  }
  double on_boundary = 0, on_limits = 0;
  for (std::size_t i = 0; i < chosen.count(); ++i) {
    on_boundary += workspace.on_boundary(chosen[i]) ? 1 : 0;
    on_limits += workspace.share_of_coordinates_on_limits(chosen[i]);
  }
  plan.statistics.poses_on_boundary = on_boundary / double(chosen.count());
  plan.statistics.coordinates_on_limits = on_limits / double(chosen.count());
}

namespace {

/// Nuisance columns that only this instrument's readings depend on.
std::vector<int> own_nuisance(const Variant& variant, const std::string& instrument) {
  std::vector<int> own;
  for (int j = 0; j < variant.columns.nuisance; ++j)
    if (variant.columns.parameters[std::size_t(j)].name.find("@" + instrument + ".") != std::string::npos)
      own.push_back(j);
  return own;
}

/// The blocks, and rows that tell these columns by their tolerances.
/// @param first  column of the variant's first parameter
BlockArray with_told(const BlockArray& blocks, const Variant& variant, const std::vector<int>& told, int first,
                     std::size_t more) {
  BlockArray all(blocks.count() + more, blocks.rows(), blocks.columns());
  for (std::size_t i = 0; i < blocks.count(); ++i) all.block(i) = blocks.block(i);
  const auto rows = std::size_t(blocks.rows());
  for (std::size_t k = 0; k < told.size(); ++k)
    all.block(blocks.count() + k / rows)(Eigen::Index(k % rows), first + told[k]) =
        1 / variant.columns.parameters[std::size_t(told[k])].tolerance;
  return all;
}

/// Φ of the poses if the instrument's own nuisance parameters are known: without its readings nothing depends on them.
double phi_without(const DesignMeasure& measure, const Study& study, const Configurations& left,
                   const std::string& instrument) {
  std::vector<SearchPart> parts = search_parts(study, study.criterion, left, study.planner.threads);
  std::size_t more = 0;
  for (std::size_t v = 0; v < parts.size(); ++v) {
    const auto rows = std::size_t(parts[v].blocks.rows());
    more = std::max(more, (own_nuisance(study.variants[v], instrument).size() + rows - 1) / rows);
  }
  for (std::size_t v = 0; v < parts.size(); ++v) {
    const Variant& variant = study.variants[v];
    const int features = variant.features == nullptr ? 0 : variant.features->columns();
    parts[v].blocks = with_told(parts[v].blocks, variant, own_nuisance(variant, instrument), features, more);
  }
  return measure.phi(parts);
}

/// Covariance of the first variant's parameters, with the same known.
Evaluation evaluation_without(const Study& study, const Configurations& poses, const std::string& instrument) {
  const Variant& variant = study.first();
  if (variant.effect != nullptr) return judge(study, poses).evaluations.front();
  const BlockArray blocks =
      build_blocks(*variant.model, variant.columns.selected, with_measured(study, poses), study.planner.threads);
  const std::vector<int> told = own_nuisance(variant, instrument);
  return evaluate(
      with_told(blocks, variant, told, 0, (told.size() + std::size_t(blocks.rows()) - 1) / std::size_t(blocks.rows())),
      variant.columns.parameters, study.prior ? Prior::every : Prior::none, variant.scale);
}

/// The rest of the plan as it would be without one instrument's poses; 0 efficiency where it leaves parameters open.
void fill_without(InstrumentWorth& worth, const Study& study, const Configurations& left, const DesignMeasure& measure,
                  double phi, double degree) {
  Configurations all = study.fixed;
  all.dimension = left.dimension;
  all.values.insert(all.values.end(), left.values.begin(), left.values.end());
  const bool any = all.count() + study.measured.count() > 0;
  if (!any && !study.prior) return;
  try {
    const Evaluation evaluation = evaluation_without(study, all, worth.name);
    worth.without = std::min(1.0, std::exp((phi_without(measure, study, left, worth.name) - phi) / degree));
    const VariantColumns& columns = study.first().columns;
    const std::vector<int> own = own_nuisance(study.first(), worth.name);
    for (int j = 0; j < int(columns.parameters.size()); ++j)
      if (!std::binary_search(own.begin(), own.end(), j))
        worth.sigma_without.emplace_back(columns.parameters[std::size_t(j)].name, evaluation.sigma[j]);
    if (any)
      worth.expected_without = expected_error(study.configurations, study.first(), with_measured(study, all),
                                              evaluation.covariance, study.planner.threads);
  } catch (const CannotDo&) {
    worth.without = 0.0;
  }
}

}  // namespace

void fill_instruments(Plan& plan, const Study& study, const Configurations& chosen, const DesignMeasure& measure,
                      double phi, double degree) {
  const MeasurementSpec& measurement = study.problem->measurement;
  const std::vector<MeasurementSpec>* instruments = instruments_of(measurement);
  // Poses that do not identify the parameters have no information to share out.
  if (instruments == nullptr || chosen.count() == 0 || !std::isfinite(phi)) return;
  const std::size_t instrument = *instrument_index(study.first().model->coordinates());
  std::vector<int> reads;
  for (std::size_t i = 0; i < chosen.count(); ++i) reads.push_back(int(chosen[i][instrument]));
  const std::vector<double> shares = measure.shares(search_parts(study, study.criterion, chosen, study.planner.threads),
                                                    reads, int(instruments->size()));
  plan.prior_share = shares.back();
  for (int k = 0; k < int(instruments->size()); ++k) {
    InstrumentWorth worth{(*instruments)[std::size_t(k)].name, 0, shares[std::size_t(k)]};
    std::vector<int> own;
    for (int i = 0; i < int(reads.size()); ++i)
      if (reads[std::size_t(i)] == k) own.push_back(i);
    worth.poses = int(own.size());
    const InstrumentTimes times = times_of((*instruments)[std::size_t(k)], study.problem->workspace.motion);
    if (worth.poses > 0) worth.setup = times.setup;
    worth.reading = times.reading * times.in_turn * worth.poses;
    fill_without(worth, study, without(chosen, own), measure, phi, degree > 0 ? degree : 1.0);
    plan.instruments.push_back(std::move(worth));
  }
}

}  // namespace posewright
