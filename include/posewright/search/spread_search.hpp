#pragma once

#include <string>

#include "posewright/blocks/read_blocks.hpp"
#include "posewright/search/search.hpp"
#include "posewright/support/workers.hpp"

namespace posewright {

struct SpreadRequest {
  std::string method = "exchange";  ///< or greedy
  int poses = 0;
  Repeats repeats;
  int threads = 0;  ///< in each process; 0 = all
};

/// Traffic between the processes during the exchanges: every look for the best exchange of a member is one all-reduce
/// of a gain and an index, every exchange one broadcast of a block.
struct SpreadTraffic {
  long looks = 0, look_bytes = 0;    ///< all-reduces, and their bytes
  long blocks = 0, block_bytes = 0;  ///< broadcasts, and bytes of a block
  /// Sent and received by the process that had most to do, all-reduces and broadcasts each for themselves.
  Workers::Traffic most_of_looks, most_of_blocks;
};

/// search() by log det M for candidates spread over processes (BlockShare, with `poses` + 1 spare blocks): optimal
/// weights and their bound, a start from the weights and one that adds pose after pose (greedy: this one alone), each
/// exchanged to a local optimum as settle() (planners/local_search.hpp) does; the better one counts. Sums over
/// candidates are added along one fixed tree of groups of candidates, everything else about a candidate depends on its
/// own block and on what all processes have: the result is the same for any number of processes and threads.
///
/// Throws CannotDo on every process alike where the candidates do not tell all parameters.
SearchResult search_spread(BlockShare share, const SpreadRequest& request, Workers& workers, const Monitor& monitor,
                           SpreadTraffic& traffic);

}  // namespace posewright
