#include "posewright/tasks/route_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>

#include "../without_roadmap.hpp"
#include "motions.hpp"
#include "posewright/lists/parameters_file.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/route/tour.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/text_file.hpp"
#include "posewright/tasks/planned_pose.hpp"
#include "replacements.hpp"

namespace posewright {
namespace {

// What a motion that does not exist costs in a tour, s.
constexpr double no_way = 1e7;
// A tour's search takes seconds by more than the square of their number: a minute of this many.
constexpr std::size_t most_routed = 1000;
// Replacements that are lost themselves are replaced again.
constexpr int most_rounds = 3;

struct Stop {
  int id = 0;  ///< of the pose; 0: home
  std::vector<double> configuration;
  PlannedPose pose;
};

/// Time of changing a choice by hand.
constexpr std::pair<const char*, double MotionSpec::*> change_times[] = {
    {"station", &MotionSpec::station_change},
    {"load_case", &MotionSpec::load_change},
    {"temperature", &MotionSpec::temperature_change}};

/// Orders the stops that can be reached, and collects what is written of the way.
class Router {
 public:
  /// @param kept  ids of poses whose joints stay on the plan's turn
  Router(const Problem& problem, const PoseList& poses, const RouteOptions& options, const Monitor& monitor,
         const std::vector<int>& kept = {})
      : problem_(problem),
        options_(options),
        monitor_(monitor),
        cell_(make_cell(problem)),
        without_roadmap_(without_roadmap(problem)),
        variant_(place_variant({without_roadmap_, find_variant(problem, "")}, cell_)),
        space_(problem, cell_) {
    route_.problem = origin_of(problem);
    route_.seed = options.seed;
    route_.closed = options.closed;
    route_.from_home = options.from_home;
    route_.settle = options.settle.value_or(problem.workspace.motion.settle);
    for (const Coordinate& c : space_.coordinates()) {
      route_.names.push_back(c.name);
      route_.units.push_back(c.unit);
    }
    route_.home = space_.home();
    take_stops(poses, kept);
  }

  Route make() {
    keep_free();
    std::vector<int> order = find_order();
    if (is_broken(order)) {
      keep_reachable();
      order = find_order();
      if (is_broken(order))
        throw CannotDo("no motion was found between poses that can both be reached; try more --milestones");
    }
    write(order);
    return std::move(route_);
  }

  /// Ids of poses whose joints are on another turn than the plan's.
  const std::vector<int>& turned() const { return turned_; }

 private:
  void take_stops(const PoseList& list, const std::vector<int>& kept) {
    require_fits(list, variant_.workspace->coordinates());
    route_.plan_file = list.name;
    route_.problem_changed = !list.problem_sha256.empty() && list.problem_sha256 != problem_.sha256;
    route_.notes = list.notes;
    note_parameters(list, parameters_of(problem_), route_.notes);
    stops_.push_back({0, space_.whole(space_.home()), {}});
    for (std::size_t i = 0; i < list.configurations.size(); ++i) {
      if (!list.measured.empty() && list.measured[i]) continue;
      const int id = list.ids.empty() ? int(i) + 1 : list.ids[i];
      std::vector<double> q = list.configurations[i];
      if (std::find(kept.begin(), kept.end(), id) == kept.end())
        q = nearest_turn(variant_, stops_.front().configuration, std::move(q));
      if (q != list.configurations[i]) turned_.push_back(id);
      Stop stop{id, q, pose_of(*variant_.model, q)};
      stop.pose.id = stop.id;
      stop.pose.sights = sights_of(*cell_, stop.configuration);
      stops_.push_back(std::move(stop));
    }
    for_each("poses", stops_.size(), [&](std::size_t i) {
      if (stops_[i].id > 0) stops_[i].pose.nearest = nearest_at(*cell_, stops_[i].configuration);
    });
    if (monitor_.should_stop()) throw CannotDo("stopped before all motions were found");
    if (!turned_.empty())
      route_.notes.push_back(fmt::format("joints of pose{} {} stand on another turn than in the plan, nearer to home",
                                         turned_.size() == 1 ? "" : "s", fmt::join(turned_, ", ")));
    std::vector<int> near;
    for (const Stop& stop : stops_)
      if (stop.id > 0 && !variant_.workspace->within_margin(stop.configuration).empty()) near.push_back(stop.id);
    if (!near.empty()) route_.notes.push_back(margin_note(list.name, near));
    if (options_.start && find_stop(*options_.start) < 0)
      throw InputError({}, "--start " + std::to_string(*options_.start) + " is not a pose of " + list.name,
                       "an id of a pose that is still to be measured");
    require_beginning();
    std::vector<std::vector<double>> reduced, leads;
    for (const Stop& stop : stops_) {
      reduced.push_back(space_.reduced(stop.configuration));
      // Nobody measures at home.
      leads.push_back(stop.id == 0 ? reduced.back() : space_.lead(stop.configuration));
    }
    motions_ = std::make_unique<Motions>(space_, std::move(reduced), std::move(leads), options_.milestones,
                                         options_.seed, options_.threads, monitor_);
  }

