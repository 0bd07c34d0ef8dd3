#include "urdf_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "parameter_names.hpp"
#include "posewright/model/srdf.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

constexpr std::uintmax_t largest_urdf = 20'000'000;  // bytes

/// Lines are those of the text that xacro wrote.
std::string name_of_text(const SerialArmSpec& arm) { return arm.urdf.string() + (arm.expanded ? " (expanded)" : ""); }

std::string names_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The arm with the base and tip that a group of the SRDF gives: those of its chain, or of the way that its joints lie
/// on.
SerialArmSpec with_group(const UrdfTree& tree, SerialArmSpec arm, const SourcePlace& place) {
  if (!arm.group) return arm;
  const SrdfGroup group = read_srdf_group(arm.srdf->value, *arm.group, {place.file, arm.srdf->line});
  std::string base = group.base, tip = group.tip;
  std::map<int, const UrdfJoint*> by_depth;
  for (const std::string& name : group.joints) {
    const UrdfJoint* joint = tree.joint(name);
    if (joint == nullptr)
      throw InputError(group.place, "joint '" + name + "' of the group is not in " + arm.urdf.filename().string(), "");
    int depth = 0;
    for (const UrdfJoint* above = joint; above != nullptr; above = above->parent->above) ++depth;
    by_depth[depth] = joint;
  }
  if (!by_depth.empty()) {
    base = by_depth.begin()->second->parent->name;
    tip = by_depth.rbegin()->second->child->name;
  }
  arm.base = Located<std::string>{base, arm.group->line};
  arm.tip = Located<std::string>{tip, arm.group->line};
  return arm;
}

/// @param end  "base" or "tip"
const UrdfLink& named_link(const UrdfTree& tree, const SerialArmSpec& arm, const std::string& end,
                           const Located<std::string>& name, const SourcePlace& place) {
  if (const UrdfLink* link = tree.link(name.value)) return *link;
  std::vector<std::string> links;
  for (const auto& entry : tree.links()) links.push_back(entry.first);
  throw InputError(
      {place.file, name.line},
      end + " '" + name.value + "' is not a link of " + arm.urdf.filename().string() + meant_instead(name.value, links),
      "links: " + names_of(links));
}

const UrdfLink& tip_of(const UrdfTree& tree, const SerialArmSpec& arm, const SourcePlace& place) {
  if (arm.tip) return named_link(tree, arm, "tip", *arm.tip, place);
  std::vector<std::string> leaves;
  for (const auto& [name, link] : tree.links())
    if (link.below.empty()) leaves.push_back(name);
  if (leaves.size() != 1)
    throw InputError(place, "the robot has several ends and no tip is named",
                     "set robot: tip to one of " + names_of(leaves));
  return *tree.link(leaves.front());
}

const UrdfLink& base_of(const UrdfTree& tree, const SerialArmSpec& arm, const SourcePlace& place) {
  return arm.base ? named_link(tree, arm, "base", *arm.base, place) : tree.root();
}

/// Throws InputError for a joint that cannot be held there.
void require_held(const UrdfJoint& joint, const Measured& value, const SourcePlace& place) {
  const bool slides = joint.type == UrdfJoint::Type::prismatic;
  const std::string name = "joint '" + joint.name + "'";
  if (joint.mimic) throw InputError(place, name + " follows '" + joint.mimic->master + "'", "hold that one");
  if (!joint.has_axis() || !(joint.axis.norm() > 1e-9))
    throw InputError(place, name + " has no axis to be held on", "revolute, continuous and prismatic joints are held");
  if (!fits_unit(value.quantity, slides ? "m" : "rad"))
    throw InputError(place, name + (slides ? " slides, and is held at an angle" : " turns, and is held at a length"),
                     slides ? "a length" : "an angle");
  if (joint.type != UrdfJoint::Type::continuous &&
      (value.value < joint.limits->lower || value.value > joint.limits->upper))
    throw InputError(place, fmt::format("{} is held at {:g}, beyond its limits", name, value.value),
                     fmt::format("{:g} to {:g} {}", joint.limits->lower, joint.limits->upper, slides ? "m" : "rad"));
}

