#include "posewright/proof/taylor_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bernstein.hpp"
#include "bernstein_tensor.hpp"
#include "posewright/support/taylor_model.hpp"

namespace posewright {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Degree of the models by the number of axes: a box of six takes some milliseconds.
constexpr std::array<int, 7> degrees = {4, 8, 8, 6, 5, 4, 4};
// A cut that leaves more than this share of an axis is not worth another model.
constexpr double worth_a_cut = 0.9;
constexpr int most_cuts = 3;
// Monomials whose degree in one variable is high are counted by their size where that is less than this share of d.
constexpr double small_share = 2e-5;
// λ: sweeps of Newton's method on Σ √(slope² + s²), for ever smaller s.
constexpr int smoothings = 6, sweeps = 12;
constexpr double first_smoothing = 0.1, finer = 0.2;
// A box whose bound exceeds what is enough by this share is halved along two axes before its parts are looked at.
constexpr double far_above = 0.1;
// Boxes that are looked into for what searches miss: a second or two.
constexpr long boxes_of_a_look = 300;

using Values = TaylorModel::Values;

/// Linear part of a model on one box, and how far f may be from it.
struct LinearPart {
  double constant, rest = 0;  ///< |f − constant − slopes · x| ≤ rest
  std::array<double, Monomials::most_variables> slopes{};
  double linear = 0;  ///< Σ |slopes|

  LinearPart(const TaylorModel& f, const Values& variations, std::size_t box) : constant(f.constant(box)) {
    const auto n = f.monomials() == nullptr ? std::size_t{0} : std::size_t(f.monomials()->variables());
    for (std::size_t a = 0; a < n; ++a) linear += std::abs(slopes[a] = f.coefficient(1 + a, box));
    rest = (variations[box] - linear) + f.radius(box) +
           8 * epsilon * (std::abs(constant) + variations[box] + f.radius(box));
  }
};

/// f ≥ 0 on the box [−1, 1]^n where x lies in all of [lower, upper] only; false: nowhere.
bool cut(const LinearPart& f, std::vector<double>& lower, std::vector<double>& upper) {
  for (std::size_t a = 0; a < lower.size(); ++a) {
    const double slope = f.slopes[a];
    if (slope == 0) continue;
    // The constant, the rest and the other slopes + slope · x ≥ 0.
    const double reach = (f.constant + f.rest) + (f.linear - std::abs(slope)) + 8 * epsilon * f.linear;
    const double end = -reach / slope;
    if (slope > 0) lower[a] = std::max(lower[a], end - 8 * epsilon * std::abs(end));
    else upper[a] = std::min(upper[a], end + 8 * epsilon * std::abs(end));
    if (lower[a] > upper[a]) return false;
  }
  return true;
}

/// One multiplier after a step of Newton's method; `slopes` follow.
double improved(const LinearPart& c, double lambda, double smoothing, double size, std::vector<double>& slopes) {
  double first = c.constant, second = 0;
  for (std::size_t a = 0; a < slopes.size(); ++a) {
    const double slope = c.slopes[a], root = std::sqrt(slopes[a] * slopes[a] + smoothing * smoothing);
    first += slope * slopes[a] / root;
    second += slope * slope * smoothing * smoothing / (root * root * root);
  }
  if (!(c.linear > 0) || !(second > 0)) return lambda;
  const double most = size / c.linear;
  const double next = std::clamp(lambda - first / second, std::max(0.0, lambda - most), lambda + most);
  for (std::size_t a = 0; a < slopes.size(); ++a) slopes[a] += (next - lambda) * c.slopes[a];
  return next;
}

/// λ ≥ 0 that makes Σ λ_i c_i + Σ_a |slope_a of d + Σ λ_i c_i| small: the linear parts' bound of d + Σ λ_i c_i. Any λ
/// is valid.
std::vector<double> multipliers(const TaylorModel& d, std::size_t box, const std::vector<LinearPart>& limits) {
  std::vector<double> lambda(limits.size(), 0.0);
  if (limits.empty() || d.monomials() == nullptr) return lambda;
  const auto n = std::size_t(d.monomials()->variables());
  std::vector<double> slopes(n, 0.0);
  double size = 0;
  for (std::size_t a = 0; a < n; ++a) size += std::abs(slopes[a] = d.coefficient(1 + a, box));
  double smoothing = first_smoothing * size, least = size;
  std::vector<double> best = lambda;
  for (int round = 0; round < smoothings && size > 0; ++round, smoothing *= finer) {
    for (int sweep = 0; sweep < sweeps; ++sweep)
      for (std::size_t i = 0; i < limits.size(); ++i)
        lambda[i] = improved(limits[i], lambda[i], smoothing, size, slopes);
    double value = 0;
    for (std::size_t i = 0; i < limits.size(); ++i) value += lambda[i] * limits[i].constant;
    for (const double slope : slopes) value += std::abs(slope);
    if (!(value < least)) continue;
    least = value;
    best = lambda;
  }
  return best;
}

/// One thread's.
class TaylorJudge : public BoxJudge {
 public:
  TaylorJudge(const BoundedSpace& space, const Eigen::MatrixXd& T, SeenAbove* seen)
      : enclosure_(space.enclosure(T)), seen_(seen) {
    for (const ConfigurationSpace::Axis& axis : space.axes()) {
      moving_.push_back(axis.upper > axis.lower ? variables_++ : -1);
      fixed_.push_back(axis.lower);
      if (axis.upper > axis.lower) widths_.push_back(axis.upper - axis.lower);
    }
    monomials_ = &Monomials::of(variables_, degrees[std::size_t(variables_)]);
  }

