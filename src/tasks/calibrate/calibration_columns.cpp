#include "calibration_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/calibration/given.hpp"
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

constexpr const char* unknown = "without σ and interval here and in written files";

void append(std::string& list, const std::string& name) { list += (list.empty() ? "" : ", ") + name; }

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

void GivenParameters::take(const std::vector<Dependency>& left_out, const VariantColumns& among) {
  if (among.automatic) return;
  const std::vector<std::vector<std::string>> names = given(left_out, among.parameters);
  for (std::size_t j = 0; j < names.size(); ++j)
    if (!names[j].empty()) on_[among.parameters[j].name] = names[j];
}

std::string GivenParameters::take(const ScoreTest& effect, const std::vector<Parameter>& fitted,
                                  const Eigen::MatrixXd& covariance, double stretch) {
  std::string named;
  for (std::size_t j = 0; j < fitted.size(); ++j) {
    const auto k = Eigen::Index(j);
    if (!(std::abs(effect.moves[k]) > stretch * std::sqrt(covariance(k, k)))) continue;
    on_[fitted[j].name].push_back(effect.name);
    append(named, fitted[j].name);
  }
  if (named.empty()) return {};
  return fmt::format(
      "{}: biased beyond their intervals by the effect {}, with {:.3g} % of the squared residuals; {}: estimate the "
      "effect, too",
      named, effect.name, 100 * effect.share, unknown);
}

std::string GivenParameters::note(const std::vector<CalibratedParameter>& left_out) const {
  if (on_.empty()) return {};
  std::string named, open;
  for (const auto& [name, others] : on_) append(named, name);
  int count = 0;
  for (const CalibratedParameter& p : left_out)
    if (!counts(p.label, Prior::manufactured)) {
      append(open, p.label.name);
      ++count;
    }
  return fmt::format("{}: valid only if {} {} nominal, which these poses cannot determine; {}", named, open,
                     count > 1 ? "are" : "is", unknown);
}

bool GivenParameters::turn(const std::string& frame) const {
  return std::ranges::any_of(on_, [&](const auto& entry) { return entry.first.starts_with(frame + ".r"); });
}

void GivenParameters::mark(CalibratedParameter& p) const {
  const auto at = on_.find(p.label.name);
  if (at == on_.end()) return;
  p.given = at->second;
  p.profiled = p.weak = false;
  p.lower = -std::numeric_limits<double>::infinity();
  p.upper = std::numeric_limits<double>::infinity();
}

}  // namespace posewright
