#include "posewright/study/discrepancy.hpp"

#include <fmt/format.h>

#include <cmath>

#include "posewright/criterion/registry.hpp"
#include "posewright/study/accuracy_points.hpp"
#include "posewright/study/columns.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// A direction of which less than this share (of squared length, whitened) is left beside the fitted columns is
// rounding.
constexpr double imitated = 1e-12;

Effects checked_effects(const Study& study) {
  const Variant& fitted = study.first();
  const VariantSpec& truth = *study.truth;
  const SourcePlace place = study.problem->at(study.truth_line);
  if (truth.name == fitted.spec->name)
    throw InputError(place, "the truth '" + truth.name + "' is the variant that is fitted", "another variant");
  const Variant other = place_variant({*study.problem, truth}, study.cell);
  if (!one_catalogue(*fitted.model, *other.model))
    throw InputError(place,
                     "variants '" + fitted.spec->name + "' and '" + truth.name + "' use different kinds of parameters",
                     "a truth in the same convention");
  // Where the truth's own columns depend on one another matters to whoever fits it; nobody does here.
  const VariantColumns columns =
      resolve_columns(*fitted.model, study.configurations, select_columns(*fitted.model, {*study.problem, truth}), true,
                      study.planner.threads)
          .columns;
  Effects effects = effects_of(fitted, *other.model, columns, study.prior);
  if (effects.count() == 0)
    throw InputError(place,
                     "truth '" + truth.name + "' has no effect that '" + fitted.spec->name + "' does not estimate",
                     "a variant with other nominal values or more parameters");
  return effects;
}

/// Information of measured and fixed poses over all columns of the effects; empty: none.
Eigen::MatrixXd measured_before(const Study& study, const Effects& effects, int threads) {
  const Configurations known = known_before(study);
  if (known.count() == 0) return {};
  const BlockArray blocks = build_blocks(*study.first().model, effects.columns.selected, known, threads);
  return blocks.all().transpose() * blocks.all();
}

/// Prior information of every fitted column, 1/tolerance; empty: no prior.
Eigen::VectorXd told_by_tolerances(const Effects& effects, bool prior) {
  Eigen::VectorXd told(prior ? effects.fitted : 0);
  for (Eigen::Index j = 0; j < told.size(); ++j) told[j] = 1 / effects.columns.parameters[std::size_t(j)].tolerance;
  return told;
}

/// Candidates' rows, and as many more as what was measured before is worth.
Eigen::MatrixXd stacked(const Study& study, const Effects& effects, const Eigen::MatrixXd& measured, int threads) {
  const BlockArray blocks = build_blocks(*study.first().model, effects.columns.selected, study.configurations, threads);
  Eigen::MatrixXd rows(blocks.all().rows() + measured.rows(), blocks.columns());
  rows.topRows(blocks.all().rows()) = blocks.all();
  if (measured.size() == 0) return rows;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(measured);
  rows.bottomRows(measured.rows()) =
      eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
  return rows;
}

/// The basis of what is left of the effects beside the fitted columns: fills mix, group.mix and, of tolerances, known.
/// @param rows  of the readings: × columns of the effects
/// @param told  by tolerances. A tolerance says that the parameter is nominal, whatever the truth is: its row holds
///              the fitted column and nothing of an effect.
/// @return β, what the fitted columns take up of every effect
Eigen::MatrixXd find_basis(Discrepancy& result, const Eigen::MatrixXd& rows, const Eigen::VectorXd& told) {
  const Effects& effects = result.effects;
  const Eigen::Index own = effects.fitted, all = effects.combinations.rows(), readings = rows.rows();
  Eigen::MatrixXd fitted = Eigen::MatrixXd::Zero(readings + told.size(), own), made(fitted.rows(), effects.count());
  fitted.topRows(readings) = rows.leftCols(own);
  if (told.size() > 0) fitted.bottomRows(own) = told.asDiagonal();
  made.topRows(readings) = rows * effects.combinations;
  made.bottomRows(told.size()).setZero();
  const Eigen::VectorXd length = fitted.colwise().norm().cwiseMax(1e-300);
  fitted *= length.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd scaled_beta = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(fitted).solve(made);
  const Eigen::MatrixXd beta = length.cwiseInverse().asDiagonal() * scaled_beta;
  const Eigen::MatrixXd left = made - fitted * scaled_beta;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(left.transpose() * left);
  const double whole = made.colwise().squaredNorm().maxCoeff();
  const Eigen::Index kept = (eigen.eigenvalues().array() > imitated * whole).count();
  const Eigen::MatrixXd U = eigen.eigenvectors().rightCols(kept);
  result.mix = Eigen::MatrixXd::Zero(all, own + kept);
  result.mix.topLeftCorner(own, own).setIdentity();
  result.mix.rightCols(kept) = effects.combinations * U;
  result.mix.topRightCorner(own, kept) -= beta * U;
  result.group.columns = int(kept);
  result.group.mix = U.transpose();
  if (told.size() == 0) return beta;
  Eigen::MatrixXd prior_rows(own, own + kept);
  prior_rows.leftCols(own) = told.asDiagonal();
  prior_rows.rightCols(kept) = -(told.asDiagonal() * (beta * U));
  result.known = prior_rows.transpose() * prior_rows;
  return beta;
}

