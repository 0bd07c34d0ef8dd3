#include "posewright/workspace/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "posewright/model/whitening.hpp"
#include "posewright/support/bytes.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/result_store.hpp"
#include "posewright/support/sha256.hpp"
#include "sampler.hpp"

namespace posewright {
namespace {

/// Name of a draw in a ResultStore, by all that decides it; empty: it is not known, or a draw takes no time.
std::string name_of_draw(const Workspace& workspace, const SamplingOptions& options) {
  if (workspace.identity().empty()) return "";
  static const std::string build = build_identity();
  if (build.empty()) return "";
  ByteWriter all;
  all.put(std::string_view("candidates 1"));
  all.put(build);
  all.put(workspace.identity());
  all.put(std::uint64_t(options.count));
  all.put(options.seed);
  all.put(std::uint64_t(options.draws_per_candidate));
  return sha256_hex(all.take());
}

/// A draw of bytes_of() (support); none where it cannot be a draw from this workspace.
std::optional<Configurations> kept_configurations(std::string_view bytes, const Workspace& workspace) {
  try {
    ByteReader reader(bytes);
    Configurations kept;
    reader.get(kept);
    const bool fits = kept.dimension == int(workspace.coordinates().size()) &&
                      kept.values.size() == kept.count() * std::size_t(kept.dimension) && reader.at_end();
    return fits ? std::optional(std::move(kept)) : std::nullopt;
  } catch (const CannotDo&) {
    return std::nullopt;
  }
}

// What an instrument sees is proposed where less of what is drawn evenly is feasible.
constexpr double scarce = 0.05;

/// Default shares: views first if little is feasible and the instrument has a direction; the boundary is drawn from
/// what is found.
std::vector<std::pair<SamplerKind, double>> shares_of(const Workspace& workspace, const Sampler& sampler) {
  using Kind = SamplerKind;
  if (workspace.samplers_are_given() || workspace.views() == nullptr || sampler.feasible_share() >= scarce)
    return workspace.sampler_shares();
  return {{Kind::look_at, 3}, {Kind::boundary, 2}};
}

Configurations drawn_configurations(const Workspace& workspace, const SamplingOptions& options,
                                    const Monitor& monitor) {
  Sampler sampler(workspace, options);
  const auto shares = shares_of(workspace, sampler);
  double open_share = 0;
  for (const auto& [kind, share] : shares) open_share += share;
  std::size_t open = options.count;
  for (const auto& [kind, share] : shares) {
    const auto wanted = std::size_t(std::lround(double(open) * share / open_share));
    open -= wanted;
    open_share -= share;
    if (kind == SamplerKind::even) sampler.interior(wanted, monitor);
    else if (kind == SamplerKind::boundary) sampler.boundary(wanted, monitor);
    else if (kind == SamplerKind::look_at) {
      sampler.views(wanted, monitor);
      // Other samplers start from what is feasible, or draw what views have shown not to be.
      if (sampler.is_empty()) break;
    } else sampler.valid_states(kind, wanted, monitor);
  }
  sampler.fill_up(options.count, monitor);
  return sampler.take();
}

}  // namespace

Configurations sample_configurations(const Workspace& workspace, const SamplingOptions& options,
                                     const Monitor& monitor) {
  const std::string name = monitor.store == nullptr ? "" : name_of_draw(workspace, options);
  if (name.empty()) return drawn_configurations(workspace, options, monitor);
  if (const auto bytes = monitor.store->find(name))
    if (auto kept = kept_configurations(*bytes, workspace)) return std::move(*kept);
  Configurations drawn = drawn_configurations(workspace, options, monitor);
  // A draw that was stopped has less than its name says.
  if (!monitor.should_stop()) monitor.store->keep(name, bytes_of(drawn));
  return drawn;
}

namespace {

/// A block that is not finite would turn every figure into nothing.
[[noreturn]] void throw_not_finite(const IdentificationModel& model, std::span<const int> selected,
                                   std::span<const double> q, const BlockArray& blocks, std::size_t i) {
  std::size_t column = 0;
  while (blocks.block(i).col(Eigen::Index(column)).allFinite()) ++column;
  throw CannotDo(fmt::format("the effect of '{}' on {} … is not a finite number at the configuration {}",
                             model.parameters()[std::size_t(selected[column])].name, model.readings().front().name,
                             fmt::join(q, ", ")));
}

}  // namespace

BlockArray build_blocks(const IdentificationModel& model, std::span<const int> selected,
                        const Configurations& configurations, int threads) {
  const std::size_t n = configurations.count();
  BlockArray blocks(n, model.block_rows(selected), int(selected.size()));
  const int workers = thread_count(threads);
  std::vector<Linearisation> scratch(static_cast<std::size_t>(workers));
  constexpr std::size_t chunk = 256;
  parallel_for((n + chunk - 1) / chunk, workers, [&](std::size_t c, int worker) {
    for (std::size_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i)
      if (!whitened_block(model, configurations[i], {}, selected, scratch[std::size_t(worker)], blocks.row(i, 0),
                          blocks.stride()))
        throw CannotDo("configuration " + std::to_string(i) + " is out of reach");
      else if (!blocks.block(i).allFinite()) throw_not_finite(model, selected, configurations[i], blocks, i);
  });
  return blocks;
}

}  // namespace posewright
