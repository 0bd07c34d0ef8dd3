#include "session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>

#include "signals.hpp"
#include "task_options.hpp"
#include "terminal.hpp"

namespace posewright::cli {
Watch::Watch(const CommonOptions& common, double seconds, TaskEngine* engine)
    : begin_(Monitor::Clock::now()), last_(begin_), stage_begin_(begin_) {
  begin_stage(SignalStage::searching);
  monitor_.interrupted = &interrupted_flag();
  monitor_.engine = engine;
  if (const std::filesystem::path folder = cache_folder(); common.cache && !folder.empty())
    monitor_.store = &store_.emplace(folder);
  if (seconds > 0) monitor_.end_within(seconds);
  if (!common.quiet && (common.verbose || ::isatty(STDERR_FILENO) != 0))
    monitor_.on_progress = [this](const Progress& progress) { show(progress); };
}

Watch::~Watch() {
  if (shown_) print_aside("\r\x1b[K");
  begin_stage(SignalStage::finishing);
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
  print_aside(fmt::format("{}{}{}", terminal ? "\r\x1b[K" : "", line, terminal ? "" : "\n"));
  shown_ = terminal;
}

void after_tasks(TaskEngine& engine, const CommonOptions& common) {
  tell_of_tasks(engine, common);
  if (!engine.writes()) throw AnotherWrites{};
}

void print_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) print_aside("posewright: note: " + note + "\n");
}

double time_limit(const po::variables_map& values) {
  if (values.count("time-limit") == 0) return 0.0;
  const double seconds = number_of({"--time-limit", {text_of(values, "time-limit")}}, 0, 1e9);
  if (seconds > 0) return seconds;
  throw InputError({}, "--time-limit 0", "a number of seconds above 0 is allowed");
}

}  // namespace posewright::cli
