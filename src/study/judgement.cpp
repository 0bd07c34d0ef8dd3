#include "posewright/study/judgement.hpp"

#include "posewright/study/accuracy_points.hpp"
#include "posewright/study/discrepancy.hpp"

namespace posewright {
namespace {

void add_effects(Judgement& judgement, const Study& study, const Configurations& poses, const Settings& settings) {
  const Discrepancy& known = *study.discrepancy;
  const Variant& fitted = study.first();
  const EffectFit fit = fit_effects(known.effects, fitted, poses, settings);
  judgement.discrimination = discrimination_of(known.truth, known.effects, fit.unfitted, fitted, poses, settings.prior);
}

}  // namespace

Judgement judge(const Study& study, const Configurations& poses, const Settings& settings) {
  Configurations all = study.measured;
  all.dimension = poses.dimension;
  all.values.insert(all.values.end(), poses.values.begin(), poses.values.end());
  Judgement judgement;
  for (const Variant& variant : study.variants)
    judgement.evaluations.push_back(
        evaluate(build_blocks(*variant.model, variant.columns.selected, all, settings.planner.threads),
                 variant.columns.parameters, settings.prior ? Prior::every : Prior::none, variant.scale));
  const Variant& first = study.first();
  if (!first.test_points.empty()) {
    const Eigen::MatrixXd& covariance = judgement.evaluations.front().covariance;
    judgement.rho0 = predicted_error(first.test_points, covariance, judgement.test_errors);
    judgement.turn = predicted_turn(first.test_points, covariance, judgement.test_axes);
  }
  if (study.discrepancy != nullptr) add_effects(judgement, study, all, settings);
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
              const Configurations& poses, const Settings& settings) {
  return measure.phi(search_parts(study, criterion, poses, settings.planner.threads));
}

}  // namespace posewright
