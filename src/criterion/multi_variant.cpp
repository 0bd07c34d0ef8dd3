#include "posewright/criterion/multi_variant.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mixed_state.hpp"
#include "posewright/criterion/determinant.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/robust_aim.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

// The soft minimum lies within ln(variants)/p below the minimum; larger p makes Newton's steps shorter.
constexpr double sharpness = 100.0;

/// ln e_v of one variant.
struct Part {
  VariantGroup group;
  LogDetFunction log_det;
  double interest;

  explicit Part(const VariantGroup& g)
      : group(g), log_det(g.nuisance, g.columns), interest(double(g.columns - g.nuisance)) {}
  auto own(const Eigen::MatrixXd& information) const {
    return information.block(group.first, group.first, group.columns, group.columns);
  }
  double efficiency(double value) const { return (value - group.reference) / interest; }
};

/// Sum of the parts' curvatures, each weighted, plus p times the covariance of their derivatives (soft minimum).
class MixedExpansion : public Expansion {
 public:
  struct Term {
    std::unique_ptr<Expansion> expansion;
    double scale;   // λ_v / s_v
    double weight;  // λ_v
    VariantGroup group;
  };
  std::vector<Term> terms;
  double p = 0.0;

  void curvature(const BlockArray::RowMatrix& rows, int r, Eigen::MatrixXd& H) const override {
    const Eigen::Index s = rows.rows() / r;
    H.setZero(s, s);
    Eigen::MatrixXd part;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(s), d(s);
    for (const Term& term : terms) {
      const BlockArray::RowMatrix own = rows.middleCols(term.group.first, term.group.columns);
      term.expansion->curvature(own, r, part);
      H += term.scale * part;
      if (p == 0.0) continue;
      const BlockArray::RowMatrix rotated = own * term.expansion->factor;
      for (Eigen::Index i = 0; i < s; ++i) d[i] = rotated.middleRows(i * r, r).squaredNorm();
      d *= term.scale / term.weight;  // of ln e_v
      H.noalias() += p * term.weight * d * d.transpose();
      mean += term.weight * d;
    }
    H.noalias() -= p * mean * mean.transpose();
  }
};

class MixedFunction : public InformationFunction {
 public:
  MixedFunction(const CriterionData& data, bool minimum) : minimum_(minimum) {
    if (data.variants.empty()) throw CannotDo("the criterion needs several variants: list them in design: variants");
    double total = 0.0;
    for (const VariantGroup& group : data.variants) total += group.weight;
    for (const VariantGroup& group : data.variants) {
      parts_.emplace_back(group);
      parts_.back().group.weight /= total;
    }
  }

  double value(const Eigen::MatrixXd& information) const override {
    double sum = 0.0, least = infinity;
    for (const Part& part : parts_) {
      const double value = part.log_det.value(part.own(information));
      if (!std::isfinite(value)) return -infinity;
      const double efficiency = part.efficiency(value);
      sum += part.group.weight * efficiency;
      least = std::min(least, efficiency);
    }
    return minimum_ ? least : sum;
  }

  Eigen::MatrixXd gradient(const Eigen::MatrixXd& information) const override {
    Eigen::MatrixXd S = Eigen::MatrixXd::Zero(information.rows(), information.cols());
    const Part* worst = minimum_ ? &least(information) : nullptr;
    for (const Part& part : parts_) {
      if (minimum_ && &part != worst) continue;
      const double weight = minimum_ ? 1.0 : part.group.weight;
      S.block(part.group.first, part.group.first, part.group.columns, part.group.columns) =
          weight / part.interest * part.log_det.gradient(part.own(information));
    }
    return S;
  }

  bool concave() const override { return true; }
  double degree() const override { return 1.0; }

  /// Their weights sum to one.
  std::vector<VariantGroup> variants() const {
    std::vector<VariantGroup> groups;
    for (const Part& part : parts_) groups.push_back(part.group);
    return groups;
  }

  std::unique_ptr<Expansion> expand(const Eigen::MatrixXd& information) const override {
    auto mixed = std::make_unique<MixedExpansion>();
    Eigen::VectorXd efficiency{Eigen::Index(parts_.size())}, weight{Eigen::Index(parts_.size())};
    for (std::size_t v = 0; v < parts_.size(); ++v) {
      auto expansion = parts_[v].log_det.expand(parts_[v].own(information));
      if (expansion == nullptr) return nullptr;
      efficiency[Eigen::Index(v)] = parts_[v].efficiency(expansion->value);
      weight[Eigen::Index(v)] = parts_[v].group.weight;
      mixed->terms.push_back({std::move(expansion), 0.0, 0.0, parts_[v].group});
    }
    if (minimum_) {
      const std::vector<double> soft = soft_minimum_weights({efficiency.begin(), efficiency.end()}, sharpness);
      weight = Eigen::Map<const Eigen::VectorXd>(soft.data(), weight.size());
      // A variant of no weight has no say; the smallest normal weight keeps its derivative finite.
      weight = weight.cwiseMax(1e-12);
      mixed->p = sharpness;
    }
    mixed->value = weight.dot(efficiency);
    mixed->factor = Eigen::MatrixXd::Zero(information.rows(), information.cols());
    for (std::size_t v = 0; v < parts_.size(); ++v) {
      MixedExpansion::Term& term = mixed->terms[v];
      term.weight = weight[Eigen::Index(v)];
      term.scale = term.weight / parts_[v].interest;
      const VariantGroup& g = term.group;
      mixed->factor.block(g.first, g.first, g.columns, g.columns) = std::sqrt(term.scale) * term.expansion->factor;
    }
    return mixed;
  }

 private:
  const Part& least(const Eigen::MatrixXd& information) const {
    const auto of = [&](const Part& part) { return part.efficiency(part.log_det.value(part.own(information))); };
    return *std::min_element(parts_.begin(), parts_.end(), [&](const Part& a, const Part& b) { return of(a) < of(b); });
  }

  bool minimum_;
  std::vector<Part> parts_;
};

class MixedCriterion : public Criterion {
 public:
  MixedCriterion(std::string name, const CriterionData& data, bool minimum)
      : name_(std::move(name)), minimum_(minimum), function_(data, minimum) {}
  std::string name() const override { return name_; }
  const InformationFunction& function() const override { return function_; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override {
    return start_mixed(view, std::move(members), function_.variants(), minimum_);
  }

 private:
  std::string name_;
  bool minimum_;
  MixedFunction function_;
};

}  // namespace

std::unique_ptr<Criterion> make_compound_criterion(const CriterionData& data) {
  return std::make_unique<MixedCriterion>("compound", data, false);
}

std::unique_ptr<Criterion> make_maximin_criterion(const CriterionData& data) {
  return std::make_unique<MixedCriterion>("maximin", data, true);
}

}  // namespace posewright
