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
Coordinate coordinate_of(const UrdfJoint& joint) {
  const bool prismatic = joint.type == UrdfJoint::Type::prismatic;
  Coordinate c{joint.name, prismatic ? "m" : "rad", -std::numbers::pi, std::numbers::pi};
  c.periodic = joint.type == UrdfJoint::Type::continuous;
  if (joint.limits && joint.limits->velocity > 0) c.speed = joint.limits->velocity;
  if (!c.periodic) {
    c.lower = joint.limits->lower;
    c.upper = joint.limits->upper;
    if (!(c.lower < c.upper))
      throw InputError(joint.place, "joint '" + joint.name + "' has empty limits", "lower must be below upper");
  }
  const double lower = joint.soft_lower, upper = joint.soft_upper;
  const bool everything = c.periodic && upper - lower >= turn;
  if ((lower != 0 || upper != 0) && !everything)
    narrow(c, lower, upper, "soft limits of '" + joint.name + "' (safety_controller)", joint.place);
  return c;
}

/// True if a file limits a follower: 0 and 0 is the format's word for no limits.
bool has_own_end(const UrdfJoint& follower) {
  if (follower.type == UrdfJoint::Type::continuous) return true;
  return follower.has_axis() && follower.limits && (follower.limits->lower != 0 || follower.limits->upper != 0);
}

/// Limits of `master` by a joint that follows it: its own limits, soft limits and velocity.
void bind_follower(Coordinate& master, const UrdfJoint& follower) {
  if (!has_own_end(follower)) return;
  const double factor = follower.mimic->multiplier, offset = follower.mimic->offset;
  const Coordinate own = coordinate_of(follower);
  // A full turn of the master is one of the follower only if it turns by whole numbers.
  if (follower.type == UrdfJoint::Type::prismatic || factor != std::round(factor)) master.periodic = false;
  if (factor == 0) {
    if (!own.periodic && (offset < own.lower || offset > own.upper))
      throw InputError(follower.place, "joint '" + follower.name + "' is beyond its own limits",
                       "its mimic multiplier is 0, so its offset is its position");
    return;
  }
  if (!own.periodic) {
    const auto [lower, upper] = std::minmax({(own.lower - offset) / factor, (own.upper - offset) / factor});
    narrow(master, lower, upper, "limits of '" + follower.name + "', which follows it", follower.place);
  }
  if (own.speed > 0 && master.speed > 0) master.speed = std::min(master.speed, own.speed / std::abs(factor));
}

class ChainBuilder {
 public:
  ChainBuilder(const SerialArmSpec& arm, const UrdfDocument& urdf) : arm_(arm), tree_(urdf.tree()) {
    for (const UrdfStep& step : urdf.way()) path_.insert(step.joint);
    chain_.X_MeasureBase = isometry(arm.placement);
  }

  void add(const UrdfStep& step) {
    const UrdfJoint& joint = *step.joint;
    if (!step.backward || !joint.moves()) pending_ = pending_ * step.origin();
    if (joint.moves()) move(step);
    if (!chain_.joints.empty() && !step.backward) carry(*joint.child, pending_);
  }

  ChainDescription finish() {
    chain_.X_LastTip = pending_;
    resolve_mimics();
    return std::move(chain_);
  }

 private:
  /// Origin of a joint with those of the joints above it that do not move.
  static Eigen::Isometry3d behind_moving_joint(const UrdfJoint& joint) {
    Eigen::Isometry3d X = joint.X_ParentJoint;
    for (const UrdfJoint* above = joint.parent->above; above != nullptr && !above->moves();
         above = above->parent->above)
      X = above->X_ParentChild() * X;
    return X;
  }

  /// A joint backward stands where its child link is, and turns the other way; its origin follows.
  void move(const UrdfStep& step) {
    const UrdfJoint& joint = *step.joint;
    if (!joint.has_axis())
      throw InputError(joint.place, "joint '" + joint.name + "' has a type that no arm has",
                       "allowed: revolute, continuous, prismatic, fixed");
    ChainJoint result;
    result.name = joint.name;
    result.prismatic = joint.type == UrdfJoint::Type::prismatic;
    result.X_ParentJoint = pending_;
    if (step.backward) result.X_AboveJoint = behind_moving_joint(joint);
    pending_ = step.backward ? step.origin() : Eigen::Isometry3d::Identity();
    result.axis = step.backward ? Eigen::Vector3d(-joint.axis) : joint.axis;
    if (!(result.axis.norm() > 1e-9))
      throw InputError(joint.place, "joint '" + joint.name + "' has a zero axis", "a direction is needed");
    result.axis.normalize();
    if (joint.mimic) {
      result.multiplier = joint.mimic->multiplier;
      result.offset = joint.mimic->offset;
      const UrdfJoint* outside = master_outside(*joint.mimic);
      result.mimic = outside == nullptr;
      if (result.mimic) masters_.push_back({chain_.joints.size(), joint.mimic->master});
      else add_coordinate(*outside, result);
    } else {
      add_coordinate(joint, result);
    }
    chain_.joints.push_back(std::move(result));
  }

