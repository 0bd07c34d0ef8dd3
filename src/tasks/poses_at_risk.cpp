#include "poses_at_risk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "posewright/model/readable.hpp"

namespace posewright {
namespace {

constexpr int robots = 200;
// A pose that fewer lose is no worse than readings that are missed by accident.
constexpr double worth_saying = 0.05;
constexpr std::size_t most_named = 4;
constexpr std::uint64_t risk_stream = 0x715c;

struct Risk {
  int id = 0;
  double share = 0.0;
};

std::vector<Risk> risks(const Variant& variant, const Configurations& poses, int first, std::uint64_t seed) {
  std::vector<Risk> found;
  for (std::size_t i = 0; i < poses.count(); ++i) found.push_back({first + int(i), 0.0});
  std::vector<double> stands(variant.model->coordinates().size());
  for (int k = 0; k < robots; ++k) {
    Random random(seed ^ risk_stream, std::uint64_t(k));
    const std::vector<double> robot = drawn_correction(variant.columns, variant.model->parameters().size(), random);
    for (std::size_t i = 0; i < poses.count(); ++i)
      if (!readable(*variant.model, poses[i], robot, stands)) found[i].share += 1.0 / robots;
  }
  std::erase_if(found, [](const Risk& risk) { return risk.share < worth_saying; });
  std::ranges::stable_sort(found, [](const Risk& a, const Risk& b) { return a.share > b.share; });
  return found;
}

}  // namespace

std::string poses_at_risk(const Variant& variant, const Configurations& poses, int first, std::uint64_t seed) {
  if (variant.model->unmeasurable_reason().empty()) return "";
  const std::vector<Risk> found = risks(variant, poses, first, seed);
  if (found.empty()) return "";
  std::string which;
  for (std::size_t i = 0; i < std::min(found.size(), most_named); ++i)
    which += fmt::format("{}pose {} by {:.0f} %", i == 0 ? "" : ", ", found[i].id, 100 * found[i].share);
  if (found.size() > most_named) which += fmt::format(", {} more by fewer", found.size() - most_named);
  return fmt::format(
      "Some of {} robots drawn from the tolerances cannot be read at these poses ({}): {}. `workspace: readable_for: "
      "20` avoids such poses; smaller tolerances of base and tool help, too.",
      robots, variant.model->unmeasurable_reason(), which);
}

}  // namespace posewright
