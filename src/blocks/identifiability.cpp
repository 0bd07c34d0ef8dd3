#include "posewright/blocks/identifiability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

// Of two columns whose remaining norms differ by less than this share, the first in order is kept: rounding must not
// decide.
constexpr double tie = 1e-6;
// A column this much shorter than the longest (both in units of tolerance) is the rounding of zeros.
constexpr double no_effect = 1e-12;
// A row counts as new when this share of the longest row of all is outside the others' span.
constexpr double new_row = 1e-10;
// Terms whose effect is below this share of the dropped column's effect are rounding, not physics.
constexpr double negligible_term = 1e-3;

/// Triangular factor of the rows in units of tolerance: m × m and cheap to work on, same Gram matrix as G.
Eigen::MatrixXd compressed(const BlockArray& sample, const std::vector<Parameter>& parameters) {
  const int m = sample.columns();
  Eigen::VectorXd tolerance(m);
  for (int j = 0; j < m; ++j) tolerance[j] = parameters[std::size_t(j)].tolerance;
  Eigen::MatrixXd rows = sample.all();
  rows *= tolerance.asDiagonal();
  if (rows.rows() <= m) return rows;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(std::move(rows));
  return qr.matrixQR().topRows(m).triangularView<Eigen::Upper>();
}

/// Column pivoting by tiers; Gram–Schmidt with one reorthogonalisation.
class Elimination {
 public:
  Elimination(const Eigen::MatrixXd& g, const IdentifiabilityOptions& options)
      : remaining_(g),
        norms_(g.colwise().norm()),
        floor_(no_effect * norms_.maxCoeff()),
        options_(options),
        kept_(std::size_t(g.cols()), false) {}

  std::vector<int> run() {
    std::vector<int> order;
    for (int j = next(); j >= 0; j = next()) {
      kept_[std::size_t(j)] = true;
      order.push_back(j);
      Eigen::VectorXd q = remaining_.col(j).normalized();
      for (const Eigen::VectorXd& p : basis_) q -= p * p.dot(q);
      q.normalize();
      basis_.push_back(q);
      for (Eigen::Index k = 0; k < remaining_.cols(); ++k)
        if (!kept_[std::size_t(k)]) remaining_.col(k) -= q * q.dot(remaining_.col(k));
    }
    return order;
  }

 private:
  int tier(Eigen::Index j) const { return options_.tiers.empty() ? 0 : options_.tiers[std::size_t(j)]; }

  int next() const {
    int best = -1;
    for (int j = 0; j < int(remaining_.cols()); ++j) {
      const double rest = remaining_.col(j).norm();
      if (kept_[std::size_t(j)] || !(rest > options_.threshold * norms_[j]) || norms_[j] <= floor_) continue;
      if (best < 0 || tier(j) < tier(best) || (tier(j) == tier(best) && rest > (1 + tie) * remaining_.col(best).norm()))
        best = j;
    }
    return best;
  }

  Eigen::MatrixXd remaining_;
  Eigen::VectorXd norms_;
  double floor_;
  const IdentifiabilityOptions& options_;
  std::vector<bool> kept_;
  std::vector<Eigen::VectorXd> basis_;
};

Dependency explain(const Eigen::MatrixXd& g, const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr,
                   const std::vector<int>& kept, int dropped, const std::vector<Parameter>& parameters) {
  Dependency dependency;
  dependency.dropped = dropped;
  const Eigen::VectorXd column = g.col(dropped);
  const double norm = column.norm();
  if (norm <= no_effect * g.colwise().norm().maxCoeff() || kept.empty()) return dependency;
  const Eigen::VectorXd solution = qr.solve(column);
  Eigen::VectorXd rest = column;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const auto k = Eigen::Index(i);
    rest -= solution[k] * g.col(kept[i]);
    if (std::abs(solution[k]) * g.col(kept[i]).norm() < negligible_term * norm) continue;
    const double units = parameters[std::size_t(kept[i])].tolerance / parameters[std::size_t(dropped)].tolerance;
    dependency.terms.push_back({kept[i], solution[k] * units});
  }
  dependency.remainder = rest.norm() / norm;
  return dependency;
}

