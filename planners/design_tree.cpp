#include "design_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "posewright/support/bytes.hpp"
#include "posewright/support/tasks.hpp"

namespace posewright {
namespace {

// Designs that are better by less count as equal.
constexpr double proof_tolerance = 1e-9;
// Nodes split between two looks at what the others found.
constexpr std::size_t round_size = 32;
// Starts of a search for as many rounds: some tenth of the time where it is needed.
constexpr long rounds_a_start = 64;
// Open nodes hold three numbers per candidate; beyond this the newest is looked into first, which keeps them few.
constexpr std::size_t most_open_bytes = std::size_t(512) << 20;

}  // namespace

DesignTree::DesignTree(const DesignTask& task, int threads, const Monitor& monitor, Design& best, double gap)
    : task_(task),
      threads_(threads),
      monitor_(monitor),
      best_(best),
      gap_(task.criterion->function().degree() * std::log1p(gap)),
      tolerance_(std::max(proof_tolerance, gap_)) {
  for (int t = 0; t < threads; ++t) relaxations_.push_back(std::make_unique<NodeRelaxation>(task));
}

bool DesignTree::run() {
  best_.bound = task_.bound;
  if (monitor_.should_stop()) return false;
  const std::size_t n = task_.candidates.blocks->count();
  const int repeats =
      std::min({task_.candidates.max_repeats, task_.poses, int(std::numeric_limits<std::uint16_t>::max())});
  ChoiceBox whole{std::vector<std::uint16_t>(n, 0), std::vector<std::uint16_t>(n, std::uint16_t(repeats))};
  std::vector<double> start(n, double(task_.poses) / double(n));
  if (task_.approximate != nullptr) {
    std::fill(start.begin(), start.end(), 0.0);
    for (std::size_t k = 0; k < task_.approximate->support.size(); ++k)
      start[std::size_t(task_.approximate->support[k])] = task_.poses * task_.approximate->weights[k];
  }
  if (auto root = look_into(std::move(whole), std::move(start), *relaxations_[0], best_)) push(std::move(root));
  bool stopped = false;
  while (!open_.empty()) {
    best_.bound = std::max(best_.value + gap_, -open_.begin()->first.first);
    if (stopped) return false;
    monitor_.report({"branch and bound", double(nodes_), 0, best_.value, best_.bound, {}});
    search_on();
    auto round = next_round();
    std::vector<Split> splits(round.size());
    for (Split& each : splits) {
      each.best = best_;
      each.left_out = true;
    }
    stopped = run_tasks(
        {"nodes", round.size(), threads_, [](std::size_t, std::string_view) {}},
        [&](std::size_t k, int worker) {
          return bytes_of(split(*round[k], *relaxations_[std::size_t(worker)], best_));
        },
        [&](std::size_t k, std::string_view bytes) { splits[k] = value_in<Split>(bytes); }, monitor_);
    merge(round, splits);
  }
  best_.bound = best_.value + gap_;
  return true;
}

/// Whenever the tree has doubled.
void DesignTree::search_on() {
  if (search_ == nullptr || rounds_++ < next_search_) return;
  const Design found = search_(int(next_search_ / rounds_a_start), ++searches_);
  next_search_ *= 2;
  if (found.value <= best_.value) return;
  best_.value = found.value;
  best_.members = found.members;
}

/// The open nodes to split now: best bound first, or the newest where there are too many.
std::vector<std::unique_ptr<DesignTree::Node>> DesignTree::next_round() {
  std::vector<std::unique_ptr<Node>> round;
  const std::size_t bytes = 12 * task_.candidates.blocks->count() + 512;
  while (!open_.empty() && round.size() < round_size) {
    auto chosen = open_.begin();
    if (open_.size() * bytes > most_open_bytes) {
      const auto newest = std::prev(bounds_.end());
      chosen = open_.find({newest->second, newest->first});
    }
    bounds_.erase(chosen->first.second);
    round.push_back(std::move(chosen->second));
    open_.erase(chosen);
  }
  return round;
}

void DesignTree::merge(std::vector<std::unique_ptr<Node>>& round, std::vector<Split>& splits) {
  for (Split& each : splits)
    if (each.best.value > best_.value) {
      best_.value = each.best.value;
      best_.members = each.best.members;
    }
  for (std::size_t k = 0; k < round.size(); ++k) {
    if (splits[k].left_out) push(std::move(round[k]));
    for (auto& child : splits[k].children)
      if (child->relaxed.bound > best_.value + tolerance_) push(std::move(child));
  }
}

void DesignTree::push(std::unique_ptr<Node> node) {
  const double key = -node->relaxed.bound;
  bounds_[nodes_] = key;
  open_[{key, nodes_++}] = std::move(node);
}

DesignTree::Split DesignTree::split(const Node& node, NodeRelaxation& relaxation, const Design& best) const {
  Split result;
  result.best = best;
  if (node.relaxed.bound <= best.value + tolerance_) return result;
  auto c = std::size_t(std::max(node.relaxed.branch, 0));
  if (node.relaxed.branch < 0)
    while (node.box.most[c] == node.box.least[c]) ++c;
  const int below = std::clamp(int(std::floor(node.relaxed.numbers[c])), int(node.box.least[c]), node.box.most[c] - 1);
  ChoiceBox fewer = node.box, more = node.box;
  fewer.most[c] = std::uint16_t(below);
  more.least[c] = std::uint16_t(below + 1);
  for (ChoiceBox* box : {&more, &fewer})
    if (auto child = look_into(std::move(*box), node.relaxed.numbers, relaxation, result.best)) {
      child->relaxed.bound = std::min(child->relaxed.bound, node.relaxed.bound);
      result.children.push_back(std::move(child));
    }
  return result;
}

std::unique_ptr<DesignTree::Node> DesignTree::look_into(ChoiceBox box, std::vector<double> numbers,
                                                        NodeRelaxation& relaxation, Design& best) const {
  RelaxedBox relaxed;
  relaxed.numbers = std::move(numbers);
  while (true) {
    if (!settle_spacing(box) || leaf(box, best)) return nullptr;
    const ChoiceBox before = box;
    if (!relaxation.solve(box, relaxed, best.value + tolerance_)) return nullptr;
    if (relaxed.branch >= 0 || (box.least == before.least && box.most == before.most)) break;
  }
  if (relaxed.branch < 0) {  // whole numbers: a design
    std::vector<int> members;
    for (std::size_t i = 0; i < relaxed.numbers.size(); ++i)
      members.insert(members.end(), std::size_t(std::lround(relaxed.numbers[i])), int(i));
    if (int(members.size()) == task_.poses) offer(std::move(members), best);
    if (relaxed.bound <= best.value + tolerance_) return nullptr;
  }
  return std::make_unique<Node>(Node{std::move(box), std::move(relaxed)});
}

/// Takes away candidates that chosen ones forbid; false if two chosen ones are too near to each other, or more are
/// chosen than a limit allows.
bool DesignTree::settle_spacing(ChoiceBox& box) const {
  const Spacing* spacing = task_.candidates.spacing;
  if (spacing == nullptr) return true;
  std::vector<int> free = spacing->most;
  for (std::size_t i = 0; i < box.least.size() && !free.empty(); ++i)
    if ((free[spacing->value_at(int(i))] -= box.least[i]) < 0) return false;
  for (std::size_t i = 0; i < box.least.size() && !free.empty(); ++i)
    box.most[i] = std::uint16_t(std::min<int>(box.most[i], box.least[i] + free[spacing->value_at(int(i))]));
  if (!spacing->keeps_distance()) return true;
  for (std::size_t i = 0; i < box.least.size(); ++i) {
    if (box.least[i] == 0) continue;
    for (std::size_t j = 0; j < box.least.size(); ++j) {
      if (!spacing->too_near(int(i), int(j))) continue;
      if (box.least[j] > 0) return false;
      box.most[j] = 0;
    }
  }
  return true;
}

/// True if the box holds one design at most; that is looked at.
bool DesignTree::leaf(const ChoiceBox& box, Design& best) const {
  const int least = std::accumulate(box.least.begin(), box.least.end(), 0);
  const int most = std::accumulate(box.most.begin(), box.most.end(), 0);
  if (least > task_.poses || most < task_.poses) return true;
  if (least < task_.poses && most > task_.poses) return false;
  const auto& count = least == task_.poses ? box.least : box.most;
  std::vector<int> members;
  for (std::size_t i = 0; i < count.size(); ++i) members.insert(members.end(), std::size_t(count[i]), int(i));
  offer(std::move(members), best);
  return true;
}

void DesignTree::offer(std::vector<int> members, Design& best) const {
  if (const Spacing* spacing = task_.candidates.spacing; spacing != nullptr && !spacing->allows(members)) return;
  const double value = task_.criterion->start(task_.candidates, members)->value();
  if (value <= best.value) return;
  best.value = value;
  best.members = std::move(members);
}

}  // namespace posewright
