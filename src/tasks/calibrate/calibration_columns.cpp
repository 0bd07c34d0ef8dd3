#include "calibration_columns.hpp"

#include "posewright/blocks/identifiability.hpp"
#include "posewright/calibration/placing_columns.hpp"
#include "posewright/study/columns.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

constexpr int random_configurations = 300;
constexpr std::uint64_t everywhere_stream = 0xe3e7;

/// The poses and random configurations within the limits.
std::vector<MeasuredPose> everywhere(const IdentificationModel& model, std::vector<MeasuredPose> poses,
                                     const std::vector<double>& placed) {
  Random random(0, everywhere_stream);
  for (int i = 0; i < random_configurations; ++i) {
    MeasuredPose pose;
    for (const Coordinate& c : model.coordinates())
      pose.q.push_back(c.discrete() ? c.values[std::size_t(random.uniform() * double(c.values.size()))]
                                    : random.uniform(c.lower, c.upper));
    // Without noise and limits of a cell: all that is asked is what tells one column from the others.
    if (model.measurable(pose.q) && model.predict(pose.q, placed, pose.y)) poses.push_back(std::move(pose));
  }
  return poses;
}

void leave_at_nominal(const std::vector<Dependency>& dependent, const VariantColumns& among, ChosenColumns& chosen) {
  for (const Dependency& d : dependent) {
    CalibratedParameter left;
    left.label = among.parameters[std::size_t(d.dropped)];
    left.estimated = false;
    left.value = left.lower = left.upper = left.label.nominal;
    left.why_not = describe(d, among.parameters);
    chosen.left_out.push_back(std::move(left));
  }
  chosen.given.take(dependent, among);
}

}  // namespace

ChosenColumns chosen_columns(const IdentificationModel& model, const VariantColumns& all,
                             const std::vector<MeasuredPose>& poses, const std::vector<double>& placed, Prior prior) {
  ChosenColumns chosen;
  std::vector<Dependency> dependent;
  const auto determine = [&](const VariantColumns& among, const std::vector<MeasuredPose>& at, Prior counted,
                             double threshold) {
    VariantColumns kept = determined(model, among, at, placed, counted, &dependent, threshold);
    leave_at_nominal(dependent, among, chosen);
    return kept;
  };
  if (prior == Prior::none) {
    chosen.columns = determine(all, poses, Prior::none, all.automatic ? 0.0 : exact_dependency);
    return chosen;
  }
  // What tells nothing new wherever the robot stands; what these poses alone do not tell, a tolerance does.
  const VariantColumns wanted =
      all.automatic ? determine(all, everywhere(model, poses, placed), Prior::none, 0.0) : all;
  chosen.columns = determine(wanted, poses, prior, exact_dependency);
  return chosen;
}

}  // namespace posewright
