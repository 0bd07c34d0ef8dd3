#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "posewright/problem/problem.hpp"

namespace posewright {

/// Pairs of links that an SRDF file lets touch. Throws InputError with its line, at `place` if there is no such file.
std::vector<std::pair<std::string, std::string>> read_srdf_pairs(const std::filesystem::path& file,
                                                                 const SourcePlace& place);

/// A group of an SRDF file: a chain, or joints of one branch.
struct SrdfGroup {
  std::string base, tip;            ///< links of <chain>; empty: joints are listed
  std::vector<std::string> joints;  ///< of <joint>, in the file's order
  SourcePlace place;
};
/// @param name  of the group; one that is made of one other group is that one
/// Throws InputError at the name's line for one that the file does not have, and for groups of links or several chains.
SrdfGroup read_srdf_group(const std::filesystem::path& file, const Located<std::string>& name,
                          const SourcePlace& place);

}  // namespace posewright
