#include "motions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr double same = 1e-9;  // m, rad, and of columns relative to the largest entry

/// Joint by joint the value within the proposed limits that is nearest to home.
std::vector<double> turned(const std::vector<Coordinate>& limits, std::span<const double> home, std::vector<double> q) {
  for (std::size_t i = 0; i < q.size(); ++i) {
    const Coordinate& c = limits[i];
    if (c.unit != "rad" || c.discrete() || c.periodic) continue;
    const double nearest = q[i] - turn * std::round((q[i] - home[i]) / turn);
    if (nearest >= c.lower && nearest <= c.upper) q[i] = nearest;
  }
  return q;
}

bool is_same(const IdentificationModel& model, const std::vector<int>& columns, std::span<const double> a,
             std::span<const double> b) {
  if (!model.tool_pose(a).isApprox(model.tool_pose(b), same)) return false;
  Linearisation at_a, at_b;
  return model.linearise(a, {}, columns, at_a) && model.linearise(b, {}, columns, at_b) &&
         (at_a.G - at_b.G).cwiseAbs().maxCoeff() <= same * (1 + at_a.G.cwiseAbs().maxCoeff());
}

}  // namespace

Motions::Motions(const MotionSpace& space, std::vector<std::vector<double>> stops,
                 std::vector<std::vector<double>> leads, int milestones, std::uint64_t seed, int threads,
                 const Monitor& monitor)
    : space_(space),
      stops_(std::move(stops)),
      leads_(std::move(leads)),
      milestones_(milestones),
      threads_(threads),
      seed_(seed),
      monitor_(monitor) {}
Motions::~Motions() = default;

void Motions::look_ahead(const std::vector<Pair>& pairs) {
  std::vector<Pair> open;
  for (const auto& [i, j] : pairs) {
    const Pair key{std::min(i, j), std::max(i, j)};
    if (straight_.count(key) == 0 && std::find(open.begin(), open.end(), key) == open.end()) open.push_back(key);
  }
  std::vector<char> free(open.size(), 0);
  parallel_for(open.size(), thread_count(threads_), [&](std::size_t k, int) {
    free[k] = char(!monitor_.should_stop() &&
                   space_.is_free(leads_[std::size_t(open[k].first)], leads_[std::size_t(open[k].second)]));
  });
  if (monitor_.should_stop()) throw CannotDo("stopped before all motions were found");
  for (std::size_t k = 0; k < open.size(); ++k) straight_[open[k]] = free[k] != 0;
}

Roadmap& Motions::roadmap() {
  if (roadmap_ == nullptr)
    roadmap_ = std::make_unique<Roadmap>(space_, milestones_, seed_, RoadmapUse::motions, monitor_);
  return *roadmap_;
}

Motion Motions::direct(int i, int j) {
  const auto& from = leads_[std::size_t(i)];
  const auto& to = leads_[std::size_t(j)];
  look_ahead({{i, j}});
  if (straight_[{std::min(i, j), std::max(i, j)}]) return {{from, to}, space_.seconds(from, to), "straight"};
  if (!space_.is_free(from) || !space_.is_free(to)) return {};
  Motion motion = roadmap().motion(from, to);
  if (!motion.points.empty()) return motion;
  // Everything is connected with the hub or with nothing: one search a stop, not one a pair.
  if (i == hub_ || j == hub_) return roadmap().grow(from, to);
  return reachable(i) && reachable(j) ? roadmap().motion(from, to) : Motion{};
}

void Motions::add_ends(Motion& motion, int i, int j) const {
  const auto &from = stops_[std::size_t(i)], &to = stops_[std::size_t(j)];
  if (motion.points.empty()) return;
  if (from != motion.points.front()) {
    motion.seconds += space_.seconds(from, motion.points.front());
    motion.points.insert(motion.points.begin(), from);
  }
  if (to != motion.points.back()) {
    motion.seconds += space_.seconds(motion.points.back(), to);
    motion.points.push_back(to);
  }
}

const Motion& Motions::between(int i, int j) {
  const Pair key{std::min(i, j), std::max(i, j)};
  auto known = found_.find(key);
  if (known == found_.end()) {
    Motion motion = direct(key.first, key.second);
    add_ends(motion, key.first, key.second);
    if (motion.points.empty() && key.first != hub_ && key.second != hub_ && reachable(key.first) &&
        reachable(key.second)) {
      motion = between(key.first, hub_);
      const Motion& rest = between(hub_, key.second);
      motion.points.insert(motion.points.end(), rest.points.begin() + 1, rest.points.end());
      motion.seconds += rest.seconds;
      motion.found_by = "via home";
    }
    known = found_.emplace(key, std::move(motion)).first;
    Motion back = known->second;
    std::reverse(back.points.begin(), back.points.end());
    turned_[key] = std::move(back);
  }
  return i <= j ? known->second : turned_.at(key);
}

void Motions::set_hub(int stop) {
  hub_ = stop;
  std::erase_if(found_, [](const auto& entry) { return entry.second.points.empty(); });
}

bool Motions::reachable(int stop) { return stop == hub_ || !between(hub_, stop).points.empty(); }

std::vector<double> nearest_turn(const Variant& variant, std::span<const double> home, std::vector<double> q) {
  if (!std::holds_alternative<SerialArmSpec>(variant.problem->robot)) return q;
  std::vector<double> other = turned(variant.workspace->proposed(), home, q);
  if (other == q) return q;
  const std::vector<int> columns = all_columns(variant).selected;
  return is_same(*variant.model, columns, q, other) ? other : q;
}

}  // namespace posewright
