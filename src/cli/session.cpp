#include "session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "posewright/support/file.hpp"
#include "posewright/support/sha256.hpp"
#include "processes.hpp"
#include "signals.hpp"
#include "terminal.hpp"

namespace posewright::cli {
namespace {

// They change how a result is made, shown or kept, and not the result.
constexpr auto of_no_account = std::to_array<std::string_view>(
    {"threads", "json", "markdown", "quiet", "verbose", "no-cache", "output", "output-dir", "poses-csv", "force",
     "resume", "shard", "time-limit", "data", "positional"});

/// Identity of the computation: command, options and all files read.
std::string computation(const po::variables_map& values, const std::string& command, const std::filesystem::path& log) {
  std::string text = command + "\n";
  for (const auto& [name, value] : values) {
    if (std::find(of_no_account.begin(), of_no_account.end(), name) != of_no_account.end()) continue;
    text += name;
    if (const auto* one = boost::any_cast<std::string>(&value.value())) text += " " + *one;
    if (const auto* several = boost::any_cast<Words>(&value.value()))
      for (const std::string& word : *several) text += " " + word;
    text += "\n";
  }
  std::vector<std::string> inputs;
  std::error_code code;
  for (const std::filesystem::path& file : files_read())
    if (!std::filesystem::equivalent(file, log, code)) inputs.push_back(sha256_hex(read_file(file)));
  std::sort(inputs.begin(), inputs.end());
  for (const std::string& input : inputs) text += input + "\n";
  return sha256_hex(text);
}

std::optional<TaskEngine::Shard> shard_of(const po::variables_map& values) {
  if (values.count("shard") == 0) return std::nullopt;
  const std::string text = text_of(values, "shard");
  TaskEngine::Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, first] = std::from_chars(text.data(), end, shard.part);
  const bool whole = first == std::errc() && slash != end && *slash == '/' &&
                     std::from_chars(slash + 1, end, shard.parts).ptr == end && slash + 1 != end;
  if (!whole || shard.part < 1 || shard.parts < shard.part || shard.parts > 1000000)
    throw InputError({}, "--shard " + text, "i/n with 1 <= i <= n <= 1000000: 3/40");
  if (values.count("resume") == 0) throw InputError({}, "--shard needs a log", "give --resume LOG");
  return shard;
}

}  // namespace

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
  if (!engine.writes()) throw AnotherWrites{};
  if (!common.verbose) return;
  const Workers::Traffic traffic = engine.workers().traffic();
  print_aside(fmt::format("posewright: {} tasks done, {} known before; {} processes, {} messages, {} bytes\n",
                          engine.computed(), engine.known(), engine.workers().processes(), traffic.messages,
                          traffic.bytes));
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

po::options_description resume_option() {
  po::options_description options("Large computations");
  options.add_options()("resume", text("LOG"), "record finished tasks in LOG, and skip those already recorded there");
  return options;
}

po::options_description task_options() {
  po::options_description options = resume_option();
  options.add_options()("shard", text("i/n"),
                        "compute only the i-th of n shares of the tasks; posewright merge joins the logs");
  return options;
}

std::unique_ptr<TaskEngine> engine_of(const po::variables_map& values, const std::string& command) {
  const std::shared_ptr<Workers> workers = started_workers();
  const std::optional<TaskEngine::Shard> shard = shard_of(values);
  if (workers->processes() > 1 && values.count("time-limit") > 0)
    throw InputError({}, "--time-limit with several processes",
                     "processes would stop at different tasks; start one process");
  std::unique_ptr<TaskLog> log;
  if (const std::string file = text_of(values, "resume"); !file.empty() && workers->rank() == 0)
    log = std::make_unique<TaskLog>(file, [=] { return computation(values, command, file); });
  return std::make_unique<TaskEngine>(workers, std::move(log), shard);
}

}  // namespace posewright::cli
