#include "posewright/study/expected_error.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/model/independent_rows.hpp"
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

/// Readings of all poses, row below row: derivatives along fitted columns, nuisance that was left out, and twists of
/// the tips.
struct Readings {
  Configurations poses;
  std::vector<int> first{0};  ///< row of each pose, and behind the last
  Eigen::MatrixXd J, left_out, along;

  int rows_of(std::size_t pose) const { return first[pose + 1] - first[pose]; }
};

Readings readings_of(const Variant& variant, const std::vector<MeasuredPose>& measured, const Configurations& more,
                     int threads) {
  const IdentificationModel& model = *variant.model;
  VariantColumns columns;
  columns.selected = variant.columns.selected;
  const auto own = Eigen::Index(columns.selected.size());
  for (const Parameter& p : variant.dropped)
    for (int i = 0; p.role == Role::nuisance && i < int(model.parameters().size()); ++i)
      if (model.parameters()[std::size_t(i)].name == p.name) columns.selected.push_back(i);
  const auto labelled = Eigen::Index(columns.selected.size());
  for (int tip = 0; tip < model.tips(); ++tip)
    for (int k = 0; k < tip_twists; ++k) columns.selected.push_back(model.tip_column(tip, k));

  const BlockArray read = blocks_of(model, columns, measured);
  const BlockArray all_read = build_blocks(model, columns.selected, more, threads);
  Readings readings;
  readings.poses.dimension = more.dimension;
  for (const MeasuredPose& pose : measured) append(readings.poses, pose.q);
  for (std::size_t i = 0; i < more.count(); ++i) append(readings.poses, more[i]);
  for (std::size_t i = 0; i < readings.poses.count(); ++i)
    readings.first.push_back(readings.first.back() + int(i < measured.size() ? read.rows() : all_read.rows()));
  Eigen::MatrixXd all(readings.first.back(), Eigen::Index(columns.selected.size()));
  all.topRows(read.all().rows()) = read.all();
  all.bottomRows(all_read.all().rows()) = all_read.all();
  readings.J = all.leftCols(own);
  readings.left_out = all.middleCols(own, labelled - own);
  readings.along = all.rightCols(all.cols() - labelled);
  return readings;
}

