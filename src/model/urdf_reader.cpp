#include "posewright/model/urdf_reader.hpp"

#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <mutex>
#include <numbers>
#include <set>

#include "posewright/model/placement.hpp"
#include "posewright/support/file.hpp"
#include "urdf_lines.hpp"

namespace posewright {
namespace {

constexpr std::uintmax_t largest_urdf = 20'000'000;  // bytes

/// Keeps what urdfdom says, for the error message; its handler is global to the process, so one reader at a time.
class CapturedMessages : public console_bridge::OutputHandler {
 public:
  CapturedMessages() : lock_(mutex()) { console_bridge::useOutputHandler(this); }
  CapturedMessages(const CapturedMessages&) = delete;
  CapturedMessages& operator=(const CapturedMessages&) = delete;
  ~CapturedMessages() override { console_bridge::restorePreviousOutputHandler(); }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR || !first_.empty()) return;
    first_ = text.substr(0, text.find('\n'));
  }
  const std::string& first() const { return first_; }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  std::scoped_lock<std::mutex> lock_;
  std::string first_;
};

urdf::ModelInterfaceSharedPtr parse(const std::string& text, const std::string& file) {
  CapturedMessages messages;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& error) {
    throw InputError({file, 0}, std::string("is no valid URDF: ") + error.what(), "");
  }
  if (model == nullptr)
    throw InputError({file, 0}, "is no valid URDF: " + (messages.first().empty() ? "not accepted" : messages.first()),
                     "");
  return model;
}

std::string names_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string tip_of(const urdf::ModelInterface& model, const SerialArmSpec& arm, const SourcePlace& place) {
  std::vector<std::string> links, leaves;
  for (const auto& [name, link] : model.links_) {
    links.push_back(name);
    if (link->child_joints.empty()) leaves.push_back(name);
  }
  if (arm.tip) {
    if (model.links_.count(arm.tip->value) == 0)
      throw InputError({place.file, arm.tip->line},
                       "tip '" + arm.tip->value + "' is no link of " + arm.urdf.filename().string(),
                       "links: " + names_of(links));
    return arm.tip->value;
  }
  if (leaves.size() != 1)
    throw InputError(place, "the robot has several ends and no tip is named",
                     "set robot: tip to one of " + names_of(leaves));
  return leaves.front();
}

std::string base_of(const urdf::ModelInterface& model, const SerialArmSpec& arm, const SourcePlace& place) {
  if (!arm.base) return model.getRoot()->name;
  if (model.links_.count(arm.base->value) == 0) {
    std::vector<std::string> links;
    for (const auto& entry : model.links_) links.push_back(entry.first);
    throw InputError({place.file, arm.base->line},
                     "base '" + arm.base->value + "' is no link of " + arm.urdf.filename().string(),
                     "links: " + names_of(links));
  }
  return arm.base->value;
}

/// Joints from base to tip.
std::vector<urdf::JointConstSharedPtr> path(const urdf::ModelInterface& model, const std::string& base,
                                            const std::string& tip, const SourcePlace& place) {
  std::vector<urdf::JointConstSharedPtr> joints;
  urdf::LinkConstSharedPtr link = model.getLink(tip);
  while (link->name != base) {
    if (link->parent_joint == nullptr)
      throw InputError(place, "tip '" + tip + "' is not below base '" + base + "'", "name links of one branch");
    joints.push_back(link->parent_joint);
    link = model.getLink(link->parent_joint->parent_link_name);
  }
  std::reverse(joints.begin(), joints.end());
  return joints;
}

Eigen::Isometry3d isometry(const urdf::Pose& pose) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  X.linear() = Eigen::Quaterniond(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z)
                   .normalized()
                   .toRotationMatrix();
  return X;
}

Coordinate coordinate_of(const urdf::Joint& joint, const SourcePlace& place) {
  const bool prismatic = joint.type == urdf::Joint::PRISMATIC;
  Coordinate c{joint.name, prismatic ? "m" : "rad", -std::numbers::pi, std::numbers::pi};
  c.periodic = joint.type == urdf::Joint::CONTINUOUS;
  if (c.periodic) return c;
  if (joint.limits == nullptr)
    throw InputError(place, "joint '" + joint.name + "' has no <limit>",
                     "lower and upper are needed, or type continuous");
  c.lower = joint.limits->lower;
  c.upper = joint.limits->upper;
  if (!(c.lower < c.upper))
    throw InputError(place, "joint '" + joint.name + "' has empty limits", "lower must be below upper");
  return c;
}

class ChainBuilder {
 public:
  ChainBuilder(const SerialArmSpec& arm, const UrdfLines& lines, const urdf::ModelInterface& model,
               const std::vector<urdf::JointConstSharedPtr>& path)
      : arm_(arm), lines_(lines), model_(model) {
    chain_.X_MeasureBase = isometry(arm.placement);
    for (const auto& joint : path) path_.insert(joint->name);
  }

