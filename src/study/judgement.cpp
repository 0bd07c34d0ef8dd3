#include "posewright/study/judgement.hpp"

#include "posewright/study/accuracy_points.hpp"
#include "posewright/study/discrepancy.hpp"
#include "posewright/study/unmodelled.hpp"

namespace posewright {
namespace {

void add_effects(Judgement& judgement, const Study& study, const Configurations& poses) {
  const Discrepancy& known = *study.discrepancy;
  const Variant& fitted = study.first();
  const EffectFit fit = fit_effects(known.effects, fitted, poses, study);
  judgement.discrimination = discrimination_of(known.truth, known.effects, fit.unfitted, fitted, poses, study.prior);
}

void fill_errors(Judgement& judgement, const Variant& variant, const AdjustedEvaluation& worth) {
  judgement.rho0 = predicted_error(variant.test_points, worth.errors, judgement.test_errors);
  judgement.turn = predicted_turn(variant.test_points, worth.errors, judgement.test_axes);
}

}  // namespace

Judgement judge(const Study& study, const Configurations& poses) {
  const Configurations all = with_measured(study, poses);
  Judgement judgement;
  const Prior prior = study.prior ? Prior::every : Prior::none;
  for (const Variant& variant : study.variants) {
    AdjustedEvaluation worth = effect_adjusted_evaluation(variant, all, prior, study.planner.threads);
    if (&variant == &study.first()) {
      judgement.unmodelled = worth.unmodelled;
      if (!variant.test_points.empty()) fill_errors(judgement, variant, worth);
    }
    judgement.evaluations.push_back(std::move(worth.evaluation));
  }
  if (study.discrepancy != nullptr) add_effects(judgement, study, all);
  return judgement;
}

std::vector<double> log_efficiencies(const Judgement& judgement, const Study& study,
                                     const std::vector<double>& references) {
  std::vector<double> result;
  for (std::size_t v = 0; v < references.size(); ++v) {
    const VariantColumns& columns = study.variants[v].columns;
    const double interest = double(columns.selected.size()) - columns.nuisance;
    result.push_back((judgement.evaluations[v].log_det - references[v]) / interest);
  }
  return result;
}

double phi_of(const DesignMeasure& measure, const std::string& criterion, const Study& study,
              const Configurations& poses) {
  return measure.phi(search_parts(study, criterion, poses, study.planner.threads));
}

}  // namespace posewright
