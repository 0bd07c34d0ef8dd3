#pragma once

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "posewright/cell/cell.hpp"
#include "posewright/cell/solid.hpp"
#include "posewright/model/instrument_view.hpp"
#include "posewright/model/link_geometry.hpp"
#include "posewright/model/tip_model.hpp"

namespace posewright {

class BodyFrames;

/// One shape of a link, the tool or an obstacle as it is drawn.
struct DrawnBody {
  std::string name;
  const char* kind = "robot";  ///< robot, tool, obstacle
  int frame = 0;               ///< index into Drawing::frames()
  Eigen::Isometry3d X_FrameBody = Eigen::Isometry3d::Identity();
  ShapeSpec shape;
  std::optional<std::array<double, 3>> colour{};  ///< of the link in the URDF: red, green, blue, 0 to 1
  TriangleMesh mesh;                              ///< of a MeshShape, thinned, m
};

/// Robot, targets and instrument at one configuration, measurement frame; of a robot with several tips its root.
struct DrawnPose {
  std::vector<Eigen::Isometry3d> frames;
  std::vector<Polyline> lines;  ///< arm from base to tip, from the root to each of several, or legs and rims
  Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
  std::vector<std::optional<Eigen::Vector3d>> targets;  ///< none: of an instrument that does not read here
  std::string instrument;                               ///< that reads; empty: there is one
};

/// Something of an instrument in the frame that carries it.
struct Carried {
  int frame = 0;  ///< index into Drawing::frames()
  Eigen::Isometry3d X_FrameThing = Eigen::Isometry3d::Identity();
};

/// An instrument that stands still.
struct DrawnStation {
  std::string instrument;  ///< empty: there is one
  std::string name;
  Eigen::Isometry3d X_MeasureStation = Eigen::Isometry3d::Identity();
};

/// A camera and the points that it looks at.
struct DrawnCamera {
  std::string instrument;         ///< empty: there is one
  std::vector<std::string> with;  ///< instruments that read together with it, by their name in the list
  Carried camera, board;
  InstrumentView::Image image;
  std::vector<std::pair<std::string, Eigen::Vector3d>> points;  ///< board frame, m
};

/// Data for a picture of the cell, for robots with and without link shapes. Links look as the URDF's <visual> shapes
/// where they can be read, else as those that are checked for collision. Meshes are thinned to 3,000 triangles each and
/// 30,000 together. Nothing here judges anything: missing
/// meshes leave a skeleton and a warning.
class Drawing {
 public:
  /// @param cell  of this problem
  Drawing(const Problem& problem, const Cell& cell);
  ~Drawing();

  /// Names of the frames that carry bodies; the first is the measurement frame.
  const std::vector<std::string>& frames() const { return frame_names_; }
  /// Where the positions of obstacles in the file are.
  const RootPlace& cell() const { return cell_; }
  const std::vector<DrawnBody>& bodies() const { return bodies_; }
  /// Of all instruments; in a list P1 of the tracker is "tracker.P1".
  const std::vector<std::string>& targets() const { return target_names_; }
  const std::vector<DrawnStation>& stations() const { return stations_; }
  /// One for each instrument that takes pictures.
  const std::vector<DrawnCamera>& cameras() const { return cameras_; }
  /// As its URDF calls it; empty: it has none.
  const std::string& robot() const { return robot_; }
  /// Why there are no bodies, where some were expected; empty: nothing is missing.
  const std::string& warning() const { return warning_; }

  /// The robot at q (the first pose of a pair of configurations); empty for a robot without a tip.
  DrawnPose at(std::span<const double> q) const;

 private:
  void add_bodies(const Problem& problem);
  void keep_to_budget();
  void add_instrument(const MeasurementSpec& measurement, int index);
  void add_camera(const MeasurementSpec& measurement, const InstrumentView& view);
  Carried carried(const MeasurementSpec& measurement, bool on_tip, const std::string& parameters,
                  const Placement& placement) const;

  std::shared_ptr<const IdentificationModel> model_;
  std::unique_ptr<BodyFrames> arm_;  // of a serial arm
  std::unique_ptr<TipModel> tip_;    // of a parallel robot
  Eigen::Vector3d base_ = Eigen::Vector3d::Zero();
  RootPlace cell_;
  std::vector<std::string> instruments_;        // of a list
  std::vector<std::set<std::string>> readers_;  // per instrument of a list: itself and those that read with it
  std::vector<std::string> tips_;               // per instrument, if they see several: the one that it sees
  std::vector<std::string> frame_names_, target_names_;
  std::vector<std::pair<int, Eigen::Vector3d>> targets_;  // index of the instrument; tip frame
  std::vector<DrawnStation> stations_;
  std::vector<DrawnBody> bodies_;
  std::vector<DrawnCamera> cameras_;
  std::string robot_, warning_;
};

/// A mesh with at most so many triangles: vertices that share a cell of a grid become one, finer grids first.
TriangleMesh thinned(const TriangleMesh& mesh, std::size_t triangles);

}  // namespace posewright
