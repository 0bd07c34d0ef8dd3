#include "posewright/calibration/platform_deformation.hpp"

#include <cmath>

#include "posewright/calibration/rigid_fit.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// The shape moves by less than a nanometre after two or three rounds.
constexpr int alignment_rounds = 50;
constexpr double still = 1e-12;

using Points = std::vector<Eigen::Vector3d>;

/// Poses of the body in every image and the shape that fits all of them.
struct Aligned {
  Points shape;
  std::vector<RigidFit> fits;
};

Aligned align(const Points& nominal, const std::vector<PlatformImage>& images) {
  Aligned result{nominal, {}};
  for (int round = 0; round < alignment_rounds; ++round) {
    result.fits.clear();
    Points mean(nominal.size(), Eigen::Vector3d::Zero());
    for (const PlatformImage& image : images) {
      const RigidFit fit = rigid_fit(result.shape, image.body);
      for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += fit.X.inverse() * image.body[k] / double(images.size());
      result.fits.push_back(fit);
    }
    // The shape may turn as a whole from round to round: it is brought back to where its points are drawn.
    const Eigen::Isometry3d back = rigid_fit(mean, nominal).X;
    double moved = 0;
    for (std::size_t k = 0; k < mean.size(); ++k) {
      mean[k] = back * mean[k];
      moved = std::max(moved, (mean[k] - result.shape[k]).norm());
    }
    result.shape = mean;
    if (moved < still) break;
  }
  for (std::size_t i = 0; i < images.size(); ++i) result.fits[i] = rigid_fit(result.shape, images[i].body);
  return result;
}

struct Line {
  Eigen::VectorXd slope, sigma;
  double left = 0.0;
};

/// y over the columns of x and an intercept.
Line regression(const Eigen::MatrixXd& x, const Eigen::VectorXd& y) {
  Eigen::MatrixXd A(x.rows(), x.cols() + 1);
  A << Eigen::VectorXd::Ones(x.rows()), x;
  const Eigen::VectorXd scale = A.colwise().norm().cwiseInverse();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(Eigen::MatrixXd(A * scale.asDiagonal()));
  if (qr.rank() < A.cols()) throw CannotDo("the actuators of these images do not move independently of each other");
  const Eigen::VectorXd found = scale.cwiseProduct(qr.solve(y));
  const double square = (y - A * found).squaredNorm();
  const Eigen::MatrixXd inverse = qr.solve(Eigen::MatrixXd::Identity(A.rows(), A.rows()));
  Line line;
  line.slope = found.tail(x.cols());
  line.sigma =
      std::sqrt(square / double(A.rows() - A.cols())) * scale.cwiseProduct(inverse.rowwise().norm()).tail(x.cols());
  line.left = std::sqrt(square / double(A.rows()));
  return line;
}

JointDeformation of_joint(const std::vector<PlatformImage>& images, const Aligned& aligned, std::size_t joint,
                          PlatformDeformation& result) {
  const auto n = Eigen::Index(images.size());
  const auto legs = images.front().actuators.size();
  Eigen::MatrixXd place(n, 3), actuators(n, legs);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = std::size_t(i);
    place.row(i) = (aligned.fits[k].X.inverse() * images[k].joints[joint]).transpose();
    actuators.row(i) = images[k].actuators.transpose();
  }
  const Eigen::MatrixXd moved = place.rowwise() - place.colwise().mean();
  for (Eigen::Index i = 0; i < n; ++i)
    result.displacements[std::size_t(i)].col(Eigen::Index(joint)) = moved.row(i).transpose();
  JointDeformation d;
  d.largest = moved.col(2).cwiseAbs().maxCoeff();
  d.spread = (moved.colwise().squaredNorm() / double(n)).cwiseSqrt().transpose();
  const Line own = regression(actuators.col(Eigen::Index(joint)), moved.col(2));
  const Line all = regression(actuators, moved.col(2));
  d.kappa = own.slope[0];
  d.kappa_sigma = own.sigma[0];
  d.left_by_kappa = own.left;
  d.K = all.slope.transpose();
  d.K_sigma = all.sigma.transpose();
  d.left_by_K = all.left;
  return d;
}

}  // namespace

PlatformDeformation platform_deformation(const Points& nominal, const std::vector<PlatformImage>& images,
                                         double noise) {
  const int legs = images.empty() ? 0 : int(images.front().actuators.size());
  if (int(images.size()) < legs + 2)
    throw CannotDo("the platform's deformation needs images of at least " + std::to_string(legs + 2) + " poses");
  const Aligned aligned = align(nominal, images);
  PlatformDeformation result;
  result.images = int(images.size());
  double square = 0;
  for (std::size_t i = 0; i < images.size(); ++i) {
    result.ids.push_back(images[i].id);
    result.actuators.push_back(images[i].actuators);
    result.displacements.emplace_back(3, Eigen::Index(images[i].joints.size()));
    square += aligned.fits[i].rms * aligned.fits[i].rms * double(nominal.size());
  }
  const int points = int(nominal.size()), count = int(images.size());
  // Six of each pose, and of the shape all but the six that say where it stands.
  result.freedom = 3 * points * count - 6 * count - (3 * points - 6);
  result.chi_square = noise > 0 ? square / (noise * noise) : 0.0;
  result.rms = std::sqrt(square / (points * count));
  for (std::size_t joint = 0; joint < images.front().joints.size(); ++joint)
    result.joints.push_back(of_joint(images, aligned, joint, result));
  return result;
}

}  // namespace posewright
