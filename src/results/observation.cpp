#include "posewright/results/observation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "document.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

// Shares of a column's effect below this are rounding: the dependency holds exactly.
constexpr double exact = 1e-9;
// Of near dependencies people see the strongest, and of each its strongest terms.
constexpr double shown_near_share = 0.02;
constexpr std::size_t most_shown = 10, most_terms = 4;

std::string spectrum_text(const Eigen::VectorXd& sigma) {
  std::string text;
  for (Eigen::Index i = 0; i < sigma.size(); ++i)
    text += fmt::format("{}{:.3g}", i == 0 ? "  " : i % 10 == 0 ? "\n  " : "  ", sigma[i]);
  return text + "\n";
}

std::string share_text(double share) {
  return share >= 0.0995 ? fmt::format("{:.0f} %", 100 * share) : fmt::format("{:.2g} %", 100 * share);
}

std::string equations(const std::vector<Dependency>& dependencies, const std::vector<Parameter>& parameters) {
  Table table({"not explained", ""}, "rl");
  for (const Dependency& d : dependencies)
    table.row({d.remainder < exact ? "exact" : share_text(d.remainder), describe(d, parameters)});
  return table.text();
}

/// Names of what parameter j mostly looks like, largest effect first; empty if a tenth or more of its effect is its
/// own.
std::string most_like(const Observation& o, int j) {
  std::string text;
  for (const Dependency& d : o.practical->near)
    if (d.dropped == j)
      for (std::size_t i = 0; i < std::min<std::size_t>(3, d.terms.size()); ++i)
        text += (text.empty() ? "" : ", ") + o.kept[std::size_t(d.terms[i].parameter)].name;
  return text;
}

/// The nearest ones, each with its largest terms: enough to see what hides behind what.
std::string near_text(const Observation& o) {
  std::vector<Dependency> shown;
  std::size_t more = 0;
  for (const Dependency& d : o.practical->near) {
    if (d.remainder > shown_near_share || shown.size() == most_shown) {
      ++more;
      continue;
    }
    shown.push_back(d);
    if (d.terms.size() > most_terms) shown.back().terms.resize(most_terms);
  }
  if (shown.empty()) return {};
  return "Nearly inseparable parameters:\n" + equations(shown, o.kept) +
         (more > 0 ? fmt::format("  and {} more, weaker ones (--json has all)\n", more) : "") +
         "  (the effect of the parameter on the left is nearly this combination of others; largest terms only)\n";
}

/// Parameters on which a kept parameter's value would depend.
const std::vector<std::string>& given_of(const Observation& o, std::size_t kept) {
  return o.given[std::size_t(o.identifiability.kept[kept])];
}

std::string names(const Observation& o, bool recommended) {
  const std::vector<int>& kept = o.practical->recommended;
  std::string text;
  for (std::size_t j = 0; j < o.kept.size(); ++j) {
    if (o.kept[j].role == Role::nuisance) continue;
    const bool worth = std::find(kept.begin(), kept.end(), int(j)) != kept.end() && given_of(o, j).empty();
    if (worth == recommended) text += (text.empty() ? "" : ", ") + o.kept[j].name;
  }
  return text;
}

std::string recommendation_text(const Observation& o) {
  const std::string identify = names(o, true), fix = names(o, false);
  if (fix.empty()) return "Recommended: identify all of them.\n";
  if (identify.empty()) return "Recommended: identify none of them; this measurement adds less than the tolerances.\n";
  return fmt::format("Recommended: identify {}\n  and fix {}.\n", identify, fix);
}

/// σ after N poses against tolerance, near dependencies, the recommended set.
std::string practical_text(const Observation& o) {
  const PracticalIdentifiability& p = *o.practical;
  std::string text = near_text(o);
  text += fmt::format("Worth identifying, with {} poses chosen well:\n", p.poses);
  Table table({"parameter", "tolerance", "σ", "σ/tolerance", "its own", "", "most like"}, "lrrrrl");
  for (std::size_t j = 0; j < o.kept.size(); ++j) {
    const Parameter& label = o.kept[j];
    const auto k = Eigen::Index(j);
    const bool worth = p.sigma[k] < label.tolerance;
    table.row({label.name, shown_value(label.tolerance, label.unit), shown_value(p.sigma[k], label.unit),
               fmt::format("{:.3g}", p.sigma[k] / label.tolerance), share_text(p.unexplained[k]),
               !given_of(o, j).empty()        ? fmt::format("given {}", fmt::join(given_of(o, j), ", "))
               : label.role == Role::nuisance ? "nuisance"
               : worth                        ? "yes"
                                              : "no: tolerance is smaller",
               most_like(o, int(j))});
  }
  text += table.text();
  return text + recommendation_text(o);
}

