#include "posewright/tasks/place_stations.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "posewright/cell/cell.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/model/link_geometry.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/problem/design_keys.hpp"
#include "posewright/results/stated_error.hpp"
#include "posewright/support/bytes.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/tasks.hpp"
#include "posewright/workspace/candidates.hpp"
#include "without_roadmap.hpp"

namespace posewright {
namespace {

constexpr std::size_t most_sets = 100;
// Said of a place that no plan was made from before the search was ended.
constexpr const char* not_looked_at = "the search ended before it was scored";
// Of the quick plan that decides which places are looked at closely.
constexpr int quick_candidates = 400, quick_restarts = 1;

using Set = std::vector<std::size_t>;  // indices into the list of places

void require_stations(const Problem& problem) {
  require_one_instrument(problem, "stations");
  MeasurementSpec measurement = problem.measurement;
  if (stations_of(measurement) == nullptr)
    throw InputError(problem.at(problem.workspace.stations->line),
                     "workspace.stations: this instrument has no stations",
                     "trackers and cameras that measure points do");
  const auto* arm = std::get_if<SerialArmSpec>(&problem.robot);
  if (arm != nullptr && root_place(*arm, problem.at(arm->line)).base_moves())
    throw InputError(problem.at(problem.workspace.stations->line),
                     "workspace.stations: joints between base and tip move the base, and the instrument with it",
                     "a base that stands");
}

/// The body of the instrument stands where the instrument does. With one place it keeps its name; with several there is
/// one at each.
void move_bodies(Problem& problem, const std::vector<StationSpec>& before, const std::vector<StationSpec>& chosen) {
  if (!problem.workspace.collision || before.empty()) return;
  CollisionSpec& collision = *problem.workspace.collision;
  std::vector<BodySpec> bodies;
  std::map<std::string, std::vector<std::string>> names;  // of bodies of instruments: what they are called now
  for (const BodySpec& body : collision.obstacles) {
    if (body.station.empty()) {
      bodies.push_back(body);
      continue;
    }
    names[body.name] = {};
    // One instrument that is carried on, or one a station: the first one's body is taken.
    if (body.station != before.front().name) continue;
    for (const StationSpec& station : chosen) {
      const Eigen::Isometry3d X =
          isometry(station.placement) * isometry(before.front().placement).inverse() * isometry(body.placement);
      BodySpec moved = body;
      moved.station = station.name;
      if (chosen.size() > 1) moved.name += " at " + station.name;
      moved.placement = {X.translation(), rpy_of(X.linear())};
      names[body.name].push_back(moved.name);
      bodies.push_back(moved);
    }
  }
  collision.obstacles = std::move(bodies);
  for (BodySpec& part : collision.tool)
    if (!part.station.empty()) part.station = chosen.front().name;
  const auto ignored = std::exchange(collision.ignore, {});
  const auto called = [&](const std::string& name) {
    const auto now = names.find(name);
    return now == names.end() ? std::vector<std::string>{name} : now->second;
  };
  for (const auto& [a, b] : ignored)
    for (const std::string& first : called(a.value))
      for (const std::string& second : called(b.value)) collision.ignore.push_back({{first, a.line}, {second, b.line}});
}

Problem with_stations(Problem problem, const std::vector<StationSpec>& chosen) {
  std::vector<StationSpec>& stations = *stations_of(problem.measurement);
  move_bodies(problem, stations, chosen);
  stations = chosen;
  return problem;
}

StationRank rank_in(std::string_view bytes, std::vector<StationSpec> stations) {
  auto rank = value_in<StationRank>(bytes);
  rank.stations = std::move(stations);
  return rank;
}

/// Places are compared by what they are worth to the nominal robot.
Problem planned_in_full(Problem problem) {
  problem.design.robust.reset();
  problem.design.criterion.value = criterion_of_places(problem);
  return problem;
}

/// With few candidates and one start, without ways: few poses are unreachable, and at every place the same.
Problem planned_quickly(const Problem& full) {
  Problem problem = without_roadmap(full);
  const int candidates = std::min(quick_candidates, problem.design.candidates.value);
  const std::pair<const char*, std::string> changes[] = {{"design.candidates", std::to_string(candidates)},
                                                         {"design.restarts", std::to_string(quick_restarts)},
                                                         {"design.method", "exchange"}};
  problem.design.candidates_from.reset();
  for (const auto& [key, value] : changes) set(problem, key, value, "quick plans");
  return problem;
}

/// The robot alone: the problem's own station, which is none of the places, may stand anywhere.
Problem without_sight(Problem problem) {
  problem.workspace.line_of_sight.reset();
  return problem;
}

class StationRanking {
 public:
  StationRanking(const Problem& problem, const StationOptions& options, const Monitor& monitor)
      : problem_(problem),
        full_(planned_in_full(problem)),
        quick_(planned_quickly(full_)),
        options_(options),
        monitor_(monitor),
        places_(problem.workspace.stations->list) {
    const std::string criterion = criterion_of_places(problem);
    const auto* entry = find_criterion(criterion);
    if (entry != nullptr && entry->several_variants)
      throw CannotDo("criterion " + criterion +
                     " compares plans with others of the same stations; choose one of one variant");
    determinant_ = entry != nullptr && entry->determinant;
    if (problem.workspace.collision) robot_ = make_cell(without_sight(quick_));
  }