/// "m/rad", "m" for m by 1, "1/m".
std::string quotient(const std::string& unit, const std::string& by) {
  const std::string denominator = by.find("·") == std::string::npos ? by : "(" + by + ")";
  return by == "1" ? unit : unit + "/" + denominator;
}

}  // namespace

Identifiability identifiability(const BlockArray& sample, const std::vector<Parameter>& parameters,
                                const IdentifiabilityOptions& options) {
  const Eigen::MatrixXd g = compressed(sample, parameters);
  Identifiability result;
  result.singular_values = Eigen::JacobiSVD<Eigen::MatrixXd>(g).singularValues();
  result.kept = Elimination(g, options).run();
  std::sort(result.kept.begin(), result.kept.end());
  result.rank = int(result.kept.size());
  Eigen::MatrixXd basis(g.rows(), result.rank);
  for (int i = 0; i < result.rank; ++i) basis.col(i) = g.col(result.kept[std::size_t(i)]);
  // Nothing is seen of anything: there is no basis to explain the columns by.
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(result.rank > 0 ? basis : Eigen::MatrixXd::Zero(g.rows(), 1));
  for (int j = 0; j < int(g.cols()); ++j)
    if (!std::binary_search(result.kept.begin(), result.kept.end(), j))
      result.dependencies.push_back(explain(g, qr, result.kept, j, parameters));
  return result;
}

std::vector<int> most_independent(const BlockArray& sample, const std::vector<Parameter>& parameters) {
  const int m = sample.columns(), n = int(sample.count());
  std::vector<Eigen::MatrixXd> rest;  // of every block what is outside the rows chosen so far
  std::vector<double> length;
  double longest = 0;
  for (int i = 0; i < n; ++i) {
    Eigen::MatrixXd block = sample.block(std::size_t(i));
    for (int j = 0; j < m; ++j) block.col(j) *= parameters[std::size_t(j)].tolerance;
    length.push_back(block.rowwise().norm().maxCoeff());
    longest = std::max(longest, length.back());
    rest.push_back(std::move(block));
  }
  const auto independent = [&](const Eigen::MatrixXd& rows) {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows.transpose());
    // An absolute threshold: what is left of a block that has nothing new is rounding, whatever its own size.
    const auto pivots = qr.matrixR().diagonal().cwiseAbs();
    return std::pair(int((pivots.array() > new_row * longest).count()), std::move(qr));
  };
  std::vector<int> order;
  std::vector<bool> taken(std::size_t(n), false);
  for (int known = 0; known < m;) {
    int best = -1, gain = 0;
    for (int i = 0; i < n && gain < std::min(sample.rows(), m - known); ++i) {
      if (taken[std::size_t(i)]) continue;
      const int found = independent(rest[std::size_t(i)]).first;
      if (found > gain) best = i, gain = found;
    }
    if (best < 0) break;
    const auto [count, qr] = independent(rest[std::size_t(best)]);
    const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(m, count);
    for (Eigen::MatrixXd& block : rest) block -= (block * basis) * basis.transpose();
    taken[std::size_t(best)] = true;
    order.push_back(best);
    known += count;
  }
  return order;
}

std::string describe(const Dependency& dependency, const std::vector<Parameter>& parameters) {
  const Parameter& dropped = parameters[std::size_t(dependency.dropped)];
  if (dependency.terms.empty()) return dropped.name + " has no effect on the measurement";
  std::string text = dropped.name + " =";
  bool first = true;
  for (const Dependency::Term& term : dependency.terms) {
    const Parameter& kept = parameters[std::size_t(term.parameter)];
    text += first ? (term.coefficient < 0 ? " −" : " ") : (term.coefficient < 0 ? " − " : " + ");
    first = false;
    const double size = std::abs(term.coefficient);
    if (kept.unit != dropped.unit) text += fmt::format("{:.4g} {}·", size, quotient(kept.unit, dropped.unit));
    else if (std::abs(size - 1) > 5e-4) text += fmt::format("{:.4g}·", size);
    text += kept.name;
  }
  return text;
}

}  // namespace posewright
