#include "posewright/criterion/determinant.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "determinant_nuisance.hpp"
#include "kernels/kernels.hpp"
#include "member_products.hpp"
#include "posewright/criterion/inverse_information.hpp"
#include "posewright/support/dense.hpp"
#include "regular.hpp"
#include "swap_gain.hpp"

namespace posewright {
namespace {

double power(double base, int exponent) {
  double result = 1;
  for (; exponent > 0; exponent >>= 1, base *= base)
    if (exponent & 1) result *= base;
  return result;
}

/// Without nuisance columns: running inverse, cached traces, pruned scans.
class DeterminantState : public DesignState {
 public:
  DeterminantState(const CandidateView& view, std::vector<int> members)
      : DesignState(view, std::move(members)),
        inverse_(*view.blocks, view.blocks->columns(), view.prior),
        gain_(inverse_, view.blocks->rows()),
        products_(inverse_),
        keeps_products_(MemberProducts::pays(*view.blocks, this->members().size())),
        changes_till_refresh_(std::max(changes_till_refresh, view.blocks->columns())),
        has_prior_(view.prior != nullptr) {
    refresh();
  }

  double value() const override { return singular_ ? -infinity : inverse_.log_det(); }

  double loss(int position) const override {
    const int k = members()[std::size_t(position)];
    if (!bounds_only_) return inverse_.trace(k);
    std::vector<double> y;
    Eigen::MatrixXd d(blocks().rows(), blocks().rows());
    inverse_.own(k, y, d);
    return d.trace();
  }

  Swap best_addition() override {
    Swap best{-1, -infinity};
    const int n = static_cast<int>(blocks().count()), r = blocks().rows();
    double ratio = 0;
    const auto may_be_best = [&](int j) { return power(1 + inverse_.trace(j) / r, r) > ratio; };
    for (int j = 0; j < n; ++j) {
      if (blocked()[std::size_t(j)] != 0 || !may_be_best(j)) continue;
      if (bounds_only_) {
        inverse_.measure(j);
        if (!may_be_best(j)) continue;
      }
      const double gain = gain_.addition(j);
      if (gain > best.gain) {
        best = {j, gain};
        ratio = std::exp(gain);
      }
    }
    return best;
  }

  double removal(int position) override { return gain_.removal(members()[std::size_t(position)]); }

  bool refresh() override {
    // Nothing has run since: an exchange asks once more after a pass without a swap.
    if (since_refresh_ == 0) return !singular_;
    since_refresh_ = 0;
    bounds_only_ = false;
    gain_.forget();
    products_.forget();
    singular_ = !inverse_.refresh(members(), 0.0);
    if (singular_) inverse_.refresh(members(), start_ridge);
    return !singular_;
  }

 private:
  Swap do_best_swap(int position, double min_gain) override {
    if (bounds_only_) refresh();
    const int k = members()[std::size_t(position)];
    return blocks().rows() == 1 ? best_row(position, k, min_gain) : best_block(k, min_gain);
  }

  void do_change(int leave, int enter) override {
    gain_.forget();
    // A ridge is for starts; every change may be the one that makes it needless, once there are rows enough.
    const bool enough = has_prior_ || long(members().size()) * blocks().rows() >= blocks().columns();
    ++since_refresh_;
    if ((singular_ && enough) || !change(leave, enter) || since_refresh_ >= changes_till_refresh_) refresh();
  }

  bool change(int leave, int enter) {
    // A design that grows asks for the best addition alone, and few candidates come near it (Minoux 1978).
    if (leave < 0) return bounds_only_ = inverse_.add(enter);
    if (bounds_only_) return false;
    if (!keeps_products_) return inverse_.change(leave, enter);
    if (!inverse_.change(leave, enter, &made_)) return false;
    products_.change(members(), made_);
    return true;
  }

  Swap best_row(int position, int k, double min_gain) {
    if (keeps_products_) return best_of_products(position, k, min_gain);
    inverse_.project(k, y_);
    double best = std::expm1(min_gain);
    const long j = kernels().scan_rows(blocks().data(), blocks().count(), blocks().stride(), y_.data(),
                                       inverse_.traces().data(), inverse_.trace(k), blocked().data(), &best);
    return j < 0 ? Swap{} : Swap{static_cast<int>(j), std::log1p(best)};
  }

  /// Variant with known x_j V x_kᵀ.
  Swap best_of_products(int position, int k, double min_gain) {
    const double* c = products_.row(members(), position);
    const std::vector<double>& d = inverse_.traces();
    const double left = 1 - d[std::size_t(k)];
    double best = std::expm1(min_gain);
    int enter = -1;
    for (std::size_t j = 0; j < d.size(); ++j) {
      const double gain = (1 + d[j]) * left + c[j] * c[j] - 1;
      if (gain <= best || blocked()[j] != 0) continue;
      best = gain;
      enter = int(j);
    }
    return enter < 0 ? Swap{} : Swap{enter, std::log1p(best)};
  }

  Swap best_block(int k, double min_gain) {
    gain_.leave(k);
    Swap best{-1, min_gain};
    const std::size_t n = blocks().count();
    for (std::size_t j = gain_.next(0, n, min_gain, blocked()); j < n; j = gain_.next(j + 1, n, best.gain, blocked())) {
      const double gain = gain_.exact(int(j));
      if (gain > best.gain) best = {int(j), gain};
    }
    return best.enter < 0 ? Swap{} : best;
  }

  InverseInformation inverse_;
  SwapGain gain_;
  MemberProducts products_;
  RankChange made_;
  bool keeps_products_ = false;
  // A fresh factor costs as much as some m changes.
  int changes_till_refresh_;
  std::vector<double> y_;
  int since_refresh_ = 1;
  bool has_prior_ = false, singular_ = false;
  bool bounds_only_ = false;  ///< since the last refresh a member was added: d of the candidates are bounds
};

}  // namespace

std::unique_ptr<DesignState> DeterminantCriterion::start(const CandidateView& view, std::vector<int> members) const {
  if (view.nuisance > 0) return start_with_nuisance(view, std::move(members));
  return std::make_unique<DeterminantState>(view, std::move(members));
}

}  // namespace posewright
