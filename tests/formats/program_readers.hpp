#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

/// Small readers of robot programs, written from the formats' descriptions: every line must be one that the format
/// knows. They throw std::runtime_error with the line that is none.
namespace posewright::readers {

struct Program {
  std::vector<std::vector<double>> moves;  ///< in order, in the controller's units and order of axes
  std::vector<std::size_t> measured;       ///< moves after which the instrument is told to measure
  std::vector<std::size_t> stops;          ///< moves after which a person is waited for (0: before the first)
  std::vector<std::string> comments, messages;
  std::set<std::string> tools;  ///< named by moves, where the language names them
  /// What it says the robot carries before its first move: number of a payload schedule; kg, m, m, m.
  std::vector<double> load;
};

Program read_krl(const std::string& source, const std::string& data, const std::string& name);
Program read_rapid(const std::string& module);
Program read_tp(const std::string& listing);
Program read_urscript(const std::string& script);
Program read_inform(const std::string& job);
/// @param files  by their names in the application's folder
Program read_val3(const std::map<std::string, std::string>& files, const std::string& name);
/// X, Y, Z, U, V, W.
Program read_gcs(const std::string& commands);

}  // namespace posewright::readers