  /// Refuses backlash without a known way to the first pose.
  void require_beginning() const {
    const auto arrives = [](const auto& choice) { return is_approach(choice.first); };
    if (!options_.from_home && std::ranges::any_of(stops_.back().pose.choices, arrives))
      throw CannotDo("joints with backlash arrive from a stated side, even at the first pose: begin --from-home");
  }

  /// On all threads, until a stop.
  void for_each(const char* stage, std::size_t count, const std::function<void(std::size_t)>& body) const {
    std::atomic<int> done = 0;
    monitor_.report({stage, 0.0, double(count), {}, {}, {}});
    parallel_for(count, thread_count(options_.threads), [&](std::size_t i, int) {
      if (monitor_.should_stop()) return;
      body(i);
      monitor_.report({stage, double(++done), double(count), {}, {}, {}});
    });
  }

  int find_stop(int id) const {
    for (std::size_t i = 0; i < stops_.size(); ++i)
      if (stops_[i].id == id && id > 0) return int(i);
    return -1;
  }

  std::string collision(std::size_t stop) const {
    if (cell_->collision != nullptr)
      if (const auto pair = cell_->collision->colliding(stops_[stop].configuration))
        return pair->first + " and " + pair->second + " are too near";
    return space_.violation(space_.reduced(stops_[stop].configuration));
  }

  /// Why no motion can end at a stop, whatever the way; empty if one may.
  std::string obstacle(std::size_t stop) const {
    const std::vector<double> q = space_.reduced(stops_[stop].configuration);
    if (!space_.is_free(q)) return "not free: " + collision(stop);
    const std::vector<double> lead = space_.lead(stops_[stop].configuration);
    if (space_.is_free(lead, q)) return {};
    std::string sides;
    for (const auto& [name, side] : stops_[stop].pose.choices)
      if (is_approach(name)) sides += (sides.empty() ? "" : ", ") + name + " " + side;
    const std::string why = space_.violation(lead);
    return "no room to arrive from the stated side (" + sides + "): " + (why.empty() ? "collision on the way" : why);
  }

  /// Leaves out poses that collide where they are, or where they are arrived from.
  void keep_free() {
    if (options_.from_home && !space_.is_free(space_.home()))
      throw CannotDo("home is not free: " + collision(0) + "; set workspace: motion: home to a configuration that is");
    for (std::size_t i = 1; i < stops_.size(); ++i)
      if (const std::string why = obstacle(i); why.empty()) open_.push_back(int(i));
      else route_.unreachable.push_back({stops_[i].id, why});
    if (open_.empty()) throw CannotDo("no pose of the plan can be reached: " + route_.unreachable.front().reason);
    require_start();
    motions_->set_hub(space_.is_free(space_.home()) ? 0 : open_.front());
    if (options_.from_home) open_.insert(open_.begin(), 0);
  }

  void require_start() const {
    if (options_.start && std::find(open_.begin(), open_.end(), find_stop(*options_.start)) == open_.end())
      throw CannotDo("pose " + std::to_string(*options_.start) + " cannot be reached");
  }

