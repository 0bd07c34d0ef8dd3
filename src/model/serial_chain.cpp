#include "posewright/model/serial_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "displacement.hpp"

namespace posewright {
namespace {

/// Data of one configuration for columns: displacement axes of base, joints and tool, joint axes.
struct ChainState {
  std::array<DisplacementAxes, max_joints + 2> displacement;
  std::array<Twist, max_joints> motion;
};

Frame<double> run_chain(const ChainDescription& chain, const ChainLayout& layout, const double* q,
                        const double* deflection, const double* correction, ChainState& state) {
  const auto part = [&](int index) { return correction == nullptr ? nullptr : correction + index; };
  Frame<double> frame;
  frame.then(chain.X_MeasureBase);
  state.displacement[0] = displace(frame, part(0));
  for (std::size_t k = 0; k < chain.joints.size(); ++k) {
    const ChainJoint& joint = chain.joints[k];
    frame.then(joint.X_ParentJoint);
    if (!joint.backward()) state.displacement[k + 1] = displace(frame, part(layout.displacement[k]));
    const double* own = part(layout.offset[std::size_t(joint.coordinate)]);
    double reading = own == nullptr ? q[joint.coordinate] : (1 + own[1]) * q[joint.coordinate] + own[0];
    if (deflection != nullptr) reading += deflection[joint.coordinate];
    const double value = joint.multiplier * reading + joint.offset;
    const Eigen::Vector3d axis = frame.R * joint.axis;
    state.motion[k] = joint.prismatic ? prismatic(axis) : revolute(axis, frame.p);
    if (joint.prismatic) frame.p += axis * value;
    else frame.then_rotate(joint.axis, value);
    if (joint.backward()) state.displacement[k + 1] = take_back(frame, part(layout.displacement[k]));
  }
  frame.then(chain.X_LastTip);
  state.displacement[chain.joints.size() + 1] = displace(frame, part(layout.tool));
  return frame;
}

/// Corrections may leave out the tool's (an instrument with targets has none): pads them. Null: none.
using PaddedCorrections = std::array<double, 8 * max_joints + 12>;
const double* padded_corrections(std::span<const double> correction, int count, PaddedCorrections& padded) {
  if (correction.empty()) return nullptr;
  padded.fill(0.0);
  std::copy_n(correction.begin(), std::min(correction.size(), std::size_t(count)), padded.begin());
  return padded.data();
}

}  // namespace

ChainLayout::ChainLayout(const ChainDescription& chain) : offset(chain.coordinates.size(), 0) {
  int next = 6;
  for (const ChainJoint& joint : chain.joints) {
    displacement.push_back(next);
    next += 6;
    if (joint.mimic) continue;
    offset[std::size_t(joint.coordinate)] = next;
    next += 2;
  }
  tool = next;
  count = next + 6;
}

SerialChain::SerialChain(ChainDescription chain) : chain_(std::move(chain)), layout_(chain_) {
  if (chain_.joints.empty() || chain_.joints.size() > max_joints)
    throw std::invalid_argument("serial chain: " + std::to_string(chain_.joints.size()) +
                                " joints; 1 to 64 are allowed");
  coordinates_ = chain_.coordinates;
  reading_noise_ = chain_.encoder_noise;
  joints_of_coordinate_.resize(coordinates_.size());

  const auto add_displacement = [&](const std::string& name, int joint, int tier, const Eigen::Isometry3d& X,
                                    double length, double angle) {
    for (int k = 0; k < 6; ++k) {
      geometric_.push_back({int(parameters_.size()) + k, tier});
      columns_.push_back({joint, k});
    }
    append_displacement(parameters_, name, X, length, angle);
  };
  add_displacement("base", -1, 0, chain_.X_MeasureBase, 10e-3, 1 * degree);
  for (std::size_t k = 0; k < chain_.joints.size(); ++k) {
    const ChainJoint& joint = chain_.joints[k];
    add_displacement(joint.name, int(k), 3, joint.X_AboveJoint.value_or(joint.X_ParentJoint), 0.5e-3, 0.05 * degree);
    joints_of_coordinate_[std::size_t(joint.coordinate)].push_back(int(k));
    if (joint.mimic) continue;
    geometric_.push_back({int(parameters_.size()), 2});
    columns_.push_back({int(k), 6});
    // Of the coordinate: a joint that slides may follow one that turns.
    const std::string& unit = chain_.coordinates[std::size_t(joint.coordinate)].unit;
    parameters_.push_back({joint.name + ".offset", unit, 0.0, unit == "m" ? 0.5e-3 : 0.05 * degree, Role::interest});
    columns_.push_back({int(k), 7});
    parameters_.push_back({joint.name + ".gear", "1", 0.0, 1e-3, Role::interest});
  }
  add_displacement("tool", int(chain_.joints.size()), 1, chain_.X_LastTip, 5e-3, 1 * degree);
}

bool SerialChain::is_backward(int joint) const {
  return joint >= 0 && joint < int(chain_.joints.size()) && chain_.joints[std::size_t(joint)].backward();
}

bool SerialChain::linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X, Twists& twists,
                            Twists* reading_twists) const {
  linearise_deflected(at.q, {}, at.correction, selected, X, twists, reading_twists);
  return true;
}

