#include "distance_pair_model.hpp"

#include <algorithm>

#include "instruments.hpp"
#include "posewright/model/closed_chain.hpp"
#include "posewright/model/pair_names.hpp"
#include "posewright/support/dense.hpp"
#include "repeatability.hpp"

namespace posewright {
struct DistancePairModel::End {
  Eigen::Isometry3d X;
  Twists twists, reading_twists, displacement;
  // Of pull_back(): what moves it at random (1σ each), f's derivatives by that, by rows along unit twists and by
  // motions.
  Twists random, by_random;
  TipAdjoint by;
};

DistancePairModel::DistancePairModel(std::unique_ptr<TipModel> tip, const MeasurementSpec& spec)
    : tip_(std::move(tip)),
      spec_(std::get<DistanceMeasurement>(spec.instrument)),
      repeats_(spec.repeats),
      repeatability_(spec.repeatability) {
  parameters_ = tip_->parameters();
  std::erase_if(parameters_, [](const Parameter& p) { return p.name.starts_with("tool."); });
  tip_parameters_ = int(parameters_.size());
  for (const Preference& preference : tip_->geometric_parameters())
    if (preference.parameter < tip_parameters_) geometric_.push_back(preference);
  for (const TargetSpec& t : spec_.targets)
    for (int k = 0; k < 3; ++k) {
      geometric_.push_back({int(parameters_.size()), 1});
      parameters_.push_back(
          {"target." + t.name + "." + "xyz"[k], "m", t.position[k], default_target_tolerance, Role::interest});
    }
  const auto append = [](std::vector<Coordinate>& to, const std::vector<Coordinate>& from, const char* suffix,
                         bool choices) {
    for (Coordinate c : from) {
      if (c.choice() != choices) continue;
      c.name += suffix;
      to.push_back(c);
    }
  };
  append(coordinates_, tip_->coordinates(), "", false);
  moving_ = coordinates_.size();
  append(coordinates_, tip_->coordinates(), second_suffix, false);
  append(coordinates_, tip_->coordinates(), "", true);
  append(actuators_, tip_->actuators(), "", false);
  append(actuators_, tip_->actuators(), second_suffix, false);
  for (const TargetSpec& t : spec_.targets) readings_.push_back({t.name + ".distance", "m"});
  rows_ = int(spec_.targets.size());
  tips_ = 2;
  tip_coordinates_ = moving_;
  unmeasurable_reason_ = "distance out of range";
  if (!actuators_.empty()) unmeasurable_reason_ += " or " + near_singularity();
}

std::vector<double> DistancePairModel::at_end(std::span<const double> q, std::size_t which) const {
  std::vector<double> own(q.begin() + std::ptrdiff_t(which * moving_),
                          q.begin() + std::ptrdiff_t((which + 1) * moving_));
  own.insert(own.end(), q.begin() + std::ptrdiff_t(2 * moving_), q.end());
  return own;
}

Eigen::Vector3d DistancePairModel::target(const Eigen::Isometry3d& X, std::span<const double> correction,
                                          std::size_t t) const {
  Eigen::Vector3d p = spec_.targets[t].position;
  if (!correction.empty())
    p += Eigen::Map<const Eigen::Vector3d>(correction.data() + std::size_t(tip_parameters_) + 3 * t);
  return X * p;
}

std::span<const double> DistancePairModel::tip_part(std::span<const double> correction) const {
  return correction.empty() ? correction : correction.first(std::size_t(tip_parameters_));
}

bool DistancePairModel::end(const Point& at, std::size_t which, std::span<const int> selected, End& result) const {
  const std::vector<double> q = at_end(at.q, which);
  if (!tip_->linearise({q, tip_part(at.correction), at.chosen}, selected, result.X, result.twists,
                       &result.reading_twists))
    return false;
  // Without its tool the tip's catalogue ends earlier than the tip knows: what follows is not its own.
  for (std::size_t c = 0; c < selected.size(); ++c)
    if (const int k = selected[c] - tip_column(int(which), 0); selected[c] >= tip_column(0, 0))
      result.twists.col(Eigen::Index(c)) =
          k >= 0 && k < 6 ? unit_displacement(result.X.translation(), k) : Twist(Twist::Zero());
  return true;
}

void DistancePairModel::do_take_loads_at(std::span<const double> correction) {
  tip_->take_loads_at(tip_part(correction));
}

bool DistancePairModel::do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const {
  static thread_local End ends[2];
  for (std::size_t i = 0; i < 2; ++i)
    if (!end(at, i, selected, ends[i])) return false;
  out.G.resize(rows_, Eigen::Index(selected.size()));
  out.covariance.setZero(rows_, rows_);
  const auto readings = Eigen::Index(tip_->reading_noise().size());
  const int displacement = displacement_size(repeatability_);
  out.rows.resize(rows_, 2 * (readings + displacement));
  for (End& each : ends) {
    each.displacement.resize(6, displacement);
    displacement_of_a_visit(repeatability_, each.X.translation(), each.displacement);
  }
  for (int t = 0; t < rows_; ++t) {
    const Eigen::Vector3d from = target(ends[0].X, at.correction, std::size_t(t)),
                          to = target(ends[1].X, at.correction, std::size_t(t));
    const double d = (to - from).norm();
    if (!(d > 0)) return false;
    const Eigen::Vector3d e = (to - from) / d;
    Twist along[2];
    along[0] << -e, -from.cross(e);
    along[1] << e, to.cross(e);
    out.G.row(t) = along[0].transpose() * ends[0].twists + along[1].transpose() * ends[1].twists;
    for (std::size_t c = 0; c < selected.size(); ++c) {
      if (selected[c] < tip_parameters_ || selected[c] >= tip_column(0, 0)) continue;
      const int own = selected[c] - tip_parameters_;
      out.G(t, Eigen::Index(c)) =
          own / 3 == t ? e.dot(ends[1].X.linear().col(own % 3) - ends[0].X.linear().col(own % 3)) : 0.0;
    }
    out.covariance(t, t) = distance_variance(spec_, d, repeats_);
    for (Eigen::Index i = 0; i < 2; ++i) {
      // The robot stands off at either end, each time anew.
      auto of_end = out.rows.row(t).segment(i * (readings + displacement), readings + displacement);
      for (Eigen::Index j = 0; j < readings; ++j)
        of_end[j] = along[i].dot(ends[i].reading_twists.col(j)) * tip_->reading_noise()[std::size_t(j)];
      of_end.tail(displacement) = along[i].transpose() * ends[i].displacement;
    }
  }
  out.share_readings();
  out.covariance.noalias() += out.rows * out.rows.transpose();
  return true;
}

bool DistancePairModel::do_read(const Point& at, Eigen::VectorXd& y) const {
  static thread_local End ends[2];
  for (std::size_t i = 0; i < 2; ++i)
    if (!end(at, i, {}, ends[i])) return false;
  for (int t = 0; t < rows_; ++t)
    y[t] = (target(ends[1].X, at.correction, std::size_t(t)) - target(ends[0].X, at.correction, std::size_t(t))).norm();
  return true;
}

bool DistancePairModel::do_configuration_at(std::span<const double> actuators, const Point& start,
                                            std::span<double> q) const {
  std::copy(start.q.begin(), start.q.end(), q.begin());
  const std::size_t each = actuators.size() / 2;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::vector<double> from = at_end(start.q, i);
    std::vector<double> own = from;
    const Point at{from, tip_part(start.correction), start.chosen};
    if (!tip_->configuration_at(actuators.subspan(i * each, each), at, own)) return false;
    std::copy_n(own.begin(), moving_, q.begin() + std::ptrdiff_t(i * moving_));
  }
  return true;
}

