#include "restricted_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/support/dense.hpp"
#include "posewright/support/distributions.hpp"

namespace posewright {
namespace {

constexpr double student_freedom = 4.0;
// Variance of a normal over the squared scale of the Student's t that is fitted to it.
constexpr double normal_of_student = 1.45;
constexpr double decade = 2.302585092994046;
constexpr double beyond_chance = 0.01;
constexpr int most_steps = 60, most_selections = 4;
constexpr double longest_scoring_step = 2.0, settled_components_step = 1e-4;
// Of a column of which nothing is known: of the information of the weakest that counts.
constexpr double nothing_known = 1e-14;

/// R and Qᵀy of J = Q R.
struct Reduced {
  Eigen::MatrixXd R;
  Eigen::VectorXd c;
};

Reduced reduced(const ComponentProblem& problem) {
  const Eigen::Index m = problem.J.cols(), rows = std::min(problem.J.rows(), m);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(problem.J);
  const Eigen::VectorXd all = qr.householderQ().transpose() * problem.y;
  return {Eigen::MatrixXd(qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>()), all.head(rows)};
}

/// The posterior with given variances.
struct Posterior {
  Eigen::VectorXd x;
  Eigen::MatrixXd C;
  double minus_two_log = 0.0;  ///< without Σ ln p_j and what does not change
};

class ComponentSearch {
 public:
  explicit ComponentSearch(const ComponentProblem& problem) : problem_(problem), small_(reduced(problem)) {
    const auto m = Eigen::Index(problem.group.size());
    own_ = Eigen::VectorXd::Zero(m);
    mixed_ = Eigen::VectorXd::Ones(m);
    for (const int k : problem.group) groups_ = std::max(groups_, k + 1);
    theta_ = Eigen::VectorXd::Zero(groups_);
  }

  VarianceComponents found() {
    VarianceComponents result;
    for (int selection = 0; selection < most_selections; ++selection) {
      maximise();
      if (!select_own()) break;
    }
    // What is far off has its own now: the others count as normal.
    mixed_.setOnes();
    mixes_ = false;
    maximise();
    result.spread = variances().cwiseSqrt();
    for (Eigen::Index j = 0; j < own_.size(); ++j) {
      if (problem_.group[std::size_t(j)] < 0) result.spread[j] = 1.0;
      if (own_[j] > 0) result.own.push_back(int(j));
    }
    result.contradicted = contradicted();
    return result;
  }

 private:
  bool in_group(Eigen::Index j) const { return problem_.group[std::size_t(j)] >= 0; }

  /// p_j; infinite where nothing is known.
  Eigen::VectorXd variances() const {
    Eigen::VectorXd p(own_.size());
    for (Eigen::Index j = 0; j < p.size(); ++j)
      p[j] = own_[j] > 0   ? own_[j]
             : in_group(j) ? std::exp(theta_[problem_.group[std::size_t(j)]]) * mixed_[j]
                           : 1 / std::max(problem_.precision[j], 0.0);
    return p;
  }

  Posterior posterior(const Eigen::VectorXd& p) const {
    const Eigen::Index m = p.size(), rows = small_.R.rows();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows + m, m);
    A.topRows(rows) = small_.R;
    Eigen::VectorXd z(rows + m);
    z.head(rows) = small_.c;
    for (Eigen::Index j = 0; j < m; ++j) {
      const double weight = std::isfinite(p[j]) ? 1 / std::sqrt(p[j]) : nothing_known;
      A(rows + j, j) = weight;
      z[rows + j] = in_group(j) ? 0.0 : weight * problem_.about[j];
    }
    const Eigen::VectorXd length = A.colwise().norm();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(A * length.cwiseInverse().asDiagonal());
    const Eigen::VectorXd c = qr.householderQ().transpose() * z;
    Eigen::MatrixXd half = Eigen::MatrixXd::Identity(m, m);
    qr.matrixQR().topRows(m).triangularView<Eigen::Upper>().solveInPlace(half);
    half = length.cwiseInverse().asDiagonal() * half;
    Posterior result{half * c.head(m), half * half.transpose(), c.tail(rows).squaredNorm()};
    result.minus_two_log += 2 * (qr.matrixQR().diagonal().cwiseAbs().array().log() + length.array().log()).sum();
    return result;
  }

  double minus_two_log(const Posterior& at, const Eigen::VectorXd& p) const {
    double sum = at.minus_two_log + (theta_.array() / (2 * decade)).square().sum();
    for (Eigen::Index j = 0; j < p.size(); ++j)
      if (in_group(j) && own_[j] == 0) sum += std::log(p[j]);
    return sum;
  }

