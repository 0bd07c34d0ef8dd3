#include "posewright/planning/harmonic_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "box_tensor.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

// Tensors of more coefficients leave out the products with a distance: a box would take too long.
constexpr std::size_t most_with_products = 400'000;
// A function and its polynomial may differ by this share of its size, at so many random places; and as many times the
// largest difference found is added to it. Values were interpolated as they are computed: what rounding makes of them
// is far below.
constexpr double same_function = 1e-7, difference_factor = 100.0, own_rounding = 1e-10;
constexpr int places_compared = 100;
// A box is halved along the axis that moves an instrument's distance where the line above a factor is higher by this.
constexpr double loose_factor = 0.04;
// How near an instrument may come is worth so much work.
constexpr long boxes_for_a_distance = 20'000;
constexpr std::uint64_t compared_stream = 0x9f00f, lines_stream = 0x11e5;
// A harmonic whose amplitude is below this share of a function's size along all of so many random lines is not there.
constexpr double harmonic_of_rounding = 1e-10;
constexpr int lines_an_axis = 3;

std::vector<int> sum_of(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> sum(a);
  for (std::size_t i = 0; i < b.size(); ++i) sum[i] += b[i];
  return sum;
}

std::vector<int> larger_of(std::vector<int> a, const std::vector<int>& b) {
  for (std::size_t i = 0; i < b.size(); ++i) a[i] = std::max(a[i], b[i]);
  return a;
}

bool fits(const std::vector<int>& degrees, const std::vector<int>& room) {
  for (std::size_t i = 0; i < degrees.size(); ++i)
    if (degrees[i] > room[i]) return false;
  return true;
}

std::vector<int> with_distance(const HarmonicForm& form, const HarmonicDegrees& squares, std::size_t part) {
  const int distance = form.parts()[part].distance;
  return distance < 0 ? squares[part] : sum_of(squares[part], form.distance_degrees()[std::size_t(distance)]);
}

/// Degrees of all tensors: with every product if they are not too large.
std::vector<int> common_degrees(const HarmonicForm& form, const HarmonicDegrees& squares) {
  std::vector<int> plain(form.axes().size(), 0), all = plain;
  for (std::size_t k = 0; k < form.parts().size(); ++k) {
    plain = larger_of(plain, squares[k]);
    all = larger_of(all, with_distance(form, squares, k));
  }
  return harmonic_size(form.axes(), all) <= most_with_products ? all : plain;
}

double largest_size(const std::vector<double>& values) {
  double largest = 0;
  for (const double v : values) largest = std::max(largest, std::abs(v));
  return largest;
}

void add_to(std::vector<double>& sum, const std::vector<double>& values) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += values[i];
}

/// What the function is nowhere below, to a percent of its range or so.
double smallest_value(const HarmonicFunction& function, int threads) {
  BoxSearchOptions options;
  options.tolerance = 1e-2;
  options.most_boxes = boxes_for_a_distance;
  options.threads = threads;
  return -largest_value(function.negated(), options, Monitor{}).bound;
}

/// ‖B_k T‖² of all parts at values of the axes.
class PartSquares {
 public:
  PartSquares(const HarmonicForm& form, const Eigen::MatrixXd& T) : form_(form), T_(T), evaluator_(form.evaluator()) {}
  HarmonicForm::Evaluator& evaluator() { return *evaluator_; }
  void operator()(std::span<const double> values, std::span<double> squares) {
    if (!evaluator_->rows(values, B_)) {
      std::fill(squares.begin(), squares.end(), std::numeric_limits<double>::quiet_NaN());
      return;
    }
    turned_.noalias() = B_ * T_;
    Eigen::Index first = 0;
    for (std::size_t k = 0; k < form_.parts().size(); ++k) {
      const Eigen::Index rows = form_.parts()[k].rows;
      squares[k] = turned_.middleRows(first, rows).squaredNorm();
      first += rows;
    }
  }

 private:
  const HarmonicForm& form_;
  const Eigen::MatrixXd& T_;
  std::unique_ptr<HarmonicForm::Evaluator> evaluator_;
  BlockArray::RowMatrix B_, turned_;
};

std::vector<double> random_values(const std::vector<HarmonicAxis>& axes, Random& random) {
  std::vector<double> values;
  values.reserve(axes.size());
  for (const HarmonicAxis& axis : axes) values.push_back(random.uniform(axis.lower, axis.upper));
  return values;
}

