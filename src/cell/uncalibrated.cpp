#include <algorithm>
#include <cmath>

#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/support/random.hpp"
#include "scene.hpp"

namespace posewright {
namespace {

constexpr int samples = 200;
constexpr std::uint64_t tolerance_seed = 4711;

std::vector<double> random_configuration(const std::vector<Coordinate>& coordinates, Random& random) {
  std::vector<double> q;
  for (const Coordinate& c : coordinates)
    q.push_back(c.discrete() ? c.values[std::size_t(random.index(int(c.values.size())))]
                             : c.lower + random.uniform() * (c.upper - c.lower));
  return q;
}

/// The robot alone, as an instrument that reads its pose would see it: its parameters move links whatever measures
/// them.
std::unique_ptr<IdentificationModel> bare_robot(Problem problem) {
  PoseMeasurement pose;
  pose.covariance.setIdentity();
  problem.measurement.instrument = pose;
  problem.measurement.loaded_minus_unloaded = false;
  VariantSpec variant = find_variant(problem, "");
  variant.nominal.clear();  // may name the instrument's parameters
  return make_model({problem, variant});
}

}  // namespace

UncalibratedError::UncalibratedError(const Problem& problem, const IdentificationModel& model, const BodyFrames& frames)
    : frames_(frames) {
  const VariantColumns columns = select_columns(model, {problem, find_variant(problem, "")});
  if (frames.branches().size() > 1) {
    take_twists_of_frames(columns, model);
    return;
  }
  const std::unique_ptr<IdentificationModel> arm = bare_robot(problem);
  Random random(tolerance_seed, 0);
  Linearisation scratch;
  std::vector<int> selected;
  std::vector<double> tolerances, of_arm;
  for (std::size_t c = 0; c < columns.selected.size(); ++c) {
    const std::string& name = model.parameters()[std::size_t(columns.selected[c])].name;
    const auto& own = arm->parameters();
    const auto found = std::find_if(own.begin(), own.end(), [&](const Parameter& p) { return p.name == name; });
    if (found == own.end()) continue;  // the instrument's: moves no link
    selected.push_back(int(found - own.begin()));
    tolerances.push_back(columns.parameters[c].tolerance);
    acts_from_.push_back(frames.acts_from(name));
  }
  for (int i = 0; i < samples; ++i) {
    const std::vector<double> q = random_configuration(model.coordinates(), random);
    // Twists are spatial: they move a link the same way as the tip, if the parameter acts before that link.
    of_arm.clear();
    for (const Coordinate& c : arm->coordinates())
      for (std::size_t k = 0; k < q.size(); ++k)
        if (model.coordinates()[k].name == c.name) of_arm.push_back(q[k]);
    if (!arm->linearise(of_arm, {}, selected, scratch)) continue;
    poses_.emplace_back(std::size_t(frames.count()));
    frames.poses(q, 0, poses_.back());
    twists_.emplace_back();
    for (std::size_t c = 0; c < selected.size(); ++c)
      twists_.back().push_back(scratch.twists.col(Eigen::Index(c)) * tolerances[c]);
  }
}

/// No instrument sees the whole of a robot with several tips.
void UncalibratedError::take_twists_of_frames(const VariantColumns& columns, const IdentificationModel& model) {
  std::vector<std::string> names;
  for (const int i : columns.selected) names.push_back(model.parameters()[std::size_t(i)].name);
  for (const std::string& name : names) acts_from_.push_back(frames_.acts_from(name));
  Random random(tolerance_seed, 0);
  for (int i = 0; i < samples; ++i) {
    const std::vector<double> q = random_configuration(model.coordinates(), random);
    poses_.emplace_back(std::size_t(frames_.count()));
    frames_.poses(q, 0, poses_.back());
    twists_.emplace_back();
    for (std::size_t c = 0; c < names.size(); ++c)
      twists_.back().push_back(*frames_.twist(names[c], q, poses_.back()) * columns.parameters[c].tolerance);
  }
}

double UncalibratedError::of(const Body& a, const Body& b) const {
  double largest = 0;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Eigen::Isometry3d X = poses_[i][std::size_t(b.frame)] * b.X_FrameBody;
    const Eigen::Vector3d centre = X * b.solid->centre();
    double variance = 0;
    for (std::size_t c = 0; c < acts_from_.size(); ++c) {
      // Where the robot stands moves its links off obstacles of the measurement frame, not off each other.
      if (!frames_.acts_between(acts_from_[c], a.frame, b.frame, a.obstacle)) continue;
      const Eigen::Vector3d v = twists_[i][c].head<3>(), w = twists_[i][c].tail<3>();
      const double moved = (v + w.cross(centre)).norm() + w.norm() * b.solid->radius();
      variance += moved * moved;
    }
    largest = std::max(largest, std::sqrt(variance));
  }
  return largest;
}

}  // namespace posewright
