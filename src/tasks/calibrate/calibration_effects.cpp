#include "calibration_effects.hpp"

#include <algorithm>
#include <map>

#include "calibration_data.hpp"
#include "posewright/model/campaigns.hpp"
#include "posewright/model/joint_effects.hpp"

namespace posewright {
namespace {

/// The problem with eccentricity among the parameters of every joint that turns.
/// @param coordinates  of the robot, maybe with others behind them
Problem with_eccentricity(Problem problem, const std::vector<Coordinate>& coordinates) {
  if (auto* arm = std::get_if<SerialArmSpec>(&problem.robot))
    arm->joint_effects = with_eccentricity(arm->joint_effects, coordinates);
  return problem;
}

/// Both parameters of a harmonic are one effect: "q1.cos1" and "q1.sin1" belong to "q1.cos1, q1.sin1"; and so are focal
/// lengths, which a lens has in common.
std::string effect_of(const std::string& name) {
  const auto dot = name.rfind('.');
  if (dot == std::string::npos) return name;
  const std::string joint = name.substr(0, dot + 1), kind = name.substr(dot + 1);
  if (kind == "fx" || kind == "fy") return joint + "fx, " + joint + "fy";
  for (const char* harmonic : {"1", "2", "_g"})
    for (const char* part : {"cos", "sin"})
      if (kind == std::string(part) + harmonic) return joint + "cos" + harmonic + ", " + joint + "sin" + harmonic;
  return name;
}

int index_of(const IdentificationModel& model, const std::string& name) {
  const auto& all = model.parameters();
  const auto at = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.name == name; });
  return at == all.end() ? -1 : int(at - all.begin());
}

}  // namespace

std::vector<ScoreTest> effects_left_out(const ProblemVariant& variant, const IdentificationModel& fitted_model,
                                        const VariantColumns& fitted, const std::vector<MeasuredPose>& poses,
                                        const Fit& fit, const ModelMaker& model_of) {
  if (!fit.scale_known || !fit.converged) return {};
  const Problem wider = with_eccentricity(variant.problem, fitted_model.coordinates());
  const auto model = model_of(wider);
  std::vector<double> correction(model->parameters().size(), 0.0);
  for (std::size_t i = 0; i < fit.correction.size(); ++i)
    correction[std::size_t(index_of(*model, fitted_model.parameters()[i].name))] = fit.correction[i];
  model->take_loads_at(correction);
  VariantColumns own = fitted;
  for (int& i : own.selected) i = index_of(*model, fitted_model.parameters()[std::size_t(i)].name);
  const auto is_own = [&](int i) {
    return std::find(own.selected.begin(), own.selected.end(), i) != own.selected.end();
  };

  std::vector<EffectToTest> effects;
  std::map<std::string, std::size_t> known;
  for (int i = 0; i < int(model->parameters().size()); ++i) {
    if (is_own(i)) continue;
    const std::string name = effect_of(model->parameters()[std::size_t(i)].name);
    const auto [at, added] = known.emplace(name, effects.size());
    if (added) effects.push_back({name, {}});
    effects[at->second].parameters.push_back(i);
  }
  for (const VariantSpec& other : wider.variants) {
    // Two automatic ones come down to the same parameters; what they leave out nearly depends on them.
    if (other.name == variant.spec.name || other.convention != variant.spec.convention ||
        (other.automatic && variant.spec.automatic))
      continue;
    EffectToTest effect{"variant " + other.name, {}};
    for (const int i : select_columns(*model, {wider, other}).selected)
      if (!is_own(i)) effect.parameters.push_back(i);
    if (effect.parameters.size() > 1) effects.push_back(std::move(effect));
  }
  return score_tests(*model, own, poses, correction, fit, effects);
}

std::vector<EffectToTest> frames_that_may_move(const MeasurementSpec& measurement, const IdentificationModel& model) {
  std::vector<EffectToTest> frames;
  for (const auto& [name, moved] : {std::pair{"base", Moved::base}, std::pair{"tool", Moved::tool}}) {
    EffectToTest frame{name, frame_parameters(model, moved_frames(measurement, moved))};
    if (!frame.parameters.empty()) frames.push_back(std::move(frame));
  }
  return frames;
}

std::shared_ptr<const UnmodelledEffect> effect_to_count(const ProblemVariant& variant, const CalibratedPoses& poses,
                                                        Calibration& result) {
  SmoothEffect& found = result.smooth;
  if (result.weighting != Weighting::weighted) {
    found.why_not = "weights are not those of the noise";
    return nullptr;
  }
  const UnmodelledSpec* spec = variant.spec.unmodelled ? &*variant.spec.unmodelled : nullptr;
  const std::vector<double> own = spec ? own_effects(variant.problem.measurement) : std::vector<double>{};
  found = smooth_effect(poses.model, poses.columns, poses.fitted, result.fit, spec ? spec->length : std::nullopt, own);
  if (spec == nullptr) return nullptr;
  if (!spec->size && !found.why_not.empty()) {
    result.notes.push_back("the size of an unmodelled effect cannot be estimated, intervals leave it out: " +
                           found.why_not);
    return nullptr;
  }
  // Where the readings' own noise is refused, all of the covariance counts so many times more.
  const double size = spec->size.value_or(found.size / std::max(1.0, found.noise));
  const double length =
      spec->length.value_or(found.why_not.empty() && found.size > 0 ? found.length : UnmodelledSize::assumed_length);
  if (!(size > 0) && own.empty()) return nullptr;
  UnmodelledSize counted{size, spec->rotation, length, own};
  if (size > 0) {
    result.counted = {size, length};
  } else {
    counted.translation = 1.0;
    counted.of_robot = false;
  }
  return std::make_shared<UnmodelledEffect>(poses.model, counted);
}

Interpolation interpolation_of(const VariantSpec& variant, const CalibratedPoses& poses,
                               const std::shared_ptr<const UnmodelledEffect>& effect, const Calibration& result) {
  if (effect != nullptr)
    return interpolate(poses.model, poses.columns, poses.fitted, poses.held_back, result.fit, effect);
  Interpolation none;
  none.why_not = result.weighting != Weighting::weighted ? "weights are not those of the noise"
                 : variant.unmodelled
                     ? "the residuals contain no smooth effect"
                     : "variant '" + variant.name + "' has no unmodelled effect: set `unmodelled: auto`";
  return none;
}

}  // namespace posewright
