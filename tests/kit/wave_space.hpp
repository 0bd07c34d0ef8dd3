#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/planning/configuration_space.hpp"
#include "posewright/support/random.hpp"

namespace posewright {

/// Smooth blocks over the unit box: entry (i, c) is a wave cos(a·q + b) with its own a and b. What a robot is to
/// planners, without a robot. The oracle counts how often it was asked for a block outside the feasible set.
class WaveSpace : public ConfigurationSpace {
 public:
  using Oracle = std::function<bool(std::span<const double>)>;

  /// @param oracle  empty: the whole box is feasible
  WaveSpace(int dimension, int rows, int columns, std::size_t candidates, std::uint64_t seed, Oracle oracle = {})
      : rows_(rows), columns_(columns), oracle_(std::move(oracle)) {
    Random random(seed, 7);
    for (int i = 0; i < rows * columns * (dimension + 1); ++i) waves_.push_back(random.uniform(-4.0, 4.0));
    axes_.assign(std::size_t(dimension), Axis{0.0, 1.0, true});
    spacing_.unit = Eigen::VectorXd::Constant(dimension, 0.01);
    spacing_.period = Eigen::VectorXd::Zero(dimension);
    while (configurations_.size() < candidates) {
      std::vector<double> q(static_cast<std::size_t>(dimension));
      for (double& x : q) x = random.uniform();
      if (!oracle_ || oracle_(q)) configurations_.push_back(q);
    }
    blocks_ = BlockArray(candidates, rows, columns);
    for (std::size_t i = 0; i < candidates; ++i) write(configurations_[i], blocks_.row(i, 0), blocks_.stride());
  }

  const BlockArray& blocks() const { return blocks_; }
  /// What of the oracle is checked quickly: true wherever the oracle is.
  void check_first(Oracle quick) { quick_ = std::move(quick); }
  /// How often the whole oracle was asked for.
  long asked() const { return asked_; }
  /// How often a block was.
  long blocks_asked() const { return blocks_asked_; }
  /// A smooth function that is ≥ 0 exactly where the oracle holds.
  void bound_by(std::function<double(std::span<const double>)> margin) { margin_ = std::move(margin); }
  /// Axis k is a choice between 0 and 1; candidates keep what they have, rounded.
  void make_choice(std::size_t k) {
    axes_[k].continuous = false;
    axes_[k].choices = {0.0, 1.0};
  }
  /// All candidates have this value of axis k.
  void set_candidates(std::size_t k, double value) {
    for (std::size_t i = 0; i < configurations_.size(); ++i) {
      configurations_[i][k] = value;
      write(configurations_[i], blocks_.row(i, 0), blocks_.stride());
    }
  }
  void allow_repeats() { spacing_.unit.resize(0); }

  const std::vector<Axis>& axes() const override { return axes_; }
  bool is_box() const override { return !oracle_; }
  std::optional<int> margins() const override { return margin_ ? std::optional(1) : ConfigurationSpace::margins(); }
  const Spacing& spacing() const override { return spacing_; }
  std::span<const double> candidate(int index) const override { return configurations_[std::size_t(index)]; }

  std::unique_ptr<Probe> probe() const override { return std::make_unique<WaveProbe>(*this); }

  bool inside(std::span<const double> q) const {
    for (const double x : q)
      if (!(x >= 0 && x <= 1)) return false;
    return !oracle_ || oracle_(q);
  }

 private:
  class WaveProbe : public Probe {
   public:
    explicit WaveProbe(const WaveSpace& space) : space_(space) {}
    bool feasible(std::span<const double> q) override {
      ++space_.asked_;
      return space_.inside(q);
    }
    bool perhaps_feasible(std::span<const double> q) override {
      return space_.quick_
                 ? std::all_of(q.begin(), q.end(), [](double x) { return x >= 0 && x <= 1; }) && space_.quick_(q)
                 : feasible(q);
    }
    bool margins(std::span<const double> q, std::span<double> out) override {
      if (!out.empty()) out[0] = space_.margin_(q);
      return true;
    }
    bool block(std::span<const double> q, double* rows, int stride) override {
      ++space_.blocks_asked_;
      space_.write(q, rows, stride);
      return true;
    }

   private:
    const WaveSpace& space_;
  };

  void write(std::span<const double> q, double* rows, int stride) const {
    const double* w = waves_.data();
    for (int i = 0; i < rows_; ++i)
      for (int c = 0; c < columns_; ++c) {
        double phase = *w++;
        for (const double x : q) phase += *w++ * x;
        rows[i * stride + c] = std::cos(phase);
      }
  }

  int rows_, columns_;
  Oracle oracle_, quick_;
  std::function<double(std::span<const double>)> margin_;
  mutable std::atomic<long> asked_{0}, blocks_asked_{0};
  std::vector<double> waves_;
  std::vector<Axis> axes_;
  Spacing spacing_;
  std::vector<std::vector<double>> configurations_;
  BlockArray blocks_;
};

}  // namespace posewright
