#include "own_process.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>

namespace posewright {
namespace {

constexpr rlim_t most_bytes = rlim_t(1) << 30;  // beyond what the process has when it begins
constexpr rlim_t most_seconds = 60;
constexpr std::size_t longest_message = 300;
constexpr char good = 'm', bad = 'e';

/// Address space of this process so far, bytes.
rlim_t present_size() {
  std::ifstream status("/proc/self/statm");
  unsigned long pages = 0;
  status >> pages;
  return rlim_t(pages) * rlim_t(::sysconf(_SC_PAGESIZE));
}

void send(int to, const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = ::write(to, bytes, size);
    if (n <= 0 && errno != EINTR) ::_exit(1);
    if (n > 0) bytes += n, size -= std::size_t(n);
  }
}

void send_text(int to, char kind, const std::string& text) {
  const std::size_t size = text.size();
  send(to, &kind, 1);
  send(to, &size, sizeof size);
  send(to, text.data(), size);
}

/// Work of the child: kind, length, bytes; those of a message where something is wrong.
[[noreturn]] void work_and_send(const std::function<std::string()>& work, int to) {
  const rlimit memory{present_size() + most_bytes, present_size() + most_bytes}, time{most_seconds, most_seconds},
      none{0, 0};
  ::setrlimit(RLIMIT_AS, &memory);
  ::setrlimit(RLIMIT_CPU, &time);
  ::setrlimit(RLIMIT_CORE, &none);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  std::string problem;
  try {
    send_text(to, good, work());
    ::_exit(0);
  } catch (const std::bad_alloc&) {
    problem = "takes more memory than a file of this kind may";
  } catch (const std::exception& error) {
    problem = std::string(error.what()).substr(0, longest_message);
  }
  send_text(to, bad, problem);
  ::_exit(0);
}

bool receive(int from, void* data, std::size_t size) {
  char* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t n = ::read(from, bytes, size);
    if (n == 0 || (n < 0 && errno != EINTR)) return false;
    if (n > 0) bytes += n, size -= std::size_t(n);
  }
  return true;
}

std::string received(int from) {
  char kind = 0;
  std::size_t size = 0;
  if (!receive(from, &kind, 1) || !receive(from, &size, sizeof size))
    throw OwnProcessFailed("cannot be read: it is damaged, or takes too much memory or time");
  std::string text(size, '\0');
  if (!receive(from, text.data(), size)) throw OwnProcessFailed("cannot be read to its end");
  if (kind != good) throw OwnProcessFailed(text);
  return text;
}

}  // namespace

std::string in_own_process(const std::function<std::string()>& work) {
  int ends[2];  // NOLINT(modernize-avoid-c-arrays): pipe() takes nothing else
  if (::pipe(ends) != 0) throw OwnProcessFailed(std::string("cannot be read: ") + std::strerror(errno));
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    work_and_send(work, ends[1]);
  }
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    throw OwnProcessFailed(std::string("cannot be read: ") + std::strerror(errno));
  }
  const auto finish = [&] {
    ::close(ends[0]);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  };
  try {
    std::string text = received(ends[0]);
    finish();
    return text;
  } catch (...) {
    finish();
    throw;
  }
}

}  // namespace posewright
