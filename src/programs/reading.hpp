#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "expression.hpp"

namespace posewright::programs {

/// A number where a text has it; an expression of numbers counts as one.
struct TextNumber {
  std::size_t begin = 0, end = 0;
  double value = 0.0;
};

/// Values of a point by the names of its axes, as the program has them.
using AxisValues = std::vector<std::pair<std::string, TextNumber>>;

/// A tool or base as a program names it.
struct FrameName {
  std::string name{};                           ///< empty: the program does not say
  std::optional<std::vector<double>> values{};  ///< stated in place, as the language writes a pose
  bool operator==(const FrameName&) const = default;
};
struct FramePair {
  FrameName tool{}, base{};
  bool operator==(const FramePair&) const = default;
};

/// A heading with the status of the points below it.
struct StatusHeading {
  std::string text{};              ///< "///RCONF 1,0,0,0,0,0"
  std::size_t begin = 0, end = 0;  ///< of the point's own line
};

struct FoundPoint {
  enum class Form { joints, pose, unclear };
  int line = 0;
  std::string name{};  ///< empty: it stands in a motion
  Form form = Form::joints;
  AxisValues axes{};
  std::string why{};            ///< it is unclear
  FramePair frames{};           ///< where the point itself names them
  std::optional<long> index{};  ///< of an element of an array, as motions count them
  std::string label{};          ///< what people call it, where its name is a number
  StatusHeading heading{};      ///< where the status stands above it: its numbers have no place
};

/// Use of a point by a motion or another instruction.
enum class Role {
  pose,      ///< moves to it
  step,      ///< moves by it
  offset,    ///< moves to a place that is computed from it
  standing,  ///< moves to where the robot is
  passed,    ///< hands it to a procedure
  operand,   ///< computes with it
  changed,   ///< gives it another value
  other,     ///< moves, and to no point: velocities, external axes
  unclear    ///< moves to what only the controller computes
};

struct Use {
  int line = 0;
  std::string instruction;
  Role role = Role::pose;
  std::string name{};                  ///< of the point; empty: `point`, or none
  std::optional<std::size_t> point{};  ///< that stands in the instruction itself
  std::string why{};                   ///< for roles other and unclear
  FramePair frames{};
  std::optional<long> index{};          ///< of the element of an array, where it is a number
  bool straight = false;                ///< the tool moves along a line
  bool moves = true;                    ///< false: a name within an instruction that is listed by itself
  std::optional<std::size_t> before{};  ///< motion, among the uses, that surely ended where this one begins
  std::string near{};                   ///< point whose joints decide instead of those before
  bool along = false;                   ///< the tool follows a path: no joint jumps
};

/// Place and form of a remark.
struct RemarkPlace {
  std::size_t at = 0;
  std::string before{}, after{};
  std::size_t longest = 1000;              ///< characters that the language allows
  std::optional<TextNumber> line_count{};  ///< that the program states and that the remark adds to
};

struct Reading {
  std::map<std::string, std::vector<double>> frames;  ///< values by name, as the language writes a pose
  std::map<std::string, FramePair> frame_data;        ///< names of frames behind a name (FDAT of KRL)
  std::string displaced;                              ///< what moves all poses of the file; empty: nothing
  std::vector<FoundPoint> points;
  std::vector<Use> uses;
  std::optional<RemarkPlace> remark;  ///< none: there is no place for one
};

/// Input of a reader; its places are those of the text.
struct Source {
  const std::string& text;
  const std::string& file;               ///< for messages
  const std::vector<std::string>& axes;  ///< what the language calls them, in its order, where points do not name them
};

/// Instructions that move: which of their arguments are points.
struct Motion {
  std::vector<std::string_view> words;  ///< in capitals where the language does not tell them apart
  Role role = Role::pose;
  std::size_t first = 0, count = 1;
  const char* why = "";
};

/// Form of motions and points in a language of expressions.
struct Grammar {
  ExpressionRules expressions;
  bool capitals = true;  ///< words are the same in capitals
  long first_index = 0;  ///< of an array
  bool (*is_straight)(const std::string& word) =
      nullptr;  ///< a motion in capitals moves the tool along a line; null: none
  std::vector<Motion> motions;
  std::vector<std::string_view> offsets;   ///< functions of a point and what is added to it
  std::vector<std::string_view> standing;  ///< words for where the robot is
  /// The point that a list is; none: it is another thing.
  std::optional<FoundPoint> (*as_point)(const Expression& list, const Source& source) = nullptr;
};

/// Collects what the readers of expressions find.
class Collector {
 public:
  Collector(const Grammar& grammar, const Source& source) : grammar_(grammar), source_(source) {}

  const Motion* motion(std::string_view word) const;
  /// An instruction, as the program writes it, with its arguments.
  void move(const Motion& motion, std::string_view word, const std::vector<Expression>& arguments, int line);
  /// name = value; false if the value is no point, list of points, or computed.
  bool define(std::string_view name, const Expression& value, int line);
  /// Gives the name a value that is not known.
  void change(std::string_view name, int line, const std::string& by);
  /// Names and points among the arguments of a procedure.
  void pass(const std::string& procedure, const std::vector<Expression>& arguments, int line, Role role);

  Reading reading;
  FramePair frames;  ///< of the motions from here on

 private:
  void target(const Motion& motion, const Expression& to, Use use);
  void names_in(const Expression& expression, const Use& use, int depth);

  const Grammar& grammar_;
  const Source& source_;
};

/// Six numbers, or why they are none; named in the order of the source's axes from `first`.
void take_numbers(const Expression& list, const std::vector<std::string>& names, FoundPoint& point);

Reading read_krl(const Source& source);
Reading read_rapid(const Source& source);
Reading read_tp(const Source& source);
Reading read_urscript(const Source& source);
Reading read_inform(const Source& source);
Reading read_val3(const Source& source);
Reading read_trajectory(const Source& source);

}  // namespace posewright::programs
