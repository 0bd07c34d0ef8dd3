#include "posewright/model/elastic_chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <set>

#include "displacement.hpp"
#include "posewright/model/gravity_compensator.hpp"
#include "posewright/support/near_words.hpp"

namespace posewright {
namespace {

// 1σ before calibration: a joint's compliance is known from similar arms to about a third, at the least to this much.
constexpr double relative_tolerance = 0.3;
constexpr double compliance_tolerance = 0.3e-6;  // rad/(N·m); m/N for prismatic joints

// A joint that springs bend by more than this is not a small deflection.
constexpr double small_angle = 0.5 * degree;
constexpr int steps_of_range = 200;

// Of the central differences of deflections, rad or m: their error is about its square.
constexpr double bending_step = 1e-5;

using Wrench = Eigen::Matrix<double, 6, 1>;  // force, moment about the origin of M

Wrench force_at(const Eigen::Vector3d& force, const Eigen::Vector3d& point) {
  Wrench w;
  w << force, point.cross(force);
  return w;
}

std::string joint_names(const std::vector<Coordinate>& coordinates) {
  std::string names;
  for (const Coordinate& c : coordinates) names += (names.empty() ? "joints: " : ", ") + c.name;
  return names;
}

int coordinate_named(const std::vector<Coordinate>& coordinates, const Located<std::string>& name,
                     const SourcePlace& place) {
  for (int i = 0; i < int(coordinates.size()); ++i)
    if (coordinates[std::size_t(i)].name == name.value) return i;
  std::vector<std::string> words;
  words.reserve(coordinates.size());
  for (const Coordinate& c : coordinates) words.push_back(c.name);
  throw InputError(
      {place.file, name.line},
      "'" + name.value + "' is not a joint of this arm that moves by itself" + meant_instead(name.value, words),
      joint_names(coordinates));
}

Quantity quantity_of(const Coordinate& c) { return c.unit == "m" ? Quantity::length : Quantity::angle; }

void limit_to(Coordinate& c, const ElastostaticSpec::Listed& listed, const SourcePlace& place) {
  if (listed.quantity != Quantity::number && listed.quantity != quantity_of(c))
    throw InputError(place, "the listed positions of '" + c.name + "' have the wrong unit",
                     "allowed: " + allowed_units({quantity_of(c)}));
  for (const double value : listed.at)
    if (value < c.lower || value > c.upper)
      throw InputError(
          place, "a listed position of '" + c.name + "' is outside its limits",
          "positions between " + std::to_string(c.lower) + " and " + std::to_string(c.upper) + " " + c.unit);
  c.values = listed.at;
  std::sort(c.values.begin(), c.values.end());
  c.periodic = false;
}

/// "-25.2deg", "120mm": each position as it is read by people, with as many digits as tell them apart.
std::vector<std::string> place_names(const std::vector<double>& at, bool prismatic) {
  const double unit = prismatic ? 1e-3 : std::numbers::pi / 180;
  std::vector<std::string> names;
  for (int digits = 6; digits <= 17; ++digits) {
    names.clear();
    for (const double value : at)
      names.push_back(fmt::format("{:.{}g}{}", value / unit, digits, prismatic ? "mm" : "deg"));
    if (std::set<std::string>(names.begin(), names.end()).size() == names.size()) break;
  }
  return names;
}

}  // namespace

bool is_numbered_place(std::string_view name) {
  constexpr std::string_view numbered = ".compliance_";
  const auto at = name.find(numbered);
  return at != std::string_view::npos &&
         name.find_first_not_of("0123456789*?", at + numbered.size()) == std::string_view::npos;
}

std::string compensator_warning(const RobotSpec& robot, const std::vector<Coordinate>& coordinates) {
  const auto* arm = std::get_if<SerialArmSpec>(&robot);
  if (arm == nullptr || !arm->elastostatic || !arm->elastostatic->compensator) return "";
  const CompensatorSpec& spring = *arm->elastostatic->compensator;
  if (!spring.torque) return "";
  double most = 0;
  for (const Coordinate& c : coordinates) {
    if (c.name != spring.joint.value) continue;
    for (int i = 0; i <= steps_of_range; ++i) {
      const CompensatorLinkage<double> linkage(spring, c.lower + (c.upper - c.lower) * i / steps_of_range);
      const double preload = spring.free_length * spring.stiffness;
      const double stiffness = spring.joint_stiffness + linkage.added_stiffness(spring.stiffness, preload);
      most = std::max(most, std::abs(linkage.torque(spring.stiffness, preload) / stiffness));
    }
  }
  if (most < small_angle) return "";
  return fmt::format(
      "the compensator's torque bends the unloaded joint {} by up to {:.2f} deg: linear springs do not hold for that; "
      "is "
      "effect: stiffness meant?",
      spring.joint.value, most / degree);
}

ElasticChain::ElasticChain(ChainDescription chain, const ElastostaticSpec& spec, const SourcePlace& place)
    : chain_(std::move(chain)), spec_(spec) {
  coordinates_ = chain_.coordinates();
  reading_noise_ = chain_.reading_noise();
  const int tool = chain_.layout().tool;
  parameters_.assign(chain_.parameters().begin(), chain_.parameters().begin() + tool);
  first_ = tool;
  add_springs(place);
  parameters_.insert(parameters_.end(), chain_.parameters().begin() + tool, chain_.parameters().end());
  for (const auto& preference : chain_.geometric_parameters())
    geometric_.push_back(
        {preference.parameter < tool ? preference.parameter : preference.parameter + int(springs_.size()),
         preference.tier});
  std::vector<std::string> loads;
  for (const LoadCaseSpec& load : spec_.loads) loads.push_back(load.name);
  coordinates_.push_back(make_choice("load_case", loads));
}

void ElasticChain::add_springs(const SourcePlace& place) {
  const std::vector<Coordinate>& joints = chain_.coordinates();
  std::vector<double> nominal(joints.size(), 0.0);
  for (const auto& [name, value] : spec_.compliance) {
    const auto c = std::size_t(coordinate_named(joints, name, place));
    if (value.quantity == Quantity::compliance && joints[c].unit == "m")
      throw InputError({place.file, name.line},
                       "the compliance of the prismatic joint '" + name.value + "' is an angle's",
                       "a plain number in m/N is needed");
    nominal[c] = value.value;
  }
  const int compensated = spec_.compensator ? coordinate_named(joints, spec_.compensator->joint, place) : -1;
  const int listed = spec_.listed ? coordinate_named(joints, spec_.listed->joint, place) : -1;
  if (listed >= 0) limit_to(coordinates_[std::size_t(listed)], *spec_.listed, {place.file, spec_.listed->joint.line});
  const auto add = [&](const std::string& name, const std::string& unit, double value, double least, Spring spring) {
    parameters_.push_back({name, unit, value, std::max(least, relative_tolerance * std::abs(value)), Role::interest});
    springs_.push_back(spring);
  };
  for (int c = 0; c < int(joints.size()); ++c) {
    const std::string& name = joints[std::size_t(c)].name;
    const std::string unit = joints[std::size_t(c)].unit == "m" ? "m/N" : "rad/(N·m)";
    if (c == compensated) {
      const CompensatorSpec& spring = *spec_.compensator;
      add(name + ".stiffness", "N·m/rad", spring.joint_stiffness, 0, {Spring::Kind::joint_stiffness, c});
      add("compensator.stiffness", "N/m", spring.stiffness, 0, {Spring::Kind::spring_stiffness, c});
      // A spring without free length (s0 = 0) may still have one: as much as a tenth of the crank.
      add("compensator.preload", "N", spring.free_length * spring.stiffness, 0.1 * spring.L * spring.stiffness,
          {Spring::Kind::preload, c});
    } else if (c == listed) {
      const std::vector<std::string> places = place_names(spec_.listed->at, unit == "m/N");
      for (int i = 0; i < int(places.size()); ++i)
        add(name + ".compliance@" + places[std::size_t(i)], unit, nominal[std::size_t(c)], compliance_tolerance,
            {Spring::Kind::listed, c, i});
    } else {
      add(name + ".compliance", unit, nominal[std::size_t(c)], compliance_tolerance, {Spring::Kind::compliance, c});
    }
  }
}

void ElasticChain::take_loads_at(std::span<const double> correction) {
  without_block(correction, first_, springs_.size(), loaded_at_);
  if (!loaded_at_.empty()) loaded_at_.resize(std::size_t(chain_.layout().count), 0.0);
}

void ElasticChain::torques(std::span<const double> q, int load, bool link_weights, std::span<double> out) const {
  const ChainDescription& chain = chain_.description();
  const LoadCaseSpec& w = spec_.loads[std::size_t(load)];
  std::array<Twist, max_joints> motion;
  std::array<Wrench, max_joints> weight;
  Frame<double> frame;
  const auto part = [&](int index) { return loaded_at_.empty() ? nullptr : loaded_at_.data() + index; };
  const ChainLayout& layout = chain_.layout();
  frame.then(chain.X_MeasureBase);
  displace(frame, part(0));
  for (std::size_t k = 0; k < chain.joints.size(); ++k) {
    const ChainJoint& joint = chain.joints[k];
    const auto coordinate = std::size_t(joint.coordinate);
    frame.then(joint.X_ParentJoint);
    displace(frame, part(layout.displacement[k]));
    const double* own = part(layout.offset[coordinate]);
    const double turned = own == nullptr ? q[coordinate] : (1 + own[1]) * q[coordinate] + own[0];
    const double value = joint.multiplier * turned + joint.offset;
    const Eigen::Vector3d axis = frame.R * joint.axis;
    motion[k] = joint.prismatic ? prismatic(axis) : revolute(axis, frame.p);
    if (joint.prismatic) frame.p += axis * value;
    else frame.then_rotate(joint.axis, value);
    weight[k] = link_weights ? force_at(joint.mass * spec_.gravity, frame.R * joint.centre_of_mass + frame.p)
                             : Wrench(Wrench::Zero());
  }
  frame.then(chain.X_LastTip);
  displace(frame, part(layout.tool));
  Wrench beyond = force_at(w.force, frame.R * w.point + frame.p) +
                  force_at(w.mass * spec_.gravity, frame.R * w.centre_of_mass + frame.p);
  beyond.tail<3>() += w.moment;
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t k = chain.joints.size(); k-- > 0;) {
    beyond += weight[k];
    out[std::size_t(chain.joints[k].coordinate)] += chain.joints[k].multiplier * motion[k].dot(beyond);
  }
}

