#include "posewright/planning/spectral_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "posewright/criterion/sensitivity.hpp"
#include "posewright/criterion/spectral.hpp"
#include "posewright/planning/eigenvalue_relaxation.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

constexpr int most_spectral_rounds = 25, most_spectral_steps = 150;
// Gap in the first rounds, whose working set will change.
constexpr double rough = 0.02;
// A step costs the cube of the working set: beyond this there is no bound.
constexpr std::size_t most_working = 1500;
constexpr double spectral_rounding = 1e-9;
// Steps to the largest quotient: each is at least quadratic near it.
constexpr int most_quotients = 60;

/// Bounds λ_min (ratio = false) or λ_min/λ_max of all plans.
class EigenvalueBound {
 public:
  EigenvalueBound(const BlockArray& blocks, const SpectralFunction& function, const SpectralBoundOptions& options,
                  bool ratio)
      : blocks_(blocks), function_(function), options_(options), ratio_(ratio) {
    const Eigen::Index m = blocks.columns();
    known_ = options.prior.size() > 0 ? options.prior : Eigen::MatrixXd::Zero(m, m);
  }

  std::optional<EigenvalueBounds::Bound> run(const Monitor& monitor) {
    if (!first_working_set()) return std::nullopt;
    EigenvalueBounds::Bound result{std::numeric_limits<double>::infinity(), 0.0};
    for (int round = 0; round < most_spectral_rounds; ++round) {
      EigenvalueRelaxation relaxation = relaxed();
      if (!relaxation.regular()) return std::nullopt;
      const double wanted = std::max(0.3 * options_.tolerance, rough * std::pow(0.3, round));
      for (int step = 0; step < most_spectral_steps && !monitor.should_stop(); ++step) {
        if (relaxation.gap() < wanted * relaxation.least() || !relaxation.step(ratio_ ? relaxation.ratio() : 0.0))
          break;
      }
      numbers_ = relaxation.numbers();
      result.attained = std::max(result.attained, ratio_ ? relaxation.ratio() : relaxation.least());
      result.bound = std::min(result.bound, pass(relaxation));
      if (ratio_) result.bound = std::min(result.bound, 1.0);
      monitor.report({"certificate", double(round + 1), 0, {}, {}, result.attained / result.bound});
      if (result.bound <= result.attained * (1 + 2 * options_.tolerance) || monitor.should_stop()) break;
      // The same candidates again: what is left is the accuracy of the weights.
      if (!next_working_set() && round >= 4) break;
    }
    return result;
  }

 private:
  bool first_working_set() {
    const std::size_t n = blocks_.count(),
                      top = std::size_t((options_.poses + options_.repeats - 1) / options_.repeats);
    const std::size_t size =
        std::min(n, std::max<std::size_t>({std::size_t(6 * blocks_.columns()), 3 * top, std::size_t(150)}));
    if (size > most_working || top > n) return false;
    working_.resize(n);
    std::iota(working_.begin(), working_.end(), 0);
    if (size < n) {
      // Long ones, and an even choice of all.
      std::vector<double> length(n);
      for (std::size_t i = 0; i < n; ++i) length[i] = blocks_.block(i).squaredNorm();
      std::stable_sort(working_.begin(), working_.end(),
                       [&](int a, int b) { return length[std::size_t(a)] > length[std::size_t(b)]; });
      working_.resize(size / 2);
      for (std::size_t k = 0; k < size - size / 2; ++k) working_.push_back(int(k * n / (size - size / 2)));
      std::sort(working_.begin(), working_.end());
      working_.erase(std::unique(working_.begin(), working_.end()), working_.end());
    }
    if (working_.size() < top) return false;
    numbers_ =
        Eigen::VectorXd::Constant(Eigen::Index(working_.size()), double(options_.poses) / double(working_.size()));
    return true;
  }

  EigenvalueRelaxation relaxed() const {
    const Eigen::Index r = blocks_.rows();
    EigenvalueRelaxation::RowMatrix rows(Eigen::Index(working_.size()) * r, blocks_.columns());
    for (std::size_t w = 0; w < working_.size(); ++w)
      rows.middleRows(Eigen::Index(w) * r, r) = blocks_.block(std::size_t(working_[w])) * function_.to_scaled();
    const Eigen::MatrixXd& C = function_.to_scaled();
    return {std::move(rows),
            blocks_.rows(),
            function_.nuisance(),
            C.transpose() * known_ * C,
            Eigen::VectorXd::Constant(Eigen::Index(working_.size()), double(options_.repeats)),
            numbers_,
            ratio_};
  }

  /// The proof: the bound by E and F of all candidates.
  double pass(const EigenvalueRelaxation& relaxation) {
    const Eigen::MatrixXd E = upper_factor(function_.to_scaled() * relaxation.least_factor());
    sensitivities(blocks_, E, options_.threads, least_);
    const double known_least = (E.transpose() * known_ * E).trace();
    value_ = least_;
    if (!ratio_) return (1 + spectral_rounding) * (known_least + largest_sum(0.0).first);
    const Eigen::MatrixXd F = upper_factor(function_.to_scaled() * relaxation.most_factor());
    sensitivities(blocks_, F, options_.threads, most_);
    const double known_most = (F.transpose() * known_ * F).trace();
    // The largest quotient of all choices of N (Dinkelbach 1967): it rises until no choice exceeds it.
    double t = relaxation.ratio();
    for (int tries = 0; tries < most_quotients; ++tries) {
      for (std::size_t i = 0; i < value_.size(); ++i) value_[i] = least_[i] - t * most_[i];
      const auto [excess, of_most] = largest_sum(known_least - t * known_most);
      // A choice of smaller λ_max than this one's may exceed t by more: far less than the margin.
      if (excess <= 1e-13 * t * (of_most + known_most)) return t * (1 + spectral_rounding);
      t += excess / (of_most + known_most);
    }
    return std::numeric_limits<double>::infinity();
  }

