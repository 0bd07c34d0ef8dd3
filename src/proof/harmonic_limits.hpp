#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "box_tensor.hpp"
#include "posewright/proof/harmonic_form.hpp"

namespace posewright {

/// Limits of a form on feasible configurations, as functions over boxes (theory.md eq. (58)).
class HarmonicLimits {
 public:
  /// Limits whose values are no polynomials of the stated degrees are left out.
  HarmonicLimits(const HarmonicForm& form, std::uint64_t seed, int threads);
  /// Degrees of the limits along every axis.
  const std::vector<int>& degrees() const { return degrees_; }

 private:
  friend class BoxLimits;
  struct Value {
    HarmonicFunction function;
    double error = 0.0;  ///< of the interpolation
    double most = 0.0;   ///< largest coefficient
  };
  void take(const std::vector<std::vector<double>>& places, const std::vector<std::vector<double>>& direct,
            int threads);

  const HarmonicForm& form_;
  std::vector<int> degrees_;
  std::vector<Value> values_;
  std::vector<NecessaryLimits::OfPoints> of_points_;
};

/// The limits on boxes. One thread's.
class BoxLimits {
 public:
  /// @param degrees  of the bound that lower() takes
  BoxLimits(const HarmonicLimits& limits, const std::vector<int>& degrees);

  /// Cuts off the box what limits of coordinates forbid. @return false: all of it
  bool cut(SearchBox& box) const;
  /// Keeps the limits that forbid something in the box for lower(). @return false: one forbids all of it
  bool leave(const SearchBox& box);
  /// Adds multiples of the kept limits to a bound of what is feasible, until it is `enough` or they do not help.
  /// @param divisor  weighted: what the bound was divided by
  /// @return false: nothing in the box is feasible
  bool lower(const SearchBox& box, const BoxTensor& divisor, double enough, BoxTensor& bound);
  /// Axis for a box with a forbidden middle: its feasible part may be smaller than its bound, so it is halved along
  /// the axis of the most varied limit if it is wider there than along its own.
  void take_turn(SearchBox& box) const;
  /// True if all limits hold at values of the axes.
  bool allow(std::span<const double> values, HarmonicForm::Evaluator& evaluator);

 private:
  struct KeptLimit {
    std::vector<double> coefficients;  ///< of the limit as a harmonic function, raised by its error
    double most = 0.0;                 ///< see BoxTensor::put()
    BoxTensor on_box;
    bool used = false;
  };
  /// A line in s that root √s does not exceed anywhere in the box: constant and slope.
  std::pair<double, double> line_above(const NecessaryLimits::OfPoints& limit, const SearchBox& box);
  void put_together(const NecessaryLimits::OfPoints& limit, const SearchBox& box, KeptLimit& kept);
  /// Axis along which the kept limit varies most that is lowest in the box, as a share of its range; −1: none is kept.
  int most_varied() const;
  /// The kept limit that is lowest where the bound is largest, null if none is below 0 there.
  KeptLimit* lowest_at_top(const BoxTensor& bound);

  const HarmonicLimits& limits_;
  std::vector<KeptLimit> kept_;
  std::size_t count_ = 0;  ///< of kept_ that are of this box
  BoxTensor square_, full_;
  std::vector<double> values_;
};

}  // namespace posewright
