#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

/// Readers of pose lists, written from the formats' descriptions; they share nothing with the writers.
namespace posewright::readers {

struct List {
  std::vector<std::string> names;         ///< empty where the format has none
  std::vector<std::vector<double>> rows;  ///< rad, m
};

/// Cells between separators, numbers only, from line `lines` on; `skip` cells in front of each line are passed over.
std::vector<std::vector<double>> table(const std::string& text, char separator, int lines, std::size_t skip);

/// By the names of the formats; the number of joints is what a format that does not tell it needs.
const std::map<std::string, std::function<List(const std::string& bytes, std::size_t joints)>>& list_readers();

}  // namespace posewright::readers
