#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "posewright/controller/controller_settings.hpp"
#include "posewright/lists/pose_list.hpp"
#include "posewright/model/arm_inverse.hpp"
#include "posewright/programs/program_document.hpp"

namespace posewright {

/// Options for reading a file of poses.
struct DocumentOptions {
  std::string format;  ///< as `export` calls it; empty: by the file's ending and first character
  ControllerSettings controller;
  std::optional<double> coupling;
  std::optional<ArmInverse> inverse{};  ///< of the nominal arm, for poses of programs
  std::string why_no_inverse{};         ///< why there is none
  ProgramFrames frames{};
  std::optional<std::vector<double>> near{};  ///< joints, rad: near those of poses whose joints before are not known
  int threads = 0;                            ///< never changes a result
};

/// Other values for the poses of a document.
struct OtherValues {
  std::span<const double> configurations;  ///< poses × coordinates, SI
  std::span<const double> actuators;       ///< poses × actuators of a parallel robot; empty for arms
  std::vector<std::string> actuator_names{};
};

/// A file that has poses, to be written again with other values for them: a plan or route (its via points are poses
/// too; home, where a robot rests, is none), a list in one of the formats that are read, CSV, a robot program. JSON,
/// CSV and programs keep all other text; other lists are written anew, with the data of their format's reader
/// takes.
class PoseDocument {
 public:
  virtual ~PoseDocument() = default;

  /// All points in the order of the file; those of a route's motions come last.
  const PoseList& poses() const { return poses_; }
  /// Notes on the reading, for the user.
  const std::vector<std::string>& notes() const { return poses_.notes; }

  /// The file with other values. Poses that are not to be touched have their listed ones.
  /// @param remark  of one line, put where the format has a place for a comment
  /// Throws CannotDo if the format cannot hold them.
  virtual std::string text(const OtherValues& values, const std::string& remark) const = 0;
  /// Account of a program; null for other files. Points of its entries are poses().
  virtual const ProgramAccount* account() const { return nullptr; }

 protected:
  PoseList poses_;
};

/// In every remark, so that nobody compensates twice.
inline constexpr const char* compensated_mark = "Written by posewright compensate";

/// A file in memory.
struct DocumentFile {
  std::string bytes, name;
  bool context = false;  ///< read for the motions of a program alone
};

/// One document for each file that is no context. Programs are read together: motions of one use points of another.
/// Throws InputError with file and line as read_poses(), and for a file that is compensated already.
std::vector<std::unique_ptr<PoseDocument>> parse_documents(const std::vector<DocumentFile>& files,
                                                           const std::vector<Coordinate>& coordinates,
                                                           const DocumentOptions& options);
/// Overload for files. The motions to points of a .dat or .dtx are sought in the .src or .pgx beside it, too.
std::vector<std::unique_ptr<PoseDocument>> read_documents(const std::vector<std::filesystem::path>& paths,
                                                          const std::vector<Coordinate>& coordinates,
                                                          const DocumentOptions& options);
/// The poses of a program, to be judged. Where remarks number poses, as those of `export` do, it is these; otherwise
/// every point that motions lead to. Files of the program that lie beside it are read too.
PoseList program_poses(const std::filesystem::path& path, const std::vector<Coordinate>& coordinates,
                       const DocumentOptions& options);

}  // namespace posewright
