// The sensitivity beside noise of joints' readings over a box. Second road: its definition by the inverse of the whole
// covariance, at random places, at corners and uphill from the best of them.

#include "posewright/planning/reading_noise_bound.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "posewright/support/random.hpp"
#include "tests/kit/basis_product.hpp"

namespace posewright {
namespace {

/// B and Z of random polynomials, linear in 1, cos, sin of angles and in numbers.
class RandomForm : public HarmonicForm {
 public:
  static constexpr int rows_of_B = 3, columns_of_B = 4, columns_of_Z = 2;

  RandomForm(int axes, double noise, Random& random) {
    std::size_t count = 1;
    for (int a = 0; a < axes; ++a) {
      const double lower = random.uniform(-4, 2);
      const bool turns = random.uniform() < 0.7;
      axes_.push_back({lower, lower + random.uniform(0.1, turns ? 7 : 1.5), turns});
      count *= turns ? 3 : 2;
    }
    parts_.push_back({rows_of_B, 1, 1, -1, InverseVariance{1.0}, InverseVariance{}});
    degrees_.assign(1, std::vector<int>(std::size_t(axes), 1));
    columns_ = columns_of_B;
    random_columns_ = columns_of_Z;
    for (std::size_t i = 0; i < count; ++i) {
      tensors_.emplace_back(rows_of_B, columns_of_B + columns_of_Z);
      for (double& x : tensors_.back().reshaped()) x = random.normal();
      tensors_.back().rightCols(columns_of_Z) *= noise;
    }
  }

  class Own : public Evaluator {
   public:
    explicit Own(const RandomForm& form) : form_(form) {}
    bool rows(std::span<const double> values, BlockArray::RowMatrix& B) override {
      B = form_.at(values).leftCols(columns_of_B);
      return true;
    }
    bool with_random(std::span<const double> values, BlockArray::RowMatrix& B, BlockArray::RowMatrix& Z) override {
      const Eigen::MatrixXd all = form_.at(values);
      B = all.leftCols(columns_of_B);
      Z = all.rightCols(columns_of_Z);
      return true;
    }
    void distances(std::span<const double>, std::span<double>) override {}
    void complete(std::span<double>) const override {}

   private:
    const RandomForm& form_;
  };
  std::unique_ptr<Evaluator> evaluator() const override { return std::make_unique<Own>(*this); }
  std::vector<double> configuration(std::span<const double> values) const override {
    return {values.begin(), values.end()};
  }
  std::vector<double> values(std::span<const double> q) const override { return {q.begin(), q.end()}; }

  Eigen::MatrixXd at(std::span<const double> q) const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(rows_of_B, columns_of_B + columns_of_Z);
    for (std::size_t i = 0; i < tensors_.size(); ++i) sum += basis_product(axes_, i, q) * tensors_[i];
    return sum;
  }
  /// tr TᵀBᵀ(1 + ZZᵀ)⁻¹BT.
  double sensitivity(std::span<const double> q, const Eigen::MatrixXd& T) const {
    const Eigen::MatrixXd all = at(q), Y = all.leftCols(columns_of_B) * T, Z = all.rightCols(columns_of_Z);
    const Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(rows_of_B, rows_of_B) + Z * Z.transpose();
    return (Y.transpose() * covariance.ldlt().solve(Y)).trace();
  }

