#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "command.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/results/next.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/text_file.hpp"
#include "posewright/tasks/next_state.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "signals.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

/// A file of readings that somebody appends to.
class GrowingFile {
 public:
  explicit GrowingFile(std::filesystem::path file) : file_(std::move(file)) {}
  /// Its whole lines now; empty if it is not there yet.
  WholeLines read() const;
  /// Waits until there are other whole lines than `seen`, or the file is shorter for longer than one who writes it anew
  /// takes. A signal ends the program here: everything is written.
  WholeLines wait_for_more(const std::string& seen) const;
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
};

/// Files for results of `next`; empty: not requested.
struct NextFiles {
  std::filesystem::path state, poses, result;

  /// Each file by itself, so that a state is there at any moment; it knows the pose list, so that a later call may
  /// replace it.
  void write(NextState& state_now, const std::string& csv, const std::string& json) const;
};

constexpr std::uintmax_t largest_data = 1'000'000'000;
constexpr auto pause = std::chrono::milliseconds(200);
// A program that writes its file anew leaves it short for a moment.
constexpr int patience = 10;

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

/// measured.csv: measured.next-state.json, beside it.
std::filesystem::path usual_state_file(const std::filesystem::path& data) {
  if (data.empty()) return {};
  std::filesystem::path file = data;
  return file.replace_filename(data.stem().string() + ".next-state.json");
}

po::options_description next_command_options() { return described(next_options()).add(problem_options()); }

NextOptions options_of(const po::variables_map& values) {
  NextOptions next;
  read_options(next_options(), values, next);
  if (values.count("watch") > 0 && next.data.empty()) throw InputError({}, "--watch follows a file", "--data FILE");
  return next;
}

/// Call after call, one state.
class NextSession {
 public:
  NextSession(const po::variables_map& values, const CommonOptions& common, const Problem& problem, NextOptions options)
      : common_(common), problem_(problem), options_(std::move(options)), data_(options_.data) {
    files_.state = values.count("state") > 0 ? output_file(values, "state", "") : usual_state_file(options_.data);
    if (values.count("output") > 0) files_.poses = output_file(values, "output", "");
    if (values.count("result") > 0) files_.result = output_file(values, "result", "");
    std::vector<std::filesystem::path> inputs = files_of(problem);
    for (const std::filesystem::path& file : {options_.data, std::filesystem::path(text_of(values, "candidates-from"))})
      if (!file.empty()) inputs.push_back(file);
    check_output_files(values, {files_.poses, files_.result, files_.state}, inputs);
    if (!files_.state.empty() && values.count("restart") == 0) state_ = read_next_state(files_.state);
    watch_ = values.count("watch") > 0;
  }

  int run() {
    for (WholeLines lines = data_.read();; lines = data_.wait_for_more(lines.text)) {
      const NextPoses result = step(lines);
      if (result.interrupted) return interrupted;
      const bool stop = result.verdict == NextVerdict::reached || result.verdict == NextVerdict::flat;
      if (!watch_ || stop) return done;
    }
  }

 private:
  NextPoses step(const WholeLines& lines) {
    if (state_) require_continues(*state_, files_.state, problem_, options_.data, lines.text);
    options_.text.reset();
    if (lines.has_rows) options_.text = lines.text;
    if (state_) reuse(*state_, problem_, options_);
    NextPoses result =
        watched(common_, 0, [&](const Monitor& monitor) { return next_poses(problem_, options_, monitor); }).result;
    if (!lines.rest.empty() && !watch_)
      result.notes.push_back(fmt::format("{}:{}: has no line end yet and is left out: it may be half a line",
                                         options_.data.string(), lines.next_line));
    NextState now = state_after(problem_, options_, result, state_);
    const auto json = next_json(problem_, options_.seed, options_.measured_file(), result, now.history);
    files_.write(now, next_csv(result), json_text(json));
    state_ = std::move(now);
    print_notes(result.notes);
    if (common_.json) {
      fmt::print("{}", watch_ ? json_text(json, JsonLayout::one_line) + "\n" : json_text(json));
    } else {
      print_report(next_text(result) + written_text({files_.poses, files_.result}) + (watch_ ? "\n" : ""));
    }
    std::fflush(stdout);
    return result;
  }

  const CommonOptions& common_;
  const Problem& problem_;
  NextOptions options_;
  GrowingFile data_;
  NextFiles files_;
  std::optional<NextState> state_;
  bool watch_ = false;
};

int run_next(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  NextOptions next = options_of(values);
  const Problem problem = given_problem(single(positional, "PROBLEM"), values);
  if (const std::string list = text_of(values, "candidates-from"); !list.empty()) {
    if (next.candidates)
      throw InputError({}, "--candidates and --candidates-from cannot be combined", "leave one of them out");
    next.candidates_from = read_poses(list, without_limits(pose_coordinates(problem, next.variant)));
  }
  return NextSession(values, common, problem, std::move(next)).run();
}

}  // namespace

Command next_command() {
  return {"next",
          "PROBLEM",
          "Fits the readings so far, chooses the next poses, reports when to stop.",
          next_command_options,
          "posewright next problem.yaml --data measured.csv --required 0.1mm --watch",
          run_next};
}

}  // namespace posewright::cli
