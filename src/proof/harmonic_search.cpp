#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "box_tensor.hpp"
#include "harmonic_limits.hpp"
#include "part_squares.hpp"
#include "posewright/proof/harmonic_bound.hpp"
#include "refuting_places.hpp"

// Largest values of functions and of sums of parts: what judges their boxes.

namespace posewright {
namespace {

// A box is halved along an axis that makes the factors' bounds tighter where they are this share of what is to be lost,
// or where the largest squared distance is so many times the smallest: quotients by the multiplier are poor there.
constexpr double loose_factors = 0.5, far_and_near = 4.0;

// Sums of many tensors are made in pieces that stay in the processor's nearest memory.
constexpr std::size_t piece = 2048;

/// Adds so many times each of the tensors.
void add(std::vector<double>& sum, std::span<const std::pair<double, const double*>> tensors) {
  for (std::size_t first = 0; first < sum.size(); first += piece) {
    const auto count = Eigen::Index(std::min(piece, sum.size() - first));
    Eigen::Map<Eigen::VectorXd> part(sum.data() + first, count);
    for (const auto& [factor, values] : tensors)
      part += factor * Eigen::Map<const Eigen::VectorXd>(values + first, count);
  }
}

void put(BoxTensor& tensor, const HarmonicFunction& function, const SearchBox& box) {
  tensor.coefficients() = function.coefficients();
  tensor.put(box, largest_size(function.coefficients()));
}

void put_weighted(BoxTensor& tensor, const HarmonicFunction& function, const SearchBox& box) {
  tensor.coefficients() = function.coefficients();
  tensor.put_weighted(box, largest_size(function.coefficients()));
}

}  // namespace

/// Bounds Σ_k s_k(r_k) ‖B_k T‖² on boxes (theory.md eq. (39), (56)). One thread's.
class HarmonicJudge : public BoxJudge {
 public:
  HarmonicJudge(const HarmonicSensitivity& function, const Refutation* refutation)
      : function_(function),
        tensor_(function.form_.axes(), function.degrees_),
        multiplier_(function.form_.axes(), function.degrees_, function.distance_degrees_),
        mean_(function.form_.axes(), function.distance_degrees_),
        other_(function.form_.axes(), function.distance_degrees_),
        ranges_(function.distances_.size()),
        gaps_(function.terms_.size()),
        varied_(function.distances_.size()),
        axes_(function.terms_.size()),
        parts_(function.form_, function.T_),
        limits_(*function.limits_, function.degrees_),
        refuting_(refutation, function.form_, function.T_) {}

  void judge(SearchBox& box, double enough, LargestFound& found) override {
    box.bound = -std::numeric_limits<double>::infinity();
    if (!limits_.cut(box) || !limits_.leave(box)) return;
    box.bound = std::numeric_limits<double>::infinity();
    if (!put_distances(box)) return;
    const double most = combine();
    tensor_.put_weighted(box, most);
    put_weighted(multiplier_, *function_.multiplied_, box);
    if (!tensor_.divide_by(multiplier_)) return;
    box.bound = tensor_.largest();
    if (!(box.bound > enough)) return;
    double top;
    const std::size_t corner = tensor_.highest_corner(top);
    if (!limits_.lower(box, multiplier_, enough, tensor_)) {
      box.bound = -std::numeric_limits<double>::infinity();
      return;
    }
    box.bound = tensor_.largest();
    if (!(box.bound > enough)) return;
    const auto& axes = function_.form_.axes();
    if (top > found.value) {
      place([&](std::size_t a) { return (corner >> a & 1) != 0 ? upper_of(axes, box, a) : lower_of(axes, box, a); });
      look(box, found);
    }
    place([&](std::size_t a) { return 0.5 * (lower_of(axes, box, a) + upper_of(axes, box, a)); });
    const double middle = look(box, found);
    choose_axis(box, middle);
  }

