#include "posewright/study/setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "criterion_choice.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr std::string_view marked[] = {"yes", "true", "1"}, unmarked[] = {"no", "false", "0", ""};

SourcePlace place_of(const PoseList& list, std::size_t i) {
  return {list.name, i < list.lines.size() ? list.lines[i] : 0};
}

int id_of(const PoseList& list, std::size_t i) {
  return i < list.own_ids.size() && list.own_ids[i] > 0 ? list.own_ids[i] : int(i) + 1;
}

/// True if the list fixes its i-th pose: measured poses of a plan are not, and marks decide.
bool is_fixed(const PoseList& list, std::size_t i) {
  if (i < list.measured.size() && list.measured[i]) return false;
  if (list.marks.empty()) return true;
  const std::string& mark = list.marks[i];
  if (std::find(std::begin(marked), std::end(marked), mark) != std::end(marked)) return true;
  if (std::find(std::begin(unmarked), std::end(unmarked), mark) != std::end(unmarked)) return false;
  throw InputError(place_of(list, i), fmt::format("'{}' in column 'fixed'", mark.substr(0, 40)), "yes or no");
}

PoseList fixed_of(const PoseList& list) {
  PoseList fixed;
  fixed.name = list.name;
  for (std::size_t i = 0; i < list.configurations.size(); ++i) {
    if (!is_fixed(list, i)) continue;
    fixed.configurations.push_back(list.configurations[i]);
    fixed.lines.push_back(place_of(list, i).line);
    fixed.own_ids.push_back(id_of(list, i));
  }
  return fixed;
}

/// Why a variant's workspace forbids q; empty: none does.
std::string violation(const Setup& setup, const std::vector<double>& q) {
  for (const Variant& v : setup.variants)
    if (const int reason = v.workspace->violation(q); reason >= 0) return v.workspace->reasons()[std::size_t(reason)];
  return {};
}

bool contains(const Configurations& list, const std::vector<double>& q) {
  for (std::size_t i = 0; i < list.count(); ++i)
    if (std::equal(q.begin(), q.end(), list[i].begin())) return true;
  return false;
}

/// Puts a list into setup.fixed, of a list that marks poses as fixed those alone; does nothing for an empty list. They
/// are still to be measured, so every variant's workspace must allow them; the minimum distance is not asked of them.
/// @param setup  with its variants and measured poses
/// Throws InputError with file and line if none is left to be chosen beside them, for `reserve` (a fixed pose may be
/// lost, too), for a pose that is forbidden, and for one that is fixed or measured twice if repeats are forbidden.
void fix_poses(Setup& setup, const PoseList& list) {
  if (list.configurations.empty()) return;
  const PoseList fixed = fixed_of(list);
  const std::size_t count = fixed.configurations.size();
  if (count == 0) throw InputError({list.name, 0}, "fixes no pose", "'yes' in column 'fixed' of at least one");
  if (setup.poses && int(count) >= *setup.poses)
    throw InputError(place_of(fixed, std::size_t(*setup.poses) - 1),
                     fmt::format("{} poses are fixed of a plan of {}", count, *setup.poses),
                     "fix fewer poses (evaluate scores a complete list)");
  if (setup.reserve)
    throw InputError({list.name, 0}, "reserve and fixed poses cannot be combined",
                     "leave one of them out: a fixed pose may be lost, too");
  require_fits(fixed, setup.first().workspace->coordinates());
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<double>& q = fixed.configurations[i];
    if (const std::string reason = violation(setup, q); !reason.empty())
      throw InputError(place_of(fixed, i), fmt::format("pose {} cannot be fixed: {}", id_of(fixed, i), reason),
                       "poses that the robot can take as the problem describes it");
    const bool measured = contains(setup.measured, q);
    if (setup.repeats.most == 1 && (measured || contains(setup.fixed, q)))
      throw InputError(place_of(fixed, i),
                       fmt::format("pose {} is {}", id_of(fixed, i), measured ? "measured already" : "fixed twice"),
                       "each pose once, or repeats: allow");
    append(setup.fixed, q);
  }
  setup.fixed_notes = list.notes;
}

