#include "posewright/criterion/share_state.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "posewright/support/parallel.hpp"
#include "swap_gain.hpp"

namespace posewright {
namespace {

// Bounds and gains are computed differently: a bound that is less than this below the best gain says nothing.
constexpr double rounding = 1e-8;
// Candidates that one thread looks through at a time.
constexpr std::size_t stretch = 16384;

/// The larger gain; of equal ones the first candidate.
void take_better(Swap& best, const Swap& other) {
  if (other.enter < 0) return;
  if (best.enter < 0 || other.gain > best.gain || (other.gain == best.gain && other.enter < best.enter)) best = other;
}

}  // namespace

struct ShareState::Running {
  Running(BlockArray& all, std::size_t candidates, int poses, int count)
      : blocks(all),
        own(candidates),
        threads(count),
        inverse(all, all.columns(), nullptr, count),
        blocked(candidates, 0),
        spare(int(candidates) + poses) {
    gains.reserve(std::size_t(threads));
    for (int t = 0; t < threads; ++t) gains.emplace_back(inverse, blocks.rows());
    free.resize(std::size_t(poses));
    std::iota(free.rbegin(), free.rend(), int(candidates));
    refresh();
  }

  bool refresh() {
    since_refresh = 0;
    forget();
    singular = !inverse.refresh(members, 0.0);
    if (singular) inverse.refresh(members, start_ridge);
    return !singular;
  }
  void forget() {
    for (SwapGain& gain : gains) gain.forget();
  }

  /// `leave` and `enter` are places among the blocks; −1: nobody.
  void change(int leave, int enter) {
    forget();
    inverse.measure(enter);
    const bool enough = long(members.size()) * blocks.rows() >= blocks.columns();
    if ((singular && enough) || !inverse.change(leave, enter) || ++since_refresh >= changes_till_refresh) refresh();
  }
  int write(int place, const double* entering) {
    std::copy_n(entering, std::size_t(blocks.rows()) * std::size_t(blocks.stride()), blocks.row(std::size_t(place), 0));
    return place;
  }

  /// look(first, end, worker, best) over stretches of the share.
  template <class Look>
  Swap best_of_all(double least, const Look& look) {
    std::vector<Swap> best(std::size_t(threads), Swap{-1, least});
    parallel_for((own + stretch - 1) / stretch, threads, [&](std::size_t part, int worker) {
      look(part * stretch, std::min(own, (part + 1) * stretch), std::size_t(worker), best[std::size_t(worker)]);
    });
    Swap all;
    for (const Swap& one : best) take_better(all, one);
    return all;
  }

  BlockArray& blocks;
  std::size_t own;
  int threads;
  InverseInformation inverse;
  std::vector<SwapGain> gains;  // one a thread
  std::vector<unsigned char> blocked;
  std::vector<int> members;  // places of the design's blocks
  std::vector<int> free;     // places that nobody has
  int spare;
  int since_refresh = 0;
  bool singular = false;
};

ShareState::ShareState(BlockArray& blocks, std::size_t own, int poses, int threads)
    : running_(std::make_unique<Running>(blocks, own, poses, threads)) {}
ShareState::~ShareState() = default;

int ShareState::size() const { return int(running_->members.size()); }
double ShareState::value() const { return running_->singular ? -infinity : running_->inverse.log_det(); }
double ShareState::loss(int position) const {
  return running_->inverse.trace(running_->members[std::size_t(position)]);
}
const double* ShareState::member(int position) const {
  return running_->blocks.row(std::size_t(running_->members[std::size_t(position)]), 0);
}

Swap ShareState::best_addition() {
  Running& run = *running_;
  const int r = run.blocks.rows();
  return run.best_of_all(-infinity, [&](std::size_t first, std::size_t end, std::size_t worker, Swap& best) {
    // ln det(I + D) ≤ r ln(1 + tr D / r).
    const auto least = [&] { return best.enter < 0 ? -infinity : r * std::expm1((best.gain - rounding) / r); };
    double wanted = least();
    for (std::size_t j = first; j < end; ++j) {
      if (run.blocked[j] != 0 || run.inverse.trace(int(j)) < wanted) continue;
      take_better(best, {int(j), run.gains[worker].addition(int(j))});
      wanted = least();
    }
  });
}

Swap ShareState::best_swap(int position, double min_gain) {
  Running& run = *running_;
  for (SwapGain& gain : run.gains) gain.leave(run.members[std::size_t(position)]);
  return run.best_of_all(min_gain, [&](std::size_t first, std::size_t end, std::size_t worker, Swap& best) {
    SwapGain& gain = run.gains[worker];
    const auto next = [&](std::size_t from) { return gain.next(from, end, best.gain - rounding, run.blocked); };
    for (std::size_t j = next(first); j < end; j = next(j + 1))
      if (const double gained = gain.exact(int(j)); gained > min_gain) take_better(best, {int(j), gained});
  });
}

void ShareState::block(int candidate, bool blocked) { running_->blocked[std::size_t(candidate)] = blocked ? 1 : 0; }

void ShareState::put(const double* entering) {
  Running& run = *running_;
  run.members.push_back(run.write(run.free.back(), entering));
  run.free.pop_back();
}

void ShareState::add(const double* entering) {
  put(entering);
  running_->change(-1, running_->members.back());
}

void ShareState::replace(int position, const double* entering) {
  Running& run = *running_;
  const int place = run.write(run.spare, entering);
  run.spare = std::exchange(run.members[std::size_t(position)], place);
  run.change(run.spare, place);
}

bool ShareState::refresh() { return running_->refresh(); }

}  // namespace posewright
