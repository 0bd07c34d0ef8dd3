#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

#include "posewright/workspace/candidates.hpp"

namespace posewright {

/// Collects drawn configurations batch by batch; validity is judged in parallel, the order stays that of the draws.
class Sampler {
 public:
  /// Both must outlive the sampler.
  Sampler(const Workspace& workspace, const SamplingOptions& options);

  void interior(std::size_t wanted, const Monitor& monitor);
  void boundary(std::size_t wanted, const Monitor& monitor);
  /// Sampler of views: from even draws the joints go to views, drawn by (seed, draw) alone.
  void views(std::size_t wanted, const Monitor& monitor);
  /// Valid states by one of OMPL's samplers, in runs that depend on (seed, kind, run) alone.
  void valid_states(SamplerKind kind, std::size_t wanted, const Monitor& monitor);
  /// Draws the missing candidates evenly, or at views; of any instrument.
  void fill_up(std::size_t count, const Monitor& monitor);

  /// Share of even draws that is feasible, by a few.
  double feasible_share() const;
  bool is_empty() const { return result_.count() == 0; }
  /// Throws CannotDo if nothing feasible was drawn: what rejects most, and what helps.
  Configurations take();

 private:
  struct DrawnBatch {
    std::vector<double> values;
    std::vector<long> rejected;
    long drawn = 0;
  };
  /// A point of the unit box, draw after draw.
  using Generate = std::function<void(std::size_t, std::span<double>)>;
  /// Makes it a configuration and says what forbids it; in several threads.
  using Judge = std::function<int(std::size_t, std::span<double>)>;

  void draw(std::size_t wanted, const Monitor& monitor, std::size_t draws_per_candidate, const Generate& generate,
            const Judge& judge);
  /// Of a list of instruments each has its part of the candidates, however seldom it sees: sets how many are wanted.
  void share_among_instruments(std::size_t wanted);
  /// One candidate less is wanted of its instrument; false: none was.
  bool counts(std::span<const double> q);
  /// Of a drawn configuration, which is moved to where joined tips meet: index into the reasons, or −1.
  int closed_violation(std::span<double> q) const;
  /// From the unit box to the limits.
  void scale(std::span<double> q) const;
  /// Moves unit coordinates to 0 or 1: all of them for the first draws (every corner once, if they are not too many),
  /// then 1, 2, … of them in turn. Periodic coordinates have no ends.
  void pin(std::size_t i, std::span<double> q) const;
  /// Draws an infeasible boundary point back to the feasible set, towards a candidate.
  int draw_back(std::size_t index, std::span<double> q) const;
  DrawnBatch run(SamplerKind kind, std::size_t number) const;
  void add(const DrawnBatch& done, std::size_t target);
  /// A configuration that is there already would be a repeat under another name.
  bool is_new(std::span<const double> q);
  int out_of_reach() const { return int(rejected_.size()) - 4; }
  int open_loop() const { return int(rejected_.size()) - 3; }
  std::size_t drawn_before() const { return rejected_.size() - 2; }
  [[noreturn]] void fail() const;

  const Workspace& workspace_;
  const SamplingOptions& options_;
  Configurations result_;
  std::vector<std::string> reasons_;
  std::vector<long> rejected_;
  std::vector<std::size_t> bounded_;        // coordinates with ends
  std::unordered_set<std::uint64_t> seen_;  // hashes of accepted configurations
  std::size_t anchors_ = 0;
  std::optional<std::size_t> instrument_;  // coordinate of a list
  std::vector<std::size_t> still_wanted_;  // of each instrument
  std::vector<double> open_;               // instruments that more are wanted of
  bool has_ompl_ = false, has_views_ = false, filling_up_ = false;
};

}  // namespace posewright
