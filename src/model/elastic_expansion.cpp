// What bounds the sensitivity of an elastic arm over boxes of joint angles (theory.md eq. (54), (55)).

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "displacement.hpp"
#include "posewright/model/elastic_chain.hpp"

namespace posewright {
namespace {

// Samples of an angle that give a function of degree 1 in its cosine and sine.
constexpr int samples = 3;
// More joints than that are not sampled: 3⁸ torques take some milliseconds.
constexpr std::size_t most_joints = 8;
// Torques are sampled as they are computed; what rounding makes of them is far below.
constexpr double rounded_up = 1 + 1e-9;

/// Values at 3 angles of an axis become coefficients of 1, cos, sin.
void to_coefficients(std::vector<double>& values, std::size_t stride) {
  constexpr double third = 1.0 / 3, root = std::numbers::sqrt3 / 3;
  for (std::size_t first = 0; first < values.size(); ++first) {
    if (first / stride % samples != 0) continue;
    double &a = values[first], &b = values[first + stride], &c = values[first + 2 * stride];
    const double mean = third * (a + b + c), cosine = third * (2 * a - b - c), sine = root * (b - c);
    a = mean;
    b = cosine;
    c = sine;
  }
}

/// No value is larger: over each frequency the function is at most the norm of its coefficients.
double largest_by_frequencies(const std::vector<double>& coefficients, std::size_t axes) {
  std::vector<double> squares(std::size_t(1) << axes, 0.0);
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    std::size_t frequency = 0, rest = i;
    for (std::size_t a = 0; a < axes; ++a, rest /= samples) frequency |= std::size_t(rest % samples != 0) << a;
    squares[frequency] += coefficients[i] * coefficients[i];
  }
  double sum = 0;
  for (const double s : squares) sum += std::sqrt(s);
  return sum * rounded_up;
}

/// Effect of a column's parameter on a point: a rotation or translation of the chain from a place on.
/// Places count the joints before, times 2: a joint's own displacement stands before its turn.
struct Motion {
  int place;
  bool turns;
};

/// Effects of a joint's own turn and of parts on the tip.
Motion turn_of(std::size_t joint) { return {2 * int(joint) + 1, true}; }
Motion carried_by_tip(const ChainDescription& chain) { return {2 * int(chain.joints.size()), false}; }

std::size_t joint_of(const ChainDescription& chain, int coordinate) {
  std::size_t k = 0;
  while (chain.joints[k].coordinate != coordinate) ++k;
  return k;
}

/// Effect of a parameter of the chain without springs; beyond its catalogue: parts on the tip.
Motion motion_of(const ChainDescription& chain, const ChainLayout& layout, int parameter) {
  if (parameter < 6) return {-1, parameter >= 3};
  for (std::size_t k = 0; k < chain.joints.size(); ++k) {
    const int first = layout.displacement[k];
    if (parameter >= first && parameter < first + 6) return {2 * int(k), parameter - first >= 3};
    if (parameter == layout.offset[std::size_t(chain.joints[k].coordinate)]) return turn_of(k);
  }
  Motion motion = carried_by_tip(chain);
  motion.turns = parameter >= layout.tool + 3 && parameter < layout.tool + 6;
  return motion;
}

/// Half the largest second derivative along the deflections of a point's change by a motion: products of turns, each
/// differentiated, end at the last of the three; what moves without turning is turned by those before it alone.
class SecondOrder {
 public:
  SecondOrder(const ChainDescription& chain, std::span<const double> deflection) {
    const std::size_t joints = chain.joints.size();
    reach_.resize(joints + 1, 0.0);
    double beyond = chain.X_LastTip.translation().norm();
    for (std::size_t k = joints; k-- > 0;) {
      reach_[k] = beyond * rounded_up;
      beyond += chain.joints[k].X_ParentJoint.translation().norm();
    }
    for (const ChainJoint& joint : chain.joints) bent_.push_back(deflection[std::size_t(joint.coordinate)]);
  }

  HarmonicColumns::Remainder of(Motion motion) const {
    HarmonicColumns::Remainder sum;
    for (std::size_t i = 0; i < bent_.size(); ++i)
      for (std::size_t j = 0; j < bent_.size(); ++j) {
        const double half = 0.5 * bent_[i] * bent_[j];
        const int last = 2 * int(std::max(i, j)) + 1;
        if (!motion.turns) {
          sum.constant += last < motion.place ? half : 0.0;
          continue;
        }
        sum.constant += half * reach_[std::size_t(std::max(last, motion.place) / 2)];
        sum.lever += half;
      }
    return sum;
  }

 private:
  std::vector<double> reach_, bent_;  // from each joint to the tip, m; deflections at most, rad
};

}  // namespace

std::vector<double> ElasticChain::largest_torques(const Point& at) const {
  const std::size_t joints = chain_.coordinates().size();
  std::vector<std::size_t> moving;
  for (std::size_t c = 0; c < joints; ++c)
    if (!coordinates_[c].discrete()) moving.push_back(c);
  std::size_t count = 1;
  for (std::size_t a = 0; a < moving.size(); ++a) count *= samples;
  std::vector<std::vector<double>> values(joints, std::vector<double>(count));
  std::vector<double> q(at.q.begin(), at.q.begin() + std::ptrdiff_t(joints)), torque(joints);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = i;
    for (const std::size_t c : moving) {
      q[c] = 2 * std::numbers::pi / samples * double(rest % samples);
      rest /= samples;
    }
    torques(q, at.chosen.load_case, torque);
    for (std::size_t c = 0; c < joints; ++c) values[c][i] = torque[c];
  }
  std::vector<double> largest;
  for (std::vector<double>& of_joint : values) {
    std::size_t stride = 1;
    for (std::size_t a = 0; a < moving.size(); ++a, stride *= samples) to_coefficients(of_joint, stride);
    largest.push_back(largest_by_frequencies(of_joint, moving.size()));
  }
  return largest;
}