  void add(const urdf::Joint& joint) {
    move(joint);
    if (!chain_.joints.empty()) carry(*model_.getLink(joint.child_link_name), pending_);
  }

  ChainDescription finish() {
    chain_.X_LastTip = pending_;
    resolve_mimics();
    return std::move(chain_);
  }

 private:
  void move(const urdf::Joint& joint) {
    const SourcePlace place = lines_.joint(joint.name);
    pending_ = pending_ * isometry(joint.parent_to_joint_origin_transform);
    if (joint.type == urdf::Joint::FIXED) return;
    if (joint.type != urdf::Joint::REVOLUTE && joint.type != urdf::Joint::CONTINUOUS &&
        joint.type != urdf::Joint::PRISMATIC)
      throw InputError(place, "joint '" + joint.name + "' is of a type that no arm has",
                       "allowed: revolute, continuous, prismatic, fixed");
    ChainJoint result;
    result.name = joint.name;
    result.prismatic = joint.type == urdf::Joint::PRISMATIC;
    result.X_ParentJoint = pending_;
    pending_.setIdentity();
    result.axis = Eigen::Vector3d(joint.axis.x, joint.axis.y, joint.axis.z);
    if (!(result.axis.norm() > 1e-9))
      throw InputError(place, "joint '" + joint.name + "' has a zero axis", "a direction is needed");
    result.axis.normalize();
    if (joint.mimic != nullptr) {
      result.mimic = true;
      result.multiplier = joint.mimic->multiplier;
      result.offset = joint.mimic->offset;
      masters_.push_back({chain_.joints.size(), joint.mimic->joint_name});
    } else {
      result.coordinate = int(chain_.coordinates.size());
      chain_.coordinates.push_back(coordinate_of(joint, place));
      chain_.encoder_noise.push_back(arm_.encoder_noise);
    }
    chain_.joints.push_back(std::move(result));
  }

  /// Mass of a link and of the branches on it that are not part of the chain, as they hang at zero position.
  void carry(const urdf::Link& link, const Eigen::Isometry3d& X_JointLink) {
    ChainJoint& joint = chain_.joints.back();
    if (link.inertial != nullptr && link.inertial->mass > 0) {
      const Eigen::Vector3d centre = X_JointLink * isometry(link.inertial->origin).translation();
      const double total = joint.mass + link.inertial->mass;
      joint.centre_of_mass = (joint.mass * joint.centre_of_mass + link.inertial->mass * centre) / total;
      joint.mass = total;
    }
    for (const auto& branch : link.child_joints)
      if (path_.count(branch->name) == 0)
        carry(*model_.getLink(branch->child_link_name),
              X_JointLink * isometry(branch->parent_to_joint_origin_transform));
  }

  void resolve_mimics() {
    for (const auto& [index, master] : masters_) {
      const auto found = std::find_if(chain_.joints.begin(), chain_.joints.end(),
                                      [&, name = master](const ChainJoint& j) { return j.name == name && !j.mimic; });
      if (found == chain_.joints.end())
        throw InputError(lines_.joint(chain_.joints[index].name),
                         "joint '" + chain_.joints[index].name + "' mimics '" + master + "', which is not in the chain",
                         "choose a tip whose chain has both");
      chain_.joints[index].coordinate = found->coordinate;
    }
  }

  const SerialArmSpec& arm_;
  const UrdfLines& lines_;
  const urdf::ModelInterface& model_;
  std::set<std::string> path_;  // names of the chain's joints
  ChainDescription chain_;
  Eigen::Isometry3d pending_ = Eigen::Isometry3d::Identity();
  std::vector<std::pair<std::size_t, std::string>> masters_;
};

}  // namespace

ChainDescription read_urdf_chain(const SerialArmSpec& arm, const SourcePlace& place) {
  const std::string file = arm.urdf.string();
  const std::string text = read_file(arm.urdf, largest_urdf);
  const UrdfLines lines(text, file);
  const urdf::ModelInterfaceSharedPtr model = parse(text, file);
  const std::string base = base_of(*model, arm, place), tip = tip_of(*model, arm, place);
  const std::vector<urdf::JointConstSharedPtr> joints = path(*model, base, tip, place);
  ChainBuilder builder(arm, lines, *model, joints);
  for (const auto& joint : joints) builder.add(*joint);
  ChainDescription chain = builder.finish();
  if (chain.coordinates.empty())
    throw InputError(place, "no joint moves between '" + base + "' and '" + tip + "'",
                     "name a base and a tip with joints between");
  if (chain.joints.size() > 64)
    throw InputError(place, "the chain has " + std::to_string(chain.joints.size()) + " joints",
                     "at most 64 are allowed");
  return chain;
}

}  // namespace posewright
