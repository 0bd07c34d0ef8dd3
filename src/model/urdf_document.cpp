#include "urdf_document.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <new>

#include "posewright/model/srdf.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/text_file.hpp"

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

/// Lines are those of the text that xacro wrote.
std::string name_of_text(const SerialArmSpec& arm) { return arm.urdf.string() + (arm.expanded ? " (expanded)" : ""); }

urdf::ModelInterfaceSharedPtr parse(const std::string& text, const std::string& file) {
  CapturedMessages messages;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError({file, 0}, std::string("is not valid URDF: ") + error.what(), "");
  }
  if (model == nullptr)
    throw InputError({file, 0}, "is not valid URDF: " + (messages.first().empty() ? "not accepted" : messages.first()),
                     "");
  return model;
}

std::string names_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The arm with the base and tip that a group of the SRDF gives: those of its chain, or of the way that its joints lie
/// on.
SerialArmSpec with_group(const urdf::ModelInterface& model, SerialArmSpec arm, const SourcePlace& place) {
  if (!arm.group) return arm;
  const SrdfGroup group = read_srdf_group(arm.srdf->value, *arm.group, {place.file, arm.srdf->line});
  std::string base = group.base, tip = group.tip;
  std::map<int, const urdf::Joint*> by_depth;
  for (const std::string& name : group.joints) {
    const urdf::JointConstSharedPtr joint = model.getJoint(name);
    if (joint == nullptr)
      throw InputError(group.place, "joint '" + name + "' of the group is not in " + arm.urdf.filename().string(), "");
    int depth = 0;
    for (auto above = joint; above != nullptr; above = model.getLink(above->parent_link_name)->parent_joint) ++depth;
    by_depth[depth] = joint.get();
  }
  if (!by_depth.empty()) {
    base = by_depth.begin()->second->parent_link_name;
    tip = by_depth.rbegin()->second->child_link_name;
  }
  arm.base = Located<std::string>{base, arm.group->line};
  arm.tip = Located<std::string>{tip, arm.group->line};
  return arm;
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
                       "tip '" + arm.tip->value + "' is not a link of " + arm.urdf.filename().string() +
                           meant_instead(arm.tip->value, links),
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
                     "base '" + arm.base->value + "' is not a link of " + arm.urdf.filename().string() +
                         meant_instead(arm.base->value, links),
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

}  // namespace

Eigen::Isometry3d isometry(const urdf::Pose& pose) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  X.linear() = Eigen::Quaterniond(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z)
                   .normalized()
                   .toRotationMatrix();
  return X;
}

UrdfDocument::UrdfDocument(const SerialArmSpec& arm, const SourcePlace& place)
    : text_(arm.expanded ? *arm.expanded : read_xml_text(arm.urdf, largest_urdf)),
      lines_(text_, name_of_text(arm)),
      model_(parse(text_, name_of_text(arm))),
      base_(base_of(*model_, with_group(*model_, arm, place), place)),
      tip_(tip_of(*model_, with_group(*model_, arm, place), place)),
      joints_(path(*model_, base_, tip_, place)) {}

UrdfDocument::UrdfDocument(std::string text, const std::string& name)
    : text_(std::move(text)),
      lines_(text_, name),
      model_(parse(text_, name)),
      base_(model_->getRoot()->name),
      tip_(base_) {}

UrdfDocument::UrdfDocument(const std::filesystem::path& file)
    : UrdfDocument(read_xml_text(file, largest_urdf), file.string()) {}

UrdfDocument UrdfDocument::whole(const SerialArmSpec& arm) {
  return {arm.expanded ? *arm.expanded : read_xml_text(arm.urdf, largest_urdf), name_of_text(arm)};
}

}  // namespace posewright
