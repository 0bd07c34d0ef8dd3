#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "posewright/formats/pose_formats.hpp"

/// Text tables of numbers.
namespace posewright::formats {

struct NumberRow {
  int line = 0;
  std::vector<double> values;
};

/// Lines of numbers between separators; empty lines and comments ('#') are passed over. A first line that holds no
/// number is a header if that is allowed. All rows are as long.
/// @param skip  leading cells of a row that are texts
/// Throws InputError with file and line.
std::vector<NumberRow> read_number_rows(const std::string& bytes, const std::string& file, char separator, bool header,
                                        std::size_t skip = 0);

/// A finite number, all of `text`; false otherwise.
bool parse_number(std::string_view text, double& value);

}  // namespace posewright::formats
