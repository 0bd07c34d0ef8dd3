#pragma once

#include <string>
#include <vector>

#include "posewright/lists/pose_document.hpp"

// What the documents of all formats share.

namespace posewright {

/// Coordinates that a robot moves, in their order.
std::vector<std::size_t> moving(const std::vector<Coordinate>& coordinates);
/// For each name its place among the coordinates.
std::vector<std::size_t> places_of(const std::vector<std::string>& names, const std::vector<Coordinate>& coordinates);
[[noreturn]] void refuse_twice(const std::string& file);

/// A list in CSV: cells of joints are replaced; comments, other columns and line ends stay.
std::unique_ptr<PoseDocument> csv_document(std::string bytes, const std::string& name,
                                           const std::vector<Coordinate>& coordinates);
/// The points of a program.
std::unique_ptr<PoseDocument> program_document(std::unique_ptr<ProgramDocument> program,
                                               const std::vector<Coordinate>& coordinates,
                                               const DocumentOptions& options);

}  // namespace posewright
