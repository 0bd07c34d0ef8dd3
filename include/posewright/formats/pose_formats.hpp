#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "posewright/controller/controller_settings.hpp"
#include "posewright/formats/pose_sequence.hpp"

namespace posewright {

/// Percent of full speed at which programs move unless the user asks for another.
inline constexpr double usual_percent = 10.0;

/// Options of the command line; empty: the format's default.
struct ExportOptions {
  std::optional<double> speed;     ///< percent
  std::optional<double> settle;    ///< s before each measurement
  std::optional<double> wait;      ///< s for a measurement, instead of an input
  std::optional<double> coupling;  ///< as in ControllerSettings, which it overrules
  std::string digital_output, digital_input, name, group;
  std::string tool;     ///< number, or name of the tooldata for abb-rapid
  std::string payload;  ///< number of a payload schedule for fanuc-tp; "KG" or "KG,X,Y,Z" (kg, m) for urscript
  std::string station;  ///< whose targets are listed; empty: of the only one, or of all
  std::optional<int> base;
  ControllerSettings controller;
};

struct ExportedFile {
  std::string name;  ///< relative to where the result goes, maybe in a folder
  std::string bytes;
};

struct Exported {
  std::vector<ExportedFile> files;
  std::vector<std::string> notes;  ///< what the user must know
};

/// A cell of a pose list: a number in the column's unit, or a text (load case, station, number with its unit).
using PoseCell = std::variant<double, std::string>;

struct PoseRow {
  int line = 0;  ///< 0: not known
  std::vector<PoseCell> cells;
  int id = 0;             ///< 0: by order
  bool measured = false;  ///< of a plan: was there before
};

/// A unit that depends on what the column is: degrees of a joint that turns, millimetres of one that slides.
inline constexpr const char* degrees_or_millimetres = "deg/mm";

/// A pose list as a file has it, before it is known which robot it is for.
struct PoseTable {
  std::vector<std::string> names;  ///< of columns; empty: the coordinates in their order
  std::vector<std::string>
      units;  ///< of columns, empty text: SI; degrees_or_millimetres; else a unit of the problem file
  std::vector<PoseRow> rows;
  int header = 0;                ///< line of the names; 0: not known
  std::string problem_sha256{};  ///< of the problem it was made for; empty: not known
  ParametersFile parameters_file{};
};

/// One row a format.
struct PoseFormat {
  std::string name{}, description{}, used_by{}, extension{};
  std::string needs{};  ///< beside six or any joints; empty: nothing
  Exported (*write)(const PoseSequence& sequence, const ExportOptions& options) = nullptr;
  PoseTable (*read)(const std::string& bytes, const std::string& file) = nullptr;  ///< null: it is not read back
  std::vector<std::string> options{};  ///< of the command line that the writer reads
  bool controller = false;             ///< a program: syntax checked, not run on a controller
  bool several_files = false;
  bool ending_matters = false;   ///< whoever reads it goes by the ending of the file's name
  bool to_be_filled = false;     ///< users put what they measured into the file
  bool any_coordinates = false;  ///< has a place for a platform's coordinates and for pairs of configurations
  bool timed = false;            ///< a trajectory that a robot follows as it is, controller or not

  /// True if a robot moves by it, so that every value is checked first.
  bool moves_robot() const { return controller || timed; }
};

const std::vector<PoseFormat>& pose_formats();
/// Throws InputError naming all formats.
const PoseFormat& find_pose_format(const std::string& name);
/// Names of formats that can be read.
/// @param others  names that the caller knows beside them, for the message
const PoseFormat& find_readable_format(const std::string& name, const std::string& others = "");
std::string readable_format_names();

/// Output of the format's writer. Throws CannotDo if the format is for joints and the plan's coordinates are those
/// of a platform or of pairs of configurations; else as the writer.
Exported export_poses(const PoseFormat& format, const PoseSequence& sequence, const ExportOptions& options);

/// A plan's or a route's poses as a list, load case and station in columns of that name.
PoseTable table_of(const PoseSequence& sequence);
/// CSV with a header of names, maybe with units ("joint_1 [deg]"); comments begin with '#'. Throws InputError.
PoseTable read_csv_table(const std::string& bytes, const std::string& file);
/// Cells of a CSV line (RFC 4180 quotes), without blanks around them.
std::vector<std::string> csv_cells(const std::string& line);

/// In every exported text that may hold a comment: what tells our files from others.
inline constexpr std::string_view export_mark = "Written by posewright";

}  // namespace posewright
