#include "session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <charconv>
#include <cmath>
#include <csignal>
#include <fstream>

#include "posewright/outputs/pose_formats.hpp"
#include "posewright/support/file.hpp"

namespace posewright::cli {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> interrupted_flag{false};
static_assert(std::atomic<bool>::is_always_lock_free, "the flag is set in a signal handler");

extern "C" void on_signal(int signal) {
  // The second signal finds the default action and ends the program.
  interrupted_flag.store(true, std::memory_order_relaxed);
  std::signal(signal, SIG_DFL);
}

/// First bytes of what this program writes: plan.json, poses.csv, and the comment in exported files that may hold one.
bool is_earlier_result(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string head(2048, '\0');
  in.read(head.data(), std::streamsize(head.size()));
  head.resize(std::size_t(in.gcount()));
  return head.starts_with("pose,") || head.starts_with("posewright,") ||
         head.starts_with("posewright_parameters: 1\n") ||
         head.starts_with("<!doctype html><!-- posewright report -->") ||
         head.substr(0, 64).find("\"schema\": \"posewright/") != std::string::npos ||
         head.find(export_mark) != std::string::npos;
}

}  // namespace

Watch::Watch(const CommonOptions& common, double seconds)
    : begin_(Monitor::Clock::now()), last_(begin_), stage_begin_(begin_) {
  interrupted_flag = false;
  monitor_.interrupted = &interrupted_flag;
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (seconds > 0)
    monitor_.deadline =
        begin_ + std::chrono::duration_cast<Monitor::Clock::duration>(std::chrono::duration<double>(seconds));
  if (!common.quiet && (common.verbose || ::isatty(STDERR_FILENO) != 0))
    monitor_.on_progress = [this](const Progress& progress) { show(progress); };
}

Watch::~Watch() {
  if (shown_) fmt::print(stderr, "\r\x1b[K");
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

void Watch::show(const Progress& progress) {
  const auto now = Monitor::Clock::now();
  if (progress.stage != stage_) {
    stage_ = progress.stage;
    stage_begin_ = now;
  } else if (now - last_ < std::chrono::milliseconds(100)) {
    return;
  }
  last_ = now;
  std::string line = stage_;
  if (progress.total > 0) line += fmt::format(" {:.0f}/{:.0f}", progress.done, progress.total);
  if (progress.best) line += fmt::format("  best {:.4f}", *progress.best);
  if (progress.bound) line += fmt::format("  bound {:.4f}", *progress.bound);
  if (progress.efficiency)
    line += fmt::format("  at least {:.2f} % of the optimum", std::floor(1e4 * *progress.efficiency) / 100);
  const double elapsed = std::chrono::duration<double>(now - stage_begin_).count();
  // A stage that has only just begun, or begun again after another one, tells nothing of its speed yet.
  if (elapsed > 1 && progress.total > 0 && progress.done > 0 && progress.done < progress.total)
    line += fmt::format("  {:.0f} s left", std::ceil(elapsed * (progress.total - progress.done) / progress.done));
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  fmt::print(stderr, "{}{}{}", terminal ? "\r\x1b[K" : "", line, terminal ? "" : "\n");
  shown_ = terminal;
}

void check_outputs(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs, bool force) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    std::error_code code;
    for (const fs::path& input : inputs)
      if (fs::equivalent(outputs[i], input, code))
        throw InputError({}, outputs[i].string() + " is an input", "write the result to another file");
    for (std::size_t k = 0; k < i; ++k)
      if (fs::weakly_canonical(outputs[i]) == fs::weakly_canonical(outputs[k]))
        throw InputError({}, outputs[i].string() + " is named for two outputs", "give each a file of its own");
    if (fs::is_regular_file(outputs[i]) && fs::file_size(outputs[i]) > 0 && !force && !is_earlier_result(outputs[i]))
      throw CannotDo(outputs[i].string() + " exists and was not written by posewright; --force replaces it");
    require_writable(outputs[i]);
  }
}

void print_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) fmt::print(stderr, "posewright: note: {}\n", note);
}

double time_limit(const po::variables_map& values) {
  const std::string text = text_of(values, "time-limit");
  if (values.count("time-limit") == 0) return 0;
  double seconds = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (code != std::errc() || end != text.data() + text.size() || !(seconds > 0) || !(seconds < 1e9))
    throw InputError({}, "--time-limit " + text, "a number of seconds above 0 is allowed");
  return seconds;
}

}  // namespace posewright::cli
