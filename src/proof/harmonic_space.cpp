#include <algorithm>
#include <cmath>
#include <numbers>

#include "posewright/proof/bounded_space.hpp"
#include "posewright/proof/harmonic_rows.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

using Axis = ConfigurationSpace::Axis;

// Choices of stations, loads, sides of arrival and so on that are looked at one by one.
constexpr std::size_t most_choices = 64;
// Columns with cos kq up to here are polynomials of a higher degree; beyond it their phase is free.
constexpr double highest_harmonic = 2.0;

/// Source of a factor's value.
struct FactorSource {
  int axis = -1;  ///< that follows the coordinate or has any phase; −1: the value at the coordinate itself
};

struct FormPart {
  const SpacePart* part;
  std::unique_ptr<HarmonicRows> rows;
  std::vector<FactorSource> factors;
  Eigen::Index first_column = 0, width = 0;
};

class StudyForm : public HarmonicForm {
 public:
  StudyForm(std::vector<FormPart> parts, const std::vector<Axis>& axes, const Eigen::MatrixXd& R,
            std::vector<double> fixed)
      : own_(std::move(parts)), R_(R), fixed_(std::move(fixed)) {
    columns_ = int(R.cols());
    for (std::size_t a = 0; a < axes.size(); ++a) {
      if (!axes[a].continuous || !(axes[a].upper > axes[a].lower)) continue;
      moving_.push_back(a);
      axes_.push_back({axes[a].lower, axes[a].upper, axes[a].turns});
    }
    for (FormPart& part : own_)
      for (const ColumnFactor& factor : part.rows->factors()) part.factors.push_back({axis_for(factor)});
    for (const FormPart& part : own_) append(part);
    if (own_.size() == 1) spreads_ = own_.front().rows->spreads();
    take_limits();
  }

  std::unique_ptr<Evaluator> evaluator() const override { return std::make_unique<StudyEvaluator>(*this); }
  std::vector<double> configuration(std::span<const double> values) const override {
    std::vector<double> q = fixed_;
    for (std::size_t i = 0; i < moving_.size(); ++i) q[moving_[i]] = values[i];
    return q;
  }
  std::vector<double> values(std::span<const double> q) const override {
    std::vector<double> values;
    for (const std::size_t a : moving_) values.push_back(q[a]);
    values.resize(axes_.size(), 0.0);
    for (const Made& made : made_) {
      const double x = q[std::size_t(made.coordinate)];
      values[std::size_t(made.axis)] = made.free ? made.constant * x : x - made.constant;
    }
    return values;
  }

 private:
  class StudyEvaluator : public Evaluator {
   public:
    explicit StudyEvaluator(const StudyForm& form) : form_(form), q_(form.fixed_) {
      for (const FormPart& part : form.own_) work_.push_back(part.rows->work());
    }
    bool rows(std::span<const double> values, BlockArray::RowMatrix& B) override {
      Eigen::Index total = 0;
      for (const HarmonicPart& part : form_.parts()) total += part.rows;
      B.setZero(total, form_.columns());
      return each(values,
                  [&](const FormPart& part, Eigen::Index first, std::size_t) {
                    auto out = B.block(first, part.first_column, own_.rows(), part.width);
                    if (part.part->mix.size() > 0) out.noalias() = own_ * part.part->mix;
                    else out = own_;
                  }) &&
             divided(B);
    }
    void distances(std::span<const double> values, std::span<double> squares) override {
      each(values, [&](const FormPart& part, Eigen::Index, std::size_t distance) {
        std::copy_n(squares_.begin(), part.rows->distances(), squares.begin() + std::ptrdiff_t(distance));
      });
    }
    void limit_values(std::span<const double> values, std::span<double> out) override {
      place(values);
      form_.own_.front().part->workspace->necessary_values(q_, out);
    }
    void complete(std::span<double> values) const override {
      for (std::size_t a = 0; a < form_.axes().size(); ++a)
        if (const HarmonicAxis& axis = form_.axes()[a]; axis.follows >= 0)
          values[a] = values[std::size_t(axis.follows)] - axis.shift;
    }

