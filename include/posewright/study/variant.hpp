#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "posewright/cell/cell.hpp"
#include "posewright/criterion/criterion_data.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/model/unmodelled_effect.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/study/accuracy_points.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/workspace/workspace.hpp"

namespace posewright {

/// One variant of a problem with all that its names mean: the robot, where it may go, the parameters that are
/// estimated. Every command works with it.
struct Variant {
  const Problem* problem = nullptr;   ///< that must outlive it
  const VariantSpec* spec = nullptr;  ///< of the problem
  std::shared_ptr<const Cell> cell;
  std::unique_ptr<IdentificationModel> model;
  std::unique_ptr<Workspace> workspace;
  std::vector<std::string> kept_parameters{};  ///< as RunOptions
  VariantColumns columns{};                    ///< that are estimated, nuisance first
  std::vector<Parameter> dropped{};    ///< of an automatic variant: what cannot be identified beside the columns
  std::vector<std::string> reasons{};  ///< one equation per dropped parameter
  double weight = 1.0;                 ///< for criteria over several variants
  Eigen::VectorXd scale{};             ///< unit of every column, by the scaling asked for
  std::vector<TestPoint> test_points{};
  std::vector<TestPlace> test_places{};              ///< of the same
  std::shared_ptr<const UnmodelledEffect> effect{};  ///< that the model lacks; null: none is stated
  std::shared_ptr<const EffectFeatures> features{};  ///< of it, among the candidates
  /// Raw information known before of the columns of a search (tolerances, poses measured already, the size of an
  /// effect); empty: none.
  Eigen::MatrixXd prior{};
  bool nuisance_counts = false;  ///< in searches, as RunOptions have it
  bool known_before = false;     ///< whether it says something of the parameters
  std::string why_not{};         ///< why its parameters cannot be identified; empty: they can
};

/// Robot and workspace of one variant, as the cell lets it be; no columns yet. Blocks of the model count visible
/// targets only, if line of sight is asked for.
Variant place_variant(const ProblemVariant& of, const std::shared_ptr<const Cell>& cell,
                      const Monitor& monitor = Monitor());

/// Columns that the variant names, before any is found inseparable. Throws as select_columns().
VariantColumns all_columns(const Variant& variant);

/// Coordinates for reading lists of poses of a problem: names, units, limits and labels of a variant's coordinates
/// (empty: the first). Throws as place_variant().
std::vector<Coordinate> pose_coordinates(const Problem& problem, const std::string& variant = "");

struct VariantOptions {
  std::string variant;                  ///< empty = as in the file
  std::vector<std::string> parameters;  ///< columns to keep, by name; empty = all that can be identified
  int candidates = default_candidates;  ///< that decide which columns of an `auto` variant can be identified
  std::uint64_t seed = 0;
  int threads = 0;
};

/// One variant ready to give Jacobian blocks at any configuration. For `auto` variants the columns are those of a plan
/// from as many candidates and the same seed; others keep all they list. Throws InputError as the stages do, also for
/// names that are no columns.
Variant make_variant(const Problem& problem, const VariantOptions& options, const Monitor& monitor);

}  // namespace posewright