  void judge(SearchBox& box, double enough, LargestFound& found) override {
    judge_together(std::span(&box, 1), enough, std::span(&found, 1));
  }

  std::size_t together() const override { return TaylorModel::boxes; }

  void judge_together(std::span<SearchBox> boxes, double enough, std::span<LargestFound> found) override {
    std::vector<double> before;
    for (SearchBox& box : boxes) {
      before.push_back(box.bound);
      box.bound = -infinity;
      box.also = -1;
    }
    std::vector<bool> possible(boxes.size(), true);
    // Without an enclosure nothing is known of a box but that it can be halved.
    TaylorModel d;
    const bool enclosed = cut_all(boxes, possible);
    if (enclosed && std::none_of(possible.begin(), possible.end(), [](bool one) { return one; })) return;
    if (!enclosed || !enclosure_->sensitivity(q_, d))
      for (std::size_t i = 0; i < boxes.size(); ++i) d.put_unknown(i);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!possible[i]) continue;
      if (!d.known(i)) leave_unknown(boxes[i], before[i]);
      else look_at_middle(d, i, boxes[i], found[i]);
    }
    add_limits(d, boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
      if (possible[i] && d.known(i)) bound(d, i, boxes[i], before[i], enough);
  }

 private:
  /// The boxes as variables; those that are too few are made up by the last.
  void put(std::span<const SearchBox> boxes) {
    q_.clear();
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      if (moving_[k] < 0) {
        q_.emplace_back(fixed_[k]);
        continue;
      }
      const auto a = std::size_t(moving_[k]);
      Values lower, upper;
      for (std::size_t i = 0; i < lower.size(); ++i) {
        lower[i] = boxes[std::min(i, boxes.size() - 1)].lower[a];
        upper[i] = boxes[std::min(i, boxes.size() - 1)].upper[a];
      }
      q_.push_back(TaylorModel::variable(*monomials_, moving_[k], lower, upper));
    }
  }

  /// Cuts off boxes what no limit allows; allowed_ are the limits on what is left, and on a little more.
  /// @param possible  false where nothing is left
  /// @return false if there is no enclosure
  bool cut_all(std::span<SearchBox> boxes, std::vector<bool>& possible) {
    std::vector<bool> cutting(boxes.size(), true);
    for (int cuts = 0;; ++cuts) {
      put(boxes);
      allowed_.clear();
      if (!enclosure_->allowed(q_, allowed_)) return false;
      variations_.clear();
      for (TaylorModel& c : allowed_) {
        c.clear_unknown();
        variations_.push_back(c.variations());
      }
      bool again = false;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (!cutting[i]) continue;
        double left = 1;
        possible[i] = cut_off(i, boxes[i], left);
        cutting[i] = possible[i] && left <= worth_a_cut && cuts < most_cuts;
        again = again || cutting[i];
      }
      if (!again) return true;
    }
  }

  /// @param left  smallest share of an axis that is left
  bool cut_off(std::size_t i, SearchBox& box, double& left) const {
    std::vector<double> lower(std::size_t(variables_), -1.0), upper(std::size_t(variables_), 1.0);
    for (std::size_t k = 0; k < allowed_.size(); ++k) {
      const TaylorModel& c = allowed_[k];
      if (!c.known(i)) continue;
      const LinearPart f(c, variations_[k], i);
      if (f.constant + f.linear + f.rest < 0 || !cut(f, lower, upper)) return false;
    }
    for (std::size_t a = 0; a < lower.size(); ++a) {
      left = std::min(left, 0.5 * (upper[a] - lower[a]));
      const double middle = 0.5 * box.lower[a] + 0.5 * box.upper[a], half = 0.5 * (box.upper[a] - box.lower[a]);
      const double slack = 4 * epsilon * (std::abs(middle) + half);
      if (lower[a] > -1) box.lower[a] = std::max(box.lower[a], middle + lower[a] * half - slack);
      if (upper[a] < 1) box.upper[a] = std::min(box.upper[a], middle + upper[a] * half + slack);
    }
    return true;
  }

  /// d + Σ λ_i c_i in place of d on each of the first boxes, for λ of its own.
  void add_limits(TaylorModel& d, std::size_t count) const {
    std::vector<Values> lambda(allowed_.size(), Values{});
    for (std::size_t i = 0; i < count; ++i) {
      if (!d.known(i)) continue;
      std::vector<LinearPart> limits;
      std::vector<std::size_t> of;
      for (std::size_t k = 0; k < allowed_.size(); ++k) {
        const TaylorModel& c = allowed_[k];
        if (!c.known(i) || c.monomials() == nullptr) continue;
        const LinearPart f(c, variations_[k], i);
        // What holds in all of the box rules out nothing.
        if (f.constant - f.linear - f.rest >= 0) continue;
        limits.push_back(f);
        of.push_back(k);
      }
      const std::vector<double> best = multipliers(d, i, limits);
      for (std::size_t k = 0; k < best.size(); ++k) lambda[of[k]][i] = best[k];
    }
    for (std::size_t k = 0; k < allowed_.size(); ++k)
      if (lambda[k] != Values{}) d.add(lambda[k], allowed_[k]);
  }

  void bound(const TaylorModel& d, std::size_t i, SearchBox& box, double before, double enough) {
    tensor_.take(d, i, std::isfinite(enough) ? small_share * std::abs(enough) : 0.0);
    box.bound = std::min(before, tensor_.largest());
    const auto [axis, second] = tensor_.most_varied();
    box.longest = axis;
    // Halves of a box that is far above would be halved again.
    box.also = box.bound > enough + far_above * std::abs(enough) ? second : -1;
    show(box);
  }

  void leave_unknown(SearchBox& box, double before) const {
    box.bound = before;
    double most = -1;
    for (std::size_t a = 0; a < box.lower.size(); ++a)
      if (const double width = (box.upper[a] - box.lower[a]) / widths_[a]; width > most) {
        most = width;
        box.longest = int(a);
      }
  }

  /// The value in the middle, if it is feasible for all that is known.
  void look_at_middle(const TaylorModel& d, std::size_t i, const SearchBox& box, LargestFound& found) const {
    const double value = d.constant(i) - d.radius(i);
    if (!(value > found.value)) return;
    for (const TaylorModel& c : allowed_)
      if (!(c.constant(i) - c.radius(i) >= 0)) return;
    found.value = value;
    found.function = box.function;
    found.where = middle_of(box);
  }

  static std::vector<double> middle_of(const SearchBox& box) {
    std::vector<double> middle;
    for (std::size_t a = 0; a < box.lower.size(); ++a) middle.push_back(0.5 * (box.lower[a] + box.upper[a]));
    return middle;
  }

  void show(const SearchBox& box) {
    if (seen_ == nullptr || !(box.bound > seen_->limit)) return;
    const std::vector<double> middle = middle_of(box);
    std::vector<double> q;
    for (std::size_t k = 0; k < moving_.size(); ++k)
      q.push_back(moving_[k] < 0 ? fixed_[k] : middle[std::size_t(moving_[k])]);
    const std::scoped_lock lock(seen_->mutex);
    seen_->middles.push_back(std::move(q));
  }

  std::unique_ptr<BoundedSpace::Enclosure> enclosure_;
  SeenAbove* seen_;
  std::vector<int> moving_;  // variable of each axis; −1: it has one value
  std::vector<double> fixed_, widths_;
  int variables_ = 0;
  const Monomials* monomials_ = nullptr;
  std::vector<TaylorModel> q_, allowed_;
  std::vector<Values> variations_;  // of allowed_
  BernsteinTensor tensor_;
};

}  // namespace