   private:
    void place(std::span<const double> values) {
      for (std::size_t i = 0; i < form_.moving_.size(); ++i) q_[form_.moving_[i]] = values[i];
    }
    template <class Use>
    bool each(std::span<const double> values, const Use& use) {
      place(values);
      Eigen::Index first = 0;
      std::size_t distance = 0;
      for (std::size_t v = 0; v < form_.own_.size(); ++v) {
        const FormPart& part = form_.own_[v];
        put_factors(part, values);
        squares_.resize(std::size_t(part.rows->distances()));
        if (!part.rows->at(q_, factors_, *work_[v], own_, squares_)) return false;
        use(part, first, distance);
        first += own_.rows();
        distance += squares_.size();
      }
      return true;
    }
    void put_factors(const FormPart& part, std::span<const double> values) {
      factors_.clear();
      for (std::size_t f = 0; f < part.factors.size(); ++f) factors_.push_back(form_.factor(part, f, values, q_));
    }
    bool divided(BlockArray::RowMatrix& B) const {
      form_.R_.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(B);
      return B.allFinite();
    }

    const StudyForm& form_;
    std::vector<std::unique_ptr<HarmonicRows::Work>> work_;
    std::vector<double> q_, factors_, squares_;
    BlockArray::RowMatrix own_;
  };

  int moving_index(int coordinate) const {
    const auto at = std::find(moving_.begin(), moving_.end(), std::size_t(coordinate));
    return at == moving_.end() ? -1 : int(at - moving_.begin());
  }
  static bool is_harmonic(const ColumnFactor& factor) {
    return factor.kind != ColumnFactor::Kind::linear && factor.constant <= highest_harmonic &&
           factor.constant == std::round(factor.constant);
  }

  /// The axis that stands for a factor; it is made if there is none yet.
  int axis_for(const ColumnFactor& factor) {
    const int leader = moving_index(factor.coordinate);
    if (leader < 0 || is_harmonic(factor)) return -1;
    const bool linear = factor.kind == ColumnFactor::Kind::linear;
    for (const auto& [coordinate, constant, free, axis] : made_)
      if (coordinate == factor.coordinate && constant == factor.constant && free != linear) return axis;
    const HarmonicAxis from = axes_[std::size_t(leader)];
    if (linear)
      axes_.push_back({from.lower - factor.constant, from.upper - factor.constant, false, leader, factor.constant});
    else axes_.push_back({0.0, 2 * std::numbers::pi, true});
    if (linear) axes_[std::size_t(leader)].counts_turns = true;
    made_.push_back({factor.coordinate, factor.constant, !linear, int(axes_.size()) - 1});
    return int(axes_.size()) - 1;
  }

  double factor(const FormPart& part, std::size_t f, std::span<const double> values,
                const std::vector<double>& q) const {
    const ColumnFactor& factor = part.rows->factors()[f];
    const int axis = part.factors[f].axis;
    if (axis < 0) return value_of(factor, q[std::size_t(factor.coordinate)]);
    const double value = values[std::size_t(axis)];
    if (factor.kind == ColumnFactor::Kind::linear) return value;
    return factor.kind == ColumnFactor::Kind::cosine ? std::cos(value) : std::sin(value);
  }

  /// The part's rows and what is known of their degrees.
  void append(const FormPart& part) {
    const int first_distance = int(distance_degrees_.size());
    std::vector<int> higher(axes_.size(), 0), own(axes_.size(), 0);
    for (std::size_t f = 0; f < part.factors.size(); ++f) {
      const ColumnFactor& factor = part.rows->factors()[f];
      if (part.factors[f].axis >= 0) own[std::size_t(part.factors[f].axis)] = 1;
      else if (const int a = moving_index(factor.coordinate); a >= 0)
        higher[std::size_t(a)] = std::max(higher[std::size_t(a)], int(factor.constant));
    }
    const auto degree = [&](std::size_t a) { return part.rows->degrees()[moving_[a]]; };
    for (HarmonicPart p : part.rows->parts()) {
      std::vector<int> degrees(axes_.size(), 0);
      const bool constant = p.turn_degree == 0;
      for (std::size_t a = 0; a < moving_.size() && !constant; ++a)
        degrees[a] = (axes_[a].turns ? p.turn_degree : p.length_degree) * degree(a) + higher[a];
      for (std::size_t a = moving_.size(); a < axes_.size() && !constant; ++a) degrees[a] = own[a];
      if (p.distance >= 0) p.distance += first_distance;
      parts_.push_back(p);
      degrees_.push_back(std::move(degrees));
    }
    for (int d = 0; d < part.rows->distances(); ++d) {
      std::vector<int> degrees(axes_.size(), 0);
      for (std::size_t a = 0; a < moving_.size(); ++a) degrees[a] = (axes_[a].turns ? 1 : 2) * degree(a);
      distance_degrees_.push_back(std::move(degrees));
    }
  }