/// Amplitudes of f's harmonics, f at 2D + 1 equispaced angles of one axis: the highest that is not rounding.
int highest_harmonic_of(const std::vector<double>& values, double size) {
  const int n = int(values.size());
  for (int h = (n - 1) / 2; h > 0; --h) {
    double cosine = 0, sine = 0;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * double(h) * double(i) / double(n);
      cosine += values[std::size_t(i)] * std::cos(angle);
      sine += values[std::size_t(i)] * std::sin(angle);
    }
    if (2 * std::hypot(cosine, sine) / double(n) > harmonic_of_rounding * size) return h;
  }
  return 0;
}

}  // namespace

HarmonicDegrees degrees_of_squares(const HarmonicForm& form, const Eigen::MatrixXd& T, std::uint64_t seed) {
  const auto& axes = form.axes();
  const std::size_t parts = form.parts().size();
  HarmonicDegrees possible, found;
  for (std::size_t k = 0; k < parts; ++k) {
    possible.push_back(sum_of(form.degrees()[k], form.degrees()[k]));
    // Numbers keep their degree: they are cheap.
    found.push_back(possible.back());
    for (std::size_t a = 0; a < axes.size(); ++a)
      if (axes[a].turns) found[k][a] = 0;
  }
  PartSquares squares(form, T);
  Random random(seed, lines_stream);
  std::vector<double> at(parts);
  for (int line = 0; line < lines_an_axis; ++line)
    for (std::size_t a = 0; a < axes.size(); ++a) {
      if (!axes[a].turns) continue;
      std::vector<double> place = random_values(axes, random);
      for (std::size_t k = 0; k < parts; ++k) {
        const int n = 2 * possible[k][a] + 1;
        std::vector<double> values;
        double size = 0;
        for (int i = 0; i < n; ++i) {
          place[a] = 2 * std::numbers::pi * double(i) / double(n);
          squares(place, at);
          values.push_back(at[k]);
          size = std::max(size, std::abs(at[k]));
        }
        found[k][a] = std::max(found[k][a], std::isfinite(size) ? highest_harmonic_of(values, size) : possible[k][a]);
      }
    }
  return found;
}

/// One thread's.
class HarmonicJudge : public BoxJudge {
 public:
  explicit HarmonicJudge(const HarmonicSensitivity& function)
      : function_(function), tensor_(function.form_.axes(), function.degrees_), evaluator_(function.form_.evaluator()) {
    for (const HarmonicSensitivity::Distance& d : function.distances_)
      distances_.emplace_back(function.form_.axes(), d.square.degrees());
  }

  void judge(SearchBox& box, double enough, LargestFound& found) override {
    ranges_.clear();
    for (std::size_t i = 0; i < distances_.size(); ++i) {
      const HarmonicSensitivity::Distance& d = function_.distances_[i];
      distances_[i].coefficients() = d.square.coefficients();
      distances_[i].put(box, largest_size(d.square.coefficients()));
      ranges_.push_back({std::max(distances_[i].smallest() - d.error, d.least), distances_[i].largest() + d.error});
      if (ranges_.back().first > 0) continue;
      // The instrument may stand in this box, for all that is known.
      box.bound = std::numeric_limits<double>::infinity();
      box.longest = distances_[i].most_varied();
      return;
    }
    loose_ = -1;
    tensor_.put(box, combine());
    box.bound = tensor_.largest();
    if (!(box.bound > enough)) return;
    box.longest = loose_ < 0 ? tensor_.most_varied() : distances_[std::size_t(loose_)].most_varied();
    double top;
    const std::size_t corner = tensor_.highest_corner(top);
    if (top > found.value) look_at(corner, box, found);
  }

 private:
  /// All terms with the bounds of their factors. @return sum of the sizes of what was added
  double combine() {
    std::vector<double>& sum = tensor_.coefficients();
    sum.assign(function_.size(), 0.0);
    double most = 0;
    for (const HarmonicSensitivity::Term& term : function_.terms_) {
      const FactorBound factor = factor_of(term);
      add(sum, factor.constant, term.plain);
      most += std::abs(factor.constant) * term.most_plain;
      if (factor.slope == 0) continue;
      add(sum, factor.slope, term.times_distance);
      most += std::abs(factor.slope) * term.most_times;
    }
    return most;
  }

  /// One for all distances of a term: those of targets on one tip are alike.
  FactorBound factor_of(const HarmonicSensitivity::Term& term) {
    if (term.distances.empty()) return {term.part.plus.weight, 0.0};
    double lower = std::numeric_limits<double>::infinity(), upper = 0, error = 0;
    for (const int d : term.distances) {
      lower = std::min(lower, ranges_[std::size_t(d)].first);
      upper = std::max(upper, ranges_[std::size_t(d)].second);
      error = std::max(error, function_.distances_[std::size_t(d)].error);
    }
    FactorBound factor = factor_bound(term.part, lower, upper, !term.times_distance.empty());
    factor.constant += std::abs(factor.slope) * error;
    const double middle = 0.5 * (lower + upper), value = term.part.factor(middle);
    const double gap = factor.constant + factor.slope * middle - value;
    if (gap > loose_factor * value) loose_ = term.distances.front();
    return factor;
  }