 private:
  /// Limits of distances, of their differences to the mean, and of the multiplier. False: the instrument may stand in
  /// this box, for all that is known.
  bool put_distances(SearchBox& box) {
    const bool multiplied = function_.multiplier_.slope > 0;
    if (multiplied) put_weighted(mean_, *function_.multiplied_, box);
    for (std::size_t d = 0; d < ranges_.size(); ++d) {
      const HarmonicSensitivity::Distance& distance = function_.distances_[d];
      DistanceRanges& ranges = ranges_[d];
      put(other_, distance.square, box);
      ranges.r.lower = std::max(other_.smallest() - distance.error, distance.least);
      ranges.r.upper = std::max(other_.largest() + distance.error, ranges.r.lower);
      box.longest = varied_[d].distance = varied_[d].difference = other_.most_varied();
      if (!(ranges.r.lower > 0)) return false;
      if (!multiplied) continue;
      put_weighted(other_, distance.multiplier, box);
      ranges.ratio = {0.0, std::numeric_limits<double>::infinity()};
      if (other_.divide_by(mean_)) {
        const double least = other_.smallest(), off = 1 + 2 * function_.multiplier_.slope * distance.error /
                                                              function_.multiplier_.value(ranges.r.lower);
        ranges.ratio.lower = 1 / (other_.largest() * off);
        if (least > 0) ranges.ratio.upper = off / least;
      }
      put(other_, distance.difference, box);
      varied_[d].difference = other_.most_varied();
      ranges.delta = {other_.smallest() - distance.error, other_.largest() + distance.error};
      // δ here is of interpolated distances.
      if (const auto& spreads = function_.form_.spreads(); !spreads.empty())
        cut_by_spread(ranges, function_.multiplier_, {spreads[d].slope, spreads[d].constant + 2 * distance.error});
    }
    return true;
  }
  /// All terms with the bounds of their factors. @return sum of the sizes of what was added
  double combine() {
    std::vector<double>& sum = tensor_.coefficients();
    sum = function_.fixed_;
    low_.assign(function_.places_of_low_.size(), 0.0);
    double most = function_.most_fixed_;
    added_.clear();
    added_low_.clear();
    for (std::size_t k = 0; k < function_.terms_.size(); ++k) {
      const HarmonicSensitivity::Term& term = function_.terms_[k];
      const auto d = std::size_t(term.part.distance);
      FactorBound factor = factor_bound(term.part, function_.multiplier_, ranges_[d], !term.times_distance.empty());
      // The tensors are of interpolated distances.
      factor.constant += 2 * (std::abs(factor.distance) + std::abs(factor.difference)) * function_.distances_[d].error;
      gaps_[k] = factor.gap;
      axes_[k] = factor.by_delta ? varied_[d].difference : varied_[d].distance;
      const auto put = [&](double times, const std::vector<double>& values, double largest, Added& to) {
        if (times == 0 || values.empty()) return;
        to.emplace_back(times, values.data());
        most += std::abs(times) * largest;
      };
      put(factor.constant, term.plain, term.most_plain, added_low_);
      put(factor.distance, term.times_distance, term.most_times_distance, added_);
      put(factor.difference, term.times_difference, term.most_times_difference, added_);
    }
    add(sum, added_);
    add(low_, added_low_);
    for (std::size_t i = 0; i < low_.size(); ++i) sum[function_.places_of_low_[i]] += low_[i];
    return most;
  }
  /// Values of all axes, by the axis.
  template <class Axis>

  void place(const Axis& value_of) {
    values_.clear();
    for (std::size_t a = 0; a < function_.form_.axes().size(); ++a) values_.push_back(value_of(a));
    parts_.evaluator().complete(values_);
  }
  /// The sensitivity at those values; `found` takes it if no limit forbids them.
  double look(const SearchBox& box, LargestFound& found) {
    const double value = parts_.sensitivity(values_);
    refuting_.look(values_, value, box.function, found.refuting);
    if (value > found.value && limits_.allow(values_, parts_.evaluator()))
      static_cast<FoundPlace&>(found) = {value, values_, box.function};
    return value;
  }
  /// Excess of the sensitivity by the bounds of factors at the last place. @param loosest  term of the most
  double loose_bound(std::size_t& loosest) const {
    double sum = 0, most = 0;
    for (std::size_t k = 0; k < gaps_.size(); ++k) {
      const double one = gaps_[k] * parts_.squares()[function_.terms_[k].index];
      sum += one;
      if (one <= most) continue;
      most = one;
      loosest = k;
    }
    return sum / function_.multiplier_.value(mean_of(parts_.distances()));
  }

