#include "posewright/study/expected_error.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/study/unmodelled.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"

namespace posewright {
namespace {

// What nuisance columns leave of a frame's motion, where it is theirs: rounding.
constexpr double taken_up = 1e-6;
constexpr int tip_twists = 6, rigid_motions = 12;
// An effect has few causes: residuals are no more witnesses of its size than so many.
constexpr double most_directions = 5;
constexpr double range_confidence = 0.95;

using RigidTwists = Eigen::Matrix<double, tip_twists, rigid_motions>;

/// Twists of a tip at X by unit motions of the base (3 shifts, 3 turns) and of the tool (3 shifts, 3 turns).
RigidTwists rigid_twists(const Eigen::Isometry3d& X) {
  RigidTwists T = RigidTwists::Zero();
  T.block<3, 3>(0, 0).setIdentity();
  T.block<3, 3>(3, 3).setIdentity();
  for (int k = 0; k < 3; ++k) T.block<3, 1>(0, 3 + k) = Eigen::Vector3d::Unit(k).cross(X.translation());
  T.block<3, 3>(0, 6) = X.linear();
  T.block<3, 3>(3, 9) = X.linear();
  return T;
}

/// The readings of all poses: derivatives along fitted columns, nuisance that was left out, and twists of the tips.
struct Readings {
  Eigen::MatrixXd J, left_out, along;
};

Readings readings_of(const Variant& variant, const Configurations& poses, int threads) {
  const IdentificationModel& model = *variant.model;
  std::vector<int> selected = variant.columns.selected;
  const auto own = Eigen::Index(selected.size());
  for (const Parameter& p : variant.dropped)
    for (int i = 0; p.role == Role::nuisance && i < int(model.parameters().size()); ++i)
      if (model.parameters()[std::size_t(i)].name == p.name) selected.push_back(i);
  const auto labelled = Eigen::Index(selected.size());
  for (int tip = 0; tip < model.tips(); ++tip)
    for (int k = 0; k < tip_twists; ++k) selected.push_back(model.tip_column(tip, k));
  const BlockArray blocks = build_blocks(model, selected, poses, threads);
  return {blocks.all().leftCols(own), blocks.all().middleCols(own, labelled - own),
          blocks.all().rightCols(blocks.columns() - labelled)};
}

/// Motions of base and tool that the readings cannot tell from nuisance parameters, or do not see.
std::array<bool, rigid_motions> taken_out(const Variant& variant, const IdentificationModel& seen,
                                          const Configurations& poses, const Readings& readings) {
  const Eigen::Index nuisance = variant.columns.nuisance, rows = readings.J.rows() / Eigen::Index(poses.count());
  const std::size_t own = variant.model->tip_coordinates();
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(readings.J.rows(), rigid_motions);
  for (std::size_t i = 0; i < poses.count(); ++i)
    for (int tip = 0; tip < variant.model->tips(); ++tip) {
      const Eigen::Index row = Eigen::Index(i) * rows;
      moved.middleRows(row, rows) += readings.along.block(row, tip * tip_twists, rows, tip_twists) *
                                     rigid_twists(seen.tool_pose(poses[i].subspan(std::size_t(tip) * own, own)));
    }
  Eigen::MatrixXd beside(readings.J.rows(), nuisance + readings.left_out.cols());
  beside << readings.J.leftCols(nuisance), readings.left_out;
  std::array<bool, rigid_motions> out{};
  if (beside.cols() == 0) return out;
  const double scale = readings.along.leftCols<3>().norm();
  const Eigen::MatrixXd left = left_beside(beside, moved);
  for (int k = 0; k < rigid_motions; ++k) out[std::size_t(k)] = left.col(k).norm() <= taken_up * scale;
  return out;
}

/// Errors of position at all places, one below the other, each times the root of its share of the weight.
class PlacesThatCount {
 public:
  PlacesThatCount(const std::vector<TestPoint>& points, const std::vector<TestPlace>& places)
      : points_(points), places_(places) {
    for (const TestPoint& point : points) total_ += point.weight;
  }