double ElasticChain::load_alone(const Point& at, std::size_t coordinate) const {
  std::array<double, max_joints> torque{};
  const std::size_t joints = chain_.coordinates().size();
  torques(at.readings(), at.chosen.load_case, false, std::span(torque).first(joints));
  return torque[coordinate];
}

void ElasticChain::deflect(const Point& at, std::span<double> deflection, std::span<double> derivative) const {
  std::array<double, max_joints> torque{};
  const std::size_t joints = chain_.coordinates().size();
  const auto q = at.readings();
  torques(q, at.chosen.load_case, std::span(torque).first(joints));
  const auto elastic =
      at.correction.empty() ? at.correction : at.correction.subspan(std::size_t(first_), springs_.size());
  const auto value = [&](std::size_t i) {
    return parameters_[std::size_t(first_) + i].nominal + (elastic.empty() ? 0.0 : elastic[i]);
  };
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const Spring& spring = springs_[i];
    const auto c = std::size_t(spring.coordinate);
    derivative[i] = 0.0;
    if (!acts(spring, q)) continue;
    if (spring.kind == Spring::Kind::compliance || spring.kind == Spring::Kind::listed) {
      deflection[c] = value(i) * torque[c];
      derivative[i] = torque[c];
    }
    if (spring.kind != Spring::Kind::joint_stiffness) continue;
    // Three parameters in a row share one deflection, δ = (τ − M) / K.
    const CompensatorLinkage<double> linkage(*spec_.compensator, q[c]);
    const double stiffness = value(i) + linkage.added_stiffness(value(i + 1), value(i + 2));
    const double acts = spec_.compensator->torque ? 1.0 : 0.0;
    const double load = spec_.compensator->torque || !spec_.link_gravity ? torque[c] : load_alone(at, c);
    deflection[c] = (load - acts * linkage.torque(value(i + 1), value(i + 2))) / stiffness;
    derivative[i] = -deflection[c] / stiffness;
    derivative[i + 1] = -(acts * linkage.torque(1, 0) + deflection[c] * linkage.added_stiffness(1, 0)) / stiffness;
    derivative[i + 2] = -(acts * linkage.torque(0, 1) + deflection[c] * linkage.added_stiffness(0, 1)) / stiffness;
    i += 2;
  }
}

