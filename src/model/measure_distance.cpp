#include <algorithm>

#include "instruments.hpp"

namespace posewright {
namespace {

constexpr double default_tolerance = 1e-3;  // m
constexpr double shortest = 1e-6;           // m

/// Distances from fixed anchors to targets on the tip: ball bar, cable sensor. Rows: anchor by anchor, target by
/// target, d = ‖p − c‖ + length. Own parameters: target.NAME.{x,y,z} (tip frame), anchor.NAME.{x,y,z} (measurement
/// frame), anchor.NAME.length (m, what the reading is too long by).
class DistanceModel : public MeasurementModel {
 public:
  explicit DistanceModel(const MeasurementSpec& spec)
      : spec_(std::get<DistanceMeasurement>(spec.instrument)), repeats_(spec.repeats) {
    rows_ = int(spec_.targets.size() * spec_.anchors.size());
    replaces_tool_ = true;
    unseen_reason_ = "distance out of range";
    const auto add = [&](const std::string& name, const Eigen::Vector3d& nominal, int tier) {
      for (int k = 0; k < 3; ++k) {
        preferences_.push_back({int(parameters_.size()), tier});
        parameters_.push_back({name + "." + "xyz"[k], "m", nominal[k], default_tolerance, Role::interest});
      }
    };
    for (const TargetSpec& target : spec_.targets) add("target." + target.name, target.position, 1);
    for (const TargetSpec& anchor : spec_.anchors) add("anchor." + anchor.name, anchor.position, 0);
    for (const TargetSpec& anchor : spec_.anchors)
      for (const TargetSpec& target : spec_.targets) readings_.push_back({anchor.name + "-" + target.name, "m"});
    for (const TargetSpec& anchor : spec_.anchors)
      parameters_.push_back({"anchor." + anchor.name + ".length", "m", 0.0, default_tolerance, Role::interest});
  }

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override {
    const std::size_t targets = spec_.targets.size(), lengths = 3 * (targets + spec_.anchors.size());
    for (std::size_t row = 0; row < std::size_t(rows_); ++row) {
      const double too_long = sighting.correction.empty() ? 0.0 : sighting.correction[lengths + row / targets];
      y[Eigen::Index(row)] = span_of(sighting, row).between.norm() + too_long;
    }
  }

  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override {
    for (Eigen::Index row = 0; row < rows_; ++row) {
      const Span span = span_of(sighting, std::size_t(row));
      Twist along;
      along.head<3>() = span.between.normalized();
      along.tail<3>() = span.p.cross(along.head<3>());
      rows.row(row) = along.transpose() * twists;
    }
  }

  void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const override {
    column.setZero();
    const int targets = int(spec_.targets.size()), anchors = int(spec_.anchors.size());
    for (int row = 0; row < rows_; ++row) {
      const int t = row % targets, a = row / targets;
      if (index >= 3 * (targets + anchors)) {
        if (index - 3 * (targets + anchors) == a) column[row] = 1.0;
        continue;
      }
      const Eigen::Vector3d e = span_of(sighting, std::size_t(row)).between.normalized();
      if (index < 3 * targets && index / 3 == t) column[row] = e.dot(sighting.X_MeasureTip.linear().col(index % 3));
      if (index >= 3 * targets && index / 3 - targets == a) column[row] = -e[index % 3];
    }
  }

  void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const override {
    covariance.setZero();
    for (int row = 0; row < rows_; ++row)
      covariance(row, row) = distance_variance(spec_, span_of(sighting, std::size_t(row)).between.norm(), repeats_);
  }

