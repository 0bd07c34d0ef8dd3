#include <algorithm>

#include "checks.hpp"

namespace posewright {
namespace {

/// Joints with backlash have room within their limits to arrive from the side that a configuration states.
class ApproachCheck : public SingleCheck {
 public:
  explicit ApproachCheck(const std::vector<Coordinate>& coordinates) : SingleCheck("no room to arrive as stated") {
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const Coordinate& choice = coordinates[i];
      if (choice.arrives.empty()) continue;
      const auto joint = std::find_if(coordinates.begin(), coordinates.end(),
                                      [&](const Coordinate& c) { return c.name == choice.arrives; });
      if (joint->periodic) continue;
      approaches_.push_back({std::size_t(joint - coordinates.begin()), i, choice.values.front(),
                             joint->lower + choice.overrun, joint->upper - choice.overrun});
    }
  }
  bool empty() const { return approaches_.empty(); }

 private:
  struct Approach {
    std::size_t joint, side;
    double rising, lowest_rising, highest_falling;
  };

  bool holds(std::span<const double> q) const override {
    return std::all_of(approaches_.begin(), approaches_.end(), [&](const Approach& a) {
      return q[a.side] == a.rising ? q[a.joint] >= a.lowest_rising : q[a.joint] <= a.highest_falling;
    });
  }

  std::vector<Approach> approaches_;
};

}  // namespace

void add_approach_check(const CheckContext& context, Checks& checks) {
  auto check = std::make_unique<ApproachCheck>(context.coordinates);
  if (!check->empty()) checks.push_back(std::move(check));
}

}  // namespace posewright