  bool is_broken(const std::vector<int>& order) {
    const auto pairs = legs(order);
    return std::any_of(pairs.begin(), pairs.end(),
                       [&](const auto& p) { return motions_->between(p.first, p.second).points.empty(); });
  }

  /// Leaves out poses that no motion connects with the hub: home if that is free, else the pose that most others are
  /// connected with.
  void keep_reachable() {
    std::vector<int> hubs, best, seen, poses = open_;
    int best_hub = 0;
    std::erase(poses, 0);
    if (space_.is_free(space_.home())) hubs.push_back(0);
    if (!options_.from_home) hubs.insert(hubs.end(), poses.begin(), poses.end());
    for (const int hub : hubs) {
      // Who is connected with an earlier hub reaches what that one does.
      if (std::find(seen.begin(), seen.end(), hub) != seen.end()) continue;
      motions_->set_hub(hub);
      std::vector<int> reached;
      for (const int& i : poses) {
        if (motions_->reachable(i)) reached.push_back(i);
        monitor_.report({"reachable poses", double(&i - poses.data()) + 1, double(poses.size()), {}, {}, {}});
      }
      seen.insert(seen.end(), reached.begin(), reached.end());
      if (reached.size() > best.size()) {
        best = reached;
        best_hub = hub;
      }
      if (2 * best.size() > poses.size()) break;
    }
    motions_->set_hub(best_hub);
    if (best.empty()) throw CannotDo("no pose can be reached from home without a collision");
    for (const int i : poses)
      if (std::find(best.begin(), best.end(), i) == best.end())
        route_.unreachable.push_back({stops_[std::size_t(i)].id, options_.from_home
                                                                     ? "no motion from home was found"
                                                                     : "no motion from most other poses was found"});
    open_ = best;
    require_start();
    if (options_.from_home) open_.insert(open_.begin(), 0);
  }

  /// Instrument that reads a stop.
  const MeasurementSpec& instrument_of(const std::vector<double>& configuration) const {
    return instrument_at(problem_.measurement, variant_.workspace->coordinates(), configuration);
  }

  /// Time of moving or setting up the instrument, or of changing the load, from one stop to the other, s.
  double change(int i, int j) const {
    if (i == 0 || j == 0) return 0.0;
    const PlannedPose &a = stops_[std::size_t(i)].pose, &b = stops_[std::size_t(j)].pose;
    double seconds = 0.0;
    for (const auto& [name, time] : change_times)
      if (label_of(a.choices, name) != label_of(b.choices, name)) seconds += problem_.workspace.motion.*time;
    const MeasurementSpec& next = instrument_of(stops_[std::size_t(j)].configuration);
    if (&next != &instrument_of(stops_[std::size_t(i)].configuration))
      seconds += times_of(next, problem_.workspace.motion).setup;
    return seconds;
  }

  double cost(int i, int j) {
    if (!motions_->known(i, j)) return change(i, j) + motions_->at_least(i, j);
    const Motion& motion = motions_->between(i, j);
    return motion.points.empty() ? no_way : change(i, j) + motion.seconds;
  }

  /// The same whichever of two stops comes first, as a tour's search needs it.
  double cost_either_way(int i, int j) {
    const auto [a, b] = std::minmax(i, j);
    const double there = cost(a, b);
    return there >= no_way ? no_way : there + (change(b, a) - change(a, b)) / 2;
  }

  std::vector<std::pair<int, int>> legs(const std::vector<int>& order) const {
    std::vector<std::pair<int, int>> pairs;
    for (std::size_t k = 1; k < order.size(); ++k) pairs.emplace_back(order[k - 1], order[k]);
    if (options_.closed && order.size() > 1) pairs.emplace_back(order.back(), order.front());
    return pairs;
  }

  /// Makes the motions of an order; their seconds and those of changes.
  double make_motions(const std::vector<int>& order) {
    motions_->look_ahead(legs(order));
    double seconds = 0;
    for (const auto& [i, j] : legs(order)) {
      motions_->between(i, j);
      seconds += cost(i, j);
    }
    return seconds;
  }

