#include "posewright/support/result_store.hpp"

namespace posewright {

// Files are in memory or a host's: nothing is kept.
std::string build_identity() { return ""; }

}  // namespace posewright
