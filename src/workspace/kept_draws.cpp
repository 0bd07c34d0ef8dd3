#include "kept_draws.hpp"

#include "posewright/support/bytes.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/result_store.hpp"
#include "posewright/support/sha256.hpp"

namespace posewright {

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

std::string bytes_of(const Configurations& drawn) {
  ByteWriter bytes;
  bytes.put(drawn.dimension);
  bytes.put(drawn.values);
  bytes.put(drawn.drawn);
  bytes.put(std::uint64_t(drawn.rejected.size()));
  for (const auto& [reason, count] : drawn.rejected) {
    bytes.put(reason);
    bytes.put(count);
  }
  return bytes.take();
}

std::optional<Configurations> kept_configurations(std::string_view bytes, const Workspace& workspace) {
  try {
    ByteReader reader(bytes);
    Configurations kept;
    reader.get(kept.dimension);
    reader.get(kept.values);
    reader.get(kept.drawn);
    for (auto left = reader.get<std::uint64_t>(); left > 0; --left) {
      auto& [reason, count] = kept.rejected.emplace_back();
      reader.get(reason);
      reader.get(count);
    }
    const bool fits = kept.dimension == int(workspace.coordinates().size()) &&
                      kept.values.size() == kept.count() * std::size_t(kept.dimension) && reader.at_end();
    return fits ? std::optional(std::move(kept)) : std::nullopt;
  } catch (const CannotDo&) {
    return std::nullopt;
  }
}

}  // namespace posewright
