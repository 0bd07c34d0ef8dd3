#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "init_text.hpp"
#include "posewright/cell/cell.hpp"
#include "posewright/cell/drawing.hpp"
#include "posewright/model/link_geometry.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/problem/package_search.hpp"
#include "posewright/problem/read_robot_file.hpp"
#include "posewright/support/text.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

constexpr double robot_smallest = 0.05, robot_largest = 100;  // m, reach
constexpr double links_smallest = 2e-3, links_largest = 20;   // the largest one, of the reach: beyond, a unit is wrong
constexpr double joined_gap = 0.02;                           // m between bodies that stand on each other

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

Eigen::AlignedBox3d box_around(const DrawnBody& body, const Eigen::Isometry3d& X) {
  Eigen::AlignedBox3d box;
  for (int k = 0; k < 3; ++k) {
    box.max()[k] = extent_at(body, X, Eigen::Vector3d::Unit(k));
    box.min()[k] = -extent_at(body, X, -Eigen::Vector3d::Unit(k));
  }
  return box;
}

/// Lowest point of what stands still beneath the first joint: the body nearest to it, and all that are joined to it. A
/// camera or a fixture elsewhere is not what the arm stands on.
double foot_of(std::vector<Eigen::AlignedBox3d> still, const Eigen::Vector3d& first_joint) {
  if (still.empty()) return 0.0;
  const auto nearer = [&](const auto& a, const auto& b) {
    return a.exteriorDistance(first_joint) < b.exteriorDistance(first_joint);
  };
  std::swap(*std::min_element(still.begin(), still.end(), nearer), still.front());
  double lowest = 0.0;
  for (auto joined = still.begin(), end = joined + 1; joined != end; ++joined) {
    lowest = std::min(lowest, joined->min().z());
    end = std::partition(end, still.end(),
                         [&](const Eigen::AlignedBox3d& box) { return box.exteriorDistance(*joined) < joined_gap; });
  }
  return lowest;
}

double size_of(const DrawnBody& body) { return box_around(body, Eigen::Isometry3d::Identity()).sizes().maxCoeff(); }

/// Refuses links of another unit than the arm.
/// @param largest  of the bodies that move; null: there is none
void require_size(const DrawnBody* largest, const InitRobot& robot, const SerialArmSpec& spec) {
  const double size = largest == nullptr ? robot.reach : size_of(*largest);
  if (size > links_smallest * robot.reach && size < links_largest * robot.reach) return;
  int line = 0;
  for (const std::vector<LinkGeometry>& links : {read_urdf_links(spec, {}), read_urdf_visuals(spec, {})})
    for (const LinkGeometry& link : links)
      if (link.name == largest->name) line = link.line;
  throw InputError(
      {spec.urdf.string(), line},
      fmt::format("link '{}' is {:.2g} m large on an arm that reaches {:.2g} m", largest->name, size, robot.reach),
      size > robot.reach ? "a mesh in mm needs scale=\"0.001 0.001 0.001\"" : "a mesh in m needs no scale");
}

/// This text with the full paths of the meshes that are found around the xacro file.
std::string with_meshes_found(std::string text, const InitFacts& facts) {
  const fs::path folder = fs::absolute(facts.robot).lexically_normal().parent_path();
  constexpr std::string_view key = "filename=\"";
  std::string result;
  std::size_t begin = 0;
  for (std::size_t at = 0; (at = text.find(key, begin)) != std::string::npos;) {
    const std::size_t first = at + key.size(), last = std::min(text.find('"', first), text.size());
    const fs::path name = text.substr(first, last - first);
    std::error_code code;
    fs::path found =
        names_package(name.string()) ? find_model(name.string(), facts.packages, facts.robot) : folder / name;
    const bool readable = found.string().find_first_of("&<\"") == std::string::npos;
    if (found.empty() || !readable || !fs::is_regular_file(found, code)) found = name;
    result += text.substr(begin, first - begin) + found.string();
    begin = last;
  }
  return result + text.substr(begin);
}

}  // namespace

