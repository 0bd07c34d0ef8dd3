#include "spread_candidates.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "posewright/criterion/sensitivity.hpp"
#include "posewright/support/bytes.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

// Groups that one thread adds up at a time: a subtree.
constexpr std::size_t subtree = 64;

/// Sums of neighbouring terms, each with its place in the one binary tree over all terms: what is added to what does
/// not depend on who adds.
class TreeSum {
 public:
  void add(std::size_t term, Eigen::VectorXd value) { add({0, term}, std::move(value)); }
  void add(const TreeSum& other) {
    for (const auto& [node, value] : other.nodes_) add(node, value);
  }
  /// Tree sum of all terms; a term without neighbour is added from the left.
  Eigen::VectorXd total() const {
    std::map<std::size_t, const Eigen::VectorXd*> by_place;
    for (const auto& [node, value] : nodes_) by_place[node.second << node.first] = &value;
    Eigen::VectorXd sum = *by_place.begin()->second;
    for (auto next = std::next(by_place.begin()); next != by_place.end(); ++next) sum += *next->second;
    return sum;
  }
  std::string bytes() const {
    ByteWriter writer;
    for (const auto& entry : nodes_) writer.put(entry);
    return writer.take();
  }
  static TreeSum in(std::string_view bytes) {
    TreeSum sum;
    ByteReader reader(bytes);
    while (!reader.at_end()) {
      auto [node, value] = reader.get<std::pair<Node, Eigen::VectorXd>>();
      sum.add(node, std::move(value));
    }
    return sum;
  }

 private:
  using Node = std::pair<int, std::size_t>;  // level, place in it

  void add(Node node, Eigen::VectorXd value) {
    while (true) {
      const auto sibling = nodes_.find({node.first, node.second ^ 1});
      if (sibling == nodes_.end()) break;
      value += sibling->second;  // of two terms: either order gives the same bits
      nodes_.erase(sibling);
      node = {node.first + 1, node.second / 2};
    }
    nodes_.emplace(node, std::move(value));
  }

  std::map<Node, Eigen::VectorXd> nodes_;
};

bool before(const SpreadBlocks::Ranked& a, const SpreadBlocks::Ranked& b) {
  return a.value != b.value ? a.value > b.value : a.candidate < b.candidate;
}

void keep_largest(std::vector<SpreadBlocks::Ranked>& ranked, std::size_t most) {
  const std::size_t kept = std::min(most, ranked.size());
  std::partial_sort(ranked.begin(), ranked.begin() + std::ptrdiff_t(kept), ranked.end(), before);
  ranked.resize(kept);
}

}  // namespace

BlockArray SpreadCandidates::fetch(const std::vector<int>& candidates) {
  BlockArray blocks(candidates.size(), rows(), columns());
  const std::size_t length = std::size_t(rows()) * std::size_t(blocks.stride()) * sizeof(double);
  const auto bytes_at = [&](const BlockArray& array, std::size_t i) {
    return std::string_view(reinterpret_cast<const char*>(array.row(i, 0)), length);
  };
  // Shares are neighbours in the order of ranks, so joined ones are in the order of candidates.
  std::string all;
  for (const int c : candidates)
    if (has(c)) all += bytes_at(share_.blocks, std::size_t(c - first()));
  workers_.combine(all, [](std::string_view lower, std::string_view higher) { return std::string(lower) += higher; });
  std::copy_n(all.data(), all.size(), reinterpret_cast<char*>(blocks.data()));
  return blocks;
}

void SpreadCandidates::pass(const Eigen::MatrixXd& T) { sensitivities(share_.blocks, T, threads_, d_); }

std::vector<SpreadBlocks::Ranked> SpreadCandidates::largest(std::size_t most, double least,
                                                            const std::vector<int>& except) {
  std::vector<Ranked> ranked;
  auto left_out = std::lower_bound(except.begin(), except.end(), first());
  for (std::size_t i = 0; i < share_.count; ++i) {
    const int candidate = first() + int(i);
    if (left_out != except.end() && *left_out == candidate) ++left_out;
    else if (d_[i] > least) ranked.push_back({d_[i], candidate});
    // No more than twice what is asked for stays in memory.
    if (ranked.size() == 2 * most + share_group) keep_largest(ranked, most);
  }
  keep_largest(ranked, most);
  std::string bytes = bytes_of(ranked);
  workers_.combine(bytes, [most](std::string_view lower, std::string_view higher) {
    std::vector<Ranked> both = value_in<std::vector<Ranked>>(lower);
    const std::vector<Ranked> more = value_in<std::vector<Ranked>>(higher);
    both.insert(both.end(), more.begin(), more.end());
    keep_largest(both, most);
    return bytes_of(both);
  });
  return value_in<std::vector<Ranked>>(bytes);
}

bool SpreadCandidates::stopped() {
  std::string bytes(1, monitor_.should_stop() ? '1' : '0');
  workers_.combine(
      bytes, [](std::string_view lower, std::string_view higher) { return std::string(std::max(lower, higher)); });
  return bytes == "1";
}

int SpreadCandidates::owner(int candidate) const {
  const int processes = workers_.processes();
  int rank = 0;
  while (rank + 1 < processes && first_of_share(share_.total, rank + 1, processes) <= std::size_t(candidate)) ++rank;
  return rank;
}

BlockArray::Map SpreadCandidates::group(std::size_t k) {
  const std::size_t begin = k * share_group, size = std::min(share_group, share_.count - begin);
  return {share_.blocks.row(begin, 0), Eigen::Index(size) * rows(), columns(),
          Eigen::OuterStride<>(share_.blocks.stride())};
}

Eigen::MatrixXd SpreadCandidates::gram() {
  const std::size_t first_group = share_.first / share_group, parts = (groups() + subtree - 1) / subtree;
  std::vector<TreeSum> sums(parts);
  const Eigen::Index m = columns();
  parallel_for(parts, threads_, [&](std::size_t part, int) {
    for (std::size_t k = part * subtree; k < std::min(groups(), (part + 1) * subtree); ++k) {
      Eigen::MatrixXd term = Eigen::MatrixXd::Zero(m, m);
      term.selfadjointView<Eigen::Lower>().rankUpdate(group(k).transpose());
      sums[part].add(first_group + k, Eigen::Map<const Eigen::VectorXd>(term.data(), term.size()));
    }
  });
  TreeSum sum;
  for (const TreeSum& one : sums) sum.add(one);
  std::string bytes = sum.bytes();
  workers_.combine(bytes, [](std::string_view lower, std::string_view higher) {
    TreeSum both = TreeSum::in(lower);
    both.add(TreeSum::in(higher));
    return both.bytes();
  });
  const Eigen::VectorXd total = TreeSum::in(bytes).total();
  return Eigen::Map<const Eigen::MatrixXd>(total.data(), m, m) / double(share_.total);
}

void SpreadCandidates::solve(const Eigen::MatrixXd& r) {
  parallel_for(groups(), threads_, [&](std::size_t k, int) {
    auto rows = group(k);
    r.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(rows);
  });
}

Whitening SpreadCandidates::whitened() {
  return whiten(
      columns(), [&] { return gram(); }, [&](const Eigen::MatrixXd& r) { solve(r); }, {});
}

}  // namespace posewright