  static void add(std::vector<double>& sum, double factor, const std::vector<double>& values) {
    Eigen::Map<Eigen::VectorXd>(sum.data(), Eigen::Index(sum.size())) +=
        factor * Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
  }

  void look_at(std::size_t corner, const SearchBox& box, LargestFound& found) {
    const auto& axes = function_.form_.axes();
    values_.clear();
    for (std::size_t a = 0; a < axes.size(); ++a)
      values_.push_back((corner >> a & 1) != 0 ? upper_of(axes, box, a) : lower_of(axes, box, a));
    const double value = sensitivity_of(function_.form_, *evaluator_, function_.T_, values_);
    if (!(value > found.value)) return;
    found.value = value;
    found.where = values_;
    found.function = box.function;
  }

  const HarmonicSensitivity& function_;
  BoxTensor tensor_;
  std::vector<BoxTensor> distances_;
  std::vector<std::pair<double, double>> ranges_;
  int loose_ = -1;  ///< distance that varies too much for a line to bound a factor well
  std::unique_ptr<HarmonicForm::Evaluator> evaluator_;
  std::vector<double> values_;
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
  explicit JudgeOfSeveral(const std::vector<std::unique_ptr<HarmonicSensitivity>>& functions) {
    for (const auto& f : functions) judges_.push_back(f->judge());
  }
  void judge(SearchBox& box, double enough, LargestFound& found) override {
    judges_[std::size_t(box.function)]->judge(box, enough, found);
  }

 private:
  std::vector<std::unique_ptr<BoxJudge>> judges_;
};

}  // namespace

FactorBound factor_bound(const HarmonicPart& part, double lower, double upper, bool affine) {
  const double high = part.plus.value(lower), low = part.plus.value(upper);
  if (!affine || !(upper > lower * (1 + 1e-12))) return {high - part.minus.value(upper), 0.0};
  const double middle = 0.5 * (lower + upper), fall = part.minus.derivative(middle);
  const double slope = (low - high) / (upper - lower) - fall;
  return {high - (low - high) / (upper - lower) * lower - part.minus.value(middle) + fall * middle, slope};
}

double HarmonicSensitivity::cost(const HarmonicForm& form, const HarmonicDegrees& squares) {
  return double(harmonic_size(form.axes(), common_degrees(form, squares))) * double(2 * form.parts().size());
}

