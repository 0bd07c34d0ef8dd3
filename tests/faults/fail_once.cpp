// Preloaded into a program: the FAIL_AT-th call of FAIL_CALL (write, rename, fsync, mkostemp, malloc) since main()
// began fails; without FAIL_AT none does. COUNT_FILE takes the number of these calls at the end.

#include <dlfcn.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" void* __libc_malloc(size_t size);

namespace {

using Main = int (*)(int, char**, char**);

std::atomic<long> calls = 0;
long fail_at = 0;
const char* wanted = "";
bool in_main = false;
Main real_main = nullptr;

bool fails(const char* call, int error) {
  if (!in_main || std::strcmp(call, wanted) != 0 || ++calls != fail_at) return false;
  errno = error;
  return true;
}

template <class Function>
Function* real(Function*, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

void count_at_end() {
  in_main = false;
  const char* file = std::getenv("COUNT_FILE");
  std::FILE* out = file == nullptr ? nullptr : std::fopen(file, "w");
  if (out == nullptr) return;
  std::fprintf(out, "%ld\n", calls.load());
  std::fclose(out);
}

int main_that_counts(int argc, char** argv, char** environment) {
  if (const char* call = std::getenv("FAIL_CALL")) wanted = call;
  if (const char* at = std::getenv("FAIL_AT")) fail_at = std::atol(at);
  // Programs that this one starts are left alone.
  unsetenv("LD_PRELOAD");
  std::atexit(count_at_end);
  in_main = true;
  return real_main(argc, argv, environment);
}

}  // namespace

extern "C" {

int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(), void (*rtld_fini)(),
                      void* stack_end) {
  real_main = main;
  return real(&__libc_start_main, "__libc_start_main")(main_that_counts, argc, argv, init, fini, rtld_fini, stack_end);
}

void* malloc(size_t size) { return fails("malloc", ENOMEM) ? nullptr : __libc_malloc(size); }

ssize_t write(int descriptor, const void* bytes, size_t count) {
  return fails("write", ENOSPC) ? -1 : real(&write, "write")(descriptor, bytes, count);
}

int rename(const char* from, const char* to) noexcept {
  return fails("rename", EIO) ? -1 : real(&rename, "rename")(from, to);
}

int fsync(int descriptor) { return fails("fsync", EIO) ? -1 : real(&fsync, "fsync")(descriptor); }

int mkostemp(char* name, int flags) {
  return fails("mkostemp", ENOSPC) ? -1 : real(&mkostemp, "mkostemp")(name, flags);
}
}
