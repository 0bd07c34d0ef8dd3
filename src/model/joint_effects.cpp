#include "posewright/model/joint_effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "displacement.hpp"
#include "parameter_names.hpp"
#include "posewright/model/pair_names.hpp"
#include "posewright/problem/units.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// 1σ before calibration: an encoder disc 20 µm off its axis at a radius of 0.1 m; a coupling that was adjusted.
constexpr double effect_angle_tolerance = 2e-4, coupling_tolerance = 1e-3;  // rad, 1
// A gear with play within its class; a drive that warms by ten kelvin.
constexpr double backlash_tolerance = 2e-4, backlash_length_tolerance = 2e-5;  // rad, m
constexpr double drift_tolerance = 1e-5, drift_length_tolerance = 1e-5;        // rad/K, m/K
// What a route comes from beyond where nobody says.
constexpr double standard_overrun = 2.0 * M_PI / 180, standard_length_overrun = 5e-3;  // rad, m

int joint_named(const std::vector<Coordinate>& joints, const Located<std::string>& name, const std::string& file) {
  for (int i = 0; i < int(joints.size()); ++i)
    if (!joints[std::size_t(i)].choice() && joints[std::size_t(i)].name == name.value) return i;
  throw_unknown_coordinate({file, name.line}, name.value, joints);
}

std::string unit_of_ratio(const Coordinate& own, const Coordinate& other) {
  return own.unit == other.unit ? "1" : own.unit + "/" + other.unit;
}

ColumnFactor::Kind factor_of(bool cosine, bool sine) {
  return cosine ? ColumnFactor::Kind::cosine : sine ? ColumnFactor::Kind::sine : ColumnFactor::Kind::linear;
}

}  // namespace

std::vector<JointEffectsSpec> with_eccentricity(const std::vector<JointEffectsSpec>& effects,
                                                const std::vector<Coordinate>& coordinates) {
  std::vector<JointEffectsSpec> each;
  for (const Coordinate& c : coordinates) {
    if (c.choice() || is_second(c.name)) continue;
    const auto known =
        std::ranges::find_if(effects, [&](const JointEffectsSpec& spec) { return matches(spec.joint.value, c.name); });
    JointEffectsSpec spec = known == effects.end() ? JointEffectsSpec{} : *known;
    spec.joint.value = c.name;
    spec.eccentricity = c.unit == "rad";
    if (!spec.eccentricity) spec.gear_ratio.reset();
    each.push_back(std::move(spec));
  }
  return each;
}

double JointEffects::Effect::value(double q) const {
  switch (kind) {
    case Kind::cosine:
      return std::cos(constant * q);
    case Kind::sine:
      return std::sin(constant * q);
    case Kind::linear:
      return q - constant;
    case Kind::side:
      return q - 0.5;  // 0: it rose, and what it drives lags
  }
  return 0.0;
}

double JointEffects::Effect::derivative(double q) const {
  switch (kind) {
    case Kind::cosine:
      return -constant * std::sin(constant * q);
    case Kind::sine:
      return constant * std::cos(constant * q);
    case Kind::linear:
      return 1.0;
    case Kind::side:
      return 0.0;
  }
  return 0.0;
}

