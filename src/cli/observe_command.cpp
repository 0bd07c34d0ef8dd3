#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "command.hpp"
#include "posewright/outputs/table.hpp"
#include "posewright/pipeline/observe_problem.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/version.hpp"
#include "session.hpp"

namespace posewright::cli {
namespace {

using Json = nlohmann::ordered_json;

// Shares of a column's effect below this are rounding: the dependency holds exactly.
constexpr double exact = 1e-9;

po::options_description options() {
  po::options_description options("Options");
  const auto text = [](const char* name) { return po::value<std::string>()->value_name(name); };
  options.add_options()                                  //
      ("variant", text("V"), "only this variant (all)")  //
      ("candidates", text("n"), "feasible configurations in the pool (2000)");
  return options;
}

std::string spectrum_text(const Eigen::VectorXd& sigma) {
  std::string text;
  for (Eigen::Index i = 0; i < sigma.size(); ++i)
    text += fmt::format("{}{:.3g}", i == 0 ? "  " : i % 10 == 0 ? "\n  " : "  ", sigma[i]);
  return text + "\n";
}

std::string observation_text(const Observation& o) {
  const Identifiability& found = o.identifiability;
  std::string text = fmt::format("Variant {}: rank {} of {} parameters, {} configurations × {} rows\n", o.variant,
                                 found.rank, o.parameters.size(), o.configurations, o.rows);
  if (o.exact_rank != found.rank)
    text += fmt::format("  ({} by exact arithmetic; {} more are told apart only by less than 1e-4 of their effect)\n",
                        o.exact_rank, o.exact_rank - found.rank);
  text += "Singular values of G, columns in units of tolerance:\n" + spectrum_text(found.singular_values);
  text += fmt::format("Pool: O1 {:.4g}  O2 {:.4g}  O3 {:.4g}  O4 {:.4g}  O5 {:.4g}\n", o.indices.o1, o.indices.o2,
                      o.indices.o3, o.indices.o4, o.indices.o5);
  if (found.dependencies.empty()) return text + "No dependencies.\n";
  text += "Dependencies (the parameter on the left cannot be told from those on the right):\n";
  Table table({"", "", "not explained"}, {Table::Align::left, Table::Align::left, Table::Align::left});
  for (const Dependency& d : found.dependencies)
    table.row({describe(d, o.parameters), "", d.remainder < exact ? "exact" : fmt::format("{:.1e}", d.remainder)});
  return text + table.text();
}

Json dependency_json(const Dependency& d, const std::vector<Parameter>& parameters) {
  Json terms = Json::array();
  for (const Dependency::Term& t : d.terms)
    terms.push_back({{"parameter", parameters[std::size_t(t.parameter)].name}, {"coefficient", t.coefficient}});
  return {{"dropped", parameters[std::size_t(d.dropped)].name},
          {"terms", terms},
          {"remainder", d.remainder},
          {"equation", describe(d, parameters)}};
}

Json observation_json(const Observation& o) {
  const Identifiability& found = o.identifiability;
  Json parameters = Json::array(), dependencies = Json::array();
  for (std::size_t j = 0; j < o.parameters.size(); ++j) {
    const Parameter& p = o.parameters[j];
    const bool kept = std::find(found.kept.begin(), found.kept.end(), int(j)) != found.kept.end();
    parameters.push_back({{"name", p.name},
                          {"unit", p.unit},
                          {"role", p.role == Role::interest ? "interest" : "nuisance"},
                          {"tolerance", p.tolerance},
                          {"identifiable", kept}});
  }
  for (const Dependency& d : found.dependencies) dependencies.push_back(dependency_json(d, o.parameters));
  return {
      {"variant", o.variant},
      {"configurations", o.configurations},
      {"rows", o.rows},
      {"rank", found.rank},
      {"exact_rank", o.exact_rank},
      {"parameters", parameters},
      {"singular_values", std::vector<double>(found.singular_values.begin(), found.singular_values.end())},
      {"indices",
       {{"o1", o.indices.o1}, {"o2", o.indices.o2}, {"o3", o.indices.o3}, {"o4", o.indices.o4}, {"o5", o.indices.o5}}},
      {"dependencies", dependencies}};
}

int run(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  const Problem problem = read_problem(single(positional, "PROBLEM"));
  ObserveOptions observe;
  observe.variant = text_of(values, "variant");
  observe.candidates = whole_number(values, "candidates", 1, 1000000).value_or(observe.candidates);
  observe.seed = common.seed;
  observe.threads = common.threads;
  std::vector<Observation> observations;
  {
    const Watch watch(common, 0);
    observations = observe_problem(problem, observe, watch.monitor());
    // A shortened pool would be shown as if it were whole.
    if (watch.was_interrupted()) return interrupted;
  }
  if (common.json) {
    Json json = {{"schema", "posewright/observation/1"},
                 {"version", version},
                 {"seed", common.seed},
                 {"problem", {{"file", problem.file.string()}, {"sha256", problem.sha256}}},
                 {"variants", Json::array()}};
    for (const Observation& o : observations) json["variants"].push_back(observation_json(o));
    fmt::print("{}\n", json.dump(1));
    return done;
  }
  for (std::size_t i = 0; i < observations.size(); ++i)
    fmt::print("{}{}", i == 0 ? "" : "\n", observation_text(observations[i]));
  return done;
}

}  // namespace

Command observe_command() {
  return {"observe",
          "PROBLEM",
          "What can be identified: rank, singular values, dependencies of each variant.",
          options,
          "posewright observe examples/telescope/problem.yaml",
          run};
}

}  // namespace posewright::cli
