#pragma once

#include "posewright/results/plan.hpp"
#include "posewright/study/judgement.hpp"
#include "posewright/study/study.hpp"
#include "posewright/tasks/planned_pose.hpp"

namespace posewright {

/// Summary of a judgement: log det, indices, accuracy, parameters; names of variant and criterion.
void fill_judgement(Plan& plan, const Judgement& judgement, const Study& study);

/// Statistics of candidates: number, source, reasons of rejections.
void fill_candidates(PlanStatistics& statistics, const Study& study);

/// Efficiency of every variant; nothing if the plan serves one.
void fill_variants(Plan& plan, const Judgement& judgement, const Study& study, const std::vector<double>& references);

/// Poses that are measured already, fixed ones, then the chosen ones, and how they lie in the workspace.
/// @param members  of the chosen among the candidates, or beyond them; empty: they are no candidates
/// @param without  efficiency without each of the chosen
void fill_poses(Plan& plan, const Study& study, const Configurations& chosen, const std::vector<int>& members,
                const std::vector<double>& without, const Judgement& judgement);

/// What each instrument of a list gives; nothing where there is one alone. Measured and fixed poses count as known
/// before, as tolerances do.
/// @param chosen  that come to these
/// @param phi     Φ of them by `measure`; efficiencies are e^{ΔΦ/degree}
void fill_instruments(Plan& plan, const Study& study, const Configurations& chosen, const DesignMeasure& measure,
                      double phi, double degree);

/// The criterion that a plan is for, with what the outputs must know of it.
void name_criterion(Plan& plan, const std::string& name);

/// Margins of proposed configurations to the limits in force.
std::vector<LimitMargin> limit_margins(const Variant& variant);
/// "within the joint limits less 1.5 to 2 deg": all configurations that are proposed, in words.
std::string proposed_within(const Workspace& workspace, const IdentificationModel& model);
CellNotes cell_notes(const Cell& cell);

}  // namespace posewright
