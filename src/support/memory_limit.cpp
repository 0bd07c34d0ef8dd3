#include "posewright/support/memory_limit.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace posewright {

std::uint64_t memory_limit() {
  std::uint64_t limit = std::uint64_t(::sysconf(_SC_PHYS_PAGES)) * std::uint64_t(::sysconf(_SC_PAGE_SIZE));
  if (rlimit own{}; ::getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY)
    limit = std::min<std::uint64_t>(limit, own.rlim_cur);
  // Of a container; the file has the word max where there is none.
  std::ifstream group("/sys/fs/cgroup/memory.max");
  if (std::uint64_t most = 0; group >> most) limit = std::min(limit, most);
  return limit;
}

}  // namespace posewright