  std::vector<int> find_order() {
    const auto n = Eigen::Index(open_.size());
    TourOptions tour;
    tour.closed = options_.closed;
    tour.seed = options_.seed;
    if (options_.from_home) tour.start = 0;
    else if (options_.start)
      tour.start = int(std::find(open_.begin(), open_.end(), find_stop(*options_.start)) - open_.begin());
    route_.planned_seconds = 0;
    for (const auto& [i, j] : legs(planned_order(tour.start)))
      route_.planned_seconds += change(i, j) + motions_->at_least(i, j);
    std::vector<int> order, best;
    double shortest = 0;
    for (long unknown = 1; unknown > 0;) {
      Eigen::MatrixXd costs = Eigen::MatrixXd::Zero(n, n);
      for (Eigen::Index a = 0; a < n; ++a)
        for (Eigen::Index b = 0; b < n; ++b)
          if (a != b) costs(a, b) = cost_either_way(open_[std::size_t(a)], open_[std::size_t(b)]);
      order.clear();
      for (const int k : cheapest_tour(costs, tour)) order.push_back(open_[std::size_t(k)]);
      const auto pairs = legs(order);
      unknown =
          std::count_if(pairs.begin(), pairs.end(), [&](const auto& p) { return !motions_->known(p.first, p.second); });
      double seconds = no_way;
      try {
        seconds = make_motions(order);
      } catch (const CannotDo&) {
        if (best.empty() || !monitor_.should_stop()) throw;
        route_.interrupted = true;
        break;
      }
      if (best.empty() || seconds < shortest) {
        best = order;
        shortest = seconds;
      }
      monitor_.report({"order", double(pairs.size()) - double(unknown), double(pairs.size()), {}, {}, {}});
    }
    route_.optimal = n <= exact_nodes && !route_.interrupted;
    return best;
  }

  /// The plan's own order, with the first stop that is asked for in front.
  std::vector<int> planned_order(const std::optional<int>& start) const {
    std::vector<int> order = open_;
    if (start) std::rotate(order.begin(), order.begin() + *start, order.begin() + *start + 1);
    return order;
  }

  void write(const std::vector<int>& order) {
    std::vector<const Motion*> made;
    for (const auto& [i, j] : legs(order)) {
      const Motion& motion = *made.emplace_back(&motions_->between(i, j));
      route_.motions.push_back({stops_[std::size_t(i)].id, stops_[std::size_t(j)].id, motion.points, motion.seconds,
                                change(i, j), motion.found_by});
    }
    for_each("clearance", made.size(), [&](std::size_t k) { route_.motions[k].nearest = nearest_on(*made[k]); });
    if (monitor_.should_stop())
      route_.notes.emplace_back("ended early: the clearance of some or all motions is left out");
    const int every = problem_.workspace.line_of_sight ? problem_.workspace.line_of_sight->every : 0;
    for (const int i : order) {
      if (stops_[std::size_t(i)].id == 0) continue;
      route_.poses.push_back(stops_[std::size_t(i)].pose);
      const std::size_t done = route_.poses.size();
      // Before anything else, after every so many poses, and at the end, so that drift is bracketed.
      const bool with_references = every > 0 && (done == 1 || done % std::size_t(every) == 0 || i == order.back());
      if (with_references) add_references(i);
      const MeasurementSpec& instrument = instrument_of(stops_[std::size_t(i)].configuration);
      route_.reading.push_back(readings_of(instrument, route_.poses.back().sights) +
                               (with_references ? readings_of(instrument, route_.references.back().sights) : 0.0));
    }
    if (route_.reading_seconds() == 0) route_.reading.clear();
  }

  /// Seconds of reading these targets, those that are seen: of a pose or of references.
  double readings_of(const MeasurementSpec& instrument, const std::vector<TargetSight>& sights) const {
    const InstrumentTimes times = times_of(instrument, problem_.workspace.motion);
    const double one = options_.reading ? *options_.reading * instrument.repeats : times.reading;
    const auto* points = std::get_if<PointsMeasurement>(&instrument.instrument);
    if (points == nullptr || !std::holds_alternative<TrackerNoise>(points->noise)) return one;
    // Without lines of sight it sees all of them.
    if (sights.empty()) return one * times.in_turn;
    return one * double(std::ranges::count_if(sights, [](const auto& s) { return s.hidden_by.empty(); }));
  }