BoxSearchResult largest_enclosed(const BoundedSpace& space, const Eigen::MatrixXd& T, const BoxSearchOptions& options,
                                 const Monitor& monitor, SeenAbove* seen) {
  SearchBox all;
  for (const ConfigurationSpace::Axis& axis : space.axes()) {
    if (!(axis.upper > axis.lower)) continue;
    all.lower.push_back(axis.lower);
    all.upper.push_back(axis.upper);
  }
  return largest_value(
      {all}, [&] { return std::make_unique<TaylorJudge>(space, T, seen); }, options, monitor);
}

WorkspaceBoundOptions::FurtherStarts middles_of_uncut_boxes(const ConfigurationSpace& space, int columns,
                                                            const WorkspaceBoundOptions& options) {
  const auto* bounded = dynamic_cast<const BoundedSpace*>(&space);
  if (bounded == nullptr || bounded->enclosure(Eigen::MatrixXd::Identity(columns, 1)) == nullptr) return {};
  BoxSearchOptions boxes;
  boxes.tolerance = options.tolerance;
  boxes.most_boxes = boxes_of_a_look;
  boxes.threads = options.threads;
  return [bounded, boxes](const Eigen::MatrixXd& T, double limit, const Monitor& monitor) {
    SeenAbove seen;
    seen.limit = limit;
    BoxSearchOptions own = boxes;
    own.enough = limit;
    largest_enclosed(*bounded, T, own, monitor, &seen);
    return std::move(seen.middles);
  };
}

}  // namespace posewright
