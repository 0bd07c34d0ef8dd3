#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "command.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright::cli {

/// -o, --poses-csv (if there are configurations), --force, --time-limit.
po::options_description output_options(bool poses);

/// The file that an output option names: `standard` if it is not given, empty for "-". InputError for an empty name.
std::filesystem::path output_file(const po::variables_map& values, const std::string& option,
                                  const char* standard = "-");
/// check_outputs of those that are not empty, with --force.
void check_output_files(const po::variables_map& values, const std::vector<std::filesystem::path>& outputs,
                        const std::vector<std::filesystem::path>& inputs);
/// Folders of files that are missing, made, and removed again in the end where they got no files.
class NewFolders {
 public:
  explicit NewFolders(const std::vector<std::filesystem::path>& files);
  ~NewFolders();
  NewFolders(const NewFolders&) = delete;
  NewFolders& operator=(const NewFolders&) = delete;

 private:
  std::vector<std::filesystem::path> missing_;  // innermost first
};
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

/// Refuses to write over anything that is not an earlier result of this program, unless forced, and over what this
/// program has read, always. Earlier results are known by how they begin; a CSV, which begins as a list with somebody's
/// readings would, only if the plan or route beside it lists it with the same sha256. Call before the search.
/// Throws CannotDo naming the file, InputError if two outputs or an input and an output are the same file.
void check_outputs(const std::vector<std::filesystem::path>& outputs, const std::vector<std::filesystem::path>& inputs,
                   bool force);

/// True if a file has these bytes already, or begins with them; false if it is not there. It does not become an input.
bool begins_with(const std::filesystem::path& file, const std::string& bytes);
bool holds(const std::filesystem::path& file, const std::string& bytes);

/// Record of a plan or route about the other files of its set: names seen from its folder, and contents.
std::vector<WrittenWith> written_with(const std::filesystem::path& main, const std::vector<FileToWrite>& others);

/// write_files() of a command's results, the main one last. What cannot be written where it was asked for is saved in
/// a new folder for temporary files.
/// Throws CannotDo that says what failed and where the results are.
void write_results(const std::vector<FileToWrite>& files);

/// "; saved as plan.json, poses.csv": files that write_results() has written in this run, for an error after that;
/// empty if there are none.
std::string saved_before();

}  // namespace posewright::cli