  /// @param own  the joint of the chain whose offset and gear are those of the coordinate
  void add_coordinate(const UrdfJoint& driven, ChainJoint& own) {
    own.coordinate = int(chain_.coordinates.size());
    chain_.coordinates.push_back(coordinate_of(driven));
    chain_.encoder_noise.push_back(arm_.encoder_noise);
  }

  /// The master that is not in the chain and moves, if this is the first joint of the chain that follows it.
  const UrdfJoint* master_outside(const UrdfMimic& mimic) const {
    const UrdfJoint* master = tree_.joint(mimic.master);
    const bool known =
        std::ranges::any_of(chain_.coordinates, [&](const Coordinate& c) { return c.name == mimic.master; });
    if (known || master == nullptr || path_.count(master) > 0 || master->mimic) return nullptr;
    return master->has_axis() ? master : nullptr;
  }

  /// Mass of a link and of the branches on it that are not part of the chain, as they hang at zero position.
  void carry(const UrdfLink& first, const Eigen::Isometry3d& X_JointFirst) {
    ChainJoint& joint = chain_.joints.back();
    std::vector<std::pair<const UrdfLink*, Eigen::Isometry3d>> open{{&first, X_JointFirst}};
    while (!open.empty()) {
      const auto [link, X_JointLink] = open.back();
      open.pop_back();
      if (link->mass > 0) {
        const Eigen::Vector3d centre = X_JointLink * link->centre_of_mass;
        const double total = joint.mass + link->mass;
        joint.centre_of_mass = (joint.mass * joint.centre_of_mass + link->mass * centre) / total;
        joint.mass = total;
      }
      // In the order of the names, as sums are rounded.
      for (auto branch = link->below.rbegin(); branch != link->below.rend(); ++branch)
        if (path_.count(*branch) == 0) open.emplace_back((*branch)->child, X_JointLink * (*branch)->X_ParentChild());
    }
  }

  void resolve_mimics() {
    for (const auto& [index, master] : masters_) {
      const auto found = std::ranges::find(chain_.coordinates, master, &Coordinate::name);
      if (found == chain_.coordinates.end())
        throw InputError(tree_.joint(chain_.joints[index].name)->place,
                         "joint '" + chain_.joints[index].name + "' mimics '" + master + "', which is not in the chain",
                         "its master must be a joint that moves and follows no other");
      chain_.joints[index].coordinate = int(found - chain_.coordinates.begin());
    }
    // Fingers and covers beside the chain follow its joints too, and end them.
    for (const auto& [name, joint] : tree_.joints()) {
      if (!joint.mimic) continue;
      for (Coordinate& c : chain_.coordinates)
        if (c.name == joint.mimic->master) bind_follower(c, joint);
    }
  }

  const SerialArmSpec& arm_;
  const UrdfTree& tree_;
  std::set<const UrdfJoint*> path_;
  ChainDescription chain_;
  Eigen::Isometry3d pending_ = Eigen::Isometry3d::Identity();
  std::vector<std::pair<std::size_t, std::string>> masters_;
};

}  // namespace

ChainDescription read_urdf_chain(const SerialArmSpec& arm, const SourcePlace& place) {
  if (!arm.ways.empty())
    throw InputError(place, "the instruments see several tips, and this is for one alone",
                     "robot: base and tip, and instruments that see that tip");
  const UrdfDocument urdf(arm, place);
  ChainBuilder builder(arm, urdf);
  if (arm.elastostatic && urdf.moves_base())
    throw InputError({place.file, arm.elastostatic->line},
                     "elastostatic needs a base that stands, and joints between '" + urdf.base().name + "' and '" +
                         urdf.tip().name + "' move it",
                     "a base above the tip");
  for (const UrdfStep& step : urdf.way()) builder.add(step);
  ChainDescription chain = builder.finish();
  chain.robot = urdf.tree().robot();
  if (chain.coordinates.empty())
    throw InputError(place, "no joint moves between '" + urdf.base().name + "' and '" + urdf.tip().name + "'",
                     "name a base and a tip with joints between");
  if (chain.joints.size() > 64)
    throw InputError(place, "the chain has " + std::to_string(chain.joints.size()) + " joints",
                     "at most 64 are allowed");
  return chain;
}

}  // namespace posewright
