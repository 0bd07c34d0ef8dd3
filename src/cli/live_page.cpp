#include "live_page.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <system_error>

#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/run_program.hpp"

namespace posewright::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view problem_slot = "@GIVEN_PROJECT@";

fs::path live_page() { return installed_file({"share/posewright/posewright.html", "wasm-package/posewright.html"}); }

/// RFC 4648.
std::string base64(std::string_view bytes) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? std::uint8_t(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? letters[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

void replace_all(std::string& text, const std::string& old, const std::string& with) {
  for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + with.size()))
    text.replace(at, old.size(), with);
}

fs::path plain(const fs::path& file) { return fs::absolute(file).lexically_normal(); }

}  // namespace

fs::path installed_file(const std::vector<std::string>& places) {
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  for (fs::path folder = program.parent_path(); folder.has_relative_path(); folder = folder.parent_path())
    for (const std::string& place : places)
      if (fs::path file = folder / place; fs::is_regular_file(file, code)) return file;
  return {};
}

void require_live_page() {
  if (live_page().empty())
    throw CannotDo("the page that plans (posewright.html) is not in this installation; see docs/live.md");
}

std::string page_with_problem(const FileToWrite& problem, const std::vector<FileToWrite>& files) {
  require_live_page();
  const fs::path folder = plain(problem.file).parent_path();
  std::string text = problem.bytes;
  nlohmann::ordered_json contents = nlohmann::ordered_json::object();
  for (const FileToWrite& file : files) {
    const fs::path absolute = plain(file.file), relative = absolute.lexically_relative(folder);
    const bool inside = !relative.empty() && *relative.begin() != "..";
    const std::string name = (inside ? relative : absolute.relative_path()).generic_string();
    contents[name] = base64(file.bytes);
    replace_all(text, absolute.generic_string(), name);
    if (!inside) replace_all(text, relative.generic_string(), name);
  }
  const std::string name = problem.file.filename().generic_string();
  contents[name] = base64(text);
  std::string data = json_text(nlohmann::ordered_json{{"problem", name}, {"files", contents}}, JsonLayout::one_line);
  replace_all(data, "<", "\\u003c");  // no byte of the data may end the element that holds them
  std::string page = read_file(live_page());
  const std::size_t slot = page.find(problem_slot);
  if (slot == std::string::npos) throw CannotDo(live_page().string() + " has no place for a problem: another version");
  return page.replace(slot, problem_slot.size(), data);
}

bool open_in_browser(const fs::path& page) {
  // The shell lets the browser run on. Without a screen xdg-open would start one of the terminal.
  const auto started = run_program(
      {"sh", "-c",
       "[ -n \"$DISPLAY$WAYLAND_DISPLAY$BROWSER\" ] || [ \"$(uname)\" = Darwin ] || exit 1\n"
       "for opener in xdg-open open; do command -v $opener >/dev/null && { $opener \"$1\" >/dev/null 2>&1 & exit 0; }; "
       "done\nexit 1",
       "sh", fs::absolute(page).string()});
  return started && started->status == 0;
}

}  // namespace posewright::cli