/// Targets of `bias`: the test poses, or the parameters of interest in units of the scale.
void fill_errors(Discrepancy& result, const Variant& fitted, const Eigen::MatrixXd& beta) {
  const Effects& effects = result.effects;
  const Eigen::Index own = effects.fitted, nuisance = fitted.columns.nuisance;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(own - nuisance, effects.combinations.rows());
  for (Eigen::Index j = nuisance; j < own; ++j) rows(j - nuisance, j) = 1 / fitted.scale[j];
  if (!result.test_points.empty()) {
    double total = 0.0;
    for (const TestPoint& point : result.test_points) total += point.weight;
    rows.resize(3 * Eigen::Index(result.test_points.size()), Eigen::NoChange);
    for (std::size_t t = 0; t < result.test_points.size(); ++t)
      rows.middleRows(3 * Eigen::Index(t), 3) =
          std::sqrt(result.test_points[t].weight / total) * result.test_points[t].A;
  }
  result.group.error_rows = rows.leftCols(own);
  result.group.error_offset = rows * effects.combinations - rows.leftCols(own) * beta;
}

void require_a_residual(const Study& study, const Discrepancy& found) {
  const int rows = study.first().model->block_rows(found.effects.columns.selected), own = found.effects.fitted;
  if (!find_criterion(study.criterion)->needs_residual || !study.poses || study.first().known_before ||
      *study.poses * rows > own)
    return;
  throw CannotDo(
      fmt::format("{} poses give {} equations for {} parameters: no degree of freedom is left to distinguish '{}' from "
                  "'{}'; at least {} poses are needed",
                  *study.poses, *study.poses * rows, own, study.first().spec->name, found.truth, own / rows + 1));
}

}  // namespace

std::shared_ptr<const Discrepancy> make_discrepancy(const Study& study) {
  const auto result = std::make_shared<Discrepancy>();
  const Variant& fitted = study.first();
  const int threads = study.planner.threads;
  result->truth = study.truth->name;
  result->effects = checked_effects(study);
  require_a_residual(study, *result);
  result->test_points = test_points_of(fitted, result->effects.columns, study.planner.seed);
  const Eigen::MatrixXd measured = measured_before(study, result->effects, threads);
  const Eigen::MatrixXd rows = stacked(study, result->effects, measured, threads);
  const Eigen::MatrixXd beta = find_basis(*result, rows, told_by_tolerances(result->effects, study.prior));
  fill_errors(*result, fitted, beta);
  if (measured.size() == 0) return result;
  const Eigen::MatrixXd known = result->mix.transpose() * measured * result->mix;
  result->known = result->known.size() > 0 ? Eigen::MatrixXd(result->known + known) : known;
  return result;
}

SearchPart part_with_effects(const Study& study, const Configurations& configurations, int threads) {
  const Variant& fitted = study.first();
  const Discrepancy& found = *study.discrepancy;
  if (found.group.columns == 0)
    throw CannotDo("'" + fitted.spec->name + "' reproduces every effect of '" + found.truth +
                   "' at every candidate: no poses distinguish them, and none reduces the bias");
  const BlockArray raw = build_blocks(*fitted.model, found.effects.columns.selected, configurations, threads);
  SearchPart part;
  part.blocks = BlockArray(raw.count(), raw.rows(), int(found.mix.cols()));
  part.blocks.all().noalias() = raw.all() * found.mix;
  part.nuisance = fitted.columns.nuisance;
  part.scale = Eigen::VectorXd::Ones(found.mix.cols());
  part.scale.head(found.effects.fitted) = fitted.scale;
  part.prior = found.known;
  part.effects = found.group;
  return part;
}

}  // namespace posewright
