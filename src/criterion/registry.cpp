#include "posewright/criterion/registry.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "posewright/criterion/determinant.hpp"
#include "posewright/criterion/effect_criteria.hpp"
#include "posewright/criterion/multi_variant.hpp"
#include "posewright/criterion/spectral.hpp"
#include "posewright/criterion/trace.hpp"

namespace posewright {
namespace {

using Made = std::unique_ptr<Criterion>;

template <SpectralIndex index>
Made spectral(const CriterionData& data) {
  return make_spectral_criterion(index, data);
}

template <char name>
Made determinant(const CriterionData& data) {
  return std::make_unique<DeterminantCriterion>(name == 'o' ? "o1" : "ds", data.nuisance, int(data.R.cols()));
}

/// From the factor of the blocks: Φ, from their products, has half as many digits if the matrix is ill-conditioned.
template <double ObservabilityIndices::*index>
double shown_index(double, const ObservabilityIndices& indices) {
  return indices.*index;
}

std::deque<CriterionEntry> make_table() {
  return {
      {.name = "o1",
       .summary = "log det of the information (D-optimality); nuisance parameters eliminated",
       .make = determinant<'o'>,
       .shown = shown_index<&ObservabilityIndices::o1>,
       .determinant = true},
      {.name = "ds",
       .summary = "the same by the name D_s-optimality",
       .make = determinant<'d'>,
       .shown = shown_phi,
       .determinant = true},
      {.name = "a",
       .summary = "least sum of the variances in units of the scale (A-optimality)",
       .make = [](const CriterionData& data) -> Made {
         return std::make_unique<TraceCriterion>("a", variance_rows(data));
       },
       .shown = shown_variance,
       .scaled = true},
      {.name = "o2",
       .summary = "inverse condition number, smallest over largest singular value",
       .make = spectral<SpectralIndex::o2>,
       .shown = shown_index<&ObservabilityIndices::o2>,
       .scaled = true},
      {.name = "o3",
       .summary = "smallest singular value (E-optimality)",
       .make = spectral<SpectralIndex::o3>,
       .shown = shown_index<&ObservabilityIndices::o3>,
       .scaled = true},
      {.name = "o4",
       .summary = "noise amplification index, smallest squared over largest",
       .make = spectral<SpectralIndex::o4>,
       .shown = shown_index<&ObservabilityIndices::o4>,
       .scaled = true},
      {.name = "o5",
       .summary = "harmonic sum of the singular values",
       .make = spectral<SpectralIndex::o5>,
       .shown = shown_index<&ObservabilityIndices::o5>,
       .scaled = true},
      {.name = "test_pose",
       .summary = "accuracy after compensation at the test poses, mean square",
       .make = [](const CriterionData& data) -> Made {
         return std::make_unique<TraceCriterion>("test_pose", test_point_rows(data));
       },
       .shown = shown_variance,
       .needs_test_poses = true,
       .accuracy = true},
      {.name = "test_pose_max",
       .summary = "the same at the worst test pose (G-optimality)",
       .make = make_worst_test_point_criterion,
       .shown = shown_variance,
       .needs_test_poses = true,
       .accuracy = true},
      {.name = "compound",
       .summary = "weighted mean of the log-efficiencies of several variants",
       .make = make_compound_criterion,
       .shown = shown_phi,
       .several_variants = true},
      {.name = "maximin",
       .summary = "efficiency of the variant that the plan serves worst",
       .make = make_maximin_criterion,
       .shown = shown_exponential,
       .several_variants = true},
      {.name = "discriminate",
       .summary = "effects of the truth that the fitted variant cannot imitate (T-optimality)",
       .make = make_discriminate_criterion,
       .shown = shown_exponential,
       .needs_truth = true,
       .needs_residual = true},
      {.name = "bias",
       .summary = "variance and squared bias by effects of the truth that are not fitted (minimal aliasing)",
       .make = make_bias_criterion,
       .shown = shown_variance,
       .scaled = true,
       .needs_truth = true,
       .accuracy = true},
  };
}

std::deque<CriterionEntry>& table() {
  static std::deque<CriterionEntry> rows = make_table();
  return rows;
}

}  // namespace

double shown_phi(double phi, const ObservabilityIndices&) { return phi; }
double shown_exponential(double phi, const ObservabilityIndices&) { return std::exp(phi); }
double shown_variance(double phi, const ObservabilityIndices&) { return -std::exp(-phi); }

const std::deque<CriterionEntry>& criterion_registry() { return table(); }

void register_criterion(CriterionEntry entry) {
  if (find_criterion(entry.name) != nullptr)
    throw std::invalid_argument("there is a criterion '" + entry.name + "' already");
  if (entry.make == nullptr || entry.shown == nullptr)
    throw std::invalid_argument("criterion '" + entry.name + "' lacks make or shown");
  table().push_back(std::move(entry));
}

const CriterionEntry* find_criterion(const std::string& name) {
  for (const CriterionEntry& entry : criterion_registry())
    if (entry.name == name) return &entry;
  return nullptr;
}

std::unique_ptr<Criterion> make_criterion(const std::string& name, const CriterionData& data) {
  const CriterionEntry* entry = find_criterion(name);
  return entry == nullptr ? nullptr : entry->make(data);
}

std::string criterion_names() {
  std::string names;
  for (const CriterionEntry& entry : criterion_registry()) names += (names.empty() ? "" : ", ") + entry.name;
  return names;
}

std::string determinant_names() {
  std::string names;
  for (const CriterionEntry& entry : criterion_registry())
    if (entry.determinant) names += (names.empty() ? "" : " or ") + entry.name;
  return names;
}

}  // namespace posewright