struct ElasticChain::Bent {
  std::vector<int> selected;
  std::vector<double> rigid;  ///< corrections of the chain alone
  std::vector<double> deflection, derivative;
  Twists twists, readings;
  TipAdjoint f;

  /// Joint angle behind a gear for a reading; a deflection does not pass the gear.
  double gear(const ChainLayout& layout, int joint) const {
    return 1 + (rigid.empty() ? 0.0 : rigid[std::size_t(layout.offset[std::size_t(joint)]) + 1]);
  }
};

ElasticChain::Bent& ElasticChain::bent(const Point& at, std::span<const int> selected) const {
  static thread_local Bent b;
  const std::size_t count = springs_.size();
  b.deflection.assign(chain_.coordinates().size(), 0.0);
  b.derivative.assign(count, 0.0);
  deflect(at, b.deflection, b.derivative);
  without_block(at.correction, first_, count, b.rigid);
  b.selected.clear();
  for (const int index : selected) {
    if (index < first_) b.selected.push_back(index);
    else b.selected.push_back(index < first_ + int(count) ? chain_.layout().count : index - int(count));
  }
  return b;
}

bool ElasticChain::linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X, Twists& twists,
                             Twists* reading_twists) const {
  Bent& b = bent(at, selected);
  linearise_as(b, at, selected, X, twists, reading_twists != nullptr ? *reading_twists : b.readings);
  return true;
}

