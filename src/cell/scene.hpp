#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "apart_table.hpp"
#include "body_frames.hpp"
#include "posewright/cell/collision.hpp"
#include "posewright/cell/solid.hpp"
#include "posewright/model/link_geometry.hpp"
#include "posewright/model/variant_columns.hpp"

namespace posewright {

/// Half of what bodies may move between two checks of a motion, m: added to every clearance, so that the clearance
/// asked for holds between the checks too.
inline constexpr double motion_resolution = 0.5e-3;

/// Distances on a motion are asked for up to this much beyond the clearance, m: further ones cost more than the steps
/// they save.
inline constexpr double look_ahead = 0.08;

/// Hulls of meshes that leave less than this are too coarse: the meshes themselves are asked, m. Where hulls stay on
/// either side of a plane, little is enough.
inline constexpr double near_enough = 0.0005;

/// Largest error of a distance between meshes, hulls and shapes, m.
inline constexpr double certain = 1e-4;

/// One solid on a frame. Links, tool parts and obstacles are made of them; what they belong to has the name.
struct Body {
  std::string name;
  std::string station;  ///< see BodySpec
  std::string parent;   ///< link it hangs on; empty: none
  bool obstacle = false, tool = false;
  int frame = 0;
  Eigen::Isometry3d X_FrameBody = Eigen::Isometry3d::Identity();
  std::shared_ptr<const Solid> solid;
};

/// Two bodies that must not come nearer than `clearance`.
struct BodyPair {
  int a = 0, b = 0;  ///< bodies; a is an obstacle, or its frame is not above that of b
  int reason = 0;
  double clearance = 0.0;                   ///< m, margins included
  double asked = 0.0;                       ///< m, without margins
  double least = 0.0;                       ///< m, by which the tolerances may move the two relative to each other
  std::vector<Eigen::VectorXd> travel;      ///< per pose of a configuration: of b's points, see BodyFrames::travel
  std::vector<Eigen::VectorXd> approach{};  ///< the same by which their distance changes at most: no more than points
                                            ///< of either move relative to the other
  double room = std::numeric_limits<double>::infinity();  ///< m beyond the clearance that the two hardly ever have
  bool never_near = false;  ///< keeps its clearance wherever the robot may stand: need not be looked at
  std::shared_ptr<const ApartTable> table{};  ///< of a pair that few coordinates move; null: none
};

/// Links, tool and obstacles, and which pairs of them must keep apart.
struct Scene {
  std::unique_ptr<BodyFrames> frames;
  std::vector<Body> bodies;
  std::vector<BodyPair> pairs;
  std::vector<std::string> reasons;  ///< what a pair that comes too near is called in the table of rejections
  std::vector<std::string> always;   ///< "link_1 and link_3": left out because they always touch
  std::vector<ReducedClearance> reduced;
  double margin = 0.0;       ///< m, largest that was added for a robot that is not calibrated yet
  std::uint64_t number = 0;  ///< of this scene among all that the program made: what a thread remembers is of one
};

/// Sufficient spare room (m), so that the next way to find it, which takes longer and finds more, is left out.
struct EnoughSpare {
  double of_boxes, of_hulls;
  double of_surfaces;  ///< most that is found of meshes
};

/// Asked with a direction from body a to b across what is between their hulls; true: the bodies need not be asked.
using AskAcross = std::function<bool(const Eigen::Vector3d& towards_b)>;

/// Lower bound of a pair's distance beyond its clearance: exact where it is negative, so that the sign is the verdict.
/// @param across  asked where the hulls keep their clearance; may be empty
double spare_of(const Scene& scene, const BodyPair& pair, const Eigen::Isometry3d& X_a, const Eigen::Isometry3d& X_b,
                const EnoughSpare& enough, const AskAcross& across = {});

/// True if pairs keep their clearance all the way on a straight motion of one pose. Where a pair is d apart, it cannot
/// come too near before it has moved by what d has to spare, on either side. Nor can it as long as its hulls stay on
/// either side of a plane (stay_apart()). What is left between two states is halved.
/// @param most_looks  at pairs between the ends before the answer is no
bool keep_apart(const Scene& scene, std::span<const BodyPair> pairs, int pose, std::span<const double> from,
                std::span<const double> to, long most_looks = std::numeric_limits<long>::max());

/// @param model       nominal one of the problem; must outlive the scene
/// @param same_robot  see Collision
/// Throws InputError and CannotDo for meshes, links and packages that are not there.
Scene build_scene(const Problem& problem, const IdentificationModel& model, const Scene* same_robot = nullptr);

/// Links of the arm, tool and obstacles, in that order.
std::vector<Body> build_bodies(const Problem& problem, const BodyFrames& frames);

/// Pairs before their solids are made.
struct BodyShape {
  std::string name, station, parent;
  enum class Kind { link, tool, obstacle } kind = Kind::link;
  int frame = 0;
  Eigen::Isometry3d X_FrameBody = Eigen::Isometry3d::Identity();
  ShapeSpec shape;
  SourcePlace place;
  std::string follower{};                         ///< see LinkGeometry
  std::optional<std::array<double, 3>> colour{};  ///< of a link
};
/// Frame and pose in it of what stands in the cell: in the URDF's root if joints of the way move the base, as the
/// measurement frame moves with its base; else in the measurement frame.
RootPlace cell_place(const Problem& problem);

/// @param tip_of  where the tip of that name is: it carries parts of the tool
std::vector<BodyShape> list_shapes(const Problem& problem,
                                   const std::function<BodyFrames::Tip(const std::string& name)>& tip_of);

/// Deviation of a robot within the tolerances of the planned variant from the nominal one, one
/// standard deviation: largest over the workspace for a pair's bodies relative to each other.
class UncalibratedError {
 public:
  UncalibratedError(const Problem& problem, const IdentificationModel& model, const BodyFrames& frames);
  double of(const Body& a, const Body& b) const;

 private:
  void take_twists_of_frames(const VariantColumns& columns, const IdentificationModel& model);

  const BodyFrames& frames_;
  std::vector<std::vector<Eigen::Isometry3d>> poses_;             // per sample
  std::vector<std::vector<Eigen::Matrix<double, 6, 1>>> twists_;  // per sample and parameter, one tolerance long
  std::vector<int> acts_from_;                                    // per parameter
};

}  // namespace posewright
