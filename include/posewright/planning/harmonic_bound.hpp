#pragma once

#include <memory>
#include <string>
#include <vector>

#include "posewright/planning/box_search.hpp"
#include "posewright/planning/harmonic_form.hpp"

namespace posewright {

/// Largest value of one function over its axes' limits (theory.md eq. (37)). Stops as largest_value() of boxes.
BoxSearchResult largest_value(const HarmonicFunction& function, const BoxSearchOptions& options,
                              const Monitor& monitor);

/// Of each part k, degrees of ‖B_k T‖² along every axis.
using HarmonicDegrees = std::vector<std::vector<int>>;

/// Twice those of the part, or less where the square does not turn as high as its entries do (an arm's first joint
/// turns all readings alike): by the harmonics along random lines. Whoever interpolates with these degrees finds out if
/// one is too low.
HarmonicDegrees degrees_of_squares(const HarmonicForm& form, const Eigen::MatrixXd& T, std::uint64_t seed);

/// Σ_k s_k(r_k) ‖B_k T‖² of a form as tensors: what its bounds over boxes are made of (theory.md eq. (39)).
class HarmonicSensitivity {
 public:
  /// Interpolates ‖B_k T‖² and the distances.
  /// @param T  columns × any
  /// @param squares  degrees_of_squares()
  /// Throws nothing of its own: defined() says whether all is as the form says, and nothing stopped it.
  HarmonicSensitivity(const HarmonicForm& form, const Eigen::MatrixXd& T, const HarmonicDegrees& squares,
                      std::uint64_t seed, int threads, const Monitor& monitor);

  /// Coefficients of a form's tensors together: what memory and a box's time go with.
  static double cost(const HarmonicForm& form, const HarmonicDegrees& squares);

  const HarmonicForm& form() const { return form_; }
  /// False if a value was not finite, or a part is no polynomial of the stated degrees at random places.
  bool defined() const { return defined_; }
  std::vector<SearchBox> first_boxes() const;
  std::unique_ptr<BoxJudge> judge() const;
  std::size_t size() const { return harmonic_size(form_.axes(), degrees_); }
  std::size_t terms() const { return terms_.size(); }

 private:
  friend class HarmonicJudge;
  /// Σ (a₀ + a₁ r) f over parts of one factor, each with its own distance: Σ f and Σ r f, or Σ f alone where r f has
  /// too high a degree.
  struct Term {
    HarmonicPart part{};
    std::vector<int> distances;
    std::vector<double> plain, times_distance;
    double most_plain = 0.0, most_times = 0.0;  ///< largest coefficients
  };
  Term& term_of(const HarmonicPart& part, bool affine);
  struct Distance {
    HarmonicFunction square;
    double error = 0.0;  ///< of the interpolation, m²
    double least = 0.0;  ///< nowhere is it smaller, m²
  };

  const HarmonicForm& form_;
  const Eigen::MatrixXd& T_;
  std::vector<int> degrees_;  ///< of all tensors
  std::vector<Term> terms_;
  std::vector<Distance> distances_;
  bool defined_ = true;
};

/// Largest value of several, each over its own axes.
BoxSearchResult largest_value(const std::vector<std::unique_ptr<HarmonicSensitivity>>& functions,
                              const BoxSearchOptions& options, const Monitor& monitor);

/// A form's function Σ_k s_k(r_k) ‖B_k T‖² at values of its axes, those that follow others put in; NaN where it has
/// none.
double sensitivity_of(const HarmonicForm& form, HarmonicForm::Evaluator& evaluator, const Eigen::MatrixXd& T,
                      std::vector<double>& values);

/// Upper bound a₀ + a₁ r of a part's factor for r in [lower, upper], lower > 0: the chord of what is convex, the
/// tangent of what is taken away. Constant where `affine` is false.
struct FactorBound {
  double constant = 0.0, slope = 0.0;
};
FactorBound factor_bound(const HarmonicPart& part, double lower, double upper, bool affine);

}  // namespace posewright
