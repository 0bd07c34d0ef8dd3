#include "next_files.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "posewright/support/file.hpp"
#include "posewright/support/text_file.hpp"
#include "result_files.hpp"
#include "signals.hpp"

namespace posewright::cli {
namespace {

constexpr std::uintmax_t largest_data = 1'000'000'000;
constexpr auto pause = std::chrono::milliseconds(200);
// A program that writes its file anew leaves it short for a moment.
constexpr int patience = 10;

}  // namespace

WholeLines GrowingFile::read() const {
  std::error_code code;
  if (file_.empty() || !std::filesystem::exists(file_, code)) return {};
  return whole_lines(read_text(file_, largest_data));
}

WholeLines GrowingFile::wait_for_more(const std::string& seen) const {
  begin_stage(SignalStage::nothing_to_lose);
  std::uintmax_t size = 0;
  std::filesystem::file_time_type time;
  for (int shorter = 0;;) {
    std::this_thread::sleep_for(pause);
    std::error_code code;
    const auto size_now = std::filesystem::file_size(file_, code);
    const auto time_now = code ? time : std::filesystem::last_write_time(file_, code);
    if (!code && size_now == size && time_now == time && shorter == 0) continue;
    WholeLines now = read();
    shorter = now.text.size() < seen.size() ? shorter + 1 : 0;
    if (shorter >= patience || (shorter == 0 && now.text != seen)) return now;
    size = code ? 0 : size_now;
    time = time_now;
  }
}

void NextFiles::write(NextState& state_now, const std::string& csv, const std::string& json) const {
  begin_stage(SignalStage::finishing);
  if (!state.empty()) {
    if (!poses.empty()) {
      const WrittenWith list = written_with(state, {{poses, csv}}).front();
      // As it is and as it will be: whenever this is ended, one of both is there. What was before is no more.
      const auto other = std::remove_if(state_now.files.begin(), state_now.files.end(),
                                        [&](const WrittenWith& file) { return file.path != list.path; });
      state_now.files.erase(other, state_now.files.end());
      if (state_now.files.size() > 1) state_now.files.erase(state_now.files.begin(), state_now.files.end() - 1);
      if (state_now.files.empty() || state_now.files.back().sha256 != list.sha256) state_now.files.push_back(list);
    }
    write_results({{state, next_state_text(state_now)}});
  }
  if (!poses.empty()) write_results({{poses, csv}});
  if (!result.empty()) write_results({{result, json}});
}

std::filesystem::path usual_state_file(const std::filesystem::path& data) {
  if (data.empty()) return {};
  std::filesystem::path file = data;
  return file.replace_filename(data.stem().string() + ".next-state.json");
}

}  // namespace posewright::cli
