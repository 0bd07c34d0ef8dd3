#include "posewright/calibration/frame_step.hpp"

#include <algorithm>

#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

constexpr std::size_t fewest_on_a_side = 3;
constexpr double least_share = 0.5, most_chance = 0.01;
// Of a column's squared length: what the fitted parameters leave of one that they imitate.
constexpr double imitated_share = 1e-8;

/// Share that the displacement of a frame from some pose on would explain, beside the fitted columns: sums over the
/// poses from the last one backwards.
class Displacement {
 public:
  explicit Displacement(Eigen::Index columns, Eigen::Index fitted)
      : squares_(Eigen::MatrixXd::Zero(columns, columns)),
        imitated_(Eigen::MatrixXd::Zero(fitted, columns)),
        along_(Eigen::VectorXd::Zero(columns)) {}

  /// @param X, Q, r  rows of one pose: the frame's columns, the fitted columns' basis, residuals
  void add(const Eigen::MatrixXd& X, const Eigen::MatrixXd& Q, const Eigen::VectorXd& r) {
    squares_ += X.transpose() * X;
    imitated_ += Q.transpose() * X;
    along_ += X.transpose() * r;
  }

  /// Decrease of the sum of squared residuals.
  /// @param freedom  columns that the fitted ones do not imitate
  double gain(int& freedom) const {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
        Eigen::MatrixXd(squares_ - imitated_.transpose() * imitated_));
    double sum = 0;
    freedom = 0;
    for (Eigen::Index k = 0; k < along_.size(); ++k) {
      if (!(eigen.eigenvalues()[k] > imitated_share * squares_.trace())) continue;
      ++freedom;
      const double along = eigen.eigenvectors().col(k).dot(along_);
      sum += along * along / eigen.eigenvalues()[k];
    }
    return sum;
  }

 private:
  Eigen::MatrixXd squares_, imitated_;
  Eigen::VectorXd along_;
};

/// Replaces the step by the best one of this frame, if that is better.
/// @param X  the frame's columns, of unit length
void search_frame(const std::string& frame, const Eigen::MatrixXd& X, const Eigen::MatrixXd& Q, const FittedRows& rows,
                  const std::vector<MeasuredPose>& poses, FrameStep& best) {
  Displacement behind(X.cols(), Q.cols());
  const double squares = rows.r.squaredNorm();
  for (std::size_t k = poses.size() - 1; k >= fewest_on_a_side; --k) {
    const int first = rows.first[k], count = rows.first[k + 1] - first;
    behind.add(X.middleRows(first, count), Q.middleRows(first, count), rows.r.segment(first, count));
    if (poses.size() - k < fewest_on_a_side) continue;
    int freedom = 0;
    const double gain = behind.gain(freedom);
    const int left = int(X.rows() - Q.cols()) - freedom;
    if (freedom == 0 || left < 1 || !(gain > best.share * squares)) continue;
    const double rest = std::max(squares - gain, 1e-300);
    best = {frame, poses[k - 1].id, poses[k].id, gain / squares,
            fisher_exceeded(gain / freedom / (rest / left), freedom, left)};
  }
}

}  // namespace

std::optional<FrameStep> frame_step(const IdentificationModel& model, const VariantColumns& columns,
                                    const std::vector<MeasuredPose>& poses, const Fit& fit,
                                    const std::vector<EffectToTest>& frames) {
  if (!fit.scale_known || !fit.converged || poses.size() < 2 * fewest_on_a_side) return std::nullopt;
  std::vector<int> selected = columns.selected;
  for (const EffectToTest& frame : frames)
    selected.insert(selected.end(), frame.parameters.begin(), frame.parameters.end());
  FittedRows rows = fitted_rows(model, selected, poses, fit.correction, fit);
  auto next = Eigen::Index(columns.selected.size());
  const ResidualProjector fitted(rows.J.leftCols(next));
  rows.r = fitted.left(rows.r);
  FrameStep best;
  for (const EffectToTest& frame : frames) {
    const auto count = Eigen::Index(frame.parameters.size());
    const Eigen::MatrixXd X = rows.J.middleCols(next, count).colwise().normalized();
    next += count;
    if (count > 0) search_frame(frame.name, X, fitted.basis(), rows, poses, best);
  }
  best.chance = std::min(1.0, best.chance * double(frames.size() * (poses.size() - 2 * fewest_on_a_side + 1)));
  if (!(best.share > least_share && best.chance < most_chance)) return std::nullopt;
  return best;
}

}  // namespace posewright
