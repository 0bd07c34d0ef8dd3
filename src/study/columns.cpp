#include "posewright/study/columns.hpp"

#include <algorithm>
#include <numeric>

#include "posewright/study/study.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Enough configurations for any structural dependency to show; more only cost time.
constexpr std::size_t structural_sample = 400;

IdentifiabilityOptions exact_options() {
  IdentifiabilityOptions options;
  options.threshold = exact_dependency;
  return options;
}

std::string dropped_names(const Identifiability& found, const std::vector<Parameter>& parameters) {
  std::string names;
  for (const Dependency& d : found.dependencies)
    names += (names.empty() ? "" : ", ") + parameters[std::size_t(d.dropped)].name;
  return names;
}

[[noreturn]] void report_dependent(const Identifiability& found, const VariantColumns& columns) {
  std::string text = "variant '" + columns.name + "': ";
  bool first = true;
  for (const Dependency& d : found.dependencies) {
    text += (first ? "" : ", ") + describe(d, columns.parameters);
    first = false;
  }
  throw CannotDo(
      text +
      ": these cannot be identified separately from any number of poses; list one of each group under fixed, use "
      "parameters: auto, or count tolerances as prior knowledge (prior: tolerance)");
}

}  // namespace

Configurations thinned(const Configurations& configurations, const std::vector<Coordinate>& coordinates,
                       std::size_t count) {
  const std::size_t n = configurations.count(), take = std::min(n, count);
  std::vector<std::size_t> choices, order(n), taken;
  for (std::size_t k = 0; k < coordinates.size(); ++k)
    if (coordinates[k].discrete()) choices.push_back(k);
  std::iota(order.begin(), order.end(), std::size_t{0});
  // A list that has them in turn would be met at every second place, of one choice alone.
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    const auto differs = [&](std::size_t k) { return configurations[a][k] != configurations[b][k]; };
    const auto first = std::ranges::find_if(choices, differs);
    return first != choices.end() && configurations[a][*first] < configurations[b][*first];
  });
  for (std::size_t i = 0; i < take; ++i) taken.push_back(order[i * n / take]);
  std::ranges::sort(taken);
  Configurations result;
  result.dimension = configurations.dimension;
  for (const std::size_t i : taken) append(result, configurations[i]);
  return result;
}

ResolvedColumns resolve_columns(const IdentificationModel& model, const Configurations& configurations,
                                VariantColumns all, bool prior, int threads) {
  ResolvedColumns resolved;
  const BlockArray sample =
      build_blocks(model, all.selected, thinned(configurations, model.coordinates(), structural_sample), threads);
  if (!all.automatic) {
    const Identifiability found = identifiability(sample, all.parameters, exact_options());
    // With fewer rows than columns nothing can be said yet; require_enough_poses() says it.
    if (!prior && !found.dependencies.empty() && sample.all().rows() >= sample.columns()) report_dependent(found, all);
    resolved.columns = std::move(all);
    return resolved;
  }
  IdentifiabilityOptions options;
  options.tiers = all.tiers;
  const Identifiability found = identifiability(sample, all.parameters, options);
  if (found.rank == 0)
    throw CannotDo("variant '" + all.name + "': no parameter changes a reading of the instrument at any of " +
                   std::to_string(sample.count()) +
                   " configurations; check position and line of sight of the instrument");
  for (const Dependency& d : found.dependencies) {
    resolved.dropped.push_back(all.parameters[std::size_t(d.dropped)]);
    resolved.reasons.push_back(describe(d, all.parameters));
  }
  resolved.columns = subset(all, found.kept);
  if (int(resolved.columns.selected.size()) == resolved.columns.nuisance) {
    std::string text;
    for (const std::string& reason : resolved.reasons) text += (text.empty() ? "" : ", ") + reason;
    throw CannotDo("variant '" + all.name +
                   "': no parameter of interest can be identified separately from the nuisance ones: " + text);
  }
  return resolved;
}

namespace {

/// Configurations that tell as much as so few can, and their blocks.
class SmallestSet {
 public:
  SmallestSet(const IdentificationModel& model, const Configurations& candidates, const VariantColumns& columns,
              int threads)
      : parameters_(columns.parameters),
        sample_(build_blocks(model, columns.selected, thinned(candidates, model.coordinates(), structural_sample),
                             threads)),
        order_(most_independent(sample_, columns.parameters)) {}

  /// Structure of the best `poses` of them; a few more than bring new rows cost nothing.
  Identifiability of(int poses) const {
    std::vector<int> chosen = order_;
    for (int i = 0; int(chosen.size()) < std::min(poses, int(sample_.count())); ++i)
      if (std::find(order_.begin(), order_.end(), i) == order_.end()) chosen.push_back(i);
    chosen.resize(std::size_t(std::min(poses, int(chosen.size()))));
    return identifiability(sample_.subset(chosen), parameters_, exact_options());
  }

  std::optional<int> number() const {
    for (int n = 1; n <= int(order_.size()) + 1; ++n)
      if (of(n).dependencies.empty()) return n;
    return std::nullopt;
  }

 private:
  std::vector<Parameter> parameters_;
  BlockArray sample_;
  std::vector<int> order_;
};

}  // namespace

std::optional<int> smallest_number_of_poses(const IdentificationModel& model, const Configurations& candidates,
                                            const VariantColumns& columns, int threads) {
  return SmallestSet(model, candidates, columns, threads).number();
}

void require_enough_poses(const IdentificationModel& model, const Configurations& candidates,
                          const VariantColumns& columns, int poses, int threads) {
  const SmallestSet fewest(model, candidates, columns, threads);
  const Identifiability found = fewest.of(poses);
  if (found.dependencies.empty()) return;
  const std::optional<int> enough = fewest.number();
  throw CannotDo(std::to_string(poses) + " poses determine " + std::to_string(found.rank) + " of " +
                 std::to_string(columns.selected.size()) + " parameters (not " +
                 dropped_names(found, columns.parameters) + "); " +
                 (enough ? "at least " + std::to_string(*enough) + " poses are needed" : "more candidates are needed"));
}

}  // namespace posewright