/// Values of the joints that the problem holds; a glob passes over joints that follow others.
std::map<std::string, double> held_joints(const UrdfTree& tree, const SerialArmSpec& arm, const SourcePlace& place) {
  std::map<std::string, double> held;
  for (const auto& [pattern, value] : arm.hold) {
    const SourcePlace here{place.file, pattern.line};
    const bool one = tree.joint(pattern.value) != nullptr;
    bool any = false;
    std::vector<std::string> names;
    for (const auto& [name, joint] : tree.joints()) {
      if (!joint.moves()) continue;
      names.push_back(name);
      if (!matches(pattern.value, name) || (joint.mimic && !one)) continue;
      require_held(joint, value, here);
      if (!held.emplace(name, value.value).second)
        throw InputError(here, "joint '" + name + "' is held twice", "one value for each joint");
      any = true;
    }
    if (!any)
      throw InputError(here,
                       "hold: '" + pattern.value + "' is no joint of " + arm.urdf.filename().string() + " that moves" +
                           meant_instead(pattern.value, names),
                       "joints: " + names_of(names));
  }
  return held;
}

std::vector<const UrdfJoint*> way_to_root(const UrdfLink& link) {
  std::vector<const UrdfJoint*> joints;
  for (const UrdfJoint* joint = link.above; joint != nullptr; joint = joint->parent->above) joints.push_back(joint);
  return joints;
}

std::vector<UrdfStep> way_between(const UrdfLink& base, const UrdfLink& tip) {
  std::vector<const UrdfJoint*> up = way_to_root(base), down = way_to_root(tip);
  while (!up.empty() && !down.empty() && up.back() == down.back()) {
    up.pop_back();
    down.pop_back();
  }
  std::vector<UrdfStep> way;
  for (const UrdfJoint* joint : up) way.push_back({joint, true});
  for (auto joint = down.rbegin(); joint != down.rend(); ++joint) way.push_back({*joint, false});
  return way;
}

}  // namespace

UrdfDocument::UrdfDocument(const SerialArmSpec& arm, const SourcePlace& place)
    : UrdfDocument(arm.expanded ? *arm.expanded : read_xml_text(arm.urdf, largest_urdf), name_of_text(arm)) {
  if (!arm.ways.empty()) {
    take_ways(arm, place);
    return;
  }
  const SerialArmSpec grouped = with_group(tree_, arm, place);
  base_ = &base_of(tree_, grouped, place);
  tip_ = &tip_of(tree_, grouped, place);
  tree_.hold(held_joints(tree_, arm, place));
  way_ = way_between(*base_, *tip_);
}

UrdfDocument::UrdfDocument(std::string text, const std::string& name)
    : text_(std::move(text)), tree_(text_, name), base_(&tree_.root()), tip_(base_) {}

UrdfDocument::UrdfDocument(const std::filesystem::path& file)
    : UrdfDocument(read_xml_text(file, largest_urdf), file.string()) {}

void UrdfDocument::take_ways(const SerialArmSpec& arm, const SourcePlace& place) {
  const UrdfLink& base = base_of(tree_, arm, place);
  const auto link_of = [&](const TipSpec& tip) -> const UrdfLink& {
    return named_link(tree_, arm, "tip", tip.link, place);
  };
  std::vector<std::vector<UrdfStep>> ways;
  for (const WaySpec& way : arm.ways) ways.push_back(way_between(way.in ? link_of(*way.in) : base, link_of(way.of)));
  tree_.hold(held_joints(tree_, arm, place));
  std::set<const UrdfJoint*> on_way;
  for (const auto& way : ways)
    for (const UrdfStep& step : way)
      if (step.joint->moves()) on_way.insert(step.joint);
  std::vector<const UrdfLink*> open{&tree_.root()};
  while (!open.empty()) {
    const UrdfLink& link = *open.back();
    open.pop_back();
    if (link.above != nullptr && on_way.count(link.above) > 0) moving_.push_back(link.above);
    for (auto below = link.below.rbegin(); below != link.below.rend(); ++below) open.push_back((*below)->child);
  }
}

bool UrdfDocument::moves_base() const {
  return std::ranges::any_of(way_, [](const UrdfStep& step) { return step.backward && step.joint->moves(); });
}

UrdfDocument UrdfDocument::whole(const SerialArmSpec& arm) {
  return {arm.expanded ? *arm.expanded : read_xml_text(arm.urdf, largest_urdf), name_of_text(arm)};
}

}  // namespace posewright