HarmonicColumns SerialChain::harmonic_columns(std::span<const int> selected, const Point& at) const {
  const std::span<const double> correction = at.correction;
  HarmonicColumns result;
  for (std::size_t c = 0; c < coordinates_.size(); ++c) {
    int highest = 0;
    for (const int k : joints_of_coordinate_[c]) {
      const ChainJoint& joint = chain_.joints[std::size_t(k)];
      const double ratio = std::abs(joint.multiplier);
      if (!joint.prismatic && ratio != std::round(ratio))
        return {"joint " + joint.name + " follows another at a ratio that is no whole number", {}, {}, {}};
      highest += joint.prismatic ? 1 : int(std::min(ratio, 99.0));
    }
    const auto gear = std::size_t(layout_.offset[c] + 1);
    if (gear < correction.size() && correction[gear] != 0.0)
      return {"a gear error of " + coordinates_[c].name + " that is known", {}, {}, {}};
    result.degrees.push_back(highest);
  }
  for (const int i : selected) {
    const bool of_gear = i < layout_.count && columns_[std::size_t(i)].kind == 7;
    if (of_gear)
      result.factors.push_back({int(result.selected.size()),
                                chain_.joints[std::size_t(columns_[std::size_t(i)].joint)].coordinate,
                                ColumnFactor::Kind::linear, 0.0});
    // The offset stands before the gear.
    result.selected.push_back(of_gear ? i - 1 : i);
  }
  return result;
}

void SerialChain::linearise_deflected(std::span<const double> q, std::span<const double> deflection,
                                      std::span<const double> correction, std::span<const int> selected,
                                      Eigen::Isometry3d& X, Twists& twists, Twists* reading_twists) const {
  PaddedCorrections padded;
  const double* all = padded_corrections(correction, layout_.count, padded);
  ChainState state;
  const Frame<double> tip =
      run_chain(chain_, layout_, q.data(), deflection.empty() ? nullptr : deflection.data(), all, state);
  const auto motion_of = [&](int coordinate) {
    Twist sum = Twist::Zero();
    for (const int k : joints_of_coordinate_[std::size_t(coordinate)])
      sum += chain_.joints[std::size_t(k)].multiplier * state.motion[std::size_t(k)];
    return sum;
  };
  twists.resize(6, Eigen::Index(selected.size()));
  for (std::size_t c = 0; c < selected.size(); ++c) {
    auto out = twists.col(Eigen::Index(c));
    if (selected[c] >= layout_.count) {
      out.setZero();
      continue;
    }
    const Column& column = columns_[std::size_t(selected[c])];
    if (column.kind >= 6) {
      const int coordinate = chain_.joints[std::size_t(column.joint)].coordinate;
      out = motion_of(coordinate);
      if (column.kind == 7) out *= q[std::size_t(coordinate)];
      continue;
    }
    out = state.displacement[std::size_t(column.joint + 1)].twist(column.kind);
    if (is_backward(column.joint)) out = -out;
  }
  if (reading_twists != nullptr) {
    reading_twists->resize(6, Eigen::Index(coordinates_.size()));
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      const double gear = all == nullptr ? 0.0 : all[layout_.offset[i] + 1];
      reading_twists->col(Eigen::Index(i)) = (1 + gear) * motion_of(int(i));
    }
  }
  X = isometry_of(tip);
}

