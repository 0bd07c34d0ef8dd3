#include "processes.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "module_folder.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/process_module.hpp"

namespace posewright::cli {
namespace {

// What starters of processes say how many there are by: Open MPI, MPICH and others by PMI, Slurm's srun.
constexpr std::array<const char*, 3> how_many = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};

int processes_started() {
  for (const char* name : how_many)
    if (const char* text = std::getenv(name)) return std::atoi(text);
  return 1;
}

std::filesystem::path module_file() {
  std::error_code code;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", code);
  // Beside the build tree's program, and where it is installed.
  for (const char* folder : {"../lib/posewright/modules", installed_module_folder}) {
    const auto file = program.parent_path() / folder / "posewright_mpi.so";
    if (std::filesystem::exists(file, code)) return file;
  }
  return {};
}

std::shared_ptr<Workers> loaded_workers(int processes) {
  const std::string started = "started as one of " + std::to_string(processes) + " processes";
  const std::filesystem::path file = module_file();
  if (file.empty()) throw CannotDo(started + ", but this posewright was built without POSEWRIGHT_MPI; start it alone");
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (module == nullptr) throw CannotDo(started + ", but Open MPI cannot be loaded: " + ::dlerror());
  auto* make = reinterpret_cast<MakeWorkers*>(::dlsym(module, make_workers_name));
  if (make == nullptr) throw CannotDo(file.string() + " belongs to another version of posewright");
  return std::shared_ptr<Workers>(make());
}

void be_silent() {
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  ::close(nowhere);
}

std::shared_ptr<Workers>& current() {
  static std::shared_ptr<Workers> workers;
  return workers;
}

}  // namespace

std::shared_ptr<Workers> started_workers() {
  std::shared_ptr<Workers>& workers = current();
  if (workers) return workers;
  const int processes = processes_started();
  workers = processes > 1 ? loaded_workers(processes) : std::shared_ptr<Workers>(thread_workers());
  if (workers->rank() > 0) be_silent();
  return workers;
}

void leave(int exit_code) {
  if (current()) current()->leave(exit_code);
}

}  // namespace posewright::cli
