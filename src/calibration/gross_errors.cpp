#include "posewright/calibration/gross_errors.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <variant>

#include "posewright/calibration/placing_columns.hpp"
#include "posewright/model/board_pose.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "robust_weights.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

constexpr double beyond_median = 5.0, fitting = 3.0;
constexpr std::size_t least_poses = 5;
constexpr int most_trims = 5;

/// Root mean square of the whitened residuals of each pose.
std::vector<double> sizes_of(const IdentificationModel& model, const std::vector<double>& correction,
                             const std::vector<MeasuredPose>& poses) {
  StackedReadings stacked(model, VariantColumns{}, poses, Prior::none, correction);
  const Eigen::VectorXd none(0);
  stacked.weigh(none, Weighting::weighted);
  std::vector<Eigen::VectorXd> raw, whitened;
  stacked.spread(none, raw, whitened);
  std::vector<double> sizes;
  for (const Eigen::VectorXd& r : whitened) {
    double squares = 0, count = 0;
    for (const double value : r)
      if (std::isfinite(value)) {
        squares += value * value;
        ++count;
      }
    sizes.push_back(std::sqrt(squares / std::max(count, 1.0)));
  }
  return sizes;
}

/// Corrections of the board at one pose that put it where its picture shows it, all others nominal; those of all poses
/// if there is no board in the picture.
std::vector<double> as_pictured(const CameraMeasurement& camera, const IdentificationModel& model,
                                const MeasuredPose& pose, const std::vector<double>& correction) {
  const std::optional<Eigen::Isometry3d> seen = board_pose(camera, pose.y);
  if (!seen) return correction;
  const Eigen::Isometry3d tip = model.tool_pose(pose.q);
  const Eigen::Isometry3d carrier = camera.on_hand ? tip : tip.inverse();
  const Eigen::Isometry3d moved = isometry(camera.board).inverse() * carrier * isometry(camera.camera) * *seen;
  const Eigen::Vector3d zyx = moved.linear().eulerAngles(2, 1, 0);
  const std::map<std::string, double> board = {{"board.x", moved.translation().x()},
                                               {"board.y", moved.translation().y()},
                                               {"board.z", moved.translation().z()},
                                               {"board.rx", zyx[2]},
                                               {"board.ry", zyx[1]},
                                               {"board.rz", zyx[0]}};
  std::vector<double> there(model.parameters().size(), 0.0);
  for (std::size_t i = 0; i < there.size(); ++i)
    if (const auto at = board.find(model.parameters()[i].name); at != board.end()) there[i] = at->second;
  return there;
}

/// One pose below the other, each at its own corrections, or all at the only ones.
Eigen::MatrixXd rows_at(const IdentificationModel& model, const VariantColumns& columns,
                        const std::vector<MeasuredPose>& poses, const std::vector<std::vector<double>>& corrections) {
  if (corrections.size() == 1) return blocks_of(model, columns, poses, corrections.front()).all();
  Eigen::MatrixXd rows;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Eigen::MatrixXd block = blocks_of(model, columns, {poses[k]}, corrections[k]).all();
    if (k == 0) rows.resize(block.rows() * Eigen::Index(poses.size()), block.cols());
    rows.middleRows(Eigen::Index(k) * block.rows(), block.rows()) = block;
  }
  return rows;
}

/// Whitened readings, one pose below the other, by every tolerance of the robot and the instrument.
Eigen::MatrixXd tolerance_rows(const IdentificationModel& model, const VariantColumns& columns,
                               const std::vector<MeasuredPose>& poses,
                               const std::vector<std::vector<double>>& corrections) {
  VariantColumns all;
  for (int i = 0; i < int(model.parameters().size()); ++i) {
    const auto at = std::ranges::find(columns.selected, i);
    const Parameter& p = at == columns.selected.end() ? model.parameters()[std::size_t(i)]
                                                      : columns.parameters[std::size_t(at - columns.selected.begin())];
    if (!counts(p, Prior::manufactured)) continue;
    all.selected.push_back(i);
    all.parameters.push_back(p);
  }
  return rows_at(model, all, poses, corrections) * tolerances_of(all).asDiagonal();
}

/// Part of them that is left where base, tool and targets are fitted: those take up most of a lens's centre, a first
/// joint's zero, a last joint's frame.
Eigen::MatrixXd beside_placing(const IdentificationModel& model, const VariantColumns& columns,
                               const std::vector<MeasuredPose>& poses,
                               const std::vector<std::vector<double>>& corrections, const Eigen::MatrixXd& rows) {
  const VariantColumns place = placing_columns(columns);
  if (place.selected.empty() || Eigen::Index(place.selected.size()) >= rows.rows()) return rows;
  return ResidualProjector(rows_at(model, place, poses, corrections)).left(rows);
}

