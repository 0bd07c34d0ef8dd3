#include "enclosed_sensitivity.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "posewright/model/explicit_model.hpp"
#include "posewright/proof/bounded_space.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

using Matrix = TipModel::EnclosedResidual::Matrix;
using Values = TaylorModel::Values;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double up = 1 + 1e-12;

/// One row of F_ξ times T, of few entries that are not zero: v · Q, Q with as many orthonormal rows, up to `away` as
/// the norm of a vector. So the large entries of T, whose products nearly cancel, meet the polynomials once.
struct ReducedRow {
  std::vector<TaylorModel> v;
  Eigen::MatrixXd Q;
  Values away{}, size{};  ///< size: no ‖v‖ exceeds it

  ReducedRow(const Matrix& F, Eigen::Index row, const Eigen::MatrixXd& T) {
    std::vector<Eigen::Index> used;
    for (Eigen::Index c = 0; c < F.cols(); ++c)
      if (!F(row, c).is_zero()) used.push_back(c);
    const auto n = Eigen::Index(used.size()), k = T.cols(), rank = std::min(n, k);
    Eigen::MatrixXd own(n, k);
    for (Eigen::Index i = 0; i < n; ++i) own.row(i) = T.row(used[std::size_t(i)]);
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(own.transpose());
    Q = (qr.householderQ() * Eigen::MatrixXd::Identity(k, rank)).transpose();
    const Eigen::MatrixXd L = Eigen::MatrixXd(qr.matrixQR().topRows(rank).triangularView<Eigen::Upper>()).transpose();
    // What the rounded factors leave of T, and what computing that rounds.
    const Eigen::MatrixXd rest =
        (own - L * Q).cwiseAbs() + 2 * double(rank + 2) * epsilon * (own.cwiseAbs() + L.cwiseAbs() * Q.cwiseAbs());
    for (Eigen::Index j = 0; j < rank; ++j) {
      TaylorModel sum;
      for (Eigen::Index i = j; i < n; ++i) sum.add(L(i, j), F(row, used[std::size_t(i)]));
      v.push_back(std::move(sum));
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      const Values farthest = F(row, used[std::size_t(i)]).farthest();
      const double left = rest.row(i).norm() * up;
      for (std::size_t box = 0; box < away.size(); ++box) away[box] += farthest[box] * left;
    }
    for (const TaylorModel& f : v) {
      const Values farthest = f.farthest();
      for (std::size_t box = 0; box < size.size(); ++box) size[box] += farthest[box] * up;
    }
  }
};

/// (a · Q_a) · (b · Q_b).
TaylorModel product(const ReducedRow& a, const ReducedRow& b) {
  const Eigen::MatrixXd C = a.Q * b.Q.transpose();
  TaylorModel sum;
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    TaylorModel other;
    for (Eigen::Index j = 0; j < C.cols(); ++j) other.add(C(i, j), b.v[std::size_t(j)]);
    sum += a.v[std::size_t(i)] * other;
  }
  // Rows of Q have norm 1 to a few roundings; C is a sum of as many products as Q has columns.
  const double rounding = 2 * double(a.Q.cols() + 2) * epsilon;
  Values by;
  for (std::size_t k = 0; k < by.size(); ++k)
    by[k] =
        (rounding * a.size[k] * b.size[k] + 1.01 * (a.away[k] * (b.size[k] + b.away[k]) + b.away[k] * a.size[k])) * up;
  return sum.widened(by);
}

/// F_X Σ_X F_Xᵀ + F_ρ Σ_ρ F_ρᵀ, lower triangle.
Matrix residual_covariance(const TipModel::EnclosedResidual& residual, const Eigen::Matrix<double, 6, 6>& covariance,
                           const std::vector<double>& noise) {
  const Eigen::Index n = residual.platform.rows();
  Matrix result(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    std::vector<TaylorModel> weighted(6);
    for (Eigen::Index k = 0; k < 6; ++k)
      for (Eigen::Index l = 0; l < 6; ++l)
        if (covariance(k, l) != 0) weighted[std::size_t(k)].add(covariance(k, l), residual.platform(i, l));
    for (Eigen::Index j = 0; j <= i; ++j) {
      TaylorModel sum;
      for (Eigen::Index k = 0; k < 6; ++k) sum += weighted[std::size_t(k)] * residual.platform(j, k);
      for (std::size_t a = 0; a < noise.size(); ++a) {
        const TaylorModel &left = residual.actuator(i, Eigen::Index(a)), &right = residual.actuator(j, Eigen::Index(a));
        // Each loop knows its own actuator alone.
        if (noise[a] == 0 || left.is_zero() || right.is_zero()) continue;
        sum.add(noise[a] * noise[a], left * right);
      }
      result(i, j) = std::move(sum);
    }
  }
  return result;
}

/// Inverse of the unit lower triangle and of the diagonal in S = L D Lᵀ.
struct InverseFactors {
  Matrix L;
  std::vector<TaylorModel> D;

