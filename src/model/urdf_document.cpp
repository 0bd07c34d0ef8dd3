#include "urdf_document.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <mutex>

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

urdf::ModelInterfaceSharedPtr parse(const std::string& text, const std::string& file) {
  CapturedMessages messages;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(text);
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

std::string tip_of(const urdf::ModelInterface& model, const SerialArmSpec& arm, const SourcePlace& place) {
  std::vector<std::string> links, leaves;
  for (const auto& [name, link] : model.links_) {
    links.push_back(name);
    if (link->child_joints.empty()) leaves.push_back(name);
  }
  if (arm.tip) {
    if (model.links_.count(arm.tip->value) == 0)
      throw InputError({place.file, arm.tip->line},
                       "tip '" + arm.tip->value + "' is not a link of " + arm.urdf.filename().string(),
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
                     "base '" + arm.base->value + "' is not a link of " + arm.urdf.filename().string(),
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
    : text_(read_xml_text(arm.urdf, largest_urdf)),
      lines_(text_, arm.urdf.string()),
      model_(parse(text_, arm.urdf.string())),
      base_(base_of(*model_, arm, place)),
      tip_(tip_of(*model_, arm, place)),
      joints_(path(*model_, base_, tip_, place)) {}

}  // namespace posewright