bool ElasticChain::linearise_bent(const Point& at, double share, std::span<const int> selected, Eigen::Isometry3d& X,
                                  Twists& twists) const {
  Bent& b = bent(at, selected);
  for (double& deflection : b.deflection) deflection *= share;
  linearise_as(b, at, selected, X, twists, b.readings);
  return true;
}

void ElasticChain::linearise_as(const Bent& b, const Point& at, std::span<const int> selected, Eigen::Isometry3d& X,
                                Twists& twists, Twists& readings) const {
  chain_.linearise_deflected(at.q.first(b.deflection.size()), b.deflection, b.rigid, b.selected, X, twists, &readings);
  for (std::size_t c = 0; c < selected.size(); ++c) {
    const int i = selected[c] - first_;
    if (i < 0 || i >= int(springs_.size())) continue;
    const int joint = springs_[std::size_t(i)].coordinate;
    twists.col(Eigen::Index(c)) = readings.col(joint) * (b.derivative[std::size_t(i)] / b.gear(chain_.layout(), joint));
  }
}

bool ElasticChain::pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                             std::span<double> gradient) const {
  Bent& b = bent(at, selected);
  const ChainLayout& layout = chain_.layout();
  const std::size_t joints = b.deflection.size();
  const auto q = at.q.first(joints);
  Eigen::Isometry3d X;
  chain_.linearise_deflected(q, b.deflection, b.rigid, {}, X, b.twists, &b.readings);
  b.f = f;
  if (f.reading_twists.cols() == 0) b.f.reading_twists = Twists::Zero(6, Eigen::Index(joints));
  // f by every deflection and by every derivative of one, the chain held.
  std::vector<double> by_deflection(joints, 0.0), by_derivative(springs_.size(), 0.0);
  for (std::size_t c = 0; c < selected.size(); ++c) {
    const int i = selected[c] - first_;
    if (i < 0 || i >= int(springs_.size())) continue;
    const int joint = springs_[std::size_t(i)].coordinate;
    const Twist slope = f.twists.col(Eigen::Index(c)) / b.gear(layout, joint);
    b.f.reading_twists.col(joint) += b.derivative[std::size_t(i)] * slope;
    by_derivative[std::size_t(i)] += b.readings.col(joint).dot(slope);
  }
  chain_.pull_back_deflected(q, b.deflection, b.rigid, b.selected, b.f, gradient, by_deflection);
  add_bending(at, by_deflection, by_derivative, gradient);
  return true;
}

void ElasticChain::add_bending(const Point& at, std::span<const double> by_deflection,
                               std::span<const double> by_derivative, std::span<double> gradient) const {
  const std::size_t joints = by_deflection.size();
  std::vector<double> q(at.q.begin(), at.q.end()), deflection(joints), derivative(springs_.size());
  Point near = at;
  near.q = q;
  near.read = {};
  for (std::size_t k = 0; k < joints; ++k) {
    if (coordinates_[k].discrete()) continue;
    double change = 0;
    for (const double step : {-bending_step, bending_step}) {
      q[k] = at.q[k] + step;
      std::fill(deflection.begin(), deflection.end(), 0.0);
      deflect(near, deflection, derivative);
      double sum = 0;
      for (std::size_t i = 0; i < joints; ++i) sum += by_deflection[i] * deflection[i];
      for (std::size_t i = 0; i < springs_.size(); ++i) sum += by_derivative[i] * derivative[i];
      change += step > 0 ? sum : -sum;
    }
    q[k] = at.q[k];
    gradient[k] += change / (2 * bending_step);
  }
}

}  // namespace posewright
