#include <fmt/format.h>

#include <cmath>

#include "init_text.hpp"
#include "posewright/cell/cell.hpp"
#include "posewright/cell/drawing.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/problem/read_robot_file.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

constexpr double robot_smallest = 0.05, robot_largest = 100;  // m, reach

/// As the problem file names it: relative to its folder where that is near, so that both may be moved together.
std::string file_name_of(const fs::path& robot, const fs::path& file) {
  std::error_code code;
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  const fs::path absolute = fs::absolute(robot).lexically_normal();
  const fs::path relative = absolute.lexically_relative(folder);
  const bool near = !relative.empty() &&
                    std::distance(relative.begin(), relative.end()) < std::distance(absolute.begin(), absolute.end());
  return (near ? relative : absolute).generic_string();
}

/// Bound on the way from the first joint to the tip: links in line, and what sliding joints add.
double reach_of(const ChainDescription& chain) {
  double reach = chain.X_LastTip.translation().norm();
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    if (i > 0) reach += chain.joints[i].X_ParentJoint.translation().norm();
    const Coordinate& c = chain.coordinates[std::size_t(chain.joints[i].coordinate)];
    if (chain.joints[i].prismatic) reach += std::max(std::abs(c.lower), std::abs(c.upper));
  }
  return reach;
}

/// The axis of the tip's frame nearest to the last joint's axis, away from the arm.
Eigen::Vector3d outward_of(const ChainDescription& chain) {
  const Eigen::Matrix3d R = chain.X_LastTip.linear().transpose();
  const Eigen::Vector3d axis = R * chain.joints.back().axis;
  Eigen::Index k = 0;
  axis.cwiseAbs().maxCoeff(&k);
  // The tip's origin seen from the joint before the last one.
  const Eigen::Isometry3d X = chain.joints.back().X_ParentJoint * chain.X_LastTip;
  const double along = (X.linear().transpose() * X.translation())[k];
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();
  outward[k] = std::abs(along) > 1e-6 ? (along > 0 ? 1 : -1) : (axis[k] > 0 ? 1 : -1);
  return outward;
}

/// Extent of a body along a direction of its own frame, from its origin.
double extent(const DrawnBody& body, const Eigen::Vector3d& d) {
  if (const auto* box = std::get_if<BoxShape>(&body.shape)) return 0.5 * d.cwiseAbs().dot(box->size);
  if (const auto* cylinder = std::get_if<CylinderShape>(&body.shape))
    return cylinder->radius * d.head<2>().norm() + 0.5 * cylinder->length * std::abs(d.z());
  if (const auto* sphere = std::get_if<SphereShape>(&body.shape)) return sphere->radius;
  double most = 0;
  for (const Eigen::Vector3d& vertex : body.mesh.vertices) most = std::max(most, vertex.dot(d));
  return most;
}

/// Extent along a direction of a frame with the body at X.
double extent_at(const DrawnBody& body, const Eigen::Isometry3d& X, const Eigen::Vector3d& d) {
  return X.translation().dot(d) + extent(body, X.linear().transpose() * d);
}

}  // namespace

InitRobot look_at_robot(const InitFacts& facts, const fs::path& file) {
  InitRobot robot;
  SerialArmSpec arm = read_robot_file(facts.robot, facts.xacro);
  robot.links = propose_chain(arm, facts.base, facts.tip);
  arm.base = Located<std::string>{robot.links.base, 0};
  arm.tip = Located<std::string>{robot.links.tip, 0};
  robot.chain = read_urdf_chain(arm, {facts.robot.string(), 0});
  robot.reach = reach_of(robot.chain);
  if (!(robot.reach > robot_smallest && robot.reach < robot_largest))
    throw InputError({facts.robot.string(), 0}, fmt::format("is a robot that reaches {:g} m", robot.reach),
                     fmt::format("{} to {} m; URDF is written in metres", robot_smallest, robot_largest));
  robot.outward = outward_of(robot.chain);
  robot.urdf = file_name_of(facts.robot, file);
  return robot;
}

void add_bodies(InitRobot& robot, const Problem& problem) {
  const std::shared_ptr<const Cell> cell = make_cell(problem);
  const Drawing drawing(problem, *cell);
  std::vector<double> here, there;
  for (const Coordinate& c : cell->model->coordinates()) {
    here.push_back(0.5 * (c.lower + c.upper));
    there.push_back(c.choice() ? 0.0 : 0.7 * c.lower + 0.3 * c.upper);
    if (c.choice()) here.back() = 0.0;
  }
  const DrawnPose a = drawing.at(here), b = drawing.at(there);
  for (const DrawnBody& body : drawing.bodies()) {
    if (std::string(body.kind) != "robot") continue;
    const Eigen::Isometry3d &Xa = a.frames[std::size_t(body.frame)], &Xb = b.frames[std::size_t(body.frame)];
    const Eigen::Isometry3d X_TipFrame = a.tip.inverse() * Xa;
    if (Xa.isApprox(Xb, 1e-9))
      robot.lowest = std::min(robot.lowest, -extent_at(body, Xa * body.X_FrameBody, -Eigen::Vector3d::UnitZ()));
    else if (X_TipFrame.isApprox(b.tip.inverse() * Xb, 1e-9))
      robot.face = std::max(robot.face, extent_at(body, X_TipFrame * body.X_FrameBody, robot.outward));
  }
}

}  // namespace posewright
