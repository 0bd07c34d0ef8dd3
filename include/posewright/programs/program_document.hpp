#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "posewright/controller/controller_settings.hpp"

namespace posewright {

/// Outcome of a motion or a point of a program.
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
  std::string why;        ///< empty: it is compensated
  int point = -1;         ///< index among the document's points; -1: none
  std::string target{};   ///< the same for a point that has a name and for motions to it; not for messages
  std::string element{};  ///< of this point alone
};

/// A straight motion of the tool from one point to the next.
struct LineMotion {
  int line = 0;
  std::string from, to;  ///< elements of points
  Eigen::Isometry3d X_TipTool = Eigen::Isometry3d::Identity();
};

/// A motion between points of a document; -1: none of them.
struct PointMotion {
  int line = 0, from = -1, to = -1;
  std::vector<double> joints{};                                 ///< where it begins, SI, if a point of joints is there
  bool along = false;                                           ///< the tool follows a path: no joint jumps
  Eigen::Isometry3d X_TipTool = Eigen::Isometry3d::Identity();  ///< if it leads to a pose
};

/// Every motion and every point of a program, in the order of the file.
struct ProgramAccount {
  std::string file, format;
  std::vector<ProgramEntry> entries;
  std::vector<LineMotion> lines{};  ///< that lead to poses
  std::size_t count(Treatment treatment) const;
};

/// A program's text and its account.
struct ProgramFile {
  std::string format;  ///< as `export` calls it: kuka-krl, abb-rapid, fanuc-tp, urscript, yaskawa-inform, staubli-val3,
                       ///< joint-trajectory
  std::string text, name;
  bool context = false;  ///< read for its motions alone: it is not written
};

/// Joints of a robot, and where its wrist is at them.
struct ArmStand {
  std::vector<double> joints;  ///< SI, the robot's signs and zeros
  bool behind_base = false, behind_arm = false;
};

/// Frames that a program's poses are in, where it does not state them itself.
struct ProgramFrames {
  /// Values by name or number, as the language writes a pose (mm, deg); the empty name is for all that have no value.
  std::map<std::string, std::vector<double>> tools{}, bases{};
  Eigen::Isometry3d X_BaseWorld = Eigen::Isometry3d::Identity();  ///< the controller's world in the robot's base
  Eigen::Isometry3d X_TipFlange = Eigen::Isometry3d::Identity();  ///< the controller's flange in the robot's tip
};

/// x y z in mm, then roll pitch yaw in deg as in a URDF.
Eigen::Isometry3d place_of_rpy(const std::vector<double>& values);

/// The robot that a program moves.
struct ProgramRobot {
  std::vector<std::string> names, units;  ///< of its joints; rad or m
  ControllerSettings settings{};
  std::optional<double> coupling{};  ///< overrules that of the settings
  std::string why_no_poses{};        ///< poses are not compensated: the reason; empty: they are
  ProgramFrames frames{};
};

/// A robot program: its account, the points that are compensated, and the text with other values for them. Everything
/// else of the program stays as it is, byte for byte.
class ProgramDocument {
 public:
  struct Point {
    int line = 0;
    std::string name;              ///< as the program calls it; empty: it has none
    std::vector<double> joints{};  ///< SI, the robot's signs and zeros; empty: it is given as a pose
    int measured = 0;              ///< number of the pose, where a remark of the program says it; 0: none does
    Eigen::Isometry3d X_BaseTip = Eigen::Isometry3d::Identity();  ///< of a pose, in the robot's base
    bool is_pose() const { return joints.empty(); }
  };
  /// Other values for a point.
  struct Values {
    ArmStand stand;
    Eigen::Isometry3d X_BaseTip = Eigen::Isometry3d::Identity();  ///< nominal, at these joints; for poses
  };

  virtual ~ProgramDocument() = default;
  virtual const ProgramAccount& account() const = 0;
  /// Points to compensate.
  virtual const std::vector<Point>& points() const = 0;
  /// Motions in the order of the file, of a language whose poses state no joints: the controller takes those nearest to
  /// the joints where a motion begins. Null: poses state their joints.
  virtual const std::vector<PointMotion>* motions() const = 0;
  /// Joints meant by a pose's status (S and T, confdata, CONFIG); several if it is ambiguous.
  virtual std::vector<std::size_t> meant(std::size_t point, const std::vector<ArmStand>& stands) const = 0;
  /// @param values  one a point; none: it stays as it is
  /// @param remark  put into a comment where a point has other values
  /// Throws CannotDo for an axis beyond the range that the settings give it.
  virtual std::string text(const std::vector<std::optional<Values>>& values, const std::string& remark) const = 0;
};

/// Reads programs that belong together: motions of one use points of another. One document for each file that is no
/// context. Throws InputError with file and line for a text that is no program and for settings that are missing.
std::vector<std::unique_ptr<ProgramDocument>> read_programs(const std::vector<ProgramFile>& files,
                                                            const ProgramRobot& robot);

/// True if a format is that of a program.
bool is_program_format(const std::string& format);
/// Their formats, for help and messages.
std::string program_format_names();
/// Format by the ending of a file's name; empty: it is no program's.
std::string program_format_of_ending(std::string_view ending);

}  // namespace posewright
