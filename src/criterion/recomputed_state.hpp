#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>
#include <vector>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/information_function.hpp"
#include "posewright/criterion/summed_information.hpp"
#include "regular.hpp"

namespace posewright {

/// A state that computes all it needs anew from the members' information after every change. Its constructor must call
/// refresh().
class RecomputedState : public DesignState {
 public:
  double removal(int position) override {
    return function_.value(information_ - block_information(blocks(), members()[std::size_t(position)])) - value();
  }

  bool refresh() override {
    information_ = summed_information(blocks(), view().prior, members());
    singular_ = !std::isfinite(function_.value(information_));
    if (singular_) information_.diagonal().array() += start_ridge;
    update();
    return !singular_;
  }

 protected:
  /// @param function  must outlive the state
  RecomputedState(const CandidateView& view, std::vector<int> members, const InformationFunction& function)
      : DesignState(view, std::move(members)), function_(function) {}

  const Eigen::MatrixXd& information() const { return information_; }
  bool singular() const { return singular_; }
  /// Φ if k leaves and j comes.
  double value_of_swap(int k, int j) const {
    return function_.value(information_ + block_information(blocks(), j) - block_information(blocks(), k));
  }

 private:
  virtual void update() = 0;

  void do_change(int leave, int enter) override {
    if (enter >= 0) information_ += block_information(blocks(), enter);
    if (leave >= 0) information_ -= block_information(blocks(), leave);
    // A start that was singular may have become regular.
    if (singular_ || !std::isfinite(function_.value(information_))) refresh();
    else update();
  }

  const InformationFunction& function_;
  Eigen::MatrixXd information_;
  bool singular_ = false;
};

}  // namespace posewright