  /// A feasible configuration is so for every part: limits of one are enough.
  void take_limits() {
    const SpacePart& part = *own_.front().part;
    limits_ = part.workspace->necessary_limits();
    for (NecessaryLimits::OfCoordinates& limit : limits_.of_coordinates) {
      std::vector<double> moving;
      for (std::size_t c = 0; c < fixed_.size(); ++c)
        if (std::find(moving_.begin(), moving_.end(), c) == moving_.end())
          limit.constant += limit.factors[c] * fixed_[c];
      for (std::size_t a = 0; a < moving_.size(); ++a) {
        moving.push_back(limit.factors[moving_[a]]);
        if (moving.back() != 0) axes_[a].counts_turns = true;
      }
      limit.factors = std::move(moving);
    }
    limit_degrees_.assign(axes_.size(), 0);
    for (std::size_t a = 0; a < moving_.size(); ++a)
      limit_degrees_[a] = (axes_[a].turns ? 1 : 2) * own_.front().rows->degrees()[moving_[a]];
  }

  struct Made {
    int coordinate;
    double constant;
    bool free;
    int axis;
  };

  std::vector<FormPart> own_;
  const Eigen::MatrixXd& R_;
  std::vector<double> fixed_;
  std::vector<std::size_t> moving_;
  std::vector<Made> made_;
};

/// All choices of the discrete axes, others at their lower end; empty: too many.
std::vector<std::vector<double>> choices_of(const SpacePart& part, const std::vector<Axis>& axes) {
  std::vector<std::vector<double>> choices(1);
  const std::vector<Coordinate>& coordinates = part.workspace->proposed();
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const std::vector<double> values =
        coordinates[a].discrete() ? coordinates[a].values : std::vector<double>{axes[a].lower};
    std::vector<std::vector<double>> longer;
    for (const auto& choice : choices)
      for (const double value : values) {
        longer.push_back(choice);
        longer.back().push_back(value);
      }
    choices = std::move(longer);
    if (choices.size() > most_choices) return {};
  }
  return choices;
}

/// Support with these choices, if any has them: what bounds of this choice are tuned to; else all with them put in.
WeightedConfigurations with_choices(const WeightedConfigurations& where, const std::vector<Axis>& axes,
                                    const std::vector<double>& fixed) {
  WeightedConfigurations own, all;
  for (std::size_t i = 0; i < where.configurations.size(); ++i) {
    std::vector<double> q = where.configurations[i];
    for (std::size_t a = 0; a < axes.size(); ++a)
      if (!axes[a].continuous) q[a] = fixed[a];
    if (q == where.configurations[i]) {
      own.configurations.push_back(q);
      own.weights.push_back(where.weights[i]);
    }
    all.configurations.push_back(std::move(q));
    all.weights.push_back(where.weights[i]);
  }
  return own.configurations.empty() ? all : own;
}

}  // namespace

HarmonicForms harmonic_forms_of(const std::vector<SpacePart>& parts, const std::vector<Axis>& axes,
                                const Eigen::MatrixXd& R, const WeightedConfigurations& where) {
  HarmonicForms result;
  const std::vector<std::vector<double>> choices = choices_of(parts.front(), axes);
  if (choices.empty()) return {"more than 64 choices at a pose", {}};
  for (const std::vector<double>& fixed : choices) {
    const WeightedConfigurations own = with_choices(where, axes, fixed);
    std::vector<FormPart> form;
    Eigen::Index column = 0;
    for (const SpacePart& part : parts) {
      if (part.features != nullptr) return {"an unmodelled effect", {}};
      FormPart one;
      one.part = &part;
      one.rows = harmonic_rows(*part.model, fixed, part.selected, result.why_not);
      if (one.rows == nullptr) return {result.why_not, {}};
      one.rows->tune(own.configurations, own.weights);
      one.first_column = column;
      one.width = part.mix.size() > 0 ? part.mix.cols() : Eigen::Index(part.selected.size());
      column += one.width;
      form.push_back(std::move(one));
    }
    result.forms.push_back(std::make_unique<StudyForm>(std::move(form), axes, R, fixed));
  }
  return result;
}

}  // namespace posewright
