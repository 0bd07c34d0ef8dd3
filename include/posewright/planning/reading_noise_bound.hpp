#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "posewright/planning/bounded_sensitivity.hpp"
#include "posewright/planning/harmonic_function.hpp"

namespace posewright {

class HarmonicLimits;

/// d(q) of a form with random columns Z as tensors (theory.md eq. (60), (61)): on each box the sum of ‖B T‖², Z_jᵀB_c
/// and Z_jᵀZ_i with factors that follow from the box's U. Each has the degrees that it turns out to have along random
/// lines, which are far below those of ‖B T‖².
class ReadingNoiseSensitivity : public BoundedSensitivity {
 public:
  /// Interpolates all of them.
  /// @param T  columns × any; it must outlive this
  /// Throws nothing of its own: defined() says whether all is as the form says, and nothing stopped it.
  ReadingNoiseSensitivity(const HarmonicForm& form, const Eigen::MatrixXd& T, std::uint64_t seed, int threads,
                          const Monitor& monitor);
  ~ReadingNoiseSensitivity() override;

  /// Coefficients of all tensors at most.
  static double cost(const HarmonicForm& form);

  const HarmonicForm& form() const override { return form_; }
  bool defined() const override { return defined_; }
  std::vector<SearchBox> first_boxes() const override;
  std::unique_ptr<BoxJudge> judge(const Refutation* refutation = nullptr) const override;
  double size() const override;
  double work() const override;

 private:
  friend class ReadingNoiseJudge;
  /// Products of one degree.
  struct Group {
    std::vector<int> degrees;
    std::vector<std::size_t> products{};  ///< which: see RandomProducts::products()
    std::vector<std::size_t> places{};    ///< of their coefficients among those of all of their kind
    Eigen::MatrixXd coefficients{};       ///< places × products
  };
  /// All of Z_jᵀB_c, or of Z_jᵀZ_i.
  struct Kind {
    std::vector<int> degrees;         ///< of all together
    std::vector<std::size_t> places;  ///< of their coefficients among those of the sum
    std::vector<Group> groups{};
  };
  struct Compared;
  Kind kind(const HarmonicDegrees& degrees, std::size_t first, std::size_t end, const Compared& compared, int threads,
            const Monitor& monitor);
  void interpolate(Group& group, const Compared& compared, int threads, const Monitor& monitor);
  void choose_affine(const Compared& compared);

  const HarmonicForm& form_;
  const Eigen::MatrixXd& divided_T_;   ///< as it was given
  Eigen::MatrixXd T_;                  ///< undivided
  std::vector<int> degrees_;           ///< of the whole sum, but for powers of y
  Group square_;                       ///< ‖B T‖² alone
  Kind mixed_, squares_;               ///< Z_jᵀB_c, and Z_jᵀZ_i
  std::vector<double> errors_, most_;  ///< of each product: more than it is off by; largest coefficient
  std::vector<std::size_t> affine_;    ///< axes along which a box's U changes
  bool defined_ = true;
  std::unique_ptr<const HarmonicLimits> limits_;
};

}  // namespace posewright