  /// Nearest pair of bodies on the way.
  std::optional<BodyDistance> nearest_on(const Motion& motion) const {
    std::optional<Separation> nearest;
    for (std::size_t k = 1; cell_->collision != nullptr && k < motion.points.size(); ++k) {
      if (monitor_.should_stop()) return std::nullopt;
      const auto found = cell_->collision->nearest(space_.whole(motion.points[k - 1]), space_.whole(motion.points[k]));
      if (found && (!nearest || found->distance < nearest->distance)) nearest = found;
    }
    return body_distance(nearest);
  }

  void add_references(int stop) {
    ReferenceCheck check{stops_[std::size_t(stop)].id, {}};
    const std::vector<double>& q = stops_[std::size_t(stop)].configuration;
    const LineOfSight& sight = *cell_->sight();
    const int station = sight.station_of(q);
    for (const Sight& s : sight.reference_sights(q, station)) check.sights.push_back(target_sight(sight, s, station));
    route_.references.push_back(std::move(check));
  }

  const Problem& problem_;
  const RouteOptions& options_;
  const Monitor& monitor_;
  std::shared_ptr<const Cell> cell_;
  Problem without_roadmap_;
  Variant variant_;
  MotionSpace space_;
  Route route_;
  std::vector<Stop> stops_;  // the first is home
  std::vector<int> turned_;  // ids
  std::vector<int> open_;    // stops that can be reached, home too where the route begins there
  std::unique_ptr<Motions> motions_;
};

/// A pose that no motion reaches on the turn nearest to home keeps the plan's.
Route routed(const Problem& problem, const PoseList& poses, const RouteOptions& options, const Monitor& monitor) {
  Router router(problem, poses, options, monitor);
  Route route = router.make();
  std::vector<int> lost;
  for (const SkippedPose& pose : route.unreachable)
    if (std::find(router.turned().begin(), router.turned().end(), pose.pose) != router.turned().end())
      lost.push_back(pose.pose);
  if (lost.empty() || route.interrupted) return route;
  return Router(problem, poses, options, monitor, lost).make();
}

nlohmann::json read_plan(const std::filesystem::path& plan) {
  const std::string text = read_text(plan, plan_size_limit);
  try {
    return parse_json(text);
  } catch (const nlohmann::json::exception&) {
    throw InputError({plan.string(), 0}, "names no problem file", "a plan.json of a problem, or --problem FILE");
  }
}

}  // namespace

std::filesystem::path problem_of_plan(const std::filesystem::path& plan) {
  const nlohmann::json json = read_plan(plan);
  std::string name;
  if (json.is_object() && json.contains("problem") && json["problem"].is_object())
    name = json["problem"].value("file", std::string());
  if (name.empty())
    throw InputError({plan.string(), 0}, "names no problem file", "a plan of a problem, or --problem FILE");
  std::error_code code;
  for (const std::filesystem::path& file : {std::filesystem::path(name), plan.parent_path() / name,
                                            plan.parent_path() / std::filesystem::path(name).filename()})
    if (std::filesystem::is_regular_file(file, code)) return file;
  throw InputError({plan.string(), 0}, "its problem file '" + name + "' is not there", "name it with --problem FILE");
}

Route route_problem(const Problem& problem, const PoseList& poses, const RouteOptions& options,
                    const Monitor& monitor) {
  const auto begin = std::chrono::steady_clock::now();
  require_at_most(poses, most_routed, "route orders");
  Route route = routed(problem, poses, options, monitor);
  PoseList list = poses;
  for (int round = 0; options.replace && round < most_rounds && !route.unreachable.empty() && !route.interrupted;
       ++round) {
    std::vector<SkippedPose> replaced = route.replaced;
    list = with_replacements(problem, list, route, options.seed, monitor, replaced);
    route = routed(problem, list, options, monitor);
    route.replaced = std::move(replaced);
  }
  settle_replaced(route);
  if (!route.unreachable.empty() || !route.replaced.empty())
    route.worth = worth_of_route(problem, poses, list, route, monitor);
  route.computing_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return route;
}

}  // namespace posewright
