#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "posewright/proof/box_search.hpp"
#include "posewright/proof/factor_bound.hpp"
#include "posewright/proof/harmonic_form.hpp"

namespace posewright {

class ConfigurationSpace;
class HarmonicLimits;

/// Degrees of each function along every axis.
using HarmonicDegrees = std::vector<std::vector<int>>;

/// Counterexamples of a proof: feasible configurations whose own d = ‖J T‖² is above a limit.
struct Refutation {
  const ConfigurationSpace& space;
  int rows = 0;  ///< of a block
  double above = 0.0;
};

/// Largest value of one function over its axes' limits (theory.md eq. (37)). Stops as largest_value() of boxes.
BoxSearchResult largest_value(const HarmonicFunction& function, const BoxSearchOptions& options,
                              const Monitor& monitor);

/// Twice those of the part, or less where the square does not turn as high as its entries do (an arm's first joint
/// turns all readings alike): by the harmonics along random lines. Whoever interpolates with these degrees finds out if
/// one is too low.
HarmonicDegrees degrees_of_squares(const HarmonicForm& form, const Eigen::MatrixXd& T, std::uint64_t seed);

/// Σ_k s_k(r_k) ‖B_k T‖² of a form as tensors: what its bounds over boxes are made of (theory.md eq. (39), (56)).
class HarmonicSensitivity {
 public:
  /// Interpolates ‖B_k T‖² and the distances.
  /// @param T  columns × any
  /// @param squares  degrees_of_squares()
  /// Throws nothing of its own: defined() says whether all is as the form says, and nothing stopped it.
  HarmonicSensitivity(const HarmonicForm& form, const Eigen::MatrixXd& T, const HarmonicDegrees& squares,
                      std::uint64_t seed, int threads, const Monitor& monitor);
  ~HarmonicSensitivity();

  /// What bounding a form takes, known before anything is computed.
  struct Cost {
    double coefficients = 0.0;  ///< of all tensors: memory
    double work = 0.0;          ///< of a box, in coefficients of its tensor: time
    double boxes = 0.0;         ///< to begin with
  };
  static Cost cost(const HarmonicForm& form, const HarmonicDegrees& squares);

  /// False if a value was not finite, or a part is no polynomial of the stated degrees at random places.
  bool defined() const { return defined_; }
  std::vector<SearchBox> first_boxes() const;
  /// @param refutation  places that it keeps as LargestFound::refuting; null: none
  std::unique_ptr<BoxJudge> judge(const Refutation* refutation = nullptr) const;
  /// Coefficients of the tensor that a box is bounded by.
  double size() const { return double(harmonic_size(form_.axes(), degrees_)); }

 private:
  friend class HarmonicJudge;
  struct Places;
  /// f = ‖B_k T‖² of a part whose factor depends on a distance r, of low degrees, and r f, δ f with δ the mean distance
  /// less r; f alone where those have too high a degree.
  struct Term {
    HarmonicPart part{};
    std::size_t index = 0;  ///< of the part in the form
    std::vector<double> plain, times_distance, times_difference;
    double most_plain = 0.0, most_times_distance = 0.0, most_times_difference = 0.0;  ///< largest coefficients
  };
  struct Distance {
    HarmonicFunction square, difference;  ///< r and δ, m²
    HarmonicFunction multiplier;          ///< at r
    double error = 0.0;                   ///< of the interpolation, m²
    double least = 0.0;                   ///< nowhere is r smaller, m²
  };
  void take_distances(const Places& places, int threads);
  void take_part(std::size_t k, const HarmonicFunction& bound);

  const HarmonicForm& form_;
  const Eigen::MatrixXd& T_;
  std::unique_ptr<const HarmonicLimits> limits_;
  std::vector<int> degrees_;                ///< of all tensors
  std::vector<int> low_degrees_;            ///< of ‖B_k T‖² of all parts
  std::vector<int> distance_degrees_;       ///< of r, δ and the multiplier
  std::vector<std::size_t> places_of_low_;  ///< of coefficients of low_degrees_ among those of degrees_
  bool affine_ = false;                     ///< tensors have room for products with a distance
  std::vector<Term> terms_;
  std::vector<double> fixed_;  ///< what has no distance, times the multiplier
  double most_fixed_ = 0.0;
  std::vector<Distance> distances_;
  Multiplier multiplier_;
  std::optional<HarmonicFunction> multiplied_;  ///< the multiplier as a function of the axes
  bool defined_ = true;
};

/// Largest value of several, each over its own axes.
BoxSearchResult largest_value(const std::vector<std::unique_ptr<HarmonicSensitivity>>& functions,
                              const BoxSearchOptions& options, const Monitor& monitor,
                              const Refutation* refutation = nullptr);

}  // namespace posewright