  Eigen::MatrixXd by_parameters() const {
    return stacked(points_.front().A.cols(), [&](std::size_t t) { return points_[t].A; });
  }
  Eigen::MatrixXd by_effect(const EffectFeatures& features) const {
    return stacked(features.columns(), [&](std::size_t t) {
      return features.columns_at(features.at(features.effect().place(places_[t].q)), places_[t].twists.topRows<3>());
    });
  }
  /// Orthonormal directions of the errors by these motions.
  Eigen::MatrixXd by_frames(const IdentificationModel& seen, const std::array<bool, rigid_motions>& motions) const {
    Eigen::MatrixXd moved = stacked(rigid_motions, [&](std::size_t t) -> Eigen::MatrixXd {
      return places_[t].twists.topRows<3>() * rigid_twists(seen.tool_pose(places_[t].q));
    });
    for (int k = 0; k < rigid_motions; ++k)
      if (!motions[std::size_t(k)]) moved.col(k).setZero();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(moved);
    return qr.householderQ() * Eigen::MatrixXd::Identity(moved.rows(), qr.rank());
  }

 private:
  template <class Rows>
  Eigen::MatrixXd stacked(Eigen::Index columns, Rows&& rows) const {
    Eigen::MatrixXd all(3 * Eigen::Index(points_.size()), columns);
    for (std::size_t t = 0; t < points_.size(); ++t)
      all.middleRows<3>(3 * Eigen::Index(t)) = std::sqrt(points_[t].weight / total_) * rows(t);
    return all;
  }

  const std::vector<TestPoint>& points_;
  const std::vector<TestPlace>& places_;
  double total_ = 0.0;
};

/// Effect of the variant, of an earlier calibration, or as large as the noise.
std::shared_ptr<const UnmodelledEffect> effect_of(const Variant& variant, ExpectedError& result) {
  if (variant.effect != nullptr) {
    result.size = ExpectedError::Size::counted;
    return variant.effect;
  }
  UnmodelledSize size{result.noise, 0.0, UnmodelledSize::assumed_length};
  if (const auto& calibrated = variant.problem->parameters; calibrated && calibrated->unmodelled) {
    result.size = ExpectedError::Size::measured;
    size.translation = calibrated->unmodelled->size;
    size.length = calibrated->unmodelled->length;
  }
  return std::make_shared<UnmodelledEffect>(*variant.model, size);
}

/// Features that hold the effect between poses and places, and its columns in the readings.
struct EffectColumns {
  EffectFeatures features;
  Eigen::MatrixXd F;
};

EffectColumns effect_columns(const std::shared_ptr<const UnmodelledEffect>& effect, const Configurations& poses,
                             const std::vector<TestPlace>& places, const Readings& readings) {
  const Eigen::MatrixXd at = effect_places(*effect, poses);
  Eigen::MatrixXd all(at.rows(), at.cols() + Eigen::Index(places.size()));
  for (std::size_t t = 0; t < places.size(); ++t) all.col(Eigen::Index(t)) = effect->place(places[t].q);
  all.rightCols(at.cols()) = at;
  EffectColumns result{EffectFeatures(effect, all, whole_features + int(places.size())), {}};
  const Eigen::MatrixXd phi = result.features.at(at);
  const Eigen::Index rows = readings.along.rows() / Eigen::Index(poses.count());
  Eigen::MatrixXd along(readings.along.rows(), Eigen::Index(effect->tips()) * effect->twists());
  for (int tip = 0; tip < effect->tips(); ++tip)
    along.middleCols(tip * effect->twists(), effect->twists()) =
        readings.along.middleCols(tip * tip_twists, effect->twists());
  effect->take_sizes(along);
  result.F = Eigen::MatrixXd::Zero(along.rows(), result.features.columns());
  for (std::size_t i = 0; i < poses.count(); ++i)
    result.features.add_columns(phi.middleCols(Eigen::Index(i) * effect->tips(), effect->tips()),
                                along.middleRows(Eigen::Index(i) * rows, rows),
                                result.F.middleRows(Eigen::Index(i) * rows, rows));
  return result;
}

/// Mean squares at the places: of the noise, and of an effect of unit size; m².
struct MeanSquares {
  double noise = 0.0, effect = 0.0, unit = 1.0;  // of `unit` metres