bool DistancePairModel::do_measurable(const Point& at) const {
  End ends[2];
  for (std::size_t i = 0; i < 2; ++i)
    if (!end(at, i, {}, ends[i])) return false;
  for (std::size_t t = 0; t < spec_.targets.size(); ++t)
    if (!spans(spec_, (target(ends[1].X, at.correction, t) - target(ends[0].X, at.correction, t)).norm())) return false;
  return true;
}

bool DistancePairModel::do_actuator_values(const Point& at, std::span<double> values) const {
  const std::size_t actuators = values.size() / 2;
  const auto values_at = [&](std::size_t which, std::span<double> own) {
    const std::vector<double> q = at_end(at.q, which);
    return tip_->actuator_values({q, tip_part(at.correction), at.chosen}, own);
  };
  return values_at(0, values.first(actuators)) && values_at(1, values.last(actuators));
}

Eigen::Isometry3d DistancePairModel::do_tool_pose(const Point& at) const {
  End second;
  second.X.setIdentity();
  end(at, 1, {}, second);
  return second.X;
}

std::optional<int> DistancePairModel::do_measurable_margins() const { return rows_ * span_margins(spec_); }

bool DistancePairModel::do_measurable_margins_at(const Point& at, std::span<double> out) const {
  if (out.empty()) return true;
  static thread_local End ends[2];
  for (std::size_t i = 0; i < 2; ++i)
    if (!end(at, i, {}, ends[i])) return false;
  for (std::size_t t = 0; t < spec_.targets.size(); ++t)
    span_margins_at(spec_, (target(ends[1].X, at.correction, t) - target(ends[0].X, at.correction, t)).norm(),
                    out.subspan(2 * t, 2));
  return true;
}

