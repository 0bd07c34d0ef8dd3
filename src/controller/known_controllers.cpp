#include "posewright/controller/known_controllers.hpp"

#include <fmt/format.h>

#include "known_settings.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/text.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

constexpr std::uintmax_t size_limit = 1'000'000;

}  // namespace

std::vector<std::string> known_controllers() {
  std::vector<std::string> names;
  for (const KnownSettings& known : known_settings) names.emplace_back(known.name);
  return names;
}

bool is_controller_file(const std::string& name_or_file, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / name_or_file;
  std::error_code ignored;
  return std::filesystem::exists(file, ignored) && !std::filesystem::is_directory(file, ignored);
}

ControllerSettings controller_settings(const std::string& name_or_file, const std::filesystem::path& folder) {
  if (is_controller_file(name_or_file, folder)) {
    const std::filesystem::path file = folder / name_or_file;
    ControllerSettings settings = parse_controller_settings(read_text(file, size_limit), file.string());
    settings.path = file;
    return settings;
  }
  for (const KnownSettings& known : known_settings)
    if (name_or_file == known.name) return parse_controller_settings(known.text, name_or_file);
  throw InputError({},
                   "controller " + in_quotes(name_or_file) + " is neither a file nor a known one" +
                       meant_instead(name_or_file, known_controllers()),
                   fmt::format("known: {}", fmt::join(known_controllers(), ", ")));
}

}  // namespace posewright
