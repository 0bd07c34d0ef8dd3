#include "posewright/model/urdf_ways.hpp"

#include <algorithm>
#include <map>

#include "posewright/model/placement.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/problem/ways.hpp"
#include "urdf_document.hpp"

namespace posewright {
namespace {

/// The joint whose offset and gear are those of a coordinate.
std::string own_joint(const ChainDescription& chain, std::size_t coordinate) {
  const auto own = std::ranges::find_if(
      chain.joints, [&](const ChainJoint& joint) { return !joint.mimic && joint.coordinate == int(coordinate); });
  return own->name;
}

}  // namespace

SerialArmSpec arm_of_way(const SerialArmSpec& arm, const WaySpec& way) {
  SerialArmSpec one = arm;
  one.ways.clear();
  one.tip = way.of.link;
  if (way.in) {
    one.base = way.in->link;
    one.placement = {};
  }
  return one;
}

std::size_t way_of(const SerialArmSpec& arm, const MeasurementSpec& instrument) {
  const auto own = std::ranges::find_if(arm.ways, [&](const WaySpec& way) { return measures(instrument, way); });
  return std::size_t(own - arm.ways.begin());
}

WayChains read_urdf_ways(const SerialArmSpec& arm, const SourcePlace& place) {
  const UrdfDocument names_tips(arm, place);  // a link that is not there is a tip, of whichever end of a way
  WayChains all;
  std::map<std::string, std::string> owners;
  for (const WaySpec& way : arm.ways) {
    WayChain one{way, read_urdf_chain(arm_of_way(arm, way), {place.file, way.of.link.line}), {}};
    for (std::size_t c = 0; c < one.chain.coordinates.size(); ++c) {
      const Coordinate& coordinate = one.chain.coordinates[c];
      const std::string owner = own_joint(one.chain, c);
      const auto [known, added] = owners.emplace(coordinate.name, owner);
      if (!added && known->second != owner)
        throw InputError({place.file, way.of.link.line},
                         "joint '" + owner + "' on the way to tip '" + way.of.name + "' follows '" + coordinate.name +
                             "', whose offset on the way to another tip is that of '" + known->second + "'",
                         "hold '" + coordinate.name + "', or leave one of these tips out");
      const auto at = std::ranges::find(all.coordinates, coordinate.name, &Coordinate::name);
      one.coordinates.push_back(std::size_t(at - all.coordinates.begin()));
      if (at == all.coordinates.end()) all.coordinates.push_back(coordinate);
    }
    all.ways.push_back(std::move(one));
  }
  return all;
}

UrdfFrames read_urdf_frames(const SerialArmSpec& arm, const SourcePlace& place) {
  const WayChains all = read_urdf_ways(arm, place);
  const UrdfDocument urdf(arm, place);
  UrdfFrames result;
  result.robot = urdf.tree().robot();
  result.coordinates = all.coordinates;
  std::map<const UrdfLink*, UrdfFrames::Tip> placed{{&urdf.tree().root(), {}}};
  const auto place_of = [&](const UrdfLink& link) {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    const UrdfLink* at = &link;
    for (; placed.count(at) == 0; at = at->above->parent) X = at->above->X_ParentChild() * X;
    return UrdfFrames::Tip{"", placed.at(at).frame, placed.at(at).X_FrameTip * X};
  };
  for (const UrdfJoint* moving : urdf.moving()) {
    for (const WayChain& way : all.ways) {
      const auto own = std::ranges::find(way.chain.joints, moving->name, &ChainJoint::name);
      if (own == way.chain.joints.end()) continue;
      const UrdfFrames::Tip parent = place_of(*moving->parent);
      ChainJoint joint = *own;
      joint.X_ParentJoint = parent.X_FrameTip * moving->X_ParentJoint;
      if (joint.backward()) joint.axis = -joint.axis;
      joint.X_AboveJoint.reset();
      joint.coordinate = int(way.coordinates[std::size_t(own->coordinate)]);
      result.joints.push_back(std::move(joint));
      result.parents.push_back(parent.frame);
      break;
    }
    placed[moving->child] = {"", int(result.joints.size()), Eigen::Isometry3d::Identity()};
  }
  const auto add = [&](const TipSpec& tip) {
    if (std::ranges::find(result.tips, tip.name, &UrdfFrames::Tip::name) != result.tips.end()) return;
    result.tips.push_back(place_of(*urdf.tree().link(tip.link.value)));
    result.tips.back().name = tip.name;
  };
  for (const WaySpec& way : arm.ways) {
    add(way.of);
    if (way.in) add(*way.in);
  }
  if (arm.base) result.base = place_of(*urdf.tree().link(arm.base->value));
  result.base.X_FrameTip = result.base.X_FrameTip * isometry(arm.placement).inverse();
  return result;
}

}  // namespace posewright
