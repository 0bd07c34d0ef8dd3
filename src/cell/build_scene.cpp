#include <algorithm>
#include <atomic>
#include <map>
#include <set>

#include "posewright/model/srdf.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/random.hpp"
#include "scene.hpp"

namespace posewright {
namespace {

// Configurations that decide which pairs of links touch wherever the robot stands, as MoveIt's assistant does.
constexpr int always_samples = 1000;
constexpr double always_share = 0.95;
constexpr std::uint64_t contact_seed = 271828;
// Whether a pair is never near is not asked at any price; limits written with fewer digits reach a little further.
constexpr long most_looks = 2000;
constexpr double beyond_limits = 1e-3;
// Standard deviations of the tolerances that links keep from each other whatever is asked for.
constexpr double least_sigmas = 3;
// Kept by what is near by design, m: less is contact.
constexpr double least_reduced = 1e-3;

using NamePair = std::pair<std::string, std::string>;

NamePair ordered(const std::string& a, const std::string& b) { return std::minmax(a, b); }

class SceneBuilder {
 public:
  SceneBuilder(const Problem& problem, const IdentificationModel& model)
      : problem_(problem), spec_(*problem.workspace.collision), model_(model) {
    static std::atomic<std::uint64_t> made{0};
    scene_.number = ++made;
    scene_.frames = make_body_frames(problem, model);
    scene_.bodies = build_bodies(problem, *scene_.frames);
  }

  Scene build(const Scene* same_robot) {
    read_ignored();
    if (spec_.self) add_self_pairs();
    add_obstacle_pairs();
    add_margins();
    if (same_robot != nullptr) take_self_pairs(*same_robot);
    else settle_self_pairs();
    find_never_near();
    add_tables();
    return std::move(scene_);
  }

 private:
  void require_bodies(const std::vector<Located<std::string>>& given, const std::set<std::string>& names) const {
    for (const Located<std::string>& name : given) {
      if (names.count(name.value) > 0) continue;
      std::string list;
      for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
      throw InputError(problem_.at(name.line),
                       "'" + name.value + "' is not a link, tool part or obstacle with a shape" +
                           meant_instead(name.value, {names.begin(), names.end()}),
                       list.empty() ? "there is none" : "allowed: " + list);
    }
  }

  void read_ignored() {
    std::set<std::string> names;
    for (const Body& body : scene_.bodies) names.insert(body.name);
    for (const auto& [a, b] : spec_.ignore) {
      require_bodies({a, b}, names);
      ignored_.insert(ordered(a.value, b.value));
    }
    for (const CollisionSpec::PairClearance& pair : spec_.pair_clearances)
      require_bodies({pair.first, pair.second}, names);
    const auto* arm = std::get_if<SerialArmSpec>(&problem_.robot);
    const auto& srdf = spec_.srdf || arm == nullptr ? spec_.srdf : arm->srdf;
    if (srdf)
      for (const auto& [a, b] : read_srdf_pairs(srdf->value, problem_.at(srdf->line))) ignored_.insert(ordered(a, b));
  }

  /// Clearance of a pair of the robot's own bodies: of the pair, of all, or as from obstacles.
  double self_clearance(const Body& a, const Body& b) const {
    for (const CollisionSpec::PairClearance& pair : spec_.pair_clearances)
      if (ordered(pair.first.value, pair.second.value) == ordered(a.name, b.name)) return pair.clearance;
    return spec_.self_clearance.value_or(spec_.clearance);
  }

  void add_pair(int a, int b, int reason, double clearance) {
    if (const Body& first = scene_.bodies[std::size_t(a)], &second = scene_.bodies[std::size_t(b)];
        !first.obstacle && first.frame > second.frame)
      std::swap(a, b);
    scene_.pairs.push_back({a, b, reason, clearance + motion_resolution, clearance, 0.0, {}});
    const Body &first = scene_.bodies[std::size_t(a)], &second = scene_.bodies[std::size_t(b)];
    const std::vector<Eigen::Vector3d> of_first = corners_of(first), of_second = corners_of(second);
    // Of two bodies either one may be said to stand still. Planes have no corners: they are the ones that do.
    const bool both_ways = !first.solid->plane() && !second.solid->plane();
    BodyPair& pair = scene_.pairs.back();
    for (int pose = 0; pose < scene_.frames->poses_per_configuration(); ++pose) {
      pair.travel.push_back(scene_.frames->travel(pose, first.frame, second.frame, of_second));
      pair.approach.push_back(pair.travel.back());
      if (both_ways)
        pair.approach.back() =
            pair.travel.back().cwiseMin(scene_.frames->travel(pose, second.frame, first.frame, of_first));
    }
  }

