#include <fmt/format.h>

#include "command.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/outputs/table.hpp"
#include "posewright/pipeline/place_stations.hpp"
#include "posewright/support/json.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"

namespace posewright::cli {
namespace {

using Json = nlohmann::ordered_json;

po::options_description stations_command_options() {
  po::options_description options("Options");
  options.add_options()                                                                     //
      ("choose", text("k"), "how many stations are used (workspace: stations: choose, 1)")  //
      ("full", text("n"), "how many of the best are planned in full (3)")                   //
      ("poses", text("N"), "number of poses (design: poses)")                               //
      ("variant", text("V"), "model variant (design: variant, else the first)")             //
      ("criterion", text("NAME"), ("what to maximise: " + criterion_names() + " (o1)").c_str())(
          "candidates", text("n"), "feasible configurations of the full plans (10000)")  //
      ("restarts", text("k"), "starts of the search of the full plans (10)")             //
      ("time-limit", text("S"), "give up after S seconds");
  options.add(problem_options());
  return options;
}

std::string names_of(const StationRank& rank) {
  std::string names;
  for (const StationSpec& station : rank.stations) names += (names.empty() ? "" : ", ") + station.name;
  return names;
}

std::string places_of(const StationRank& rank) {
  std::string places;
  for (const StationSpec& station : rank.stations) {
    const Eigen::Vector3d& p = station.placement.position;
    places += fmt::format("{}({:.3f}, {:.3f}, {:.3f})", places.empty() ? "" : "; ", p.x(), p.y(), p.z());
  }
  return places;
}

std::string ranking_text(const std::vector<StationRank>& ranks) {
  using A = Table::Align;
  Table table({"", "station", "place [m]", "planned", "parameters", "criterion", "σ", "feasible", "predicted error",
               "most rejected by"},
              {A::right, A::left, A::left, A::left, A::right, A::right, A::right, A::right, A::right, A::left});
  int place = 0;
  for (const StationRank& rank : ranks) {
    if (!rank.why_not.empty()) continue;
    table.row({std::to_string(++place), names_of(rank), places_of(rank), rank.in_full ? "in full" : "quickly",
               std::to_string(rank.parameters), fmt::format("{:.4f}", rank.phi),
               rank.sigma_ratio ? fmt::format("{:.2f} ×", *rank.sigma_ratio) : "",
               fmt::format("{:.1f} %", 100 * rank.feasible_share), rank.rho0 ? shown_value(*rank.rho0, "m") : "",
               rank.main_rejection});
  }
  std::string text = table.text();
  for (const StationRank& rank : ranks)
    if (!rank.why_not.empty()) text += fmt::format("{}: no plan: {}\n", names_of(rank), rank.why_not);
  text += "\nFor measurement: device:\n  stations:\n";
  for (const StationSpec& station : ranks.front().stations) {
    const Eigen::Vector3d &p = station.placement.position, &r = station.placement.rpy;
    text += fmt::format("    {}: {{position: [{}, {}, {}], rpy: [{}, {}, {}]}}\n", station.name, p.x(), p.y(), p.z(),
                        r.x(), r.y(), r.z());
  }
  return text;
}

Json ranking_json(const std::vector<StationRank>& ranks) {
  Json list = Json::array();
  for (const StationRank& rank : ranks) {
    Json stations = Json::object();
    for (const StationSpec& s : rank.stations)
      stations[s.name] = {{"position", {s.placement.position.x(), s.placement.position.y(), s.placement.position.z()}},
                          {"rpy", {s.placement.rpy.x(), s.placement.rpy.y(), s.placement.rpy.z()}}};
    Json json = {{"stations", stations}};
    if (!rank.why_not.empty()) {
      json["why_not"] = rank.why_not;
    } else {
      json["in_full"] = rank.in_full;
      json["parameters"] = rank.parameters;
      json["phi"] = rank.phi;
      json["criterion_value"] = rank.criterion_value;
      json["sigma_ratio"] = rank.sigma_ratio ? Json(*rank.sigma_ratio) : Json(nullptr);
      json["feasible_share"] = rank.feasible_share;
      json["main_rejection"] = rank.main_rejection;
      json["rho0"] = rank.rho0 ? Json(*rank.rho0) : Json(nullptr);
    }
    list.push_back(json);
  }
  return {{"schema", "posewright/stations/1"}, {"ranking", list}};
}

int run_stations(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  StationOptions stations;
  stations.choose = whole_number(values, "choose", 1, 100);
  stations.full = whole_number(values, "full", 0, 10000).value_or(3);
  stations.plan.poses = whole_number(values, "poses", 1, 1000000);
  stations.plan.variant = text_of(values, "variant");
  stations.plan.criterion = text_of(values, "criterion");
  stations.plan.candidates = whole_number(values, "candidates", 1, 10000000);
  stations.plan.restarts = whole_number(values, "restarts", 1, 1000000);
  stations.plan.seed = common.seed;
  stations.plan.threads = common.threads;
  const Problem problem = given_problem(single(positional, "PROBLEM"), values);
  const std::vector<StationRank> ranks = watched(common, time_limit(values), [&](const Monitor& monitor) {
                                           return place_stations(problem, stations, monitor);
                                         }).result;
  if (common.json) fmt::print("{}", json_text(ranking_json(ranks)));
  else print_report(ranking_text(ranks));
  return done;
}

}  // namespace

Command stations_command() {
  return {"stations",
          "PROBLEM",
          "Ranks places for the instrument by the plan that each of them allows.",
          stations_command_options,
          "posewright stations examples/cell/problem.yaml --choose 1",
          run_stations};
}

}  // namespace posewright::cli
