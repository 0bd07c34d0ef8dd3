#pragma once

#include <string>
#include <vector>

#include "posewright/formats/pose_formats.hpp"

/// Common parts of all robot programs: the order of moves, measurements and stops, and joint values as a controller
/// counts them.
namespace posewright::formats {

/// Seconds that a robot stands before it is measured, where nobody says otherwise.
inline constexpr double default_settle = 2.0;

/// Differences between controllers.
struct ProgramRules {
  const char* format = "";
  const char* default_name = "CALPOSES";
  std::size_t longest_name = 32;
  bool capitals = false;                  ///< names are in capital letters
  std::vector<std::string> axes;          ///< six that turn, then what else there may be
  std::vector<std::string> settings;      ///< keys of the settings file that are read
  const char* coupling_needed = nullptr;  ///< why it has no default; null: 0
  const char* signs_needed = nullptr;     ///< why sign and zero_deg have none; null: +1, 0
  int decimals = 4;
  const char *pose = "P", *via = "V", *home = "H";  ///< what names of points begin with
};

struct ProgramPoint {
  std::string name;
  std::vector<double> axes;  ///< deg, mm, in the order of RobotProgram::axes
};

struct ProgramStep {
  enum class Kind { move, measure, stop };
  Kind kind = Kind::move;
  std::string comment;                ///< before it; may be empty
  std::size_t point = 0;              ///< of a move
  std::vector<std::string> messages;  ///< of a stop: what a person is to do
};

struct RobotProgram {
  std::string name;
  std::vector<std::string> axes;  ///< of each value of a point
  std::vector<bool> slides;       ///< which of them are in mm
  std::vector<ProgramPoint> points;
  std::vector<ProgramStep> steps;
  double speed = 10.0;         ///< percent
  double settle = 2.0;         ///< s
  std::optional<double> wait;  ///< s; none: an input is waited for
  int decimals = 4;
  int number = 0;  ///< of its points, for programs whose points are in another file
  std::vector<std::string> notes;
};

/// Throws InputError for names that the controller does not take and settings that are missing or not read, CannotDo
/// for robots that it cannot have.
RobotProgram make_program(const PoseSequence& sequence, const ExportOptions& options, const ProgramRules& rules);

/// A number of a digital signal, 1 if none is given.
int signal_number(const std::string& text, const char* option, int first, int last, int otherwise);
/// A name of a digital signal.
std::string signal_name(const std::string& text, const char* option, const char* otherwise);
/// The number of the tool whose load data the controller uses.
int tool_number(const ExportOptions& options, int otherwise);
/// The name of a tool's data, for controllers that call tools by names.
std::string tool_name(const ExportOptions& options, const char* otherwise);
/// Without poses that are measured already, and without zeros that are negative.
PoseSequence to_measure(const PoseSequence& sequence);
/// Refuses or notes data that a list cannot have: stations, load cases.
std::vector<std::string> list_notes(const PoseSequence& sequence);
/// One file of the format's usual name.
Exported one_file(const std::string& name, std::string bytes, std::vector<std::string> notes = {});
/// Throws CannotDo for poses that joints are to reach from a stated side and that no route leads to.
void require_arrivals(const PoseSequence& sequence);
/// True if station, load case or temperature change from one pose to the next.
bool has_changes(const PoseSequence& sequence);
/// Keys of the settings file that a format does not read are an error.
void allow_settings(const ControllerSettings& settings, const char* format, const std::vector<std::string>& keys);

}  // namespace posewright::formats
