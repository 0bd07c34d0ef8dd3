#include "posewright/model/urdf_reader.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "posewright/model/placement.hpp"
#include "urdf_document.hpp"

namespace posewright {
namespace {

constexpr double turn = 2 * std::numbers::pi;

/// Keeps c within [lower, upper]; `by` says what asks for it.
void narrow(Coordinate& c, double lower, double upper, const std::string& by, const SourcePlace& place) {
  if (lower <= c.lower && upper >= c.upper) return;
  c.lower = std::max(c.lower, lower);
  c.upper = std::min(c.upper, upper);
  c.periodic = false;
  c.limited_by += (c.limited_by.empty() ? "" : ", ") + by;
  if (!(c.lower < c.upper))
    throw InputError(place, "no range is left for joint '" + c.name + "'", "it is narrowed by " + by);
}

/// Hard and soft limits of a joint alone. Soft ones are those of <safety_controller>, where both are 0 none (the
/// default of the format).
Coordinate coordinate_of(const urdf::Joint& joint, const SourcePlace& place) {
  const bool prismatic = joint.type == urdf::Joint::PRISMATIC;
  Coordinate c{joint.name, prismatic ? "m" : "rad", -std::numbers::pi, std::numbers::pi};
  c.periodic = joint.type == urdf::Joint::CONTINUOUS;
  if (joint.limits != nullptr && joint.limits->velocity > 0) c.speed = joint.limits->velocity;
  if (!c.periodic) {
    if (joint.limits == nullptr)
      throw InputError(place, "joint '" + joint.name + "' has no <limit>",
                       "lower and upper are needed, or type continuous");
    c.lower = joint.limits->lower;
    c.upper = joint.limits->upper;
    if (!(c.lower < c.upper))
      throw InputError(place, "joint '" + joint.name + "' has empty limits", "lower must be below upper");
  }
  if (joint.safety == nullptr) return c;
  const double lower = joint.safety->soft_lower_limit, upper = joint.safety->soft_upper_limit;
  const bool everything = c.periodic && upper - lower >= turn;
  if ((lower != 0 || upper != 0) && !everything)
    narrow(c, lower, upper, "soft limits of '" + joint.name + "' (safety_controller)", place);
  return c;
}

/// True if a file limits a follower: 0 and 0 is the format's word for no limits.
bool has_own_end(const urdf::Joint& follower) {
  if (follower.type == urdf::Joint::CONTINUOUS) return true;
  return (follower.type == urdf::Joint::REVOLUTE || follower.type == urdf::Joint::PRISMATIC) &&
         follower.limits != nullptr && (follower.limits->lower != 0 || follower.limits->upper != 0);
}

/// Limits of `master` by a joint that follows it: its own limits, soft limits and velocity.
void bind_follower(Coordinate& master, const urdf::Joint& follower, const SourcePlace& place) {
  if (!has_own_end(follower)) return;
  const double factor = follower.mimic->multiplier, offset = follower.mimic->offset;
  const Coordinate own = coordinate_of(follower, place);
  // A full turn of the master is one of the follower only if it turns by whole numbers.
  if (follower.type == urdf::Joint::PRISMATIC || factor != std::round(factor)) master.periodic = false;
  if (factor == 0) {
    if (!own.periodic && (offset < own.lower || offset > own.upper))
      throw InputError(place, "joint '" + follower.name + "' is beyond its own limits",
                       "its mimic multiplier is 0, so its offset is its position");
    return;
  }
  if (!own.periodic) {
    const auto [lower, upper] = std::minmax({(own.lower - offset) / factor, (own.upper - offset) / factor});
    narrow(master, lower, upper, "limits of '" + follower.name + "', which follows it", place);
  }
  if (own.speed > 0 && master.speed > 0) master.speed = std::min(master.speed, own.speed / std::abs(factor));
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
      throw InputError(place, "joint '" + joint.name + "' has a type that no arm has",
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
      result.multiplier = joint.mimic->multiplier;
      result.offset = joint.mimic->offset;
      const urdf::JointConstSharedPtr outside = master_outside(*joint.mimic);
      result.mimic = outside == nullptr;
      if (result.mimic) masters_.push_back({chain_.joints.size(), joint.mimic->joint_name});
      else add_coordinate(*outside, result);
    } else {
      add_coordinate(joint, result);
    }
    chain_.joints.push_back(std::move(result));
  }

