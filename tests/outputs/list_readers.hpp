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

/// By the names of the formats; the number of joints is what a format that does not tell it needs.
const std::map<std::string, std::function<List(const std::string& bytes, std::size_t joints)>>& list_readers();

}  // namespace posewright::readers