// Columns of an assumed effect make each candidate several times as costly, and more of them gain little.
constexpr int candidates_with_effect = 3000, restarts_with_effect = 2;

std::vector<DesignSpec::Weighted> variants_of(const Setup& setup, const RunOptions& run) {
  const Problem& problem = *setup.problem;
  const DesignSpec& design = problem.design;
  std::vector<DesignSpec::Weighted> all;
  for (const std::string& name : run.variants) all.push_back({{name, 0}, 1.0});
  if (!all.empty()) return all;
  if (!find_criterion(setup.criterion)->several_variants) return {{{find_variant(problem, "").name, 0}, 1.0}};
  if (design.variant && design.variant->line < 0)
    throw InputError(problem.at(design.variant->line), "names one variant",
                     "the criterion is over several: design: variants");
  if (!design.variants.empty()) return design.variants;
  for (const VariantSpec& variant : problem.variants) all.push_back({{variant.name, variant.line}, 1.0});
  return all;
}

void name_truth(Setup& setup) {
  const Problem& problem = *setup.problem;
  const DesignSpec& design = problem.design;
  const Located<std::string> truth = design.truth.value_or(Located<std::string>{});
  const CriterionEntry& entry = *find_criterion(setup.criterion);
  // Without a truth, bias counts an effect that is assumed.
  if (entry.needs_residual && truth.value.empty())
    throw InputError(problem.at(design.criterion.line),
                     "criterion '" + design.criterion.value + "' needs an alternative model to test",
                     "set design: truth or --truth");
  if (truth.value.empty()) return;
  setup.truth = &find_variant(problem, truth.value);
  setup.truth_line = truth.line;
  if (entry.several_variants)
    throw InputError(
        problem.at(truth.line),
        "--truth needs a single fitted variant; criterion '" + design.criterion.value + "' is over several",
        "leave out the truth, or another criterion");
}

/// Throws InputError for what robots that are drawn do not go together with.
void draw_robots(Setup& setup, const VariantSpec& first) {
  const Problem& problem = *setup.problem;
  const std::optional<RobustSpec>& robust = problem.design.robust;
  if (!robust) return;
  const auto refuse = [&](const std::string& why, const std::string& allowed) {
    throw InputError(problem.at(robust->line), "a plan over drawn robots (robust) " + why, allowed);
  };
  if (find_criterion(setup.criterion)->several_variants)
    refuse("is for one variant, not for the several of criterion '" + setup.criterion + "'",
           "criterion: " + determinant_names() + ", and variant: one of them");
  if (!find_criterion(setup.criterion)->determinant)
    refuse("is for the determinant, not for criterion '" + setup.criterion + "'", "criterion: " + determinant_names());
  if (setup.reserve) refuse("cannot be combined with reserve", "leave one of them out");
  if (first.unmodelled) refuse("does not support a variant with an unmodelled effect", "a variant without unmodelled");
  setup.robust = robust;
}

void require_same_coordinates(const Variant& a, const Variant& b) {
  const auto& x = a.workspace->coordinates();
  const auto& y = b.workspace->coordinates();
  const auto same = [](const Coordinate& c, const Coordinate& d) { return c.name == d.name && c.labels == d.labels; };
  if (x.size() != y.size() || !std::equal(x.begin(), x.end(), y.begin(), y.end(), same))
    throw CannotDo("variants '" + a.spec->name + "' and '" + b.spec->name +
                   "' have different coordinates: no pose can serve both");
}

std::optional<PoseList> given_or_read(const std::optional<PoseList>& given, const std::filesystem::path& file,
                                      const std::vector<Coordinate>& coordinates) {
  if (given) require_fits(*given, coordinates);
  if (given || file.empty()) return given;
  return read_poses(file, coordinates);
}

}  // namespace

void require_number_of_poses(const Problem& problem) {
  const DesignSpec& design = problem.design;
  if (!design.poses && !design.smallest)
    throw InputError(problem.at(design.line), "has no number of poses", "set design: poses or --poses");
  if (!design.smallest) return;
  const bool of_poses = design.require.accuracy || design.require.of_axes();
  if (!of_poses && design.require.sigma.empty())
    throw InputError(problem.at(design.line), "poses: auto needs a requirement",
                     "set design: require: accuracy, position, rotation or sigma");
  if (of_poses && !design.test_poses)
    throw InputError(problem.at(design.require.line), "an accuracy is required but there are no test poses",
                     "set design: test_poses");
  if (design.robust)
    throw InputError(problem.at(design.robust->line), "a plan over drawn robots (robust) needs a number of poses",
                     "set poses to a number, not auto");
}