  /// @param own  the joint of the chain whose offset and gear are those of the coordinate
  void add_coordinate(const urdf::Joint& driven, ChainJoint& own) {
    own.coordinate = int(chain_.coordinates.size());
    chain_.coordinates.push_back(coordinate_of(driven, lines_.joint(driven.name)));
    chain_.encoder_noise.push_back(arm_.encoder_noise);
  }

  /// The master that is not in the chain and moves, if this is the first joint of the chain that follows it.
  urdf::JointConstSharedPtr master_outside(const urdf::JointMimic& mimic) const {
    const urdf::JointConstSharedPtr master = model_.getJoint(mimic.joint_name);
    const bool known =
        std::ranges::any_of(chain_.coordinates, [&](const Coordinate& c) { return c.name == mimic.joint_name; });
    if (known || master == nullptr || path_.count(master->name) > 0 || master->mimic != nullptr) return nullptr;
    const bool moves = master->type == urdf::Joint::REVOLUTE || master->type == urdf::Joint::CONTINUOUS ||
                       master->type == urdf::Joint::PRISMATIC;
    return moves ? master : nullptr;
  }

  /// Mass of a link and of the branches on it that are not part of the chain, as they hang at zero position.
  void carry(const urdf::Link& first, const Eigen::Isometry3d& X_JointFirst) {
    ChainJoint& joint = chain_.joints.back();
    std::vector<std::pair<const urdf::Link*, Eigen::Isometry3d>> open{{&first, X_JointFirst}};
    while (!open.empty()) {
      const auto [link, X_JointLink] = open.back();
      open.pop_back();
      if (link->inertial != nullptr && link->inertial->mass > 0) {
        const Eigen::Vector3d centre = X_JointLink * isometry(link->inertial->origin).translation();
        const double total = joint.mass + link->inertial->mass;
        joint.centre_of_mass = (joint.mass * joint.centre_of_mass + link->inertial->mass * centre) / total;
        joint.mass = total;
      }
      // In the order of the file, as sums are rounded.
      for (auto branch = link->child_joints.rbegin(); branch != link->child_joints.rend(); ++branch)
        if (path_.count((*branch)->name) == 0)
          open.emplace_back(model_.getLink((*branch)->child_link_name).get(),
                            X_JointLink * isometry((*branch)->parent_to_joint_origin_transform));
    }
  }

  void resolve_mimics() {
    for (const auto& [index, master] : masters_) {
      const auto found = std::ranges::find(chain_.coordinates, master, &Coordinate::name);
      if (found == chain_.coordinates.end())
        throw InputError(lines_.joint(chain_.joints[index].name),
                         "joint '" + chain_.joints[index].name + "' mimics '" + master + "', which is not in the chain",
                         "its master must be a joint that moves and follows no other");
      chain_.joints[index].coordinate = int(found - chain_.coordinates.begin());
    }
    // Fingers and covers beside the chain follow its joints too, and end them.
    for (const auto& [name, joint] : model_.joints_) {
      if (joint->mimic == nullptr) continue;
      for (Coordinate& c : chain_.coordinates)
        if (c.name == joint->mimic->joint_name) bind_follower(c, *joint, lines_.joint(name));
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
  const UrdfDocument urdf(arm, place);
  ChainBuilder builder(arm, urdf.lines(), urdf.model(), urdf.joints());
  for (const auto& joint : urdf.joints()) builder.add(*joint);
  ChainDescription chain = builder.finish();
  chain.robot = urdf.model().getName();
  if (chain.coordinates.empty())
    throw InputError(place, "no joint moves between '" + urdf.base() + "' and '" + urdf.tip() + "'",
                     "name a base and a tip with joints between");
  if (chain.joints.size() > 64)
    throw InputError(place, "the chain has " + std::to_string(chain.joints.size()) + " joints",
                     "at most 64 are allowed");
  return chain;
}

}  // namespace posewright
