#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "posewright/planning/configuration_space.hpp"
#include "posewright/proof/harmonic_form.hpp"
#include "posewright/support/taylor_model.hpp"
#include "posewright/workspace/space_part.hpp"

namespace posewright {

struct WeightedConfigurations {
  std::vector<std::vector<double>> configurations;
  std::vector<double> weights;
};

/// A space that bounds ‖J(q) T‖² of the task's blocks over boxes of its axes: then the largest value can be proved.
class BoundedSpace : public ConfigurationSpace {
 public:
  /// ‖J(q) T‖² by Taylor models, for one T and one thread.
  class Enclosure {
   public:
    virtual ~Enclosure() = default;
    /// Functions that are not negative at feasible configurations; other configurations may pass, too.
    /// @param q  one a coordinate, over the box
    /// @return false if the box has no enclosure
    virtual bool allowed(std::span<const TaylorModel> q, std::vector<TaylorModel>& limits) = 0;
    /// Limits of all allowed values; the model is undefined elsewhere.
    virtual bool sensitivity(std::span<const TaylorModel> q, TaylorModel& d) = 0;
  };

  /// Harmonic forms that bound it for any T, or why there are none.
  /// @param where  configurations at which bounds that can be chosen ought to be good
  virtual HarmonicForms harmonic_forms(const WeightedConfigurations& where) const = 0;
  /// Null if the space has none.
  virtual std::unique_ptr<Enclosure> enclosure(const Eigen::MatrixXd& T) const = 0;
};

/// Harmonic forms of these parts' blocks, one for each choice of the discrete axes. Everything referred to must outlive
/// them.
/// @param R  blocks are J_raw R⁻¹
HarmonicForms harmonic_forms_of(const std::vector<SpacePart>& parts, const std::vector<ConfigurationSpace::Axis>& axes,
                                const Eigen::MatrixXd& R, const WeightedConfigurations& where);

/// Enclosure of these parts' blocks J_raw R⁻¹; null if there is none. Parts must outlive it.
std::unique_ptr<BoundedSpace::Enclosure> enclosure_of(const std::vector<SpacePart>& parts, const Eigen::MatrixXd& R,
                                                      const Eigen::MatrixXd& T);

}  // namespace posewright