  /// `first` plus the N largest values, each as often as it may repeat; and the sum of most_ over the same.
  std::pair<double, double> largest_sum(double first) {
    const std::size_t top = std::size_t((options_.poses + options_.repeats - 1) / options_.repeats);
    order_.resize(value_.size());
    std::iota(order_.begin(), order_.end(), 0);
    keep_largest(order_, value_, top);
    double sum = first, most = 0.0;
    int left = options_.poses;
    for (std::size_t k = 0; k < top; ++k) {
      const auto i = std::size_t(order_[k]);
      const int taken = std::min(left, options_.repeats);
      sum += taken * value_[i];
      if (ratio_) most += taken * most_[i];
      left -= taken;
      price_ = value_[i];
    }
    return {sum, most};
  }

  /// Keeps candidates with positive numbers and adds those above the price; false if none is.
  bool next_working_set() {
    std::vector<std::pair<int, double>> kept;
    std::vector<bool> inside(value_.size(), false);
    const std::size_t least = std::size_t((options_.poses + options_.repeats - 1) / options_.repeats) * 2;
    for (std::size_t w = 0; w < working_.size(); ++w) {
      const double number = numbers_[Eigen::Index(w)];
      const auto i = std::size_t(working_[w]);
      if (number < 1e-3 && value_[i] < price_ - 0.2 * std::abs(price_) && kept.size() + working_.size() - w > least)
        continue;
      kept.emplace_back(working_[w], number);
      inside[i] = true;
    }
    std::vector<int> entering;
    for (std::size_t i = 0; i < value_.size(); ++i)
      if (!inside[i] && value_[i] > price_) entering.push_back(int(i));
    std::stable_sort(entering.begin(), entering.end(),
                     [&](int a, int b) { return value_[std::size_t(a)] > value_[std::size_t(b)]; });
    const std::size_t room = std::max<std::size_t>(std::size_t(2 * blocks_.columns()), 60);
    if (entering.size() > room) entering.resize(room);
    for (const int i : entering) kept.emplace_back(i, 0.0);
    std::sort(kept.begin(), kept.end());
    working_.clear();
    numbers_.resize(Eigen::Index(kept.size()));
    for (const auto& [i, number] : kept) {
      numbers_[Eigen::Index(working_.size())] = number;
      working_.push_back(i);
    }
    numbers_ *= options_.poses / numbers_.sum();
    numbers_ = numbers_.cwiseMin(double(options_.repeats));
    const double missing = options_.poses - numbers_.sum();
    const Eigen::VectorXd room_left = Eigen::VectorXd::Constant(numbers_.size(), double(options_.repeats)) - numbers_;
    if (missing > 0) numbers_ += missing / room_left.sum() * room_left;
    return !entering.empty();
  }

  const BlockArray& blocks_;
  const SpectralFunction& function_;
  const SpectralBoundOptions& options_;
  bool ratio_;
  Eigen::MatrixXd known_;
  std::vector<int> working_, order_;
  Eigen::VectorXd numbers_;
  std::vector<double> least_, most_, value_;  // tr(J E Jᵀ), tr(J F Jᵀ), tr(J (E − tF) Jᵀ) of all candidates
  double price_ = 0.0;
};

}  // namespace

std::optional<SpectralBound> spectral_bound(const BlockArray& blocks, const InformationFunction& function,
                                            const SpectralBoundOptions& options, const Monitor& monitor,
                                            EigenvalueBounds* known) {
  const auto* spectral = dynamic_cast<const SpectralFunction*>(&function);
  if (spectral == nullptr || spectral->index() == SpectralIndex::o5) return std::nullopt;
  const bool least = spectral->index() != SpectralIndex::o2;
  const bool ratio = spectral->index() != SpectralIndex::o3 && spectral->nuisance() == 0;
  if (!least && !ratio) return std::nullopt;
  // Φ = ln o3 + ln o2 for o4, either alone for the others; each is half of that of eigenvalues.
  SpectralBound result;
  for (const bool of_ratio : {false, true}) {
    if (!(of_ratio ? ratio : least)) continue;
    std::optional<EigenvalueBounds::Bound> found;
    if (known != nullptr) found = of_ratio ? known->ratio : known->least;
    if (!found) found = EigenvalueBound(blocks, *spectral, options, of_ratio).run(monitor);
    if (!found) return std::nullopt;
    if (known != nullptr) (of_ratio ? known->ratio : known->least) = found;
    result.bound += 0.5 * std::log(found->bound);
    result.gap += 0.5 * std::log(found->bound / found->attained);
  }
  return result;
}

}  // namespace posewright