Setup resolve(const Problem& problem, const RunOptions& run, const Monitor& monitor, Purpose purpose) {
  if (purpose == Purpose::plan) require_number_of_poses(problem);
  const DesignSpec& design = problem.design;
  Setup s;
  s.problem = &problem;
  s.criterion_automatic = design.criterion.value == automatic_criterion;
  s.criterion = s.criterion_automatic ? "o1" : design.criterion.value;
  s.method = design.method.value;
  require_known(s.criterion, s.method, problem.at(design.criterion.line), problem.at(design.method.line),
                automatic_criterion);
  const std::optional<int> stated = design.poses ? std::optional(design.poses->value) : std::nullopt;
  if (purpose != Purpose::list) s.poses = stated;
  s.candidates = design.candidates.value;
  s.prior = design.prior;
  s.reserve = design.reserve;
  s.repeats = design.repeats;
  s.scaling = design.scaling;
  const std::vector<DesignSpec::Weighted> names = variants_of(s, run);
  const VariantSpec& first = find_variant(problem, names.front().name.value);
  name_truth(s);
  const std::filesystem::path listed =
      !run.candidates_from && design.candidates_from ? design.candidates_from->value : "";
  // Candidates of a user's list are places that count, and so are those of a variant that lacks an effect.
  const bool places = design.test_poses || run.candidates_from || !listed.empty() || first.unmodelled;
  if (find_criterion(s.criterion)->needs_test_poses && !places)
    throw CannotDo("the criterion needs places where accuracy matters: set design: test_poses");
  s.planner.restarts = design.restarts.value;
  s.planner.restarts_stated = design.restarts.line != 0;
  s.planner.seed = run.seed;
  s.planner.threads = run.threads;
  // Of several numbers each search has its share of the time.
  s.planner.use_all_time = purpose != Purpose::plan || s.poses.has_value();
  s.candidates_alone = run.candidates_alone;
  s.other_numbers = run.other_numbers;
  s.proof = run.proof;
  const bool with_effect = assumes_effect(s);
  if (with_effect) limit_search_with_effect(s);
  const bool may_be = with_effect || (s.criterion_automatic && why_not_bias(s, first, stated).empty());
  if (may_be && design.candidates.line == 0) s.candidates = candidates_with_effect;
  if (purpose != Purpose::search) draw_robots(s, first);

  s.cell = make_cell(problem, run.same_robot.get());
  for (const DesignSpec::Weighted& wanted : names) {
    Variant variant = place_variant({problem, find_variant(problem, wanted.name.value)}, s.cell, monitor);
    variant.weight = wanted.weight;
    variant.nuisance_counts = run.nuisance_counts;
    if (const auto kept = run.kept_parameters.find(variant.spec->name); kept != run.kept_parameters.end())
      variant.kept_parameters = kept->second;
    s.variants.push_back(std::move(variant));
    require_same_coordinates(s.first(), s.variants.back());
  }
  const std::vector<Coordinate>& coordinates = s.first().workspace->coordinates();
  s.measured.dimension = s.fixed.dimension = int(coordinates.size());
  if (const auto list = given_or_read(run.measured, design.measured.value_or(""), without_limits(coordinates)))
    for (const auto& q : list->configurations) append(s.measured, q);
  if (purpose == Purpose::plan)
    if (const auto list = given_or_read(run.fixed, design.fixed.value_or(""), coordinates)) fix_poses(s, *list);
  s.candidates_from = given_or_read(run.candidates_from, listed, without_limits(coordinates));
  return s;
}

void limit_search_with_effect(Setup& setup) {
  if (!setup.planner.restarts_stated) setup.planner.restarts = restarts_with_effect;
  if (setup.problem->design.method.line == 0) setup.method = "exchange";
  setup.planner.kicks = 0;
}

}  // namespace posewright