/// Root mean square of the readings of each pose, with the noise.
std::vector<double> sizes_of_rows(const Eigen::MatrixXd& rows, const std::vector<MeasuredPose>& poses) {
  const Eigen::Index each = rows.rows() / Eigen::Index(poses.size());
  std::vector<double> sizes;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double count = std::max(1.0, double(poses[k].y.array().isFinite().count()));
    sizes.push_back(std::sqrt(1.0 + rows.middleRows(Eigen::Index(k) * each, each).squaredNorm() / count));
  }
  return sizes;
}

/// Root mean square over all readings, of that of each pose.
double rms_of_all(const std::vector<double>& sizes, const std::vector<MeasuredPose>& poses) {
  double squares = 0, count = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const auto read = double(poses[k].y.array().isFinite().count());
    squares += read * sizes[k] * sizes[k];
    count += read;
  }
  return std::sqrt(squares / count);
}

/// Once the poses are sorted into kept and left out.
class Trimming {
 public:
  Trimming(const IdentificationModel& model, const VariantColumns& columns, const std::vector<MeasuredPose>& poses,
           const FitOptions& options)
      : model_(model),
        place_(placing_columns(columns)),
        poses_(poses),
        options_(options),
        explained_(explained_sizes(model, columns, poses, options.start)),
        out_(poses.size(), 0) {}

  std::vector<GrossPose> gross() {
    for (int round = 0; round < most_trims; ++round) {
      const std::vector<double> sizes = sizes_of(model_, options_.start, poses_);
      if (!trim(sizes)) return others_fit(sizes) ? listed(sizes) : std::vector<GrossPose>{};
      if (count() * 4 >= poses_.size()) return {};
      place();
    }
    return {};
  }

 private:
  std::size_t count() const { return std::size_t(std::count(out_.begin(), out_.end(), 1)); }

  /// Leaves out what is far off; false if nothing changes.
  bool trim(const std::vector<double>& sizes) {
    const double middle = median(sizes);
    const std::vector<char> before = out_;
    for (std::size_t k = 0; k < poses_.size(); ++k)
      out_[k] = ResidualSize{sizes[k], explained_[k]}.beyond_robots() && sizes[k] > beyond_median * middle ? 1 : 0;
    return out_ != before;
  }

  void place() {
    std::vector<MeasuredPose> rest;
    for (std::size_t k = 0; k < poses_.size(); ++k)
      if (out_[k] == 0) rest.push_back(poses_[k]);
    const VariantColumns place = determined(model_, place_, rest, options_.start, options_.prior);
    if (!place.selected.empty()) options_.start = fit(model_, place, rest, options_).correction;
  }

  bool others_fit(const std::vector<double>& sizes) const {
    double squares = 0, explained = 0;
    for (std::size_t k = 0; k < poses_.size(); ++k)
      if (out_[k] == 0) {
        squares += sizes[k] * sizes[k];
        explained += explained_[k] * explained_[k];
      }
    return squares < fitting * fitting * explained;
  }

  std::vector<GrossPose> listed(const std::vector<double>& sizes) const {
    std::vector<GrossPose> gross;
    for (std::size_t k = 0; k < poses_.size(); ++k)
      if (out_[k] != 0) gross.push_back({poses_[k].id, sizes[k], explained_[k]});
    std::ranges::sort(gross, [](const GrossPose& a, const GrossPose& b) { return a.size > b.size; });
    return gross;
  }

  const IdentificationModel& model_;
  const VariantColumns place_;
  const std::vector<MeasuredPose>& poses_;
  FitOptions options_;
  std::vector<double> explained_;
  std::vector<char> out_;
};

}  // namespace

std::vector<double> explained_sizes(const IdentificationModel& model, const VariantColumns& columns,
                                    const std::vector<MeasuredPose>& poses, const std::vector<double>& correction) {
  return sizes_of_rows(tolerance_rows(model, columns, poses, {correction}), poses);
}

double residual_rms(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                    const std::vector<double>& correction) {
  return rms_of_all(sizes_of(model, correction, poses), poses);
}

double explained_rms(const MeasurementSpec& measurement, const IdentificationModel& model,
                     const VariantColumns& columns, const std::vector<MeasuredPose>& poses,
                     const std::vector<double>& correction) {
  std::vector<std::vector<double>> corrections;
  if (const auto* camera = std::get_if<CameraMeasurement>(&measurement.instrument)) {
    for (const MeasuredPose& pose : poses) corrections.push_back(as_pictured(*camera, model, pose, correction));
  } else {
    corrections.push_back(correction);
  }
  const Eigen::MatrixXd rows = tolerance_rows(model, columns, poses, corrections);
  return rms_of_all(sizes_of_rows(beside_placing(model, columns, poses, corrections, rows), poses), poses);
}

std::vector<GrossPose> gross_poses(const IdentificationModel& model, const VariantColumns& columns,
                                   const std::vector<MeasuredPose>& poses, const FitOptions& options) {
  if (poses.size() < least_poses) return {};
  try {
    return Trimming(model, columns, poses, options).gross();
  } catch (const CannotDo&) {
    return {};  // out of reach, or too little is read without them: the fit says so
  }
}

}  // namespace posewright
