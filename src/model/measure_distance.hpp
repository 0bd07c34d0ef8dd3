#pragma once

#include "posewright/model/instrument_view.hpp"
#include "posewright/model/measurement_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

InstrumentView view_of(const DistanceMeasurement& distance);

/// Variance of one distance reading d: (sigma + sigma_per_m d)²/repeats.
double distance_variance(const DistanceMeasurement& spec, double d, double repeats);
/// True if the instrument can span d; distances under a micrometre have no direction.
bool spans(const DistanceMeasurement& spec, double d);

/// Margins of one distance's range: their number, and values (IdentificationModel::measurable_margins()).
int span_margins(const DistanceMeasurement& spec);
void span_margins_at(const DistanceMeasurement& spec, double d, std::span<double> out);

/// Distances from fixed anchors to targets on the tip: ball bar, cable sensor. Rows: anchor by anchor, target by
/// target, d = ‖p − c‖ + length. Own parameters: target.NAME.{x,y,z} (tip frame), anchor.NAME.{x,y,z} (measurement
/// frame), anchor.NAME.length (m, what the reading is too long by).
class DistanceModel : public MeasurementModel {
 public:
  explicit DistanceModel(const MeasurementSpec& spec);

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override;
  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override;
  void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const override;
  void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const override;
  Twist pull_back(const Sighting& sighting, const Adjoint& f) const override;
  bool sees(const Sighting& sighting) const override;
  std::optional<int> margins() const override { return rows_ * span_margins(spec_); }
  void margins_at(const Sighting& sighting, std::span<double> out) const override;
  HarmonicNoise harmonic_noise() const override;

 private:
  /// From anchor to target, in M.
  struct Span {
    Eigen::Vector3d p, between;
  };
  Span span_of(const Sighting& sighting, std::size_t row) const;

  DistanceMeasurement spec_;
  double repeats_;
};

}  // namespace posewright
