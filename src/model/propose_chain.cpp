#include "posewright/model/propose_chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "posewright/support/near_words.hpp"
#include "posewright/support/text.hpp"
#include "urdf_document.hpp"

namespace posewright {
namespace {

using LinkPtr = urdf::LinkConstSharedPtr;

constexpr std::array<std::string_view, 5> flange_names = {"tool0", "flange", "ee_link", "tool_frame", "tcp"};
constexpr std::array<std::string_view, 2> base_names = {"base_link", "link0"};

bool moves(const urdf::Joint& joint) { return joint.type != urdf::Joint::FIXED; }

bool anything_moves_below(const urdf::ModelInterface& model, const std::string& link) {
  for (const auto& joint : model.getLink(link)->child_joints)
    if (moves(*joint) || anything_moves_below(model, joint->child_link_name)) return true;
  return false;
}

bool is_called(const std::string& link, std::string_view name) {
  return link == name || link.ends_with("_" + std::string(name));
}

int joints_above(const urdf::ModelInterface& model, LinkPtr link) {
  int count = 0;
  for (; link->parent_joint != nullptr; link = model.getLink(link->parent_joint->parent_link_name))
    count += moves(*link->parent_joint) ? 1 : 0;
  return count;
}

/// The only link of that name that a joint moves; null if there is none or several.
LinkPtr flange(const urdf::ModelInterface& model) {
  for (const std::string_view name : flange_names) {
    LinkPtr found;
    int count = 0;
    for (const auto& [link_name, link] : model.links_)
      if (is_called(link_name, name) && joints_above(model, link) > 0) found = link, ++count;
    if (count == 1) return found;
  }
  return nullptr;
}

std::string ends(const urdf::ModelInterface& model) {
  std::vector<std::string> names;
  for (const auto& [name, link] : model.links_)
    if (link->child_joints.empty() && joints_above(model, link) > 0) names.push_back(name);
  return fmt::format("{}", fmt::join(names, ", "));
}

LinkPtr end_of_way(const UrdfDocument& urdf, const std::string& from, const std::string& file) {
  const urdf::ModelInterface& model = urdf.model();
  LinkPtr link = model.getLink(from);
  while (true) {
    std::vector<std::string> moving;
    for (const auto& joint : link->child_joints)
      if (moves(*joint) || anything_moves_below(model, joint->child_link_name))
        moving.push_back(joint->child_link_name);
    if (moving.size() == 1) {
      link = model.getLink(moving.front());
    } else if (moving.empty() && link->child_joints.size() == 1) {
      link = model.getLink(link->child_joints.front()->child_link_name);
    } else {
      break;
    }
  }
  if (joints_above(model, link) > joints_above(model, model.getLink(from))) return link;
  const std::string all = ends(model);
  throw InputError({file, 0}, all.empty() ? "has no joint that moves" : "has several arms or ends",
                   all.empty() ? "a robot is needed" : "name one with --tip: " + all);
}

LinkPtr given_link(const UrdfDocument& urdf, const std::string& name, const std::string& option,
                   const std::string& file) {
  if (const LinkPtr link = urdf.model().getLink(name)) return link;
  std::vector<std::string> names;
  for (const auto& entry : urdf.model().links_) names.push_back(entry.first);
  throw InputError({file, 0}, "has no link " + in_quotes(name) + meant_instead(name, names) + ", " + option,
                   fmt::format("links: {}", fmt::join(names, ", ")));
}

/// A base that drives or floats: its joint is of no axis.
bool carries(const urdf::Joint& joint) {
  return joint.type == urdf::Joint::FLOATING || joint.type == urdf::Joint::PLANAR;
}

/// Parent of the first moving joint, or a fixed link above it with the name of a base.
std::string base_of(const urdf::ModelInterface& model, LinkPtr tip) {
  std::vector<LinkPtr> way;
  for (LinkPtr link = tip;; link = model.getLink(link->parent_joint->parent_link_name)) {
    way.push_back(link);
    if (link->parent_joint == nullptr) break;
  }
  std::string base = way.back()->name;
  for (auto link = way.rbegin(); link != way.rend(); ++link) {
    if ((*link)->parent_joint != nullptr && moves(*(*link)->parent_joint) && !carries(*(*link)->parent_joint)) break;
    base = (*link)->name;
    const bool stands = (*link)->parent_joint == nullptr || !carries(*(*link)->parent_joint);
    if (stands &&
        std::any_of(base_names.begin(), base_names.end(), [&](std::string_view name) { return is_called(base, name); }))
      break;
  }
  return base;
}

}  // namespace

ProposedChain propose_chain(const SerialArmSpec& arm, const std::string& base, const std::string& tip) {
  const UrdfDocument urdf = UrdfDocument::whole(arm);
  const std::string file = arm.urdf.string();
  if (!base.empty()) given_link(urdf, base, "--base", file);
  LinkPtr end = tip.empty() ? nullptr : given_link(urdf, tip, "--tip", file);
  if (end == nullptr && base.empty()) end = flange(urdf.model());
  if (end == nullptr) end = end_of_way(urdf, base.empty() ? urdf.base() : base, file);
  if (base.empty() && joints_above(urdf.model(), end) == 0)
    throw InputError({file, 0}, "has no joint that moves " + in_quotes(end->name), "another --tip");
  ProposedChain chain{base.empty() ? base_of(urdf.model(), end) : base, end->name, {}};
  const int joints = joints_above(urdf.model(), end);
  for (const auto& [name, link] : urdf.model().links_)
    if (name != chain.tip && joints_above(urdf.model(), link) == joints) chain.other_tips.push_back(name);
  return chain;
}

}  // namespace posewright
