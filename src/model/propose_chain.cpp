#include "posewright/model/propose_chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "posewright/support/near_words.hpp"
#include "posewright/support/text.hpp"
#include "urdf_document.hpp"

namespace posewright {
namespace {

constexpr std::array<std::string_view, 5> flange_names = {"tool0", "flange", "ee_link", "tool_frame", "tcp"};
constexpr std::array<std::string_view, 2> base_names = {"base_link", "link0"};

bool anything_moves(const UrdfJoint* joint) {
  return joint->moves() || std::ranges::any_of(joint->child->below, anything_moves);
}

bool is_called(const std::string& link, std::string_view name) {
  return link == name || link.ends_with("_" + std::string(name));
}

/// The last joint that moves a link; null: none.
const UrdfJoint* mover_of(const UrdfLink& link) {
  const UrdfJoint* joint = link.above;
  while (joint != nullptr && !joint->moves()) joint = joint->parent->above;
  return joint;
}

/// The only link of that name that a joint moves; null if there is none or several.
const UrdfLink* flange(const UrdfTree& tree) {
  for (const std::string_view name : flange_names) {
    const UrdfLink* found = nullptr;
    int count = 0;
    for (const auto& [link_name, link] : tree.links())
      if (is_called(link_name, name) && mover_of(link) != nullptr) found = &link, ++count;
    if (count == 1) return found;
  }
  return nullptr;
}

std::string ends(const UrdfTree& tree) {
  std::vector<std::string> names;
  for (const auto& [name, link] : tree.links())
    if (link.below.empty() && mover_of(link) != nullptr) names.push_back(name);
  return fmt::format("{}", fmt::join(names, ", "));
}

const UrdfLink& end_of_way(const UrdfTree& tree, const UrdfLink& from, const std::string& file) {
  const UrdfLink* link = &from;
  while (true) {
    std::vector<const UrdfJoint*> moving;
    std::ranges::copy_if(link->below, std::back_inserter(moving), anything_moves);
    if (moving.size() == 1) {
      link = moving.front()->child;
    } else if (moving.empty() && link->below.size() == 1) {
      link = link->below.front()->child;
    } else {
      break;
    }
  }
  if (mover_of(*link) != mover_of(from)) return *link;
  const std::string all = ends(tree);
  throw InputError({file, 0}, all.empty() ? "has no joint that moves" : "has several arms or ends",
                   all.empty() ? "a robot is needed" : "name one with --tip: " + all);
}

const UrdfLink& given_link(const UrdfTree& tree, const std::string& name, const std::string& option,
                           const std::string& file) {
  if (const UrdfLink* link = tree.link(name)) return *link;
  std::vector<std::string> names;
  for (const auto& entry : tree.links()) names.push_back(entry.first);
  throw InputError({file, 0}, "has no link " + in_quotes(name) + meant_instead(name, names) + ", " + option,
                   fmt::format("links: {}", fmt::join(names, ", ")));
}

/// A base that drives or floats: its joint is of no axis.
bool carries(const UrdfJoint& joint) { return joint.moves() && !joint.has_axis(); }

/// Parent of the first moving joint, or a fixed link above it with the name of a base.
std::string base_of(const UrdfLink& tip) {
  std::vector<const UrdfLink*> way{&tip};
  while (way.back()->above != nullptr) way.push_back(way.back()->above->parent);
  std::string base = way.back()->name;
  for (auto link = way.rbegin(); link != way.rend(); ++link) {
    const UrdfJoint* above = (*link)->above;
    if (above != nullptr && above->has_axis()) break;
    base = (*link)->name;
    const bool stands = above == nullptr || !carries(*above);
    if (stands && std::ranges::any_of(base_names, [&](std::string_view name) { return is_called(base, name); })) break;
  }
  return base;
}

}  // namespace

ProposedChain propose_chain(const SerialArmSpec& arm, const std::string& base, const std::string& tip) {
  const UrdfDocument urdf = UrdfDocument::whole(arm);
  const UrdfTree& tree = urdf.tree();
  const std::string file = arm.urdf.string();
  const UrdfLink& start = base.empty() ? tree.root() : given_link(tree, base, "--base", file);
  const UrdfLink* end = tip.empty() ? nullptr : &given_link(tree, tip, "--tip", file);
  if (end == nullptr && base.empty()) end = flange(tree);
  if (end == nullptr) end = &end_of_way(tree, start, file);
  if (base.empty() && mover_of(*end) == nullptr)
    throw InputError({file, 0}, "has no joint that moves " + in_quotes(end->name), "another --tip");
  ProposedChain chain{base.empty() ? base_of(*end) : base, end->name, {}};
  for (const auto& [name, link] : tree.links())
    if (name != chain.tip && mover_of(link) == mover_of(*end)) chain.other_tips.push_back(name);
  return chain;
}

}  // namespace posewright
