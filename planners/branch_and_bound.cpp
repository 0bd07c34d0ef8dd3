#include "branch_and_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exchange.hpp"
#include "local_search.hpp"
#include "posewright/criterion/information_function.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Designs that are better by less count as equal.
constexpr double proof_tolerance = 1e-9;
constexpr double most_enumerated = 3e6;

/// How often each candidate is chosen at least and at most.
struct Node {
  std::vector<int> least, most;
};

class Tree {
 public:
  Tree(const DesignTask& task, const Monitor& monitor, Design& best)
      : task_(task), function_(task.criterion->function()), monitor_(monitor), best_(best) {}

  /// True if the best design is proved.
  bool run() {
    const std::size_t n = task_.candidates.blocks->count();
    std::vector<Node> open{{std::vector<int>(n, 0), std::vector<int>(n, task_.candidates.max_repeats)}};
    long nodes = 0;
    while (!open.empty()) {
      if (monitor_.should_stop()) return false;
      Node node = std::move(open.back());
      open.pop_back();
      if (++nodes % 50 == 0) monitor_.report({"branch and bound", double(nodes), 0, best_.value, task_.bound, {}});
      branch(std::move(node), open);
    }
    return true;
  }

 private:
  struct Relaxation {
    std::vector<int> free;
    std::vector<double> share;  // of the remaining poses, per free candidate
    int left = 0;               // poses
    bool alive = false;
  };

  void branch(Node node, std::vector<Node>& open) {
    const Relaxation relaxed = relax(node);
    if (!relaxed.alive) return;
    // The candidate whose number is farthest from whole.
    int chosen = -1;
    double farthest = -1.0, number = 0.0;
    for (std::size_t i = 0; i < relaxed.free.size(); ++i) {
      const double x = relaxed.share[i] * relaxed.left;
      const double distance = std::abs(x - std::round(x));
      if (distance > farthest) {
        farthest = distance;
        chosen = relaxed.free[i];
        number = x;
      }
    }
    const auto c = std::size_t(chosen);
    const int below = std::clamp(node.least[c] + int(std::floor(number)), node.least[c], node.most[c] - 1);
    Node without = node;
    without.most[c] = below;
    node.least[c] = below + 1;
    // Last in, first out: the promising side is looked into first.
    if (number - std::floor(number) >= 0.5) {
      open.push_back(std::move(without));
      open.push_back(std::move(node));
    } else {
      open.push_back(std::move(node));
      open.push_back(std::move(without));
    }
  }

  int chosen(const Node& node) const { return std::accumulate(node.least.begin(), node.least.end(), 0); }

  Eigen::MatrixXd fixed_information(const Node& node) const {
    const BlockArray& blocks = *task_.candidates.blocks;
    const int m = blocks.columns();
    Eigen::MatrixXd M = task_.candidates.prior != nullptr ? *task_.candidates.prior : Eigen::MatrixXd::Zero(m, m);
    for (std::size_t i = 0; i < node.least.size(); ++i)
      if (node.least[i] > 0) M += node.least[i] * blocks.block(i).transpose() * blocks.block(i);
    return M;
  }