  explicit InverseFactors(const Matrix& S) : L(S.rows(), S.cols()) {
    const Eigen::Index n = S.rows();
    Matrix factor(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      std::vector<TaylorModel> row;
      TaylorModel pivot = S(j, j);
      for (Eigen::Index k = 0; k < j; ++k) {
        TaylorModel entry = S(j, k);
        for (Eigen::Index m = 0; m < k; ++m) entry -= row[std::size_t(m)] * factor(k, m);
        factor(j, k) = entry * D[std::size_t(k)];
        pivot -= entry * factor(j, k);
        row.push_back(std::move(entry));
      }
      D.push_back(inverse(pivot));
    }
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index i = j + 1; i < n; ++i) {
        TaylorModel sum = -factor(i, j);
        for (Eigen::Index k = j + 1; k < i; ++k) sum -= factor(i, k) * L(k, j);
        L(i, j) = std::move(sum);
      }
  }
};

}  // namespace

TaylorModel enclosed_sensitivity(const TipModel::EnclosedResidual& residual,
                                 const Eigen::Matrix<double, 6, 6>& covariance, const std::vector<double>& noise,
                                 const Eigen::MatrixXd& T) {
  const Eigen::Index n = residual.parameter.rows();
  std::vector<ReducedRow> rows;
  for (Eigen::Index i = 0; i < n; ++i) rows.emplace_back(residual.parameter, i, T);
  Matrix A(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) A(i, j) = product(rows[std::size_t(i)], rows[std::size_t(j)]);
  const InverseFactors inverse(residual_covariance(residual, covariance, noise));
  // Σ_k D_k⁻¹ (L⁻¹ A L⁻ᵀ)_kk.
  TaylorModel d;
  for (Eigen::Index k = 0; k < n; ++k) {
    TaylorModel diagonal = A(k, k);
    for (Eigen::Index i = 0; i < k; ++i) {
      TaylorModel sum;
      sum.add(2, A(k, i));
      sum += inverse.L(k, i) * A(i, i);
      for (Eigen::Index j = 0; j < i; ++j) sum.add(2, inverse.L(k, j) * A(i, j));
      diagonal += inverse.L(k, i) * sum;
    }
    d += diagonal * inverse.D[std::size_t(k)];
  }
  return d;
}

// By theory.md eq. (7): where the instrument sees the whole pose, the residual of a closed chain holds all that its
// readings tell of parameters that move the tip.
bool enclose(const IdentificationModel& model, std::span<const TaylorModel> q, std::span<const int> selected,
             const Eigen::MatrixXd* T, EnclosedModel& out) {
  const auto* robot = dynamic_cast<const ExplicitModel*>(&model);
  if (robot == nullptr || !model.sees_all_targets()) return false;
  const std::span<const double> correction = model.nominal_shift();
  const auto in_use = std::size_t(robot->tip_parameters());
  const auto of_tip = correction.first(std::min(correction.size(), in_use));
  const auto of_instrument = correction.subspan(of_tip.size());
  const Repeatability& repeatability = robot->repeatability();
  const auto is_other = [&](int i) { return i >= robot->tip_parameters(); };
  if (repeatability.independent > 0 || std::any_of(selected.begin(), selected.end(), is_other) ||
      std::any_of(of_instrument.begin(), of_instrument.end(), [](double x) { return x != 0; }))
    return false;
  std::optional<Eigen::Matrix<double, 6, 6>> covariance = robot->measurement().tip_covariance();
  if (!covariance) return false;
  // A visit displaces the tip alike in all directions.
  covariance->diagonal().head<3>().array() += repeatability.translation * repeatability.translation;
  covariance->diagonal().tail<3>().array() += repeatability.rotation * repeatability.rotation;
  TipModel::EnclosedResidual residual;
  if (!robot->tip().enclose_residual(q.first(robot->tip().coordinates().size()), of_tip,
                                     T != nullptr ? selected : selected.first(0), residual))
    return false;
  if (T != nullptr) out.sensitivity = enclosed_sensitivity(residual, *covariance, robot->tip().reading_noise(), *T);
  out.allowed = std::move(residual.allowed);
  return true;
}

namespace {

class ModelEnclosure : public BoundedSpace::Enclosure {
 public:
  ModelEnclosure(const SpacePart& part, Eigen::MatrixXd T) : part_(part), T_(std::move(T)) {}

  bool allowed(std::span<const TaylorModel> q, std::vector<TaylorModel>& limits) override {
    if (!enclose(*part_.model, q, part_.selected, nullptr, out_)) return false;
    limits = std::move(out_.allowed);
    return true;
  }
  bool sensitivity(std::span<const TaylorModel> q, TaylorModel& d) override {
    if (!enclose(*part_.model, q, part_.selected, &T_, out_)) return false;
    d = std::move(out_.sensitivity);
    return true;
  }

 private:
  const SpacePart& part_;
  Eigen::MatrixXd T_;  // of raw columns
  EnclosedModel out_;
};

}  // namespace

std::unique_ptr<BoundedSpace::Enclosure> enclosure_of(const std::vector<SpacePart>& parts, const Eigen::MatrixXd& R,
                                                      const Eigen::MatrixXd& T) {
  const SpacePart& part = parts.front();
  if (parts.size() > 1 || part.features != nullptr || part.mix.size() > 0) return nullptr;
  std::vector<TaylorModel> middle;
  for (const Coordinate& c : part.workspace->proposed()) {
    if (c.discrete() && c.values.size() > 1) return nullptr;
    middle.emplace_back(0.5 * (c.lower + c.upper));
  }
  // Blocks of the task are J R⁻¹.
  auto result = std::make_unique<ModelEnclosure>(part, R.triangularView<Eigen::Upper>().solve(T));
  std::vector<TaylorModel> limits;
  if (!result->allowed(middle, limits)) return nullptr;
  return result;
}

}  // namespace posewright
