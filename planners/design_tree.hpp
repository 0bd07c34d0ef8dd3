#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "node_relaxation.hpp"

namespace posewright {

/// Branch and bound over the sets of N candidates, best bound first. Nodes are split in rounds of a fixed number, each
/// by itself and merged in order, so that the tree is the same on any number of threads and processes.
class DesignTree {
 public:
  /// @param best  a design to begin with; whatever is better replaces it
  /// @param gap   PlannerOptions::gap
  DesignTree(const DesignTask& task, int threads, const Monitor& monitor, Design& best, double gap = 0.0);
  /// More starts of a search while the proof goes on, a share of its time: what they find makes the tree smaller.
  /// @param search  a design from so many starts, other ones for every number of the call
  void search_beside(std::function<Design(int starts, int call)> search) { search_ = std::move(search); }
  /// True if `best` is proved within the gap; best.bound is what no design exceeds.
  bool run();

 private:
  struct Node {
    ChoiceBox box;
    RelaxedBox relaxed;

    static auto fields(auto& own) {
      return std::tie(own.box.least, own.box.most, own.relaxed.bound, own.relaxed.numbers, own.relaxed.branch);
    }
  };
  struct Split {
    std::vector<std::unique_ptr<Node>> children;
    Design best;
    bool left_out = false;  ///< by a stop: its node stays open

    static auto fields(auto& own) { return std::tie(own.best.value, own.best.members, own.children); }
  };

  Split split(const Node& node, NodeRelaxation& relaxation, const Design& best) const;
  /// Null if nothing in the box is better than `best`.
  std::unique_ptr<Node> look_into(ChoiceBox box, std::vector<double> numbers, NodeRelaxation& relaxation,
                                  Design& best) const;
  bool settle_spacing(ChoiceBox& box) const;
  bool leaf(const ChoiceBox& box, Design& best) const;
  void offer(std::vector<int> members, Design& best) const;
  void push(std::unique_ptr<Node> node);
  std::vector<std::unique_ptr<Node>> next_round();
  void search_on();
  void merge(std::vector<std::unique_ptr<Node>>& round, std::vector<Split>& splits);

  const DesignTask& task_;
  int threads_;
  const Monitor& monitor_;
  Design& best_;
  double gap_, tolerance_;  // in Φ; parts that may hold what is better by no more are done
  std::vector<std::unique_ptr<NodeRelaxation>> relaxations_;       // one per thread
  std::map<std::pair<double, long>, std::unique_ptr<Node>> open_;  // by −bound, then age
  std::map<long, double> bounds_;                                  // of the open nodes, by age
  long nodes_ = 0;
  std::function<Design(int, int)> search_;
  long rounds_ = 0, next_search_ = 64;
  int searches_ = 0;
};

}  // namespace posewright
