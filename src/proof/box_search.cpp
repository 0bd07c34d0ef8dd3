#include "posewright/proof/box_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "posewright/support/bytes.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/tasks.hpp"

namespace posewright {
namespace {

// Boxes of one round; more threads than this would have nothing to do. Of those that are judged together there are as
// many groups as a few threads share.
constexpr std::size_t boxes_a_round = 32, groups_a_round = 8;

/// Two halves of each box from `first` on.
void halve(std::vector<SearchBox>& boxes, std::size_t first, std::size_t axis) {
  for (std::size_t i = first, end = boxes.size(); i < end; ++i) {
    const double middle = 0.5 * (boxes[i].lower[axis] + boxes[i].upper[axis]);
    boxes.push_back(boxes[i]);
    boxes[i].upper[axis] = boxes.back().lower[axis] = middle;
  }
}

/// Verdict of a judge on a box, with its bounds: each field, in the order of the bytes.
template <class Box, class Found, class Visit>
void each_field(Box& box, Found& found, const Visit& visit) {
  visit(box.lower);
  visit(box.upper);
  visit(box.bound);
  visit(box.longest);
  visit(box.also);
  visit(found.value);
  visit(found.where);
  visit(found.function);
  visit(found.refuting.value);
  visit(found.refuting.where);
  visit(found.refuting.function);
}

}  // namespace

BoxSearchResult largest_value(std::vector<SearchBox> round, const std::function<std::unique_ptr<BoxJudge>()>& make,
                              const BoxSearchOptions& options, const Monitor& monitor) {
  BoxSearchResult result;
  std::priority_queue<SearchBox> open;
  const int threads = thread_count(options.threads);
  std::vector<std::unique_ptr<BoxJudge>> judges;
  judges.reserve(std::size_t(threads));
  for (int i = 0; i < threads; ++i) judges.push_back(make());
  const std::size_t together = judges.front()->together();
  const std::size_t most_in_round = together == 1 ? boxes_a_round : groups_a_round * together;
  const auto enough_now = [&] {
    const double best = result.found.value;
    const double near = std::isfinite(best) ? best + options.tolerance * std::abs(best) : best;
    return std::max(near, options.enough - options.slack);
  };
  while (true) {
    std::vector<LargestFound> found(round.size(), result.found);
    const double enough = enough_now();
    const std::size_t groups = (round.size() + together - 1) / together;
    const auto boxes_of = [&](std::size_t i) {
      return std::span(round).subspan(together * i, std::min(together, round.size() - together * i));
    };
    const auto found_of = [&](std::size_t i) { return std::span(found).subspan(together * i, boxes_of(i).size()); };
    // Boxes that are not judged keep an infinite bound.
    if (options.shared && monitor.engine != nullptr) {
      result.stopped = run_tasks(
          {"boxes", groups, threads, [](std::size_t, std::string_view) {}},
          [&](std::size_t i, int thread) {
            judges[std::size_t(thread)]->judge_together(boxes_of(i), enough, found_of(i));
            ByteWriter bytes;
            for (std::size_t k = 0; k < boxes_of(i).size(); ++k)
              each_field(boxes_of(i)[k], found_of(i)[k], [&](const auto& field) { bytes.put(field); });
            return bytes.take();
          },
          [&](std::size_t i, std::string_view from) {
            ByteReader bytes(from);
            for (std::size_t k = 0; k < boxes_of(i).size(); ++k)
              each_field(boxes_of(i)[k], found_of(i)[k], [&](auto& field) { bytes.get(field); });
          },
          monitor);
    } else {
      parallel_for(groups, threads, [&](std::size_t i, int thread) {
        if (monitor.should_stop()) return;
        judges[std::size_t(thread)]->judge_together(boxes_of(i), enough, found_of(i));
      });
      result.stopped = monitor.should_stop();
    }
    result.boxes += long(round.size());
    for (LargestFound& one : found) {
      if (one.refuting.value > result.found.refuting.value) result.found.refuting = std::move(one.refuting);
      if (one.value > result.found.value) static_cast<FoundPlace&>(result.found) = std::move(one);
    }
    for (SearchBox& box : round) {
      // What is no number bounds nothing: neither less than enough nor more.
      if (std::isnan(box.bound)) box.bound = std::numeric_limits<double>::infinity();
      open.push(std::move(box));
    }
    round.clear();
    result.complete = open.top().bound <= enough_now();
    if (result.complete || result.stopped || result.boxes >= options.most_boxes) break;
    while (round.size() < most_in_round && !open.empty() && open.top().bound > enough_now()) {
      const std::size_t first = round.size();
      round.push_back(open.top());
      open.pop();
      halve(round, first, std::size_t(round[first].longest));
      if (round[first].also >= 0) halve(round, first, std::size_t(round[first].also));
    }
  }
  result.largest = result.found.value;
  result.bound = open.top().bound + options.slack;
  return result;
}

}  // namespace posewright