 private:
  std::vector<Eigen::MatrixXd> tensors_;
};

BoxSearchResult largest(const RandomForm& form, const Eigen::MatrixXd& T, int threads, long most_boxes) {
  std::vector<std::unique_ptr<BoundedSensitivity>> functions;
  functions.push_back(std::make_unique<ReadingNoiseSensitivity>(form, T, 3, threads, Monitor{}));
  EXPECT_TRUE(functions.front()->defined());
  BoxSearchOptions options;
  options.threads = threads;
  options.most_boxes = most_boxes;
  return largest_value(functions, options, Monitor{});
}

Eigen::MatrixXd random_factor(double scale, Random& random) {
  Eigen::MatrixXd T(RandomForm::columns_of_B, 3);
  for (double& x : T.reshaped()) x = scale * random.normal();
  return T;
}

TEST(ReadingNoise, IsBoundedWhereItIsOfAnySize) {
  int complete = 0;
  constexpr int trials = 60;
  for (int trial = 0; trial < trials; ++trial) {
    Random random(17, std::uint64_t(trial));
    const double noise = trial % 3 == 0 ? 0.1 : trial % 3 == 1 ? 1.0 : 10.0;
    const RandomForm form(1 + trial % 3, noise, random);
    const Eigen::MatrixXd T = random_factor(trial % 2 == 0 ? 1.0 : 1e-6, random);
    const BoxSearchResult most = largest(form, T, 1, 3000);
    double found = 0;
    std::vector<double> q(form.axes().size()), best(form.axes().size());
    const auto look_at = [&] {
      const double value = form.sensitivity(q, T);
      EXPECT_LE(value, most.bound) << "trial " << trial;
      if (value <= found) return;
      found = value;
      best = q;
    };
    for (int i = 0; i < 2000; ++i) {
      for (std::size_t a = 0; a < q.size(); ++a) {
        q[a] = random.uniform(form.axes()[a].lower, form.axes()[a].upper);
        if (const double edge = random.uniform(); edge < 0.2)
          q[a] = edge < 0.1 ? form.axes()[a].lower : form.axes()[a].upper;
      }
      look_at();
    }
    for (double step = 0.5; step > 1e-6; step *= 0.7)
      for (int i = 0; i < 20; ++i) {
        for (std::size_t a = 0; a < q.size(); ++a)
          q[a] = std::clamp(best[a] + step * random.normal(), form.axes()[a].lower, form.axes()[a].upper);
        look_at();
      }
    ASSERT_FALSE(most.found.where.empty());
    EXPECT_NEAR(form.sensitivity(most.found.where, T) / most.largest, 1, 1e-9);
    complete += int(most.complete);
    if (most.complete) {
      EXPECT_LE(most.bound, std::max(found, most.largest) * (1 + 2e-3)) << "trial " << trial;
    }
  }
  // A bound that no number of boxes brings down would hold as well.
  EXPECT_GT(complete, trials * 3 / 4);
}

TEST(ReadingNoise, IsBoundedWhateverTheNumberOfThreads) {
  Random random(19, 1);
  const RandomForm form(3, 1.0, random);
  const Eigen::MatrixXd T = random_factor(1.0, random);
  const BoxSearchResult one = largest(form, T, 1, 300), three = largest(form, T, 3, 300);
  EXPECT_EQ(one.bound, three.bound);
  EXPECT_EQ(one.boxes, three.boxes);
  EXPECT_EQ(one.found.where, three.found.where);
}

TEST(ReadingNoise, IsBoundedTheMoreTightlyTheMoreBoxesThereAre) {
  Random random(21, 2);
  const RandomForm form(3, 1.0, random);
  const Eigen::MatrixXd T = random_factor(1.0, random);
  const double few = largest(form, T, 1, 1).bound, more = largest(form, T, 1, 100).bound;
  EXPECT_GT(few, more);
  EXPECT_GT(more, largest(form, T, 1, 1000).largest);
}

TEST(ReadingNoise, IsRefusedWhereColumnsAreNoPolynomials) {
  class Bent : public RandomForm {
   public:
    using RandomForm::RandomForm;
    class Other : public Own {
     public:
      using Own::Own;
      bool with_random(std::span<const double> q, BlockArray::RowMatrix& B, BlockArray::RowMatrix& Z) override {
        Own::with_random(q, B, Z);
        B(0, 0) += 1e-3 * std::cos(0.7 * q[0]);
        return true;
      }
    };
    std::unique_ptr<Evaluator> evaluator() const override { return std::make_unique<Other>(*this); }
  };
  Random random(23, 2);
  const Bent form(2, 1.0, random);
  const Eigen::MatrixXd T = random_factor(1.0, random);
  EXPECT_FALSE(ReadingNoiseSensitivity(form, T, 3, 1, Monitor{}).defined());
}

}  // namespace
}  // namespace posewright