bool ElasticChain::acts(const Spring& spring, std::span<const double> q) const {
  return spring.kind != Spring::Kind::listed ||
         q[std::size_t(spring.coordinate)] == spec_.listed->at[std::size_t(spring.listed)];
}

std::string ElasticChain::why_not_expanded(const Point& at) const {
  const ChainDescription& chain = chain_.description();
  if (spec_.compensator) return "the torque of a gravity compensator, a root of the joint's cosine and sine";
  if (chain_.coordinates().size() > most_joints) return "an elastic arm of more than eight joints";
  for (const ChainJoint& joint : chain.joints)
    if (joint.prismatic || joint.mimic || joint.multiplier != 1.0)
      return "an elastic arm with joint " + joint.name + ", which slides or follows another";
  for (const double sigma : reading_noise_)
    if (sigma > 0) return "noise of the joints' readings of an elastic arm";
  const auto of_springs = [&](std::size_t i) {
    return i >= std::size_t(first_) && i < std::size_t(first_) + springs_.size();
  };
  for (std::size_t i = 0; i < at.correction.size(); ++i)
    if (!of_springs(i) && at.correction[i] != 0) return "an elastic arm whose geometry is calibrated already";
  for (const double value : loaded_at_)
    if (value != 0) return "an elastic arm whose geometry is calibrated already";
  return {};
}

HarmonicColumns ElasticChain::harmonic_columns(std::span<const int> selected, const Point& at) const {
  HarmonicColumns result;
  result.why_not = why_not_expanded(at);
  if (!result.why_not.empty()) return result;
  const int count = int(springs_.size());
  // Columns of the springs are those of their joints' offsets, times torques.
  std::vector<int> of_chain;
  bool springs = false;
  for (const int i : selected) {
    of_chain.push_back(i < first_ ? i : i < first_ + count ? chain_.layout().count : i - count);
    springs = springs || (i >= first_ && i < first_ + count);
  }
  std::vector<double> rigid;
  Point inside = at;
  inside.correction = without_block(at.correction, first_, springs_.size(), rigid);
  result = chain_.harmonic_columns(of_chain, inside);
  if (!result.why_not.empty()) return result;
  for (std::size_t c = 0; c < selected.size(); ++c) {
    int& own = result.selected[c];
    if (selected[c] >= first_ && selected[c] < first_ + count) own = selected[c];
    else if (own >= first_) own += count;
  }
  result.degrees.push_back(0);

  // Deflections of every joint at most, rad.
  const std::size_t joints = chain_.coordinates().size();
  const std::vector<double> torque = largest_torques(at);
  std::vector<double> deflection(joints, 0.0);
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const auto c = std::size_t(springs_[i].coordinate);
    if (!acts(springs_[i], at.q)) continue;
    const std::size_t index = std::size_t(first_) + i;
    const double value = parameters_[index].nominal + (at.correction.empty() ? 0.0 : at.correction[index]);
    deflection[c] = std::max(deflection[c], std::abs(value) * torque[c]);
  }
  result.bends = std::any_of(deflection.begin(), deflection.end(), [](double d) { return d > 0; });
  result.order = 1 + int(springs) + int(result.bends);
  if (result.bends) result.remainders = remainders_of(result.selected, deflection, torque, result.factors, at);
  return result;
}

std::vector<HarmonicColumns::Remainder> ElasticChain::remainders_of(std::span<const int> selected,
                                                                    std::span<const double> deflection,
                                                                    std::span<const double> torque,
                                                                    std::span<const ColumnFactor> factors,
                                                                    const Point& at) const {
  const ChainDescription& chain = chain_.description();
  const SecondOrder second(chain, deflection);
  const int count = int(springs_.size());
  std::vector<HarmonicColumns::Remainder> result;
  for (std::size_t column = 0; column < selected.size(); ++column) {
    const int index = selected[column], spring = index - first_;
    double size = rounded_up;
    Motion motion = carried_by_tip(chain);
    if (spring >= 0 && spring < count) {
      const Spring& own = springs_[std::size_t(spring)];
      motion = turn_of(joint_of(chain, own.coordinate));
      size *= acts(own, at.q) ? torque[std::size_t(own.coordinate)] : 0.0;
    } else {
      motion = motion_of(chain, chain_.layout(), index < first_ ? index : index - count);
    }
    for (const ColumnFactor& factor : factors)
      if (factor.column == int(column)) {
        const Coordinate& c = coordinates_[std::size_t(factor.coordinate)];
        size *= std::max(std::abs(c.lower - factor.constant), std::abs(c.upper - factor.constant));
      }
    const HarmonicColumns::Remainder most = second.of(motion);
    result.push_back({size * most.constant, size * most.lever});
  }
  return result;
}

}  // namespace posewright