  /// θ and the scales of the mixture in turn.
  void maximise() {
    for (int step = 0; step < most_steps; ++step) {
      if (mixes_) mix(posterior(variances()));
      const double change = score_step();
      if (change < settled_components_step) return;
    }
  }

  void mix(const Posterior& at) {
    for (Eigen::Index j = 0; j < own_.size(); ++j) {
      if (!in_group(j) || own_[j] > 0) continue;
      const double size = (at.x[j] * at.x[j] + at.C(j, j)) / std::exp(theta_[problem_.group[std::size_t(j)]]);
      mixed_[j] = (student_freedom + size) / (student_freedom + 1);
    }
  }

  /// One step of Fisher scoring, halved until it gains; the largest change.
  double score_step() {
    if (groups_ == 0) return 0.0;
    const Eigen::VectorXd p = variances();
    const Posterior at = posterior(p);
    const double before = minus_two_log(at, p);
    Eigen::VectorXd slope = theta_ / (2 * decade * decade);
    Eigen::MatrixXd information = Eigen::MatrixXd::Identity(groups_, groups_) / (2 * decade * decade);
    for (Eigen::Index i = 0; i < p.size(); ++i) {
      if (!in_group(i) || own_[i] > 0) continue;
      const int k = problem_.group[std::size_t(i)];
      slope[k] += 1 - (at.x[i] * at.x[i] + at.C(i, i)) / p[i];
      for (Eigen::Index j = 0; j < p.size(); ++j) {
        if (!in_group(j) || own_[j] > 0) continue;
        const double told = (i == j ? 1.0 : 0.0) - at.C(i, j) / std::sqrt(p[i] * p[j]);
        information(k, problem_.group[std::size_t(j)]) += told * told;
      }
    }
    Eigen::VectorXd step = -information.ldlt().solve(slope);
    step *= std::min(1.0, longest_scoring_step / std::max(step.cwiseAbs().maxCoeff(), 1e-300));
    const Eigen::VectorXd from = theta_;
    for (int halving = 0; halving < 6; ++halving, step /= 2) {
      theta_ = (from + step).cwiseMax(0.0);
      const Eigen::VectorXd there = variances();
      if (minus_two_log(posterior(there), there) <= before) return (theta_ - from).cwiseAbs().maxCoeff();
    }
    theta_ = from;
    return 0.0;
  }

  /// x̂² and v of column j where nothing is known of it; false if only that knowledge tells it.
  static bool told_alone(const Posterior& at, const Eigen::VectorXd& p, Eigen::Index j, double about, double& square,
                         double& variance) {
    const double share = 1 - at.C(j, j) / p[j];
    if (!(share > 1e-9)) return false;
    variance = at.C(j, j) / share;
    square = std::pow((at.x[j] - about) / share, 2);
    return true;
  }

  /// Gives columns that are beyond their group a component of their own; true if there are new ones.
  bool select_own() {
    const Eigen::VectorXd p = variances();
    const Posterior at = posterior(p);
    const auto tested =
        double(std::count_if(problem_.group.begin(), problem_.group.end(), [](int k) { return k >= 0; }));
    bool more = false;
    for (Eigen::Index j = 0; j < p.size(); ++j) {
      double square = 0, variance = 0;
      if (!in_group(j) || !told_alone(at, p, j, 0.0, square, variance)) continue;
      const double group = normal_of_student * std::exp(theta_[problem_.group[std::size_t(j)]]);
      const bool beyond = chi_square_exceeded(square / (variance + group), 1) * tested < beyond_chance;
      more = more || (beyond && own_[j] == 0);
      own_[j] = beyond ? std::max(square - variance, group) : 0.0;
    }
    return more;
  }

  std::vector<int> contradicted() const {
    const Eigen::VectorXd p = variances();
    const Posterior at = posterior(p);
    std::vector<int> columns;
    for (Eigen::Index j = 0; j < p.size(); ++j) {
      double square = 0, variance = 0;
      if (in_group(j) || !std::isfinite(p[j]) || !told_alone(at, p, j, problem_.about[j], square, variance)) continue;
      if (chi_square_exceeded(square / (variance + p[j]), 1) * double(p.size()) < beyond_chance)
        columns.push_back(int(j));
    }
    return columns;
  }

  const ComponentProblem& problem_;
  const Reduced small_;
  int groups_ = 0;
  bool mixes_ = true;
  Eigen::VectorXd theta_, own_, mixed_;
};

}  // namespace

VarianceComponents restricted_components(const ComponentProblem& problem) { return ComponentSearch(problem).found(); }

}  // namespace posewright