  Twist pull_back(const Sighting& sighting, const Adjoint& f) const override {
    const int targets = int(spec_.targets.size()), anchors = int(spec_.anchors.size());
    Twist sum = Twist::Zero();
    for (int row = 0; row < rows_; ++row) {
      const Span span = span_of(sighting, std::size_t(row));
      const double d = span.between.norm();
      const Eigen::Vector3d e = span.between / d;
      const Twist rows = f.twist_rows.row(row).transpose();
      // The row is (e, p × e): f by e, by p in it, by a turn of the tip.
      const Eigen::Vector3d turn_part = rows.tail<3>();
      Eigen::Vector3d by_e = rows.head<3>() + turn_part.cross(span.p), by_turn = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < f.own.size(); ++i) {
        const int index = f.own[i];
        const double slope = f.own_columns(row, Eigen::Index(i));
        if (index < 3 * targets && index / 3 == row % targets) {
          const Eigen::Vector3d along = slope * sighting.X_MeasureTip.linear().col(index % 3);
          by_e += along;
          by_turn += along.cross(e);
        } else if (index >= 3 * targets && index < 3 * (targets + anchors) && index / 3 - targets == row / targets) {
          by_e[index % 3] -= slope;
        }
      }
      const double by_d =
          f.covariance(row, row) * 2 * (spec_.sigma + spec_.sigma_per_m * d) * spec_.sigma_per_m / repeats_;
      const Eigen::Vector3d by_point = e.cross(turn_part) + (by_e - e.dot(by_e) * e) / d + by_d * e;
      sum += change_by_motion(span.p, by_point, by_turn);
    }
    return sum;
  }

  bool sees(const Sighting& sighting) const override {
    for (int row = 0; row < rows_; ++row)
      if (!spans(spec_, span_of(sighting, std::size_t(row)).between.norm())) return false;
    return true;
  }
  std::optional<int> margins() const override { return rows_ * span_margins(spec_); }

  void margins_at(const Sighting& sighting, std::span<double> out) const override {
    if (out.empty()) return;
    for (std::size_t row = 0; row < std::size_t(rows_); ++row)
      span_margins_at(spec_, span_of(sighting, row).between.norm(), out.subspan(2 * row, 2));
  }

  HarmonicNoise harmonic_noise() const override {
    HarmonicNoise noise;
    noise.kind = HarmonicNoise::Kind::distances;
    noise.along = squared(spec_.sigma, spec_.sigma_per_m, repeats_);
    // What a reading is too long by is no multiple of a direction.
    for (std::size_t a = 0; a < spec_.anchors.size(); ++a)
      noise.excluded.push_back(int(3 * (spec_.targets.size() + spec_.anchors.size()) + a));
    return noise;
  }

 private:
  /// From anchor to target, in M.
  struct Span {
    Eigen::Vector3d p, between;
  };

  Span span_of(const Sighting& sighting, std::size_t row) const {
    const std::size_t targets = spec_.targets.size(), t = row % targets, a = row / targets;
    Eigen::Vector3d p_TipTarget = spec_.targets[t].position, anchor = spec_.anchors[a].position;
    if (!sighting.correction.empty()) {
      p_TipTarget += Eigen::Map<const Eigen::Vector3d>(sighting.correction.data() + 3 * t);
      anchor += Eigen::Map<const Eigen::Vector3d>(sighting.correction.data() + 3 * (targets + a));
    }
    Span span;
    span.p = sighting.X_MeasureTip * p_TipTarget;
    span.between = span.p - anchor;
    return span;
  }

  DistanceMeasurement spec_;
  double repeats_;
};

}  // namespace

InstrumentView view_of(const DistanceMeasurement& distance) {
  InstrumentView view;
  view.targets = distance.targets;
  return view;
}

double distance_variance(const DistanceMeasurement& spec, double d, double repeats) {
  const double sigma = spec.sigma + spec.sigma_per_m * d;
  return sigma * sigma / repeats;
}

bool spans(const DistanceMeasurement& spec, double d) {
  if (!(d > shortest)) return false;
  return spec.range_upper <= 0 || (d >= spec.range_lower && d <= spec.range_upper);
}

int span_margins(const DistanceMeasurement& spec) { return spec.range_upper > 0 ? 2 : 0; }

void span_margins_at(const DistanceMeasurement& spec, double d, std::span<double> out) {
  const double range = std::max(spec.range_upper - spec.range_lower, shortest);
  out[0] = (d - spec.range_lower) / range;
  out[1] = (spec.range_upper - d) / range;
}

std::unique_ptr<MeasurementModel> model_of(const DistanceMeasurement& distance, const MeasurementSpec& spec) {
  if (distance.anchors.empty()) return nullptr;
  return std::make_unique<DistanceModel>(spec);
}

}  // namespace posewright
