#include "signals.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <ctime>

#include "command.hpp"

namespace posewright::cli {
namespace {

std::atomic<bool> asked_to_stop{false};
std::atomic<int> signals_so_far{0};
std::atomic<SignalStage> current_stage{SignalStage::nothing_to_lose};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<double>::is_always_lock_free &&
                  std::atomic<int>::is_always_lock_free && std::atomic<SignalStage>::is_always_lock_free,
              "they are used in a signal handler");

// Some send one to the process and one to its group: so soon, s, the second is not a second wish.
constexpr double same_wish = 0.3;
std::atomic<double> first_signal{0.0};

double seconds_now() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

extern "C" void on_signal(int) {
  const double now = seconds_now();
  const int before = signals_so_far.fetch_add(1);
  if (before == 0) first_signal = now;
  else if (first_signal == 0 || now - first_signal < same_wish) return;
  if (before > 0 || current_stage == SignalStage::nothing_to_lose) ::_exit(interrupted);
  if (current_stage == SignalStage::searching) asked_to_stop = true;
}

void handle(int signal) {
  struct sigaction action {};
  if (signal == SIGHUP && ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN) return;
  action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  ::sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

void prepare_process() {
  // Wrong way round on purpose: reading from what should be written to fails, as it would if it were closed.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(descriptor, F_GETFD) < 0 && ::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0)
      ::_exit(cannot_do);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) handle(signal);
}

void begin_stage(SignalStage stage) {
  current_stage = stage;
  // One that came while the last result was written is for what follows.
  if (stage == SignalStage::searching && signals_so_far > 0) asked_to_stop = true;
  // What was passed over for a moment is heard now.
  if (stage == SignalStage::nothing_to_lose && signals_so_far > 0) ::_exit(interrupted);
}

const std::atomic<bool>& interrupted_flag() { return asked_to_stop; }

}  // namespace posewright::cli