namespace {

/// @param arm  of the file
InitRobot look_at_tip(SerialArmSpec arm, const InitFacts& facts, const std::string& tip, const fs::path& file) {
  InitRobot robot;
  robot.links = propose_chain(arm, facts.base, tip);
  arm.base = Located<std::string>{robot.links.base, 0};
  arm.tip = Located<std::string>{robot.links.tip, 0};
  robot.chain = read_urdf_chain(arm, {facts.robot.string(), 0});
  robot.root = root_place(arm, {facts.robot.string(), 0});
  robot.reach = reach_of(robot.chain);
  if (!(robot.reach > robot_smallest && robot.reach < robot_largest))
    throw InputError({facts.robot.string(), 0}, fmt::format("is a robot that reaches {:g} m", robot.reach),
                     fmt::format("{} to {} m; URDF is written in metres", robot_smallest, robot_largest));
  robot.outward = outward_of(robot.chain);
  robot.urdf = file_name_of(facts.robot, file);
  robot.expanded = arm.expanded;
  return robot;
}

}  // namespace

std::vector<InitRobot> look_at_robot(const InitFacts& facts, const fs::path& file) {
  const SerialArmSpec arm = read_robot_file(facts.robot, facts.xacro);
  if (facts.tips.empty()) return {look_at_tip(arm, facts, "", file)};
  std::vector<InitRobot> tips;
  for (const std::string& tip : facts.tips) {
    if (std::ranges::count(facts.tips, tip) > 1)
      throw InputError({}, "--tip " + in_quotes(tip) + " is given twice", "a link once");
    tips.push_back(look_at_tip(arm, facts, tip, file));
    if (tips.back().links.base != tips.front().links.base)
      throw InputError({},
                       fmt::format("the chains to '{}' and '{}' begin at '{}' and '{}'", tips.front().links.tip, tip,
                                   tips.front().links.base, tips.back().links.base),
                       "name one link with --base");
  }
  return tips;
}

std::vector<Coordinate> joints_of(const std::vector<InitRobot>& tips) {
  std::vector<Coordinate> all;
  for (const InitRobot& tip : tips)
    for (const Coordinate& c : tip.chain.coordinates)
      if (std::ranges::find(all, c.name, &Coordinate::name) == all.end()) all.push_back(c);
  return all;
}

FileToWrite expanded_robot(const InitFacts& facts, const InitRobot& robot, const fs::path& file) {
  if (robot.expanded == nullptr) return {};
  const auto folder = [](const fs::path& of) { return fs::absolute(of).lexically_normal().parent_path(); };
  const bool moved = folder(file) != folder(facts.robot);
  return {fs::path(file).replace_extension(".urdf"),
          moved ? with_meshes_found(*robot.expanded, facts) : *robot.expanded};
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
  const auto in_cell = [&](const DrawnPose& pose, const Eigen::Isometry3d& X) -> Eigen::Isometry3d {
    if (!robot.root.base_moves()) return X;
    return (pose.frames[std::size_t(robot.root.frame)] * robot.root.X_FrameRoot).inverse() * X;
  };
  std::vector<Eigen::AlignedBox3d> still;
  const DrawnBody* largest = nullptr;
  double face = 0.0;
  for (const DrawnBody& body : drawing.bodies()) {
    if (std::string(body.kind) != "robot") continue;
    const Eigen::Isometry3d &Xa = a.frames[std::size_t(body.frame)], &Xb = b.frames[std::size_t(body.frame)];
    const Eigen::Isometry3d X_TipFrame = a.tip.inverse() * Xa;
    if (body.frame > 0 && (largest == nullptr || size_of(body) > size_of(*largest))) largest = &body;
    if (const Eigen::Isometry3d X = in_cell(a, Xa); X.isApprox(in_cell(b, Xb), 1e-9))
      still.push_back(box_around(body, X * body.X_FrameBody));
    else if (X_TipFrame.isApprox(b.tip.inverse() * Xb, 1e-9))
      face = std::max(face, extent_at(body, X_TipFrame * body.X_FrameBody, robot.outward));
  }
  require_size(largest, robot, std::get<SerialArmSpec>(problem.robot));
  robot.face = face;
  const Eigen::Isometry3d& X_First =
      robot.root.base_moves() ? a.frames[std::size_t(robot.root.frame)] : robot.chain.joints.front().X_ParentJoint;
  robot.lowest = foot_of(std::move(still), in_cell(a, X_First).translation());
}

}  // namespace posewright
