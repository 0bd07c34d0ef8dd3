#include "posewright/proof/box_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <span>
#include <utility>

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

/// Branch and bound by rounds of boxes.
class BoxSearch {
 public:
  BoxSearch(const std::function<std::unique_ptr<BoxJudge>()>& make, const BoxSearchOptions& options,
            const Monitor& monitor)
      : options_(options), monitor_(monitor) {
    const int threads = thread_count(options.threads);
    judges_.reserve(std::size_t(threads));
    for (int i = 0; i < threads; ++i) judges_.push_back(make());
    together_ = judges_.front()->together();
  }

  BoxSearchResult largest(std::vector<SearchBox> round) {
    while (true) {
      judge(round);
      open(round);
      result_.complete = open_.top().bound <= enough();
      if (result_.complete || result_.stopped || result_.boxes >= options_.most_boxes) break;
      round = next_round();
    }
    result_.largest = result_.found.value;
    result_.bound = open_.top().bound + options_.slack;
    return std::move(result_);
  }

 private:
  double enough() const {
    const double best = result_.found.value;
    const double near = std::isfinite(best) ? best + options_.tolerance * std::abs(best) : best;
    return std::max(near, options_.enough - options_.slack);
  }

  /// Bounds of the boxes and the places that judges find. Boxes that are not judged keep an infinite bound.
  void judge(std::vector<SearchBox>& round) {
    std::vector<LargestFound> found(round.size(), result_.found);
    const std::size_t groups = (round.size() + together_ - 1) / together_;
    const auto group = [&](auto& of_boxes, std::size_t i) {
      return std::span(of_boxes).subspan(together_ * i, std::min(together_, round.size() - together_ * i));
    };
    const auto visit_group = [&](std::size_t i, const auto& visit) {
      for (std::size_t k = 0; k < group(round, i).size(); ++k)
        each_field(group(round, i)[k], group(found, i)[k], visit);
    };
    const auto judge_group = [&, enough = enough()](std::size_t i, int thread) {
      judges_[std::size_t(thread)]->judge_together(group(round, i), enough, group(found, i));
    };
    if (options_.shared && monitor_.engine != nullptr) {
      result_.stopped = run_tasks(
          {"boxes", groups, int(judges_.size()), [](std::size_t, std::string_view) {}},
          [&](std::size_t i, int thread) {
            judge_group(i, thread);
            ByteWriter bytes;
            visit_group(i, [&](const auto& field) { bytes.put(field); });
            return bytes.take();
          },
          [&](std::size_t i, std::string_view from) {
            ByteReader bytes(from);
            visit_group(i, [&](auto& field) { bytes.get(field); });
          },
          monitor_);
    } else {
      parallel_for(groups, int(judges_.size()), [&](std::size_t i, int thread) {
        if (!monitor_.should_stop()) judge_group(i, thread);
      });
      result_.stopped = monitor_.should_stop();
    }
    for (LargestFound& one : found) {
      if (one.refuting.value > result_.found.refuting.value) result_.found.refuting = std::move(one.refuting);
      if (one.value > result_.found.value) static_cast<FoundPlace&>(result_.found) = std::move(one);
    }
  }

  void open(std::vector<SearchBox>& round) {
    result_.boxes += long(round.size());
    for (SearchBox& box : round) {
      // What is no number bounds nothing: neither less than enough nor more.
      if (std::isnan(box.bound)) box.bound = std::numeric_limits<double>::infinity();
      open_.push(std::move(box));
    }
  }

  /// Parts of the boxes with the largest bounds.
  std::vector<SearchBox> next_round() {
    const std::size_t count = together_ == 1 ? boxes_a_round : groups_a_round * together_;
    std::vector<SearchBox> round;
    while (round.size() < count && !open_.empty() && open_.top().bound > enough()) {
      const std::size_t first = round.size();
      round.push_back(open_.top());
      open_.pop();
      halve(round, first, std::size_t(round[first].longest));
      if (round[first].also >= 0) halve(round, first, std::size_t(round[first].also));
    }
    return round;
  }

  const BoxSearchOptions& options_;
  const Monitor& monitor_;
  std::vector<std::unique_ptr<BoxJudge>> judges_;
  std::size_t together_ = 1;
  std::priority_queue<SearchBox> open_;
  BoxSearchResult result_;
};

}  // namespace

BoxSearchResult largest_value(std::vector<SearchBox> round, const std::function<std::unique_ptr<BoxJudge>()>& make,
                              const BoxSearchOptions& options, const Monitor& monitor) {
  return BoxSearch(make, options, monitor).largest(std::move(round));
}

}  // namespace posewright
