#pragma once

#include <deque>
#include <memory>
#include <string>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/criterion_data.hpp"
#include "posewright/criterion/observability_indices.hpp"

namespace posewright {

/// One row a criterion: name for users, objective, needed data. No other code knows a criterion's name.
struct CriterionEntry {
  std::string name;
  std::string summary;
  /// Throws CannotDo if needed data are missing.
  std::unique_ptr<Criterion> (*make)(const CriterionData& data);
  /// Φ of a design in the criterion's own terms (docs/plan-file.md); `indices` are those of the same design.
  double (*shown)(double phi, const ObservabilityIndices& indices);
  bool determinant = false;       ///< Φ is `log_det` of a plan
  bool scaled = false;            ///< Φ depends on the scale of the columns
  bool several_variants = false;  ///< needs CriterionData::variants
  bool needs_test_poses = false;  ///< needs CriterionData::test_points
  bool needs_truth = false;       ///< needs CriterionData::effects
  bool needs_residual = false;    ///< needs more readings than there are parameters
  bool accuracy = false;          ///< if there are test poses, the shown value is −(squared position error, m²)
};

/// Forms of `shown` of a row: Φ itself, e^Φ, −e^{−Φ} (Φ = −ln of a variance).
double shown_phi(double phi, const ObservabilityIndices&);
double shown_exponential(double phi, const ObservabilityIndices&);
double shown_variance(double phi, const ObservabilityIndices&);

/// References to its rows stay valid.
const std::deque<CriterionEntry>& criterion_registry();
/// One row more, for programs that bring a criterion of their own; before the first search, by one thread.
/// Throws std::invalid_argument if the name is taken or a function is missing.
void register_criterion(CriterionEntry entry);
/// nullptr if no criterion has that name.
const CriterionEntry* find_criterion(const std::string& name);
/// nullptr if no criterion has that name.
std::unique_ptr<Criterion> make_criterion(const std::string& name, const CriterionData& data);
/// "o1, …": for messages with the allowed values.
std::string criterion_names();
/// "o1 or ds": those whose Φ is the determinant.
std::string determinant_names();

}  // namespace posewright
