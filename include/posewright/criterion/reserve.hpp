#pragma once

#include <memory>
#include <string>

#include "posewright/criterion/criterion.hpp"

namespace posewright {

/// Φ of a design after the loss of the one pose that hurts most: min_i Φ(S∖i). A plan that is good by it survives a
/// hidden reflector or a robot that refuses one pose. Swaps are screened by the derivative at the worst loss and the
/// best few evaluated exactly, each by N factorisations. function() is the wrapped criterion's: its bound for N poses
/// holds all the more here.
class ReserveCriterion : public Criterion {
 public:
  /// @param inner  outlives this
  explicit ReserveCriterion(const Criterion& inner) : inner_(inner) {}
  std::string name() const override { return inner_.name(); }
  const InformationFunction& function() const override { return inner_.function(); }
  bool of_information_alone() const override { return false; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override;

 private:
  const Criterion& inner_;
};

}  // namespace posewright