/// A row is (−e, −from × e) · twists of the first end + (e, to × e) · twists of the second one.
bool DistancePairModel::do_pull_back(const Point& at, std::span<const int> selected, const Eigen::MatrixXd& by_G,
                                     const Eigen::MatrixXd& by_covariance, std::span<double> gradient) const {
  static thread_local End ends[2];
  const auto readings = Eigen::Index(tip_->reading_noise().size());
  const int displacement = displacement_size(repeatability_);
  for (std::size_t i = 0; i < 2; ++i) {
    End& own = ends[i];
    if (!end(at, i, selected, own)) return false;
    for (std::size_t c = 0; c < selected.size(); ++c)
      if (selected[c] >= tip_parameters_ && selected[c] < tip_column(0, 0)) own.twists.col(Eigen::Index(c)).setZero();
    own.random.resize(6, readings + displacement);
    for (Eigen::Index j = 0; j < readings; ++j)
      own.random.col(j) = tip_->reading_noise()[std::size_t(j)] * own.reading_twists.col(j);
    displacement_of_a_visit(repeatability_, own.X.translation(), own.random.rightCols(displacement));
    own.by.twists.setZero(6, Eigen::Index(selected.size()));
    own.by.tip.setZero();
    own.by_random.setZero(6, own.random.cols());
  }
  Eigen::MatrixXd along[2] = {Eigen::MatrixXd(rows_, 6), Eigen::MatrixXd(rows_, 6)}, by_along[2];
  for (int t = 0; t < rows_; ++t) {
    const Eigen::Vector3d from = target(ends[0].X, at.correction, std::size_t(t)),
                          to = target(ends[1].X, at.correction, std::size_t(t)), e = (to - from).normalized();
    along[0].row(t) << -e.transpose(), -from.cross(e).transpose();
    along[1].row(t) << e.transpose(), to.cross(e).transpose();
  }
  const Eigen::MatrixXd random_rows[2] = {along[0] * ends[0].random, along[1] * ends[1].random};
  for (int i = 0; i < 2; ++i) {
    const Eigen::MatrixXd by_random_rows = 2 * by_covariance * random_rows[i];
    by_along[i] = by_G * ends[i].twists.transpose() + by_random_rows * ends[i].random.transpose();
    ends[i].by.twists = along[i].transpose() * by_G;
    ends[i].by_random = along[i].transpose() * by_random_rows;
  }
  for (int t = 0; t < rows_; ++t) {
    const Eigen::Vector3d from = target(ends[0].X, at.correction, std::size_t(t)),
                          to = target(ends[1].X, at.correction, std::size_t(t));
    const double d = (to - from).norm();
    const Eigen::Vector3d e = (to - from) / d;
    const Eigen::Vector3d turn0 = by_along[0].row(t).tail<3>(), turn1 = by_along[1].row(t).tail<3>();
    Eigen::Vector3d by_e = by_along[1].row(t).head<3>() - by_along[0].row(t).head<3>();
    by_e += turn1.cross(to) - turn0.cross(from);
    Eigen::Vector3d by_turn[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (std::size_t c = 0; c < selected.size(); ++c) {
      const int own = selected[c] - tip_parameters_;
      if (own < 0 || selected[c] >= tip_column(0, 0) || own / 3 != t) continue;
      const double slope = by_G(t, Eigen::Index(c));
      const Eigen::Vector3d a = ends[0].X.linear().col(own % 3), b = ends[1].X.linear().col(own % 3);
      by_e += slope * (b - a);
      by_turn[0] -= slope * a.cross(e);
      by_turn[1] += slope * b.cross(e);
    }
    const double sigma = spec_.sigma + spec_.sigma_per_m * d;
    const Eigen::Vector3d by_span =
        (by_e - e.dot(by_e) * e) / d + by_covariance(t, t) * 2 * sigma * spec_.sigma_per_m / repeats_ * e;
    ends[0].by.tip += change_by_motion(from, -e.cross(turn0) - by_span, by_turn[0]);
    ends[1].by.tip += change_by_motion(to, e.cross(turn1) + by_span, by_turn[1]);
  }
  std::vector<double> of_end(tip_->coordinates().size());
  for (std::size_t i = 0; i < 2; ++i) {
    End& own = ends[i];
    // Turns about the tip's origin move it by p × axis.
    Eigen::Vector3d by_origin = Eigen::Vector3d::Zero();
    for (int k = 3; k < displacement; ++k)
      by_origin += repeatability_.rotation *
                   Eigen::Vector3d::Unit(k - 3).cross(Eigen::Vector3d(own.by_random.col(readings + k).head<3>()));
    for (std::size_t c = 0; c < selected.size(); ++c) {
      auto slope = own.by.twists.col(Eigen::Index(c));
      if (const int k = selected[c] - tip_column(int(i), 0); k >= 3 && k < 6)
        by_origin += Eigen::Vector3d::Unit(k - 3).cross(Eigen::Vector3d(slope.head<3>()));
      if (selected[c] >= tip_parameters_) slope.setZero();
    }
    own.by.tip += change_by_motion(own.X.translation(), by_origin, Eigen::Vector3d::Zero());
    own.by.reading_twists = own.by_random.leftCols(readings);
    for (Eigen::Index j = 0; j < readings; ++j) own.by.reading_twists.col(j) *= tip_->reading_noise()[std::size_t(j)];
    std::fill(of_end.begin(), of_end.end(), 0.0);
    const std::vector<double> q = at_end(at.q, i);
    if (!tip_->pull_back({q, tip_part(at.correction), at.chosen}, selected, own.by, of_end)) return false;
    for (std::size_t k = 0; k < moving_; ++k) gradient[i * moving_ + k] = of_end[k];
  }
  return true;
}

}  // namespace posewright
