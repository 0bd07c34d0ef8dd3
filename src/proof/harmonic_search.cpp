// Largest values of functions and of sums of parts: what judges their boxes.
#include "box_tensor.hpp"
#include "harmonic_judge.hpp"
#include "part_squares.hpp"

namespace posewright {
namespace {

/// A plain function, without parts.
class FunctionJudge : public BoxJudge {
 public:
  explicit FunctionJudge(const HarmonicFunction& function)
      : function_(function),
        tensor_(function.axes(), function.degrees()),
        most_(largest_size(function.coefficients())) {}

  void judge(SearchBox& box, double enough, LargestFound& found) override {
    tensor_.coefficients() = function_.coefficients();
    tensor_.put(box, most_);
    box.bound = tensor_.largest();
    if (!(box.bound > enough)) return;
    box.longest = tensor_.most_varied();
    double top;
    const std::size_t corner = tensor_.highest_corner(top);
    if (!(top > found.value)) return;
    found.value = top;
    found.where.clear();
    for (std::size_t a = 0; a < function_.axes().size(); ++a)
      found.where.push_back((corner >> a & 1) != 0 ? box.upper[a] : box.lower[a]);
  }

 private:
  const HarmonicFunction& function_;
  BoxTensor tensor_;
  double most_;
};

/// Judges each box by its own function.
class JudgeOfSeveral : public BoxJudge {
 public:
  JudgeOfSeveral(const std::vector<std::unique_ptr<HarmonicSensitivity>>& functions, const Refutation* refutation) {
    for (const auto& f : functions) judges_.push_back(f->judge(refutation));
  }
  void judge(SearchBox& box, double enough, LargestFound& found) override {
    judges_[std::size_t(box.function)]->judge(box, enough, found);
  }

 private:
  std::vector<std::unique_ptr<BoxJudge>> judges_;
};

}  // namespace

std::vector<SearchBox> HarmonicSensitivity::first_boxes() const { return parts_of_everything(form_.axes(), degrees_); }

std::unique_ptr<BoxJudge> HarmonicSensitivity::judge(const Refutation* refutation) const {
  return std::make_unique<HarmonicJudge>(*this, refutation);
}

BoxSearchResult largest_value(const HarmonicFunction& function, const BoxSearchOptions& options,
                              const Monitor& monitor) {
  return largest_value(
      parts_of_everything(function.axes(), function.degrees()),
      [&] { return std::make_unique<FunctionJudge>(function); }, options, monitor);
}

BoxSearchResult largest_value(const std::vector<std::unique_ptr<HarmonicSensitivity>>& functions,
                              const BoxSearchOptions& options, const Monitor& monitor, const Refutation* refutation) {
  std::vector<SearchBox> first;
  for (std::size_t f = 0; f < functions.size(); ++f)
    for (SearchBox& box : functions[f]->first_boxes()) {
      box.function = int(f);
      first.push_back(std::move(box));
    }
  return largest_value(
      std::move(first), [&] { return std::make_unique<JudgeOfSeveral>(functions, refutation); }, options, monitor);
}

}  // namespace posewright