HarmonicSensitivity::HarmonicSensitivity(const HarmonicForm& form, const Eigen::MatrixXd& T,
                                         const HarmonicDegrees& degrees_of_parts, std::uint64_t seed, int threads,
                                         const Monitor& monitor)
    : form_(form), T_(T), degrees_(common_degrees(form, degrees_of_parts)) {
  const auto& axes = form.axes();
  const std::size_t parts = form.parts().size();
  Random random(seed, compared_stream);
  PartSquares squares(form, T);
  std::vector<std::vector<double>> places;
  places.reserve(places_compared);
  for (int i = 0; i < places_compared; ++i) places.push_back(random_values(axes, random));

  for (std::size_t d = 0; d < form.distance_degrees().size(); ++d) {
    const auto of = [&form, d](HarmonicForm::Evaluator& evaluator, std::span<const double> values) {
      std::vector<double> all(form.distance_degrees().size());
      evaluator.distances(values, all);
      return all[d];
    };
    HarmonicFunction square(
        axes, form.distance_degrees()[d],
        [&] {
          return [evaluator = std::shared_ptr<HarmonicForm::Evaluator>(form.evaluator()),
                  of](std::span<const double> values) { return of(*evaluator, values); };
        },
        1);
    double difference = 0, size = 0;
    for (const auto& place : places) {
      const double r = of(squares.evaluator(), place);
      difference = std::max(difference, std::abs(square.value(place) - r));
      size = std::max(size, r);
    }
    defined_ = defined_ && square.defined() && difference <= same_function * size;
    const double error = difference_factor * difference + own_rounding * size;
    const double least = smallest_value(square, threads) - error;
    distances_.push_back({std::move(square), error, least});
  }

  // Parts of the same degrees are sampled together.
  std::map<std::vector<int>, std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < parts; ++k) groups[degrees_of_parts[k]].push_back(k);
  std::vector<std::vector<double>> direct(places.size(), std::vector<double>(parts));
  for (std::size_t i = 0; i < places.size(); ++i) squares(places[i], direct[i]);
  for (const auto& group : groups) {
    const std::vector<std::size_t>& members = group.second;
    const std::vector<HarmonicFunction> functions = HarmonicFunction::of_several(
        axes, group.first, members.size(),
        [&] {
          return [own = std::make_shared<PartSquares>(form, T), all = std::vector<double>(parts), parts, &members,
                  &monitor](std::span<const double> values, std::span<double> out) mutable {
            if (monitor.should_stop()) all.assign(parts, std::numeric_limits<double>::quiet_NaN());
            else (*own)(values, all);
            for (std::size_t i = 0; i < members.size(); ++i) out[i] = all[members[i]];
          };
        },
        threads);
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::size_t k = members[i];
      double difference = 0, size = 0;
      for (std::size_t p = 0; p < places.size(); ++p) {
        difference = std::max(difference, std::abs(functions[i].value(places[p]) - direct[p][k]));
        size = std::max(size, direct[p][k]);
      }
      defined_ = defined_ && functions[i].defined() && difference <= same_function * size;
      // The constant more makes it a bound of the part.
      const HarmonicFunction upper = functions[i].raised(difference_factor * difference + own_rounding * size);
      const HarmonicPart& part = form.parts()[k];
      const bool affine = part.distance >= 0 && fits(with_distance(form, degrees_of_parts, k), degrees_);
      Term& term = term_of(part, affine);
      add_to(term.plain, upper.lifted(degrees_).coefficients());
      if (affine)
        add_to(
            term.times_distance,
            HarmonicFunction::product(upper, distances_[std::size_t(part.distance)].square, degrees_).coefficients());
    }
  }
  for (Term& term : terms_) {
    term.most_plain = largest_size(term.plain);
    term.most_times = largest_size(term.times_distance);
  }
}

/// Parts of one factor are one term.
HarmonicSensitivity::Term& HarmonicSensitivity::term_of(const HarmonicPart& part, bool affine) {
  const auto same = [&](const Term& t) {
    return t.part.plus == part.plus && t.part.minus == part.minus && t.distances.empty() == (part.distance < 0) &&
           t.times_distance.empty() != affine;
  };
  auto at = std::find_if(terms_.begin(), terms_.end(), same);
  if (at == terms_.end()) {
    terms_.push_back({part, {}, std::vector<double>(size(), 0.0), std::vector<double>(affine ? size() : 0, 0.0)});
    at = terms_.end() - 1;
  }
  if (part.distance >= 0) at->distances.push_back(part.distance);
  return *at;
}

double sensitivity_of(const HarmonicForm& form, HarmonicForm::Evaluator& evaluator, const Eigen::MatrixXd& T,
                      std::vector<double>& values) {
  evaluator.complete(values);
  static thread_local BlockArray::RowMatrix B;
  if (!evaluator.rows(values, B)) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> distances(form.distance_degrees().size());
  evaluator.distances(values, distances);
  double sum = 0;
  Eigen::Index first = 0;
  for (const HarmonicPart& part : form.parts()) {
    const double r = part.distance < 0 ? 0.0 : distances[std::size_t(part.distance)];
    sum += part.factor(r) * (B.middleRows(first, part.rows) * T).squaredNorm();
    first += part.rows;
  }
  return sum;
}

std::vector<SearchBox> HarmonicSensitivity::first_boxes() const { return parts_of_everything(form_.axes(), degrees_); }

std::unique_ptr<BoxJudge> HarmonicSensitivity::judge() const { return std::make_unique<HarmonicJudge>(*this); }

BoxSearchResult largest_value(const HarmonicFunction& function, const BoxSearchOptions& options,
                              const Monitor& monitor) {
  return largest_value(
      parts_of_everything(function.axes(), function.degrees()),
      [&] { return std::make_unique<FunctionJudge>(function); }, options, monitor);
}

BoxSearchResult largest_value(const std::vector<std::unique_ptr<HarmonicSensitivity>>& functions,
                              const BoxSearchOptions& options, const Monitor& monitor) {
  std::vector<SearchBox> first;
  for (std::size_t f = 0; f < functions.size(); ++f)
    for (SearchBox& box : functions[f]->first_boxes()) {
      box.function = int(f);
      first.push_back(std::move(box));
    }
  return largest_value(
      std::move(first), [&] { return std::make_unique<JudgeOfSeveral>(functions); }, options, monitor);
}

}  // namespace posewright
