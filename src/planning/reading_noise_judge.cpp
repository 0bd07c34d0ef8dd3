#include "reading_noise_judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace posewright {
namespace {

std::vector<int> most_powers(std::size_t axes, const std::vector<std::size_t>& affine) {
  std::vector<int> powers(axes, 0);
  for (const std::size_t a : affine) powers[a] = 2;
  return powers;
}

}  // namespace

ReadingNoiseJudge::ReadingNoiseJudge(const ReadingNoiseSensitivity& function, const Refutation* refutation)
    : function_(function),
      products_(function.form_, function.T_),
      fitted_(function.form_, function.affine_),
      limits_(*function.limits_, function.degrees_),
      refuting_(refutation, function.form_, function.divided_T_),
      sum_(function.form_.axes(), function.degrees_, most_powers(function.degrees_.size(), function.affine_)),
      tensor_(function.form_.axes(), function.degrees_) {
  const std::size_t count = function.affine_.size() + 1;
  auto& terms = sum_.terms();
  const std::vector<int> none(function.degrees_.size(), 0);
  const auto powers = [&](std::size_t i, std::size_t k) {
    std::vector<int> both = none;
    for (const std::size_t one : {i, k})
      if (one > 0) ++both[function.affine_[one - 1]];
    return both;
  };
  // Tensors of low degrees are added to those before them.
  terms.push_back({function.degrees_, none, {}});
  for (std::size_t i = 1; i < count; ++i) terms.push_back({function.mixed_.degrees, powers(i, 0), {}});
  term_of_.assign(count, std::vector<std::size_t>(count));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k <= i; ++k) {
      term_of_[i][k] = term_of_[k][i] = k == 0 ? i : terms.size();
      if (k > 0) terms.push_back({function.squares_.degrees, powers(i, k), {}});
    }
  W_.resize(terms.size());
  W_sizes_.resize(terms.size());
  factors_.resize(function.errors_.size());
  sizes_.resize(function.errors_.size());
}

void ReadingNoiseJudge::judge(SearchBox& box, double enough, LargestFound& found) {
  // A part of a box is bounded by what bounds the whole.
  const double whole = box.bound;
  box.bound = -std::numeric_limits<double>::infinity();
  if (!limits_.cut(box) || !limits_.leave(box)) return;
  box.bound = whole;
  box.longest = 0;
  if (!fitted_.fit(box, products_, [&](const auto& values, double d) { look(box, values, d, found); })) return;
  const double error = combine();
  sum_.put(box);
  tensor_.take(sum_.coefficients(), sum_.sizes(), sum_.rounding());
  const double bound = tensor_.largest() + error;
  // What is no number bounds nothing.
  box.bound = std::isnan(bound) ? whole : std::min(whole, bound);
  if (!(box.bound > enough)) return;
  box.longest = tensor_.most_bent();
  const auto& axes = function_.form_.axes();
  middle_.clear();
  for (std::size_t a = 0; a < axes.size(); ++a)
    middle_.push_back(0.5 * (lower_of(axes, box, a) + upper_of(axes, box, a)));
  products_.evaluator().complete(middle_);
  if (!limits_.allow(middle_, products_.evaluator())) limits_.take_turn(box);
}

void ReadingNoiseJudge::look(const SearchBox& box, const std::vector<double>& values, double d, LargestFound& found) {
  if (d > found.value && limits_.allow(values, products_.evaluator()))
    static_cast<FoundPlace&>(found) = {d, values, box.function};
  refuting_.look(values, d, box.function, found.refuting);
}

double ReadingNoiseJudge::combine() {
  const std::vector<Eigen::MatrixXd>& U = fitted_.U();
  const Eigen::Index random = U.front().rows();
  for (std::size_t k = 0; k < W_.size(); ++k) {
    W_[k].setZero(random, random);
    W_sizes_[k].setZero(random, random);
  }
  for (std::size_t i = 0; i < U.size(); ++i)
    for (std::size_t k = 0; k < U.size(); ++k) {
      W_[term_of_[i][k]].noalias() += U[i] * U[k].transpose();
      W_sizes_[term_of_[i][k]].noalias() += U[i].cwiseAbs() * U[k].cwiseAbs().transpose();
    }
  double error = 0;
  auto& terms = sum_.terms();
  for (std::size_t k = U.size(); k < terms.size(); ++k) error += put_squares(k, terms[k]);
  for (std::size_t k = 0; k < U.size(); ++k) {
    error += put_squares(k, squares_);
    error += add_mixed(k);
  }
  return error + function_.errors_.front();
}

double ReadingNoiseJudge::put_squares(std::size_t term, BoxSum::Term& to) {
  const Eigen::MatrixXd &W = W_[term], &sizes = W_sizes_[term];
  to.coefficients.assign(harmonic_size(function_.form_.axes(), function_.squares_.degrees), 0.0);
  to.coefficients.front() = W.trace();
  to.most = sizes.trace();
  std::size_t p = function_.errors_.size() - std::size_t(W.rows() * (W.rows() + 1) / 2);
  for (Eigen::Index r = 0; r < W.rows(); ++r)
    for (Eigen::Index c = 0; c <= r; ++c, ++p) {
      factors_[p] = r == c ? W(r, r) : W(r, c) + W(c, r);
      sizes_[p] = r == c ? sizes(r, r) : sizes(r, c) + sizes(c, r);
    }
  return add_products(function_.squares_, to);
}

double ReadingNoiseJudge::add_mixed(std::size_t term) {
  const Eigen::MatrixXd& U = fitted_.U()[term];
  V_.noalias() = -2 * function_.T_ * U.transpose();
  V_sizes_.noalias() = 2 * function_.T_.cwiseAbs() * U.cwiseAbs().transpose();
  std::copy_n(V_.data(), V_.size(), factors_.begin() + 1);
  std::copy_n(V_sizes_.data(), V_.size(), sizes_.begin() + 1);
  BoxSum::Term& to = sum_.terms()[term];
  const auto& mixed = function_.mixed_;
  BoxSum::Term& own = term == 0 ? mixed_ : to;
  own.coefficients.assign(harmonic_size(function_.form_.axes(), mixed.degrees), 0.0);
  for (std::size_t i = 0; i < squares_.coefficients.size(); ++i)
    own.coefficients[function_.squares_.places[i]] = squares_.coefficients[i];
  own.most = squares_.most;
  const double error = add_products(mixed, own);
  if (term > 0) return error;
  const auto& square = function_.square_.coefficients;
  to.coefficients.assign(square.data(), square.data() + square.size());
  for (std::size_t i = 0; i < own.coefficients.size(); ++i) to.coefficients[mixed.places[i]] += own.coefficients[i];
  to.most = own.most + function_.most_.front();
  return error;
}

/// Adds a kind's products with their factors. @return more than they are off by
double ReadingNoiseJudge::add_products(const ReadingNoiseSensitivity::Kind& kind, BoxSum::Term& to) {
  double error = 0;
  for (const auto& group : kind.groups) {
    own_.resize(Eigen::Index(group.products.size()));
    for (std::size_t i = 0; i < group.products.size(); ++i) {
      const std::size_t p = group.products[i];
      own_[Eigen::Index(i)] = factors_[p];
      to.most += sizes_[p] * function_.most_[p];
      error += sizes_[p] * function_.errors_[p];
    }
    low_.noalias() = group.coefficients * own_;
    for (std::size_t i = 0; i < group.places.size(); ++i) to.coefficients[group.places[i]] += low_[Eigen::Index(i)];
  }
  return error;
}

}  // namespace posewright
