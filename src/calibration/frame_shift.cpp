#include "posewright/calibration/frame_shift.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "posewright/calibration/placement.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr std::array<const char*, 6> base_names = {"base.x", "base.y", "base.z", "base.rx", "base.ry", "base.rz"};

/// The base's columns; fewer than six if the model has none.
VariantColumns base_columns(const IdentificationModel& model) {
  VariantColumns columns;
  for (const char* name : base_names)
    for (std::size_t i = 0; i < model.parameters().size(); ++i)
      if (model.parameters()[i].name == name) {
        columns.selected.push_back(int(i));
        columns.parameters.push_back(model.parameters()[i]);
        columns.parameters.back().places = true;
        columns.tiers.push_back(0);
      }
  return columns;
}

std::vector<MeasuredPose> read_completely(const std::vector<MeasuredPose>& poses) {
  std::vector<MeasuredPose> whole;
  std::copy_if(poses.begin(), poses.end(), std::back_inserter(whole),
               [](const MeasuredPose& pose) { return pose.y.allFinite(); });
  return whole;
}

double root_mean_square(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                        const std::vector<double>& correction) {
  Linearisation at;
  Eigen::VectorXd y, off;
  double sum = 0, readings = 0;
  for (const MeasuredPose& pose : poses) {
    if (!model.predict_and_linearise(pose.q, correction, {}, at, y)) continue;
    model.difference(pose.y, y, off);
    const Eigen::LLT<Eigen::MatrixXd> factor(at.covariance);
    factor.matrixL().solveInPlace(off);
    sum += off.squaredNorm();
    readings += double(off.size());
  }
  return readings > 0 ? std::sqrt(sum / readings) : 0.0;
}

/// Rotation of a displacement Trans · Rz · Ry · Rx.
Eigen::Matrix3d rotation_of(const std::vector<double>& correction, const std::vector<int>& base) {
  const auto angle = [&](std::size_t k) { return correction[std::size_t(base[3 + k])]; };
  return (Eigen::AngleAxisd(angle(2), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(angle(1), Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(angle(0), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace

std::optional<FrameShift> frame_shift(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                                      const std::vector<double>& correction) {
  const VariantColumns base = base_columns(model);
  const std::vector<MeasuredPose> whole = read_completely(poses);
  if (base.selected.size() < base_names.size() || whole.size() < 3) return std::nullopt;
  FrameShift shift;
  shift.before = shift.after = root_mean_square(model, whole, correction);
  std::vector<double> best = correction;
  try {
    // From where the fit left it, and from the side that the nominal robot says.
    std::vector<double> aside = correction;
    const std::vector<double> rough = placed(model, base, whole, {});
    for (const int i : base.selected) aside[std::size_t(i)] = rough[std::size_t(i)];
    for (const std::vector<double>& start : {correction, aside}) {
      FitOptions options;
      options.start = start;
      const std::vector<double> found = fit(model, base, whole, options).correction;
      const double rms = root_mean_square(model, whole, found);
      if (!(rms < shift.after)) continue;
      shift.after = rms;
      best = found;
    }
  } catch (const CannotDo&) {
    return std::nullopt;  // these poses do not tell where the base is
  }
  Eigen::Vector3d moved;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = std::size_t(base.selected[k]);
    moved[Eigen::Index(k)] = best[i] - correction[i];
  }
  shift.moved = moved.norm();
  shift.turned =
      Eigen::AngleAxisd(rotation_of(best, base.selected) * rotation_of(correction, base.selected).transpose()).angle();
  return shift;
}

}  // namespace posewright
