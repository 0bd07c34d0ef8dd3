#include "neighbour_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

constexpr double largest = 32767;

/// Rows have the sign that brings them nearest to those of the middle.
void turn_rows(Eigen::MatrixXd& block, const Eigen::MatrixXd& middle) {
  for (Eigen::Index i = 0; i < block.rows(); ++i)
    if (block.row(i).dot(middle.row(i)) < 0) block.row(i) *= -1;
}

}  // namespace

bool NeighbourErrors::small() const { return efficiency <= 1e-4 && sigma <= 1e-3 && accuracy <= 1e-3; }

void NeighbourErrors::include(const NeighbourErrors& other) {
  efficiency = std::max(efficiency, other.efficiency);
  sigma = std::max(sigma, other.sigma);
  accuracy = std::max(accuracy, other.accuracy);
}

std::optional<BlockSurface> BlockSurface::through(std::size_t coordinates, int node, const BlockAt& block_at) {
  std::vector<int> k(coordinates, 0);
  const std::optional<Eigen::MatrixXd> middle = block_at(k);
  if (!middle) return std::nullopt;
  bool all = true;
  const auto at = [&](std::size_t i, int n, std::size_t j, int l) -> Eigen::MatrixXd {
    std::fill(k.begin(), k.end(), 0);
    k[i] = n;
    if (l != 0) k[j] = l;
    std::optional<Eigen::MatrixXd> block = block_at(k);
    all = all && block.has_value();
    if (!block) return *middle;
    turn_rows(*block, *middle);
    return *block;
  };
  const double h = node;
  std::vector<Eigen::MatrixXd> terms{*middle}, squares;
  for (std::size_t i = 0; i < coordinates; ++i) {
    const Eigen::MatrixXd up = at(i, node, i, 0), down = at(i, -node, i, 0);
    terms.emplace_back((up - down) / (2 * h));
    squares.emplace_back((up + down - 2 * *middle) / (2 * h * h));
  }
  for (std::size_t i = 0; i < coordinates; ++i)
    for (std::size_t j = i; j < coordinates; ++j)
      terms.push_back(i == j ? squares[i]
                             : Eigen::MatrixXd((at(i, node, j, node) - at(i, node, j, -node) - at(i, -node, j, node) +
                                                at(i, -node, j, -node)) /
                                               (4 * h * h)));
  if (!all) return std::nullopt;
  return BlockSurface(terms, coordinates);
}

BlockSurface::BlockSurface(const std::vector<Eigen::MatrixXd>& terms, std::size_t coordinates)
    : rows_(terms.front().rows()), columns_(terms.front().cols()), coordinates_(coordinates) {
  for (auto& scale : scale_) scale.assign(std::size_t(columns_), 0.0);
  for (std::size_t t = 0; t < terms.size(); ++t)
    for (Eigen::Index j = 0; j < columns_; ++j) {
      double& scale = scale_[order(t)][std::size_t(j)];
      scale = std::max(scale, terms[t].col(j).cwiseAbs().maxCoeff() / largest);
    }
  for (std::size_t t = 0; t < terms.size(); ++t)
    for (Eigen::Index i = 0; i < rows_; ++i)
      for (Eigen::Index j = 0; j < columns_; ++j) {
        const double scale = scale_[order(t)][std::size_t(j)];
        terms_.push_back(scale > 0 ? std::int16_t(std::lround(terms[t](i, j) / scale)) : std::int16_t(0));
      }
}

Eigen::MatrixXd BlockSurface::term(std::size_t index) const {
  Eigen::MatrixXd result(rows_, columns_);
  std::size_t at = index * std::size_t(rows_ * columns_);
  const std::vector<double>& scale = scale_[order(index)];
  for (Eigen::Index i = 0; i < rows_; ++i)
    for (Eigen::Index j = 0; j < columns_; ++j) result(i, j) = terms_[at++] * scale[std::size_t(j)];
  return result;
}

Eigen::MatrixXd BlockSurface::at(const std::vector<int>& k) const {
  Eigen::MatrixXd block = term(0);
  std::size_t next = 1;
  for (std::size_t i = 0; i < coordinates_; ++i, ++next)
    if (k[i] != 0) block += k[i] * term(next);
  for (std::size_t i = 0; i < coordinates_; ++i)
    for (std::size_t j = i; j < coordinates_; ++j, ++next)
      if (k[i] * k[j] != 0) block += double(k[i] * k[j]) * term(next);
  return block;
}

NeighbourFigures::NeighbourFigures(const ReportInformation& information) : information_(information) {
  const auto m = Eigen::Index(information.columns.size());
  tolerance_.resize(m);
  M_ = Eigen::MatrixXd::Zero(m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const Parameter& label = information.columns[std::size_t(j)].label;
    tolerance_[j] = label.tolerance;
    if (label.role == Role::nuisance) ++nuisance_;
  }
  for (const auto& [id, own] : information.poses) M_ += own;
  if (information.prior) M_ += *information.prior;
  double weight = 0;
  test_ = Eigen::MatrixXd::Zero(m, m);
  for (const auto& [w, A] : information.test) {
    test_ += w * A;
    weight += w;
  }
  if (weight > 0) test_ /= weight;
  regular_ = of(M_).has_value();
}

std::optional<NeighbourFigures::Figures> NeighbourFigures::of(const Eigen::MatrixXd& M) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(M);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd L = factor.matrixL();
  Figures figures;
  for (Eigen::Index j = nuisance_; j < L.rows(); ++j) figures.log_det += 2 * std::log(L(j, j));
  const Eigen::MatrixXd inverse =
      factor.matrixL().solve(Eigen::MatrixXd::Identity(M.rows(), M.cols()));  // L⁻¹: M⁻¹ = L⁻ᵀ L⁻¹
  figures.sigma = inverse.colwise().norm();
  if (!information_.test.empty()) figures.variance = (inverse * test_).cwiseProduct(inverse).sum();
  return figures;
}

NeighbourErrors NeighbourFigures::compare(int id, const Eigen::MatrixXd& found, const Eigen::MatrixXd& middle,
                                          const Eigen::MatrixXd& there) const {
  const auto stated = of(M_ + found.transpose() * found - middle.transpose() * middle);
  const auto own = std::find_if(information_.poses.begin(), information_.poses.end(),
                                [&](const auto& pose) { return pose.first == id; });
  const auto truth = of(M_ - own->second + there.transpose() * there);
  constexpr double nothing = std::numeric_limits<double>::infinity();
  if (!stated || !truth) return {nothing, nothing, nothing};
  NeighbourErrors errors;
  errors.efficiency = std::abs(stated->log_det - truth->log_det) / double(M_.rows() - nuisance_);
  errors.sigma = (stated->sigma - truth->sigma).cwiseQuotient(truth->sigma).cwiseAbs().maxCoeff();
  if (truth->variance > 0) errors.accuracy = std::abs(std::sqrt(std::max(0.0, stated->variance) / truth->variance) - 1);
  return errors;
}

}  // namespace posewright