JointEffects::JointEffects(std::unique_ptr<TipModel> arm, const SerialArmSpec& arm_spec, const std::string& file)
    : arm_(std::move(arm)), is_elastic_(arm_spec.elastostatic.has_value()) {
  coordinates_ = arm_->coordinates();
  const std::size_t moving = coordinates_.size();
  if (arm_spec.temperature) add_temperature(*arm_spec.temperature);
  reading_noise_ = arm_->reading_noise();
  parameters_ = arm_->parameters();
  const auto is_tool = [](const Parameter& p) { return p.name.starts_with("tool."); };
  const auto tool = std::find_if(parameters_.begin(), parameters_.end(), is_tool);
  first_ = int(tool - parameters_.begin());
  const std::vector<Parameter> last(tool, parameters_.end());
  parameters_.erase(tool, parameters_.end());
  std::set<int> taken;
  for (const JointEffectsSpec& spec : arm_spec.joint_effects) {
    bool found = false;
    for (int j = 0; j < int(moving); ++j) {
      const Coordinate c = coordinates_[std::size_t(j)];
      if (c.choice() || !matches(spec.joint.value, c.name)) continue;
      if (!taken.insert(j).second)
        throw InputError({file, spec.joint.line}, "robot.joint_effects: joint '" + c.name + "' is there twice",
                         "each joint once");
      add(spec, j, file);
      found = true;
    }
    if (!found) throw_unknown_coordinate({file, spec.joint.line}, spec.joint.value, coordinates_);
  }
  for (const IdentificationModel::Preference& p : arm_->geometric_parameters())
    geometric_.push_back({p.parameter < first_ ? p.parameter : p.parameter + int(effects_.size()), p.tier});
  // Somebody lists them because they are suspected; what geometry explains is geometry all the same.
  for (std::size_t e = 0; e < effects_.size(); ++e) geometric_.push_back({first_ + int(e), 4});
  parameters_.insert(parameters_.end(), last.begin(), last.end());
}

void JointEffects::add(const JointEffectsSpec& spec, int joint, const std::string& file) {
  const Coordinate c = coordinates_[std::size_t(joint)];
  const SourcePlace place{file, spec.joint.line};
  const bool turns = c.unit == "rad";
  // A pattern is meant for the joints among them that turn.
  if (!turns && (spec.eccentricity || spec.gear_ratio) && spec.joint.value == c.name)
    throw InputError(place, "robot.joint_effects: joint '" + c.name + "' does not turn",
                     "eccentricity and gear_ratio are for joints that turn");
  const auto harmonic = [&](const std::string& suffix, Kind kind, double frequency) {
    parameters_.push_back({c.name + suffix, "rad", 0.0, effect_angle_tolerance, Role::interest});
    effects_.push_back({joint, joint, kind, frequency});
  };
  if (spec.eccentricity && turns)
    for (const int n : {1, 2}) {
      harmonic(".cos" + std::to_string(n), Kind::cosine, n);
      harmonic(".sin" + std::to_string(n), Kind::sine, n);
    }
  if (spec.gear_ratio && turns) {
    harmonic(".cos_g", Kind::cosine, *spec.gear_ratio);
    harmonic(".sin_g", Kind::sine, *spec.gear_ratio);
  }
  for (const Located<std::string>& name : spec.coupling) {
    const int other = joint_named(coordinates_, name, file);
    if (other == joint)
      throw InputError({file, name.line}, "robot.joint_effects: joint '" + c.name + "' is coupled with itself",
                       "that is " + c.name + ".gear");
    parameters_.push_back({c.name + ".coupling." + name.value, unit_of_ratio(c, coordinates_[std::size_t(other)]), 0.0,
                           coupling_tolerance, Role::interest});
    effects_.push_back({joint, other, Kind::linear, 0.0});
  }
  if (spec.backlash) {
    parameters_.push_back(
        {c.name + ".backlash", c.unit, 0.0, turns ? backlash_tolerance : backlash_length_tolerance, Role::interest});
    effects_.push_back({joint, int(coordinates_.size()), Kind::side, 0.0});
    if (spec.overrun && !fits_unit(spec.overrun->quantity, c.unit))
      throw InputError(place, "robot.joint_effects: overrun of joint '" + c.name + "' has the wrong unit",
                       "a value in " + c.unit + " is expected");
    const double standard = turns ? standard_overrun : standard_length_overrun;
    coordinates_.push_back(make_approach(c.name, spec.overrun ? spec.overrun->value : standard));
  }
  if (!spec.temperature) return;
  if (temperature_ < 0)
    throw InputError(place, "robot.joint_effects: joint '" + c.name + "' has a drift term, but no temperature is given",
                     "robot: temperature: {reference: 20}, in degrees Celsius");
  parameters_.push_back(
      {c.name + ".temperature", c.unit + "/K", 0.0, turns ? drift_tolerance : drift_length_tolerance, Role::interest});
  effects_.push_back({joint, temperature_, Kind::linear, reference_temperature_});
}

