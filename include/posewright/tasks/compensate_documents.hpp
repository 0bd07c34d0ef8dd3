#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "posewright/lists/pose_document.hpp"
#include "posewright/model/dh_table.hpp"
#include "posewright/tasks/compensate_problem.hpp"

namespace posewright {

/// Options of `compensate`, and how its files are read.
struct CompensateCall : CompensateOptions {
  DocumentOptions reading{};
  bool partial = false;                    ///< files even if some poses or lines are not compensated
  std::optional<double> line_deviation{};  ///< m that the tool may leave straight lines of programs by
  std::optional<DhConvention> dh{};
};

struct CompensatedDocuments {
  Compensation result;
  bool good = true;                ///< the texts may be written
  std::vector<std::string> texts;  ///< of the files, with the joints to command; empty unless `good`
};

/// Poses of files, lists or robot programs, compensated: compensate_problem() and the same files with other values.
CompensatedDocuments compensate_documents(const Problem& problem, const std::vector<std::filesystem::path>& files,
                                          const CompensateCall& call, const Monitor& monitor);

}  // namespace posewright