  static std::vector<Eigen::Vector3d> corners_of(const Body& body) {
    std::vector<Eigen::Vector3d> corners;
    for (const Eigen::Vector3d& corner : body.solid->corners()) corners.push_back(body.X_FrameBody * corner);
    return corners;
  }

  void add_self_pairs() {
    scene_.reasons.emplace_back("self-collision");
    const int count = int(scene_.bodies.size());
    for (int i = 0; i < count; ++i)
      for (int j = i + 1; j < count; ++j) {
        const Body &a = scene_.bodies[std::size_t(i)], &b = scene_.bodies[std::size_t(j)];
        const bool adjacent = a.name == b.parent || b.name == a.parent;
        if (a.obstacle || b.obstacle || a.frame == b.frame || adjacent || ignored_.count(ordered(a.name, b.name)) > 0)
          continue;
        add_pair(i, j, 0, self_clearance(a, b));
      }
  }

  /// An obstacle of several shapes is one row in the table of rejections.
  int reason_of(const std::string& text) {
    const auto known = std::find(scene_.reasons.begin(), scene_.reasons.end(), text);
    const int place = int(known - scene_.reasons.begin());
    if (known == scene_.reasons.end()) scene_.reasons.push_back(text);
    return place;
  }

  void add_obstacle_pairs() {
    const int count = int(scene_.bodies.size());
    for (int i = 0; i < count; ++i) {
      const Body& obstacle = scene_.bodies[std::size_t(i)];
      if (!obstacle.obstacle) continue;
      const int reason = reason_of("collision with " + obstacle.name);
      for (int j = 0; j < count; ++j) {
        const Body& body = scene_.bodies[std::size_t(j)];
        // What does not move stands where the user put it: a base on its table touches it.
        if (body.obstacle || body.frame == obstacle.frame || ignored_.count(ordered(obstacle.name, body.name)) > 0)
          continue;
        add_pair(i, j, reason, spec_.clearance);
      }
    }
  }

  /// True if both are links or tool.
  bool is_own(const BodyPair& pair) const {
    return !scene_.bodies[std::size_t(pair.a)].obstacle && !scene_.bodies[std::size_t(pair.b)].obstacle;
  }

  void add_margins() {
    const double sigmas = problem_.workspace.uncalibrated;
    const auto concerns = [&](const BodyPair& pair) { return sigmas > 0 || is_own(pair); };
    if (std::none_of(scene_.pairs.begin(), scene_.pairs.end(), concerns)) return;
    const UncalibratedError error(problem_, model_, *scene_.frames);
    for (BodyPair& pair : scene_.pairs) {
      if (!concerns(pair)) continue;
      const double sigma = error.of(scene_.bodies[std::size_t(pair.a)], scene_.bodies[std::size_t(pair.b)]);
      const double margin = sigmas * sigma;
      scene_.margin = std::max(scene_.margin, margin);
      if (is_own(pair)) pair.least = least_sigmas * sigma;
      pair.clearance = motion_resolution + std::max(pair.asked + margin, pair.least);
      pair.asked = std::max(pair.asked, pair.least);
    }
  }

  /// Links whose shapes overlap wherever the robot stands say nothing about collision and are left out; those that
  /// cannot keep their clearance by design keep a part of it.
  void settle_self_pairs() {
    std::vector<int> touching(scene_.pairs.size(), 0);
    std::vector<double> largest(scene_.pairs.size(), 0.0);
    std::vector<Eigen::Isometry3d> X(std::size_t(scene_.frames->count()));
    Random random(contact_seed, 0);
    std::vector<double> q;
    const int misses = int(always_samples * (1 - always_share));
    for (int i = 0; i < always_samples; ++i) {
      q.clear();
      for (const Coordinate& c : model_.coordinates())
        q.push_back(c.discrete() ? c.values.front() : c.lower + random.uniform() * (c.upper - c.lower));
      scene_.frames->poses(q, 0, X);
      for (std::size_t p = 0; p < scene_.pairs.size(); ++p) {
        const BodyPair& pair = scene_.pairs[p];
        const Body &a = scene_.bodies[std::size_t(pair.a)], &b = scene_.bodies[std::size_t(pair.b)];
        const bool known = largest[p] >= 2 * pair.asked && touching[p] < i - misses;
        if (!is_own(pair) || known) continue;
        const double found = distance(*a.solid, X[std::size_t(a.frame)] * a.X_FrameBody, *b.solid,
                                      X[std::size_t(b.frame)] * b.X_FrameBody, 2 * pair.asked + motion_resolution);
        largest[p] = std::max(largest[p], found);
        touching[p] += found <= 0;
      }
    }
    std::set<NamePair> always;
    std::map<NamePair, double> reduced;
    for (std::size_t p = 0; p < scene_.pairs.size(); ++p) {
      BodyPair& pair = scene_.pairs[p];
      const Body &a = scene_.bodies[std::size_t(pair.a)], &b = scene_.bodies[std::size_t(pair.b)];
      if (!is_own(pair)) continue;
      const NamePair names = ordered(a.name, b.name);
      if (touching[p] >= always_share * always_samples) always.insert(names);
      else if (largest[p] < 2 * pair.asked) {
        // 1 mm and what tolerances move at least, if they ever are so far apart.
        const double least = std::min(std::max(least_reduced, pair.least), 0.8 * largest[p]);
        const double kept = std::min(pair.asked, std::max(0.5 * largest[p], least));
        pair.clearance = kept + (kept > motion_resolution ? motion_resolution : 0.0);
        pair.room = std::max(0.0, largest[p] - pair.clearance);
        const auto at = reduced.emplace(names, kept).first;
        at->second = std::min(at->second, kept);
      }
    }
    std::erase_if(scene_.pairs, [&](const BodyPair& p) { return always.count(ordered(name(p.a), name(p.b))) > 0; });
    for (const auto& [a, b] : always) scene_.always.push_back(a + " and " + b);
    for (const auto& [names, kept] : reduced)
      if (always.count(names) == 0) scene_.reduced.push_back({names.first, names.second, kept});
  }