/// Motions of base and tool that the readings cannot tell from nuisance parameters, or do not see.
std::array<bool, rigid_motions> taken_out(const Variant& variant, const IdentificationModel& seen,
                                          const Readings& readings) {
  const Eigen::Index nuisance = variant.columns.nuisance;
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(readings.J.rows(), rigid_motions);
  for (std::size_t i = 0; i < readings.poses.count(); ++i)
    for (int tip = 0; tip < variant.model->tips(); ++tip) {
      const Eigen::Index row = readings.first[i], rows = readings.rows_of(i);
      moved.middleRows(row, rows) +=
          readings.along.block(row, tip * tip_twists, rows, tip_twists) *
          rigid_twists(seen.tool_pose(seen_configuration(*variant.model, readings.poses[i], tip)));
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
class ErrorsAtPlaces {
 public:
  ErrorsAtPlaces(const std::vector<TestPoint>& points, const std::vector<TestPlace>& places)
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

/// Features that hold the effect between poses and places, and its rows in the readings.
struct EffectBetween {
  EffectFeatures features;
  EffectRows rows;
};

EffectBetween effect_between(const std::shared_ptr<const UnmodelledEffect>& effect,
                             const std::vector<TestPlace>& places, const Readings& readings) {
  const Eigen::MatrixXd at = effect_places(*effect, readings.poses);
  Eigen::MatrixXd all(effect->place(places.front().q).size(), at.cols() + Eigen::Index(places.size()));
  for (std::size_t t = 0; t < places.size(); ++t) all.col(Eigen::Index(t)) = effect->place(places[t].q);
  if (at.size() > 0) all.rightCols(at.cols()) = at;
  const EffectFeatures features(effect, all, whole_features + int(places.size()));
  Eigen::MatrixXd along(readings.along.rows(), Eigen::Index(effect->tips()) * effect->twists());
  for (int tip = 0; tip < effect->tips(); ++tip)
    along.middleCols(tip * effect->twists(), effect->twists()) =
        readings.along.middleCols(tip * tip_twists, effect->twists());
  effect->take_sizes(along);
  return {features, EffectRows(features.at(at), std::move(along), readings.first)};
}

/// Mean squares at the places: of the noise, and of an effect of unit size; m².
struct MeanSquares {
  double noise = 0.0, effect = 0.0, unit = 1.0;  // of `unit` metres
};

/// Sizes that count: of the noise, in units of the stated one, and of the effect, m; squares.
struct CountedSize {
  double noise = 1.0, effect = 0.0;

  ExpectedError::WithEffect error(const MeanSquares& squares) const {
    return {std::sqrt(effect),
            std::sqrt(noise * squares.noise + effect / (squares.unit * squares.unit) * squares.effect)};
  }
};

/// Least, found and largest size by the residuals, eq. (69).
/// @param left  products of the columns that an effect of `unit` metres has beside what the parameters take up
std::vector<CountedSize> measured_sizes(const FittedResiduals& residuals, const Eigen::MatrixXd& left, double unit) {
  const double all = left.trace(), free = residuals.freedom;
  const double of_unit = std::max(0.0, residuals.squares - free) / all;
  const double mean = free + of_unit * all,
               variance = free + 2 * of_unit * all + of_unit * of_unit * left.squaredNorm();
  const double directions = std::min(mean * mean / variance, most_directions);
  const double half = (1 - range_confidence) / 2;
  std::vector<CountedSize> sizes;
  for (const double factor : {directions / chi_square_quantile(1 - half, directions), 1.0,
                              directions / chi_square_quantile(half, directions)}) {
    const double found = factor * residuals.squares;
    sizes.push_back({std::min(1.0, found / free), std::max(0.0, found - free) / all * unit * unit});
  }
  return sizes;
}

}  // namespace

/// All that does not depend on the number of poses.
class ErrorsToExpect::Places {
 public:
  Places(const Variant& variant, std::vector<TestPoint> points, const std::vector<TestPlace>& places, Readings readings,
         std::size_t measured)
      : readings_(std::move(readings)), measured_(measured) {
    said_.at = variant.test_points.empty() ? ExpectedError::At::candidates : ExpectedError::At::test_poses;
    said_.places = int(points.size());
    said_.required = variant.problem->design.require.accuracy;
    said_.noise = noise_of_a_pose(readings_.along.leftCols<3>(), readings_.poses.count());
    // Effects come in multiples of it, and angles alone say nothing of displacements.
    if (!std::isfinite(said_.noise)) return;
    const auto effect = effect_of(variant, said_);
    unit_ = effect->size().translation;
    said_.length = effect->size().length;
    counted_ = variant.effect != nullptr;
    const auto seen = make_pose_seen(variant);
    const std::array<bool, rigid_motions> out = taken_out(variant, *seen, readings_);
    said_.base_out = std::any_of(out.begin(), out.begin() + tip_twists, [](bool o) { return o; });
    said_.tool_out = std::any_of(out.begin() + tip_twists, out.end(), [](bool o) { return o; });
    const EffectBetween between = effect_between(effect, places, readings_);
    rows_ = between.rows;
    const ErrorsAtPlaces errors(points, places);
    Eigen::MatrixXd A = errors.by_parameters(), B = errors.by_effect(between.features);
    moves_ = !A.isZero(0);
    const Eigen::MatrixXd Q = errors.by_frames(*seen, out);
    A -= Q * (Q.transpose() * A);
    B -= Q * (Q.transpose() * B);
    AA_ = A.transpose() * A;
    AB_ = A.transpose() * B;
    BB_ = B.squaredNorm();
    if (said_.size != ExpectedError::Size::of_robots) sizes_ = {{1, unit_ * unit_}};
    else
      for (const double times : ExpectedError::robots) sizes_.push_back({1, times * times * unit_ * unit_});
  }

  bool moves() const { return moves_; }
  std::size_t poses() const { return readings_.poses.count(); }

  void take_size_of(const FittedResiduals& residuals, const Eigen::MatrixXd& covariance) {
    if (counted_ || covariance.size() == 0 || !(residuals.freedom >= most_directions)) return;
    const EffectRows rows = rows_->beginning(measured_);
    const auto J = readings_.J.topRows(rows.rows());
    const Eigen::MatrixXd FJ = rows.transposed_times(J), taken = FJ * covariance;
    const Eigen::MatrixXd left = rows.products() - taken * FJ.transpose() - FJ * taken.transpose() +
                                 taken * (J.transpose() * J) * taken.transpose();
    std::vector<CountedSize> found = measured_sizes(residuals, left, unit_);
    // A size beyond those of robots that so few residuals give, while all of these remain possible, is chance.
    const auto square = [&](double times) { return std::pow(times * said_.noise, 2); };
    if (found[0].effect <= square(ExpectedError::robots.front()) &&
        std::min(found[1].effect, found[2].effect) >= square(ExpectedError::robots.back()))
      return;
    sizes_ = std::move(found);
    said_.size = ExpectedError::Size::measured;
  }

  /// Jᵀ F of all poses, as of independent readings: of those that an effect which the fit counts makes dependent it is
  /// Jᵀ (I + F Fᵀ)⁻¹ F = Jᵀ F (I + Fᵀ F)⁻¹.
  Eigen::MatrixXd products_of_all() const {
    Eigen::MatrixXd FJ = rows_->transposed_times(readings_.J);
    if (!counted_) return FJ.transpose();
    Eigen::MatrixXd inner = rows_->products();
    inner.diagonal().array() += 1.0;
    return inner.llt().solve(FJ).transpose();
  }

  /// J and F as of independent readings, so that the first rows are those of the first poses alone.
  void whiten_in_order(Eigen::MatrixXd& J, Eigen::MatrixXd& F) const {
    J = readings_.J;
    F = rows_->dense();
    if (!counted_) return;
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(F.rows(), F.rows());
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(F);
    const Eigen::LLT<Eigen::MatrixXd> root(covariance);
    root.matrixL().solveInPlace(J);
    root.matrixL().solveInPlace(F);
  }

  Eigen::Index rows_before(std::size_t pose) const { return readings_.first[pose]; }

  /// @param JF  Jᵀ F of the poses
  ExpectedError expected(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& JF) const {
    const Eigen::MatrixXd follows = covariance * JF;
    Eigen::MatrixXd V = covariance;
    if (counted_) V -= follows * follows.transpose();
    const MeanSquares squares{V.cwiseProduct(AA_).sum(),
                              std::max(0.0, follows.cwiseProduct(AA_ * follows - 2 * AB_).sum() + BB_), unit_};
    ExpectedError e = said_;
    e.amplification = std::sqrt(squares.effect / 3) / unit_;
    for (const CountedSize& size : sizes_) e.with.push_back(size.error(squares));
    e.by_noise = std::sqrt(sizes_[sizes_.size() / 2].noise * squares.noise);
    return e;
  }

 private:
  Readings readings_;
  std::size_t measured_;
  ExpectedError said_;  // what is the same for any number of poses
  bool counted_ = false, moves_ = false;
  double unit_ = 1.0;
  std::vector<CountedSize> sizes_;
  std::optional<EffectRows> rows_;  // columns of the effect, F
  Eigen::MatrixXd AA_, AB_;         // AᵀA, AᵀB
  double BB_ = 0.0;
};

ErrorsToExpect::ErrorsToExpect(const Configurations& candidates, const Variant& variant,
                               const std::vector<MeasuredPose>& measured, const Configurations& more, int threads) {
  std::vector<TestPoint> points = variant.test_points;
  if (variant.model->tips() == 0 || (points.empty() && variant.model->tips() > 1)) return;
  std::vector<TestPlace> places = variant.test_places;
  if (points.empty()) points = test_points_at_candidates(candidates, variant, places);
  places_ = std::make_unique<Places>(variant, std::move(points), places, readings_of(variant, measured, more, threads),
                                     measured.size());
  if (!places_->moves()) places_.reset();
}

ErrorsToExpect::~ErrorsToExpect() = default;

void ErrorsToExpect::take_size_of(const FittedResiduals& residuals, const Eigen::MatrixXd& covariance) {
  if (places_ != nullptr) places_->take_size_of(residuals, covariance);
}

std::vector<std::optional<ExpectedError>> ErrorsToExpect::after_each(
    const std::vector<Eigen::MatrixXd>& covariances) const {
  std::vector<std::optional<ExpectedError>> errors(covariances.size());
  if (places_ == nullptr) return errors;
  Eigen::MatrixXd J, F;
  places_->whiten_in_order(J, F);
  Eigen::MatrixXd JF = Eigen::MatrixXd::Zero(J.cols(), F.cols());
  for (std::size_t n = 0; n < covariances.size(); ++n) {
    if (n > 0) {
      const Eigen::Index first = places_->rows_before(n - 1), rows = places_->rows_before(n) - first;
      JF.noalias() += J.middleRows(first, rows).transpose() * F.middleRows(first, rows);
    }
    if (covariances[n].size() > 0) errors[n] = places_->expected(covariances[n], JF);
  }
  return errors;
}

std::optional<ExpectedError> ErrorsToExpect::after_all(const Eigen::MatrixXd& covariance) const {
  if (places_ == nullptr) return std::nullopt;
  return places_->expected(covariance, places_->products_of_all());
}

std::optional<ExpectedError> expected_error(const Configurations& candidates, const Variant& variant,
                                            const Configurations& poses, const Eigen::MatrixXd& covariance,
                                            int threads) {
  return ErrorsToExpect(candidates, variant, {}, poses, threads).after_all(covariance);
}

}  // namespace posewright