/// Headline: number of identifiable parameters, and smallest number of poses.
std::string verdict_text(const Observation& o) {
  const auto all = [&](Role role) {
    return std::count_if(o.parameters.begin(), o.parameters.end(), [&](const Parameter& p) { return p.role == role; });
  };
  const auto kept = [&](Role role) {
    const std::vector<int>& found = o.identifiability.kept;
    return std::count_if(found.begin(), found.end(), [&](int j) {
      return o.parameters[std::size_t(j)].role == role && o.given[std::size_t(j)].empty();
    });
  };
  std::string text = fmt::format("Variant {}: {} of {} parameters can be identified", o.variant, kept(Role::interest),
                                 all(Role::interest));
  if (all(Role::nuisance) > 0)
    text += fmt::format(", and {} of {} nuisance parameters", kept(Role::nuisance), all(Role::nuisance));
  return text + (o.smallest_poses ? fmt::format("; {} poses at least.\n", *o.smallest_poses)
                                  : "; too few candidates to determine the smallest number of poses: draw more.\n");
}

}  // namespace

std::string observation_text(const Observation& o, bool with_singular_values) {
  const Identifiability& found = o.identifiability;
  std::string text = verdict_text(o) + fmt::format("Rank {} of {} in all, from {} configurations × {} rows.\n",
                                                   found.rank, o.parameters.size(), o.configurations, o.rows);
  if (o.exact_rank != found.rank)
    text += fmt::format("  ({} exact; {} more differ by less than 1e-4 of their effect)\n", o.exact_rank,
                        o.exact_rank - found.rank);
  if (with_singular_values)
    text += "Singular values of G, columns in units of tolerance:\n" + spectrum_text(found.singular_values);
  text += fmt::format("Pool: O1 {:.4g}  O2 {:.4g}  O3 {:.4g}  O4 {:.4g}  O5 {:.4g}\n", o.indices.o1, o.indices.o2,
                      o.indices.o3, o.indices.o4, o.indices.o5);
  if (found.dependencies.empty()) {
    text += "No dependencies.\n";
  } else {
    text += "Dependencies:\n" + equations(found.dependencies, o.parameters);
    text += "  (a parameter on the left cannot be identified separately from those on its right)\n";
  }
  return o.practical ? text + practical_text(o) : text;
}

namespace {

Json dependency_json(const Dependency& d, const std::vector<Parameter>& parameters) {
  Json terms = Json::array();
  for (const Dependency::Term& t : d.terms)
    terms.push_back({{"parameter", parameters[std::size_t(t.parameter)].name}, {"coefficient", t.coefficient}});
  return {{"dropped", parameters[std::size_t(d.dropped)].name},
          {"terms", terms},
          {"remainder", d.remainder},
          {"equation", describe(d, parameters)}};
}

Json practical_json(const Observation& o) {
  const PracticalIdentifiability& p = *o.practical;
  Json parameters = Json::array(), near = Json::array(), recommended = Json::array();
  for (std::size_t j = 0; j < o.kept.size(); ++j) {
    const auto k = Eigen::Index(j);
    parameters.push_back({{"name", o.kept[j].name},
                          {"sigma", p.sigma[k]},
                          {"worth_identifying", p.sigma[k] < o.kept[j].tolerance},
                          {"unexplained", p.unexplained[k]}});
  }
  for (const Dependency& d : p.near) near.push_back(dependency_json(d, o.kept));
  for (const int j : p.recommended) recommended.push_back(o.kept[std::size_t(j)].name);
  return {{"poses", p.poses}, {"parameters", parameters}, {"near_dependencies", near}, {"recommended", recommended}};
}

}  // namespace

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
                          {"identifiable", kept && o.given[j].empty()},
                          {"given", o.given[j]}});
  }
  for (const Dependency& d : found.dependencies) dependencies.push_back(dependency_json(d, o.parameters));
  Json json = {
      {"variant", o.variant},
      {"configurations", o.configurations},
      {"rows", o.rows},
      {"rank", found.rank},
      {"exact_rank", o.exact_rank},
      {"parameters", parameters},
      {"singular_values", std::vector<double>(found.singular_values.begin(), found.singular_values.end())},
      {"indices",
       {{"o1", o.indices.o1}, {"o2", o.indices.o2}, {"o3", o.indices.o3}, {"o4", o.indices.o4}, {"o5", o.indices.o5}}},
      {"dependencies", dependencies},
      {"smallest_poses", o.smallest_poses ? Json(*o.smallest_poses) : Json(nullptr)}};
  if (o.practical) json["practical"] = practical_json(o);
  return json;
}

Json observations_json(const Problem& problem, std::uint64_t seed, const std::vector<Observation>& observations) {
  Json json = begin_document("posewright/observation/1", problem, seed);
  json["variants"] = list_json(observations, observation_json);
  return json;
}

}  // namespace posewright
