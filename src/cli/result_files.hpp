#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "posewright/results/plan.hpp"
#include "posewright/support/file.hpp"

namespace posewright::cli {

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