bool SerialChain::pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                            std::span<double> gradient) const {
  pull_back_deflected(at.q, {}, at.correction, selected, f, gradient);
  return true;
}

void SerialChain::pull_back_deflected(std::span<const double> q, std::span<const double> deflection,
                                      std::span<const double> correction, std::span<const int> selected,
                                      const TipAdjoint& f, std::span<double> gradient,
                                      std::span<double> by_deflection) const {
  PaddedCorrections padded;
  const double* all = padded_corrections(correction, layout_.count, padded);
  ChainState state;
  run_chain(chain_, layout_, q.data(), deflection.empty() ? nullptr : deflection.data(), all, state);
  const std::size_t joints = chain_.joints.size();
  // Of what joints before the k-th carry: f's change by a twist of all of it.
  std::array<Twist, max_joints + 1> carried;
  std::fill_n(carried.begin(), joints + 1, Twist::Zero());
  carried[joints] = f.tip;
  const auto add_joints = [&](int coordinate, const Twist& slope) {
    for (const int k : joints_of_coordinate_[std::size_t(coordinate)])
      carried[std::size_t(k)] +=
          chain_.joints[std::size_t(k)].multiplier * carried_change(state.motion[std::size_t(k)], slope);
  };
  const auto motion_along = [&](int coordinate, const Twist& slope) {
    double sum = 0;
    for (const int k : joints_of_coordinate_[std::size_t(coordinate)])
      sum += chain_.joints[std::size_t(k)].multiplier * state.motion[std::size_t(k)].dot(slope);
    return sum;
  };
  for (std::size_t c = 0; c < selected.size(); ++c) {
    if (selected[c] >= layout_.count) continue;
    const Twist slope = f.twists.col(Eigen::Index(c));
    const Column& column = columns_[std::size_t(selected[c])];
    if (column.kind < 6) {
      // The base's own axes are carried by no joint, those of a joint that is passed backward by itself too.
      const Twist own = state.displacement[std::size_t(column.joint + 1)].twist(column.kind);
      if (is_backward(column.joint)) carried[std::size_t(column.joint + 1)] += carried_change(-own, slope);
      else if (column.joint >= 0) carried[std::size_t(column.joint)] += carried_change(own, slope);
      continue;
    }
    const int coordinate = chain_.joints[std::size_t(column.joint)].coordinate;
    add_joints(coordinate, column.kind == 7 ? Twist(q[std::size_t(coordinate)] * slope) : slope);
    if (column.kind == 7) gradient[std::size_t(coordinate)] += motion_along(coordinate, slope);
  }
  const auto gear = [&](std::size_t i) { return 1 + (all == nullptr ? 0.0 : all[layout_.offset[i] + 1]); };
  for (Eigen::Index i = 0; i < f.reading_twists.cols(); ++i)
    add_joints(int(i), gear(std::size_t(i)) * f.reading_twists.col(i));
  Twist beyond = Twist::Zero();
  for (std::size_t k = joints; k-- > 0;) {
    beyond += carried[k + 1];
    const auto coordinate = std::size_t(chain_.joints[k].coordinate);
    const double change = chain_.joints[k].multiplier * state.motion[k].dot(beyond);
    gradient[coordinate] += gear(coordinate) * change;
    if (!by_deflection.empty()) by_deflection[coordinate] += change;
  }
}

}  // namespace posewright
