#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

#include "posewright/problem/read_problem.hpp"

/// The problem files of examples/, for tests over all of them.
namespace posewright {

inline std::filesystem::path examples_folder() { return std::filesystem::path(POSEWRIGHT_SOURCE_DIR) / "examples"; }

inline Problem example(const std::string& file) { return read_problem(examples_folder() / file); }

/// Relative to the folder, sorted; without those of `cells`, whose robots are not among the sources (safety's stories).
inline std::vector<std::string> example_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(examples_folder()))
    if (entry.path().extension() == ".yaml" && entry.path().parent_path().filename() != "cells")
      files.push_back(std::filesystem::relative(entry.path(), examples_folder()).string());
  std::sort(files.begin(), files.end());
  return files;
}

/// A text as a name that a test may have.
inline std::string test_name(std::string text) {
  for (char& c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return text;
}

}  // namespace posewright
