#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "posewright/lists/pose_list.hpp"
#include "posewright/model/calibrated_values.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/key_edit.hpp"

namespace posewright {

/// Bytes of the largest plan or route that is read.
inline constexpr std::size_t plan_size_limit = 200'000'000;

/// Parameters of a problem, as stated in a plan.
ParametersFile parameters_of(const Problem& problem);

/// Parameters of a plan, route or evaluation; the file as found from here or from
/// the plan's folder. Empty if it states none or is no such file.
/// Throws InputError if the file is not there.
ParametersFile parameters_of_plan(const std::filesystem::path& plan);
/// Keys that a plan or route was made with in place of the file's (Problem::changed); empty: it states none.
KeyEdits edits_of_plan(const std::filesystem::path& plan);

/// Note for the user if the plan `name` was made at other parameters than the problem's; else empty.
std::string parameters_note(const std::string& name, const ParametersFile& made_at, const ParametersFile& now);
/// Variant for a list, added to `notes`; a list without a problem gives no note.
void note_parameters(const PoseList& list, const ParametersFile& now, std::vector<std::string>& notes);

/// A calibrated parameter and its 1σ, SI, where it was estimated.
struct EstimatedValue {
  CalibratedValue value;
  std::optional<double> sigma;
};

/// Text of a parameters file (docs/parameters-file.md): all that were estimated or are not nominal, values to the last
/// digit. Equal input gives equal bytes.
std::string parameters_yaml(const ProblemVariant& variant, const std::vector<EstimatedValue>& values,
                            const std::optional<CalibratedEffect>& unmodelled = std::nullopt);

}  // namespace posewright
