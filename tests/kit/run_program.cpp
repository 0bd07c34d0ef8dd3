#include "run_program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

namespace posewright {
namespace {

std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void redirect(const std::filesystem::path& file, int descriptor) {
  const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  ::dup2(opened, descriptor);
}

}  // namespace

ProgramRun run_program(const std::filesystem::path& folder, const std::vector<std::string>& words,
                       double interrupt_after, int signals) {
  // Beside the folder, so that tests can count what the program leaves in it.
  const std::filesystem::path out = folder.string() + ".out", err = folder.string() + ".err";
  const pid_t child = ::fork();
  if (child == 0) {
    std::vector<char*> arguments;
    std::string program = POSEWRIGHT_PROGRAM;
    arguments.push_back(program.data());
    std::vector<std::string> copies = words;
    for (std::string& word : copies) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::filesystem::current_path(folder);
    redirect(out, STDOUT_FILENO);
    redirect(err, STDERR_FILENO);
    ::execv(program.c_str(), arguments.data());
    ::_exit(127);
  }
  if (interrupt_after > 0) {
    std::this_thread::sleep_for(std::chrono::duration<double>(interrupt_after));
    for (int i = 0; i < signals; ++i) ::kill(child, SIGINT);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ProgramRun run{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), contents(out), contents(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return run;
}

int messages_in(const std::string& err) {
  std::istringstream in(err);
  int count = 0;
  for (std::string line; std::getline(in, line);) count += line.starts_with("  ") ? 0 : 1;
  return count;
}

}  // namespace posewright