void JointEffects::add_temperature(const TemperatureSpec& spec) {
  std::vector<std::string> labels;
  for (const double at : spec.at) labels.push_back(fmt::format("{}", at));
  Coordinate c = make_choice("temperature", labels);
  c.values = spec.at;
  c.lower = spec.at.front();
  c.upper = spec.at.back();
  c.measurable = true;
  temperature_ = int(coordinates_.size());
  reference_temperature_ = spec.reference;
  coordinates_.push_back(std::move(c));
}

double JointEffects::Effect::second_derivative(double q) const {
  return kind == Kind::cosine || kind == Kind::sine ? -constant * constant * value(q) : 0.0;
}

double JointEffects::coefficient(const Point& at, std::size_t effect) const {
  const std::size_t i = std::size_t(first_) + effect;
  return parameters_[i].nominal + (at.correction.empty() ? 0.0 : at.correction[i]);
}

HarmonicColumns JointEffects::harmonic_columns(std::span<const int> selected, const Point& at) const {
  const std::span<const double> correction = at.correction;
  const int count = int(effects_.size());
  for (std::size_t e = 0; e < effects_.size(); ++e)
    if (parameters_[std::size_t(first_) + e].nominal != 0.0 ||
        (!correction.empty() && correction[std::size_t(first_) + e] != 0.0))
      return {"an effect of joint " + coordinates_[std::size_t(effects_[e].joint)].name + " that is known", {}, {}, {}};
  std::vector<int> of_arm;
  std::vector<ColumnFactor> factors;
  for (const int index : selected) {
    const int e = index - first_;
    if (e >= 0 && e < count) {
      const Effect& effect = effects_[std::size_t(e)];
      const int offset = arm_->offset_of(effect.joint);
      if (offset < 0) return {"effects of joints of a robot without offsets", {}, {}, {}};
      factors.push_back({int(of_arm.size()), effect.of,
                         factor_of(effect.kind == Kind::cosine, effect.kind == Kind::sine),
                         effect.kind == Kind::side ? 0.5 : effect.constant});
      of_arm.push_back(offset);
    } else {
      of_arm.push_back(index < first_ ? index : index - count);
    }
  }
  std::vector<double> rest;
  Point inside = at;
  inside.correction = without_block(correction, first_, effects_.size(), rest);
  HarmonicColumns result = arm_->harmonic_columns(of_arm, inside);
  if (!result.why_not.empty()) return result;
  if (result.order > 1 || result.bends) return {"effects of joints that bend, too", {}, {}, {}};
  // Back to the indices of this robot.
  for (int& index : result.selected)
    if (index >= first_) index += count;
  result.degrees.resize(coordinates_.size(), 0);
  result.factors.insert(result.factors.end(), factors.begin(), factors.end());
  return result;
}

void JointEffects::take_loads_at(std::span<const double> correction) {
  std::vector<double> rest;
  arm_->take_loads_at(without_block(correction, first_, effects_.size(), rest));
}

struct JointEffects::Inside {
  std::vector<double> turned, rest;
  std::vector<int> selected;
  Twists twists, joints;
  TipAdjoint f;
  std::vector<double> gradient;
  Point arm;
};

JointEffects::Inside& JointEffects::inside(const Point& at, std::span<const int> selected) const {
  static thread_local Inside in;
  const int count = int(effects_.size()), beyond = int(arm_->parameters().size());
  const std::size_t own = arm_->coordinates().size();
  in.turned.assign(at.q.begin(), at.q.begin() + std::ptrdiff_t(own));
  for (std::size_t e = 0; e < effects_.size(); ++e)
    in.turned[std::size_t(effects_[e].joint)] +=
        coefficient(at, e) * effects_[e].value(at.q[std::size_t(effects_[e].of)]);
  in.selected.clear();
  for (const int index : selected)
    in.selected.push_back(index < first_ ? index : index < first_ + count ? beyond : index - count);
  in.arm = {in.turned, without_block(at.correction, first_, effects_.size(), in.rest), at.chosen,
            at.readings().first(own)};
  return in;
}