  std::vector<StationRank> rank() {
    const auto choose = wanted_ = std::size_t(options_.choose.value_or(problem_.workspace.stations->choose));
    if (choose > places_.size())
      throw InputError({}, "--choose " + std::to_string(choose),
                       "there are " + std::to_string(places_.size()) + " places to choose among");
    std::vector<StationRank> ranks = quick(choose);
    sort(ranks);
    RunOptions full = options_.run;
    full.proof.seconds = 0.0;  // places are held against each other, not against what is possible
    std::size_t in_full = 0;
    while (in_full < std::min(ranks.size(), std::size_t(std::max(options_.full, 0))) && ranks[in_full].why_not.empty())
      ++in_full;
    // One at a time in each process: the parts of a whole plan keep its threads busy.
    run_tasks(
        {"full plans", in_full, 1}, [&](std::size_t i, int) { return bytes_of(judge(full_, ranks[i].stations, full)); },
        [&](std::size_t i, std::string_view bytes) {
          StationRank found = rank_in(bytes, ranks[i].stations);
          // What was cut short is no better than the quick plan.
          if (found.stopped) return;
          ranks[i] = std::move(found);
          ranks[i].in_full = true;
        },
        monitor_);
    for (std::size_t i = 0; i < in_full; ++i) ranks[i].stopped = !ranks[i].in_full;
    sort(ranks);
    compare(ranks);
    if (!ranks.front().why_not.empty())
      throw CannotDo("no place allows a plan; the first one: " + ranks.front().why_not);
    return ranks;
  }

 private:
  void compare(std::vector<StationRank>& ranks) const {
    const StationRank best = ranks.front();
    if (!determinant_) return;
    for (StationRank& rank : ranks)
      if (rank.why_not.empty() && rank.parameters == best.parameters && rank.in_full == best.in_full)
        rank.sigma_ratio = std::exp((best.phi - rank.phi) / (2.0 * std::max(rank.parameters, 1)));
  }

  /// Every set if there are few, else one station after the other.
  std::vector<StationRank> quick(std::size_t choose) {
    double sets = 1;
    for (std::size_t i = 0; i < choose; ++i) sets *= double(places_.size() - i) / double(i + 1);
    if (choose == 1 || options_.every_set || sets <= double(most_sets)) return quick_of(all_sets(choose));
    Set chosen;
    std::vector<StationRank> ranks;
    while (chosen.size() < choose) {
      std::vector<Set> trials;
      for (std::size_t i = 0; i < places_.size(); ++i)
        if (std::find(chosen.begin(), chosen.end(), i) == chosen.end()) {
          trials.push_back(chosen);
          trials.back().push_back(i);
        }
      ranks = quick_of(trials);
      chosen = trials[std::size_t(std::ranges::min_element(ranks, better) - ranks.begin())];
    }
    return ranks;
  }

  std::vector<Set> all_sets(std::size_t choose) const {
    std::vector<Set> sets;
    std::vector<bool> chosen(places_.size(), false);
    std::fill_n(chosen.begin(), choose, true);
    do {
      sets.emplace_back();
      for (std::size_t i = 0; i < chosen.size(); ++i)
        if (chosen[i]) sets.back().push_back(i);
    } while (std::prev_permutation(chosen.begin(), chosen.end()));
    return sets;
  }