  /// With noise of s and an effect of τ.
  ExpectedError::WithEffect with(double s_squared, double size_squared) const {
    return {std::sqrt(size_squared), std::sqrt(s_squared * noise + size_squared / (unit * unit) * effect)};
  }
};

/// Least, found and largest size by the residuals, eq. (69).
/// @param left  columns of the effect of unit size beside what the parameters take up
void take_measured(const FittedResiduals& residuals, const Eigen::MatrixXd& left, const MeanSquares& squares,
                   ExpectedError& result) {
  const double all = residuals.share * left.squaredNorm(), free = residuals.freedom;
  const double of_unit = std::max(0.0, residuals.squares - free) / all;
  const double both =
      residuals.share * residuals.share *
      (left.rows() < left.cols() ? Eigen::MatrixXd(left * left.transpose()) : Eigen::MatrixXd(left.transpose() * left))
          .squaredNorm();
  const double mean = free + of_unit * all, variance = free + 2 * of_unit * all + of_unit * of_unit * both;
  const double directions = std::min(mean * mean / variance, most_directions);
  result.size = ExpectedError::Size::measured;
  result.with.clear();
  const double half = (1 - range_confidence) / 2;
  for (const double factor : {directions / chi_square_quantile(1 - half, directions), 1.0,
                              directions / chi_square_quantile(half, directions)}) {
    const double found = factor * residuals.squares;
    result.with.push_back(
        squares.with(std::min(1.0, found / free), std::max(0.0, found - free) / all * squares.unit * squares.unit));
  }
  result.by_noise *= std::min(1.0, std::sqrt(residuals.squares / free));
}

}  // namespace

std::optional<ExpectedError> expected_error(const Configurations& candidates, const Variant& variant,
                                            const Configurations& poses, const Eigen::MatrixXd& covariance, int threads,
                                            const std::optional<FittedResiduals>& residuals) {
  const IdentificationModel& model = *variant.model;
  ExpectedError result;
  result.at_test_poses = !variant.test_points.empty();
  if (model.tips() == 0 || (!result.at_test_poses && model.tips() > 1)) return std::nullopt;
  std::vector<TestPoint> points = variant.test_points;
  std::vector<TestPlace> test_places = variant.test_places;
  if (points.empty()) points = test_points_at_candidates(candidates, variant, test_places);
  result.places = int(points.size());
  result.required = variant.problem->design.require.accuracy;

  Readings readings = readings_of(variant, poses, threads);
  result.noise = noise_of_a_pose(readings.along.leftCols<3>(), poses.count());
  const auto effect = effect_of(variant, result);
  result.length = effect->size().length;
  const auto seen = make_pose_seen(variant);
  const std::array<bool, rigid_motions> out = taken_out(variant, *seen, poses, readings);
  result.base_out = std::any_of(out.begin(), out.begin() + tip_twists, [](bool o) { return o; });
  result.tool_out = std::any_of(out.begin() + tip_twists, out.end(), [](bool o) { return o; });

  EffectColumns columns = effect_columns(effect, poses, test_places, readings);
  if (variant.effect != nullptr) {
    const IndependentRows independent(columns.F);
    independent.apply(readings.J);
    independent.apply(columns.F);
  }
  const Eigen::MatrixXd follows = covariance * (readings.J.transpose() * columns.F);
  Eigen::MatrixXd V = covariance;
  if (variant.effect != nullptr) V -= follows * follows.transpose();
  const PlacesThatCount places(points, test_places);
  Eigen::MatrixXd A = places.by_parameters();
  if (A.isZero(0)) return std::nullopt;
  const Eigen::MatrixXd Q = places.by_frames(*seen, out);
  Eigen::MatrixXd E = A * follows - places.by_effect(columns.features);
  A -= Q * (Q.transpose() * A);
  E -= Q * (Q.transpose() * E);

  const MeanSquares squares{(A * V).cwiseProduct(A).sum(), E.squaredNorm(), effect->size().translation};
  result.by_noise = std::sqrt(squares.noise);
  result.amplification = std::sqrt(squares.effect / 3) / squares.unit;
  if (residuals && residuals->freedom >= most_directions && variant.effect == nullptr) {
    take_measured(*residuals, columns.F - readings.J * follows, squares, result);
  } else if (result.size != ExpectedError::Size::of_robots) {
    result.with = {squares.with(1, squares.unit * squares.unit)};
  } else {
    for (const double times : ExpectedError::robots)
      result.with.push_back(squares.with(1, times * times * squares.unit * squares.unit));
  }
  return result;
}

}  // namespace posewright
