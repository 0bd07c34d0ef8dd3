#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/model/harmonic_parts.hpp"
#include "posewright/model/identification_model.hpp"

namespace posewright {

/// Rows whose squares, times factors, sum to no less than a model's information at every configuration (theory.md eq.
/// (39)): JᵀJ ⪯ Σ_k s_k(r_k) B_kᵀB_k, with equality where nothing is random but the instrument.
class HarmonicRows {
 public:
  virtual ~HarmonicRows() = default;

  const std::vector<HarmonicPart>& parts() const { return parts_; }
  /// Factors of the columns.
  const std::vector<ColumnFactor>& factors() const { return factors_; }
  /// Degree of the columns in each coordinate of the model; 0 for choices.
  const std::vector<int>& degrees() const { return degrees_; }
  /// Distances that factors of parts depend on.
  int distances() const { return distances_; }
  /// Largest deviation of each from the mean of all; empty: not known.
  const std::vector<DistanceSpread>& spreads() const { return spreads_; }
  /// Each column of the parts may be off by a vector of at most this length; empty: by none.
  const std::vector<double>& remainders() const { return remainders_; }

  /// Adapts free choices so that the bound is near d at these configurations.
  virtual void tune(const std::vector<std::vector<double>>& configurations, std::span<const double> weights) = 0;

  /// Work space of one thread.
  class Work {
   public:
    virtual ~Work() = default;
  };
  virtual std::unique_ptr<Work> work() const = 0;
  /// Rows of all parts, one part after the other, and squares of the distances (m²).
  /// @param factors  the value of each, in place of that at q
  /// @return false if q is out of reach
  virtual bool at(std::span<const double> q, std::span<const double> factors, Work& work, BlockArray::RowMatrix& B,
                  std::span<double> squares) const = 0;

 protected:
  std::vector<HarmonicPart> parts_;
  std::vector<ColumnFactor> factors_;
  std::vector<int> degrees_;
  int distances_ = 0;
  std::vector<DistanceSpread> spreads_;
  std::vector<double> remainders_;
};

/// Rows of a model's columns over boxes of its coordinates, with the choices of q. Every target counts as seen, which
/// only adds information. They refer to the model.
/// @param why_not  reason, if no bound is known and null is returned
std::unique_ptr<HarmonicRows> harmonic_rows(const IdentificationModel& model, std::span<const double> q,
                                            std::span<const int> selected, std::string& why_not);

/// Variant without the remainders of its rows (HarmonicRows::remainders()), which are left to the caller.
std::unique_ptr<HarmonicRows> harmonic_expansion(const IdentificationModel& model, std::span<const double> q,
                                                 std::span<const int> selected, std::string& why_not);

/// Rows whose columns may be off by their remainders as rows that bound the sensitivity all the same (theory.md eq.
/// (55)). One part of constant noise is what they may have.
std::unique_ptr<HarmonicRows> with_remainders(std::unique_ptr<HarmonicRows> inside);

/// Difference of two readings at the same configuration with the same constant noise: rows of one less those of
/// the other.
std::unique_ptr<HarmonicRows> harmonic_difference(std::unique_ptr<HarmonicRows> one,
                                                  std::unique_ptr<HarmonicRows> other);

/// The factor at a coordinate's value.
double value_of(const ColumnFactor& factor, double x);

}  // namespace posewright