  /// Takes away free candidates that are too near to chosen ones.
  void exclude_neighbours(Node& node) const {
    if (task_.candidates.spacing == nullptr) return;
    for (std::size_t i = 0; i < node.least.size(); ++i) {
      if (node.least[i] == 0) continue;
      for (std::size_t j = 0; j < node.least.size(); ++j)
        if (task_.candidates.spacing->too_near(int(i), int(j))) node.most[j] = std::min(node.most[j], node.least[j]);
    }
  }
  bool clashes(const Node& node) const {
    if (task_.candidates.spacing == nullptr) return false;
    for (std::size_t i = 0; i < node.least.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (node.least[i] > 0 && node.least[j] > 0 && task_.candidates.spacing->too_near(int(i), int(j))) return true;
    return false;
  }

  /// A leaf is evaluated; elsewhere the bound decides, and fixes what it can; repeats while that fixes something.
  Relaxation relax(Node& node) {
    Relaxation result;
    while (true) {
      exclude_neighbours(node);
      result = {};
      result.left = task_.poses - chosen(node);
      int room = 0;
      for (std::size_t i = 0; i < node.least.size(); ++i)
        if (node.most[i] > node.least[i]) {
          result.free.push_back(int(i));
          room += node.most[i] - node.least[i];
        }
      if (result.left < 0 || room < result.left || clashes(node)) return result;
      if (result.left == 0 || room == result.left) {
        leaf(node, result.left > 0);
        return result;
      }
      if (!bound(node, result)) return result;
      if (!fixed_something_) break;
    }
    result.alive = true;
    return result;
  }

  void leaf(const Node& node, bool filled) {
    const std::vector<int>& count = filled ? node.most : node.least;
    std::vector<int> members;
    for (std::size_t i = 0; i < count.size(); ++i) members.insert(members.end(), std::size_t(count[i]), int(i));
    const double value = task_.criterion->start(task_.candidates, members)->value();
    if (value > best_.value) {
      best_.value = value;
      best_.members = members;
    }
  }

  bool bound(Node& node, Relaxation& result) {
    const BlockArray blocks = task_.candidates.blocks->subset(result.free);
    const double left = result.left;
    int widest = 0;
    for (const int i : result.free) widest = std::max(widest, node.most[std::size_t(i)] - node.least[std::size_t(i)]);
    ApproximateDesignOptions options;
    options.cap = std::min(1.0, widest / left);
    options.tolerance = 1e-5;
    options.prior = fixed_information(node) / left;
    ApproximateDesign design;
    try {
      design = solve_approximate_design(blocks, function_, options, Monitor{});
    } catch (const CannotDo&) {
      return false;  // whatever is added, some parameter stays unknown
    }
    if (design.bound_for(result.left) <= best_.value + proof_tolerance) return false;
    result.share.assign(result.free.size(), 0.0);
    for (std::size_t i = 0; i < design.support.size(); ++i)
      result.share[std::size_t(design.support[i])] = design.weights[i];
    fix(node, result, design, options);
    return true;
  }

  /// Σ v d must reach `needed` in anything better than the best: whoever makes that impossible by being in, or by being
  /// missing, is settled. For candidates that are free to be chosen once.
  void fix(Node& node, const Relaxation& result, const ApproximateDesign& design,
           const ApproximateDesignOptions& options) {
    fixed_something_ = false;
    if (options.cap * result.left > 1.0 + 1e-12) return;
    const double value = design.value + design.degree * std::log(double(result.left));
    const double prior = (design.factor.transpose() * options.prior * design.factor).trace();
    const double needed =
        (design.degree * std::exp((best_.value + proof_tolerance - value) / design.degree) - prior) * result.left;
    std::vector<double> sorted = design.sensitivity;
    std::sort(sorted.begin(), sorted.end(), std::greater<>());
    const auto left = std::ptrdiff_t(result.left);
    const double top = std::accumulate(sorted.begin(), sorted.begin() + left, 0.0);
    const double weakest = sorted[std::size_t(left) - 1], next = sorted[std::size_t(left)];
    for (std::size_t i = 0; i < result.free.size(); ++i) {
      const double d = design.sensitivity[i];
      const auto c = std::size_t(result.free[i]);
      if (d <= weakest && top - weakest + d < needed) {
        node.most[c] = node.least[c];
        fixed_something_ = true;
      } else if (d > weakest && top - d + next < needed) {
        node.least[c] = node.most[c];
        fixed_something_ = true;
      }
    }
  }

  const DesignTask& task_;
  const InformationFunction& function_;
  const Monitor& monitor_;
  Design& best_;
  bool fixed_something_ = false;
};

/// Number of sets of N of n, with repeats or without.
double number_of_sets(double n, int poses, bool repeats) {
  double sets = 1.0;
  for (int i = 0; i < poses; ++i) sets *= (repeats ? n + i : n - i) / (i + 1);
  return sets;
}

class Enumeration {
 public:
  Enumeration(const DesignTask& task, const Monitor& monitor, Design& best)
      : task_(task), monitor_(monitor), best_(best), members_(std::size_t(task.poses)) {
    const BlockArray& blocks = *task.candidates.blocks;
    const int m = blocks.columns();
    base_ = task.candidates.prior != nullptr ? *task.candidates.prior : Eigen::MatrixXd::Zero(m, m);
  }
  bool run() { return next(0, 0, 0, base_); }

 private:
  bool next(int position, int first, int repeated, const Eigen::MatrixXd& information) {
    if (position == task_.poses) {
      if (monitor_.should_stop()) return false;
      const double value = task_.criterion->of_information_alone()
                               ? task_.criterion->function().value(information)
                               : task_.criterion->start(task_.candidates, members_)->value();
      if (value <= best_.value + proof_tolerance || !apart()) return true;
      best_.value = value;
      best_.members = members_;
      return true;
    }
    const BlockArray& blocks = *task_.candidates.blocks;
    for (int i = first; i < int(blocks.count()); ++i) {
      const int used = i == first && position > 0 ? repeated : 0;
      if (used >= task_.candidates.max_repeats) continue;
      members_[std::size_t(position)] = i;
      const auto block = blocks.block(std::size_t(i));
      if (!next(position + 1, i, used + 1, information + block.transpose() * block)) return false;
    }
    return true;
  }

  bool apart() const {
    if (task_.candidates.spacing == nullptr) return true;
    for (std::size_t i = 0; i < members_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (task_.candidates.spacing->too_near(members_[i], members_[j])) return false;
    return true;
  }

  const DesignTask& task_;
  const Monitor& monitor_;
  Design& best_;
  std::vector<int> members_;
  Eigen::MatrixXd base_;
};

}  // namespace

Design BranchAndBoundPlanner::do_plan(const DesignTask& task, const PlannerOptions& options,
                                      const Monitor& monitor) const {
  Design design = ExchangePlanner().plan(task, options, monitor);
  if (task.criterion->function().degree() > 0) {
    design.optimal = Tree(task, monitor, design).run();
  } else {
    const double sets =
        number_of_sets(double(task.candidates.blocks->count()), task.poses, task.candidates.max_repeats > 1);
    // With reserve each set costs N factorisations.
    if (!(sets <= (task.criterion->of_information_alone() ? most_enumerated : 0.01 * most_enumerated)))
      throw CannotDo("criterion " + task.criterion->name() +
                     " has no bound: all sets would have to be tried, and there are too many");
    design.optimal = Enumeration(task, monitor, design).run();
  }
  design.stopped = !design.optimal;
  return design;
}

}  // namespace posewright