  std::vector<StationRank> quick_of(const std::vector<Set>& sets) {
    RunOptions quick = options_.run;
    quick.candidates_alone = true;
    // Places side by side keep threads busier than the parts of one plan do.
    const int threads = thread_count(options_.run.threads), at_once = std::min(threads, int(sets.size()));
    quick.threads = std::max(1, threads / std::max(1, at_once));
    std::vector<StationRank> ranks(sets.size());
    const auto stations_at = [&](std::size_t s) {
      std::vector<StationSpec> stations;
      for (const std::size_t i : sets[s]) stations.push_back(places_[i]);
      return stations;
    };
    for (std::size_t s = 0; s < sets.size(); ++s) {
      ranks[s].stations = stations_at(s);
      ranks[s].why_not = not_looked_at;
      ranks[s].stopped = true;
    }
    const bool stopped = run_tasks(
        {"places", sets.size(), at_once},
        [&](std::size_t s, int) { return bytes_of(judge(quick_, stations_at(s), quick)); },
        [&](std::size_t s, std::string_view bytes) { ranks[s] = rank_in(bytes, stations_at(s)); }, monitor_);
    const bool none = std::all_of(ranks.begin(), ranks.end(), [](const StationRank& r) { return r.stopped; });
    if (stopped && (none || sets.front().size() < wanted_)) throw CannotDo("stopped before the first place was scored");
    return ranks;
  }

  StationRank judge(const Problem& problem, const std::vector<StationSpec>& stations, RunOptions run) const {
    StationRank rank;
    rank.stations = stations;
    Monitor quiet;  // its plan's own stages would hide how many places are done
    quiet.stop_with(monitor_);
    try {
      run.same_robot = robot_;
      const Plan plan = plan_problem(with_stations(problem, stations), run, quiet);
      for (const PlannedParameter& p : plan.parameters)
        rank.parameters += p.sigma.has_value() && p.label.role == Role::interest;
      rank.criterion_value = plan.criterion_value;
      rank.phi = determinant_ ? plan.log_det : plan.criterion_value;
      rank.expected = plan.expected;
      long most = 0, passed_over = 0;
      for (const auto& [reason, count] : plan.statistics.rejected)
        if (reason == passed_over_reason) {
          passed_over = count;
        } else if (count > most) {
          most = count;
          rank.main_rejection = reason;
        }
      // What a sampler passes over is feasible.
      rank.feasible_share = double(plan.statistics.feasible + passed_over) / double(plan.statistics.drawn);
    } catch (const CannotDo& error) {
      rank.why_not = error.what();
    } catch (const StationInside&) {
      // A bad place; what is wrong with the rest of the problem is wrong everywhere.
      rank.why_not = "is inside a body";
    }
    if (quiet.should_stop()) {
      rank.stopped = true;
      rank.why_not = not_looked_at;
    }
    return rank;
  }

  /// Plans that identify more come first: their determinants are of other sizes.
  static bool better(const StationRank& a, const StationRank& b) {
    if (a.why_not.empty() != b.why_not.empty()) return a.why_not.empty();
    if (a.in_full != b.in_full) return a.in_full;
    if (a.parameters != b.parameters) return a.parameters > b.parameters;
    return a.phi > b.phi;
  }
  static void sort(std::vector<StationRank>& ranks) { std::stable_sort(ranks.begin(), ranks.end(), better); }

  const Problem& problem_;
  Problem full_, quick_;
  const StationOptions& options_;
  const Monitor& monitor_;
  const std::vector<StationSpec>& places_;
  std::shared_ptr<const Cell> robot_;  // where the instrument does not matter; null: nothing collides
  bool determinant_ = false;
  std::size_t wanted_ = 0;  // stations of a set
};

}  // namespace

std::string criterion_of_places(const Problem& problem) {
  const std::string& named = problem.design.criterion.value;
  return named == automatic_criterion ? "o1" : named;
}

std::vector<StationRank> place_stations(const Problem& problem, const StationOptions& options, const Monitor& monitor) {
  if (!problem.workspace.stations)
    throw InputError(problem.at(0), "names no places for stations", "set workspace: stations: among or box");
  require_stations(problem);
  return StationRanking(problem, options, monitor).rank();
}

}  // namespace posewright
