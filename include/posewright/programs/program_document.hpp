#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "posewright/controller/controller_settings.hpp"

namespace posewright {

/// What becomes of a motion or a point of a program.
enum class Treatment {
  compensated,
  left,             ///< on purpose: relative, with an offset, an operand, home, moved to by nothing
  not_compensated,  ///< understood, and cannot be compensated
  not_understood    ///< moves to what only the controller computes, or is written in a way that is not read
};

struct ProgramEntry {
  int line = 0;
  std::string what;  ///< the instruction and its point, or the point
  Treatment treatment = Treatment::left;
  std::string why;  ///< empty: it is compensated
  int point = -1;   ///< index among the document's points; -1: none
};

/// Every motion and every point of a program, in the order of the file.
struct ProgramAccount {
  std::string file, format;
  std::vector<ProgramEntry> entries;
  std::size_t count(Treatment treatment) const;
};

/// A program's text with what is to be known of it.
struct ProgramFile {
  std::string format;  ///< as `export` calls it: kuka-krl, abb-rapid, fanuc-tp, urscript, yaskawa-inform, staubli-val3,
                       ///< joint-trajectory
  std::string text, name;
  bool context = false;  ///< read for its motions alone: it is not written
};

/// The robot that a program moves.
struct ProgramRobot {
  std::vector<std::string> names, units;  ///< of its joints; rad or m
  ControllerSettings settings{};
  std::optional<double> coupling{};  ///< overrules that of the settings
};

/// A robot program: its account, the points that are compensated, and the text with other values for them. Everything
/// else of the program stays as it is, byte for byte.
class ProgramDocument {
 public:
  struct Point {
    int line = 0;
    std::string name;            ///< as the program calls it; empty: it has none
    std::vector<double> joints;  ///< SI, the robot's signs and zeros
  };

  virtual ~ProgramDocument() = default;
  virtual const ProgramAccount& account() const = 0;
  /// Those that are to be compensated.
  virtual const std::vector<Point>& points() const = 0;
  /// @param joints  one a point; none: it stays as it is
  /// @param remark  put into a comment where a point has other values
  /// Throws CannotDo for an axis beyond the range that the settings give it.
  virtual std::string text(const std::vector<std::optional<std::vector<double>>>& joints,
                           const std::string& remark) const = 0;
};

/// Reads programs that belong together: motions of one use points of another. One document for each file that is no
/// context. Throws InputError with file and line for a text that is no program and for settings that are missing.
std::vector<std::unique_ptr<ProgramDocument>> read_programs(const std::vector<ProgramFile>& files,
                                                            const ProgramRobot& robot);

/// Whether a format is that of a program.
bool is_program_format(const std::string& format);
/// Format by the ending of a file's name; empty: it is no program's.
std::string program_format_of_ending(std::string_view ending);

}  // namespace posewright