  /// Axis to halve: the one that tightens loose distances or factors; else the one with most curvature of the tensor.
  void choose_axis(SearchBox& box, double middle) {
    box.longest = tensor_.most_bent();
    double widest = far_and_near;
    std::size_t loosest = 0;
    for (std::size_t d = 0; d < ranges_.size(); ++d)
      if (const double ratio = ranges_[d].r.upper / ranges_[d].r.lower; ratio > widest) {
        widest = ratio;
        box.longest = varied_[d].distance;
      }
    // Where a limit forbids the middle, its value says nothing of what is to be lost.
    const bool forbidden = !limits_.allow(values_, parts_.evaluator());
    if (!(widest > far_and_near) && !forbidden && loose_bound(loosest) > loose_factors * (box.bound - middle))
      box.longest = axes_[loosest];
    if (forbidden) limits_.take_turn(box);
  }

  const HarmonicSensitivity& function_;
  BoxTensor tensor_, multiplier_;
  BoxTensor mean_, other_;  ///< of the multiplier, with the degrees of distances; of one distance
  std::vector<DistanceRanges> ranges_;
  std::vector<double> gaps_;  ///< of the terms' factors
  struct Varied {
    int distance = 0, difference = 0;
  };
  std::vector<Varied> varied_;  ///< axes along which distances and differences vary most
  std::vector<int> axes_;       ///< along which a term's factor becomes tighter
  PartSquares parts_;
  BoxLimits limits_;
  RefutingPlaces refuting_;
  using Added = std::vector<std::pair<double, const double*>>;
  Added added_, added_low_;  ///< tensors, and how many times each is added
  std::vector<double> low_, values_;
};

namespace {

/// A plain function, without parts.
class FunctionJudge : public BoxJudge {
 public:
  explicit FunctionJudge(const HarmonicFunction& function)
      : function_(function),
        tensor_(function.axes(), function.degrees()),
        most_(largest_size(function.coefficients())) {}

  void judge(SearchBox& box, double enough, LargestFound& found) override {
    tensor_.coefficients() = function_.coefficients();
    tensor_.put(box, most_);
    box.bound = tensor_.largest();
    if (!(box.bound > enough)) return;
    box.longest = tensor_.most_varied();
    double top;
    const std::size_t corner = tensor_.highest_corner(top);
    if (!(top > found.value)) return;
    found.value = top;
    found.where.clear();
    for (std::size_t a = 0; a < function_.axes().size(); ++a)
      found.where.push_back((corner >> a & 1) != 0 ? box.upper[a] : box.lower[a]);
  }

 private:
  const HarmonicFunction& function_;
  BoxTensor tensor_;
  double most_;
};

/// Judges each box by its own function.
class JudgeOfSeveral : public BoxJudge {
 public:
  JudgeOfSeveral(const std::vector<std::unique_ptr<HarmonicSensitivity>>& functions, const Refutation* refutation) {
    for (const auto& f : functions) judges_.push_back(f->judge(refutation));
  }
  void judge(SearchBox& box, double enough, LargestFound& found) override {
    judges_[std::size_t(box.function)]->judge(box, enough, found);
  }

 private:
  std::vector<std::unique_ptr<BoxJudge>> judges_;
};

}  // namespace

std::vector<SearchBox> HarmonicSensitivity::first_boxes() const { return parts_of_everything(form_.axes(), degrees_); }

std::unique_ptr<BoxJudge> HarmonicSensitivity::judge(const Refutation* refutation) const {
  return std::make_unique<HarmonicJudge>(*this, refutation);
}

BoxSearchResult largest_value(const HarmonicFunction& function, const BoxSearchOptions& options,
                              const Monitor& monitor) {
  return largest_value(
      parts_of_everything(function.axes(), function.degrees()),
      [&] { return std::make_unique<FunctionJudge>(function); }, options, monitor);
}

BoxSearchResult largest_value(const std::vector<std::unique_ptr<HarmonicSensitivity>>& functions,
                              const BoxSearchOptions& options, const Monitor& monitor, const Refutation* refutation) {
  std::vector<SearchBox> first;
  for (std::size_t f = 0; f < functions.size(); ++f)
    for (SearchBox& box : functions[f]->first_boxes()) {
      box.function = int(f);
      first.push_back(std::move(box));
    }
  return largest_value(
      std::move(first), [&] { return std::make_unique<JudgeOfSeveral>(functions, refutation); }, options, monitor);
}

}  // namespace posewright