bool JointEffects::linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X, Twists& twists,
                             Twists* reading_twists) const {
  Inside& in = inside(at, selected);
  const int count = int(effects_.size());
  const std::size_t own = arm_->coordinates().size();
  Twists& joints = in.joints;
  if (!arm_->linearise(in.arm, in.selected, X, twists, &joints)) return false;
  for (std::size_t c = 0; c < selected.size(); ++c) {
    const int e = selected[c] - first_;
    if (e < 0 || e >= count) continue;
    const Effect& effect = effects_[std::size_t(e)];
    twists.col(Eigen::Index(c)) = joints.col(effect.joint) * effect.value(at.q[std::size_t(effect.of)]);
  }
  if (reading_twists == nullptr) return true;
  // A reading moves the joint itself and what its effects add.
  *reading_twists = joints;
  for (std::size_t e = 0; e < effects_.size(); ++e)
    if (const double k = coefficient(at, e); k != 0 && effects_[e].of < int(own))
      reading_twists->col(effects_[e].of) +=
          k * effects_[e].derivative(at.q[std::size_t(effects_[e].of)]) * joints.col(effects_[e].joint);
  return true;
}

bool JointEffects::pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                             std::span<double> gradient) const {
  // Loads bend an arm as it reads, not as it stands: there two derivatives would be wanted of the arm.
  if (is_elastic_) return TipModel::pull_back(at, selected, f, gradient);
  Inside& in = inside(at, selected);
  Eigen::Isometry3d X;
  if (!arm_->linearise(in.arm, {}, X, in.twists, &in.joints)) return false;
  const int count = int(effects_.size()), own = int(arm_->coordinates().size());
  in.f = f;
  if (f.reading_twists.cols() > 0) in.f.reading_twists.conservativeResize(6, own);
  else in.f.reading_twists = Twists::Zero(6, own);
  const auto q_of = [&](const Effect& effect) { return at.q[std::size_t(effect.of)]; };
  for (std::size_t c = 0; c < selected.size(); ++c) {
    const int e = selected[c] - first_;
    if (e < 0 || e >= count) continue;
    const Effect& effect = effects_[std::size_t(e)];
    const Twist slope = f.twists.col(Eigen::Index(c));
    in.f.reading_twists.col(effect.joint) += effect.value(q_of(effect)) * slope;
    gradient[std::size_t(effect.of)] += effect.derivative(q_of(effect)) * in.joints.col(effect.joint).dot(slope);
  }
  for (std::size_t e = 0; e < effects_.size() && f.reading_twists.cols() > 0; ++e) {
    const Effect& effect = effects_[e];
    const double k = coefficient(at, e);
    if (k == 0 || effect.of >= own) continue;
    const Twist slope = k * f.reading_twists.col(effect.of);
    in.f.reading_twists.col(effect.joint) += effect.derivative(q_of(effect)) * slope;
    gradient[std::size_t(effect.of)] += effect.second_derivative(q_of(effect)) * in.joints.col(effect.joint).dot(slope);
  }
  in.gradient.assign(std::size_t(own), 0.0);
  if (!arm_->pull_back(in.arm, in.selected, in.f, in.gradient)) return false;
  // A joint stands where it reads and where its effects put it.
  for (std::size_t k = 0; k < std::size_t(own); ++k) gradient[k] += in.gradient[k];
  for (std::size_t e = 0; e < effects_.size(); ++e)
    gradient[std::size_t(effects_[e].of)] +=
        coefficient(at, e) * effects_[e].derivative(q_of(effects_[e])) * in.gradient[std::size_t(effects_[e].joint)];
  return true;
}

}  // namespace posewright
