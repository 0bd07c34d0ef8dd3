#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "command.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/plan.hpp"
#include "session.hpp"

namespace posewright::cli {

/// -o, --poses-csv (if there are configurations), --force, --time-limit.
po::options_description output_options(bool poses);

/// The file that an output option names: `standard` if it is not given, empty for "-". InputError for an empty name.
std::filesystem::path output_file(const po::variables_map& values, const std::string& option, const char* standard);
/// check_outputs of those that are not empty, with --force.
void check_output_files(const po::variables_map& values, const std::vector<std::filesystem::path>& outputs,
                        const std::vector<std::filesystem::path>& inputs);
/// "Written: a, b" with a line end; empty if none of them is named.
std::string written_text(const std::vector<std::filesystem::path>& outputs);

/// Output of a plan: files, and the table or JSON on stdout.
class Outputs {
 public:
  /// Checks the files before any search. Throws CannotDo or InputError.
  /// @param validation  a second plan comes with it, in files named like those of the plan with -validation
  Outputs(const po::variables_map& values, const std::vector<std::filesystem::path>& inputs, bool poses,
          bool validation = false);
  /// Runs the search under a Watch, writes everything, returns the exit code.
  int search_and_write(const CommonOptions& common, double seconds, const std::function<Plan(const Monitor&)>& search,
                       const std::function<Plan(const Plan&, const Monitor&)>& validation = {},
                       TaskEngine* engine = nullptr) const;

 private:
  /// Returns the plan as JSON.
  static std::string write(const Plan& plan, const std::filesystem::path& json, const std::filesystem::path& csv);

  std::filesystem::path plan_, poses_;                        ///< empty = not asked for
  std::filesystem::path validation_plan_, validation_poses_;  ///< the same of the second plan
};

}  // namespace posewright::cli
