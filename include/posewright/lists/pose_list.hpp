#pragma once

#include <string>
#include <vector>

#include "posewright/blocks/parameter.hpp"
#include "posewright/model/identification_model.hpp"

namespace posewright {

/// Configurations as a user lists them, with a weight if the list has one.
struct PoseList {
  std::vector<std::vector<double>>
      configurations;                  ///< in the order of the problem's coordinates, SI; a choice as 0, 1, …
  std::vector<double> weights;         ///< as many, or none
  std::vector<bool> measured{};        ///< of a plan: which poses were there before it; else empty
  std::vector<int> ids{};              ///< of a plan or route; else 1, 2, …
  std::vector<int> lines{};            ///< of the file, 0: not known; empty for configurations in memory
  std::vector<int> own_ids{};          ///< of a column `id` or `pose`, 0: it is not a number; empty: there is none
  std::vector<std::string> marks{};    ///< cells of a column `fixed`; empty: there is none
  std::vector<std::string> columns{};  ///< names of all columns of the list
  std::vector<std::string> notes{};    ///< notes on the reading of the list, for the user
  std::string name{};                  ///< of the list, for messages: its file
  std::string problem_sha256{};        ///< of the problem it was made for; empty: not known
  ParametersFile parameters_file{};    ///< that it was made at
};

/// Throws InputError for a list that was read with coordinates of another number than these.
void require_fits(const PoseList& list, const std::vector<Coordinate>& coordinates);

/// Throws InputError for a list of more poses than a task takes whose time grows with their square.
void require_at_most(const PoseList& list, std::size_t most, const std::string& task);

/// Configurations in memory: one value for each coordinate, in their order; choices that have one label only may be
/// left out. Throws InputError for values that do not fit.
PoseList poses_given(const std::vector<std::vector<double>>& configurations,
                     const std::vector<Coordinate>& coordinates);

}  // namespace posewright
