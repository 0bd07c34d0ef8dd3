#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/blocks/parameter.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/random.hpp"

namespace posewright {

/// The free columns of one variant in design order: nuisance first, then interest, each in the model's order (interest
/// in the order the variant lists them). The only place that puts columns in order.
struct VariantColumns {
  std::string name;
  bool automatic = false;             ///< still to be reduced to an irreducible subset
  std::vector<int> selected;          ///< indices into the model's parameters()
  std::vector<Parameter> parameters;  ///< labels: the user's names, roles and tolerances
  std::vector<int> tiers;             ///< preference of identifiability()
  int nuisance = 0;                   ///< how many lead
};

/// Resolves names, globs, roles and tolerances of a variant. Throws InputError for a pattern that matches nothing
/// (naming some that exist) and for a tolerance in a unit that none of the matched parameters has.
VariantColumns select_columns(const IdentificationModel& model, const ProblemVariant& variant);

/// Parameters under `fixed` of the variant, as indices of the catalogue.
std::vector<int> fixed_parameters(const IdentificationModel& model, const ProblemVariant& variant);

/// Sets the nominal values that the variant names. Throws InputError as select_columns() does.
void apply_nominal(IdentificationModel& model, const ProblemVariant& variant);

/// For every column the value of the last pattern that matches its name, if any. Throws InputError as
/// select_columns() does.
std::vector<std::optional<double>> values_by_pattern(const VariantColumns& columns,
                                                     const std::vector<PatternValue>& values, const ProblemFile& file,
                                                     const char* what);

/// Columns whose name this shell-style pattern with * and ? matches, ascending.
std::vector<int> columns_named(const VariantColumns& columns, const std::string& pattern);

/// The columns that `kept` (ascending indices into columns) names.
VariantColumns subset(const VariantColumns& columns, const std::vector<int>& kept);

/// ξ − nominal of every parameter of a model of so many, for a robot drawn from the tolerances: a normal error of one
/// tolerance (1σ) in each column, independent; zero elsewhere.
std::vector<double> drawn_correction(const VariantColumns& columns, std::size_t parameters, Random& random);

/// 1σ of every column before anything is measured, SI.
Eigen::VectorXd tolerances_of(const VariantColumns& columns);

/// The variant called `name`, or the one the design block names, or the first. Throws InputError for an unknown name.
const VariantSpec& find_variant(const Problem& problem, const std::string& name);

}  // namespace posewright