  /// Results of settle_self_pairs(), find_never_near() and add_tables() for the same bodies.
  void take_self_pairs(const Scene& known) {
    scene_.always = known.always;
    scene_.reduced = known.reduced;
    std::map<std::pair<int, int>, const BodyPair*> pairs;
    for (const BodyPair& pair : known.pairs) pairs[{pair.a, pair.b}] = &pair;
    std::erase_if(scene_.pairs, [&](const BodyPair& p) { return is_own(p) && pairs.count({p.a, p.b}) == 0; });
    for (BodyPair& pair : scene_.pairs) {
      if (!is_own(pair)) continue;
      const BodyPair& same = *pairs.at({pair.a, pair.b});
      pair.clearance = same.clearance;
      pair.never_near = same.never_near;
      pair.table = same.table;
    }
  }

  /// A tool that only the last joint turns past the wrist: one turn through the whole range answers for all poses.
  void find_never_near() {
    const std::vector<Coordinate>& coordinates = model_.coordinates();
    if (scene_.frames->poses_per_configuration() != 1) return;
    const std::vector<double> middle = middle_configuration();
    for (BodyPair& pair : scene_.pairs) {
      const Eigen::VectorXd& approach = pair.approach.front();
      Eigen::Index moving = 0;
      approach.maxCoeff(&moving);
      const Coordinate& c = coordinates[std::size_t(moving)];
      if (pair.never_near || (approach.array() != 0).count() != 1 || c.discrete()) continue;
      std::vector<double> first = middle, last = middle;
      first[std::size_t(moving)] = c.lower - beyond_limits;
      last[std::size_t(moving)] = c.upper + beyond_limits;
      pair.never_near = keep_apart(scene_, {&pair, 1}, 0, first, last, most_looks);
    }
  }

  /// Distances of most links depend on two or three joints only.
  void add_tables() {
    if (scene_.frames->poses_per_configuration() != 1) return;
    const std::vector<Coordinate>& coordinates = model_.coordinates();
    std::vector<double> middle = middle_configuration();
    for (BodyPair& pair : scene_.pairs) {
      std::vector<ApartTable::Axis> axes;
      bool fits = !pair.never_near && pair.table == nullptr;
      for (std::size_t k = 0; k < coordinates.size(); ++k) {
        const double approach = pair.approach.front()[Eigen::Index(k)];
        const Coordinate& c = coordinates[k];
        if (!(approach > 0)) continue;
        fits = fits && !c.discrete() && c.lower < c.upper && axes.size() < ApartTable::most_axes;
        if (fits)
          axes.push_back({k, c.lower - beyond_limits, c.upper + beyond_limits, scene_.frames->period(k), approach});
      }
      if (fits && !axes.empty()) pair.table = std::make_shared<ApartTable>(std::move(axes), middle, pair.room);
    }
  }

  std::vector<double> middle_configuration() const {
    std::vector<double> middle;
    middle.reserve(model_.coordinates().size());
    for (const Coordinate& c : model_.coordinates())
      middle.push_back(c.discrete() ? c.values.front() : 0.5 * (c.lower + c.upper));
    return middle;
  }

  const std::string& name(int body) const { return scene_.bodies[std::size_t(body)].name; }

  const Problem& problem_;
  const CollisionSpec& spec_;
  const IdentificationModel& model_;
  std::set<NamePair> ignored_;
  Scene scene_;
};

}  // namespace

Scene build_scene(const Problem& problem, const IdentificationModel& model, const Scene* same_robot) {
  return SceneBuilder(problem, model).build(same_robot);
}

}  // namespace posewright
