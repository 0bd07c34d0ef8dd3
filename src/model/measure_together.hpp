#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "posewright/model/measurement_model.hpp"
#include "posewright/problem/measurement_specs.hpp"

namespace posewright {

/// Instruments of a list that read the same visit: the rows of one after those of the other, with independent noise.
/// Parameters and readings have the names that the list gives them ("target@NAME.P1.x", "NAME.P1.x").
class TogetherModel : public MeasurementModel {
 public:
  /// @param spec  with TogetherMeasurement, whose members have targets that stand for the tool, all or none
  explicit TogetherModel(const MeasurementSpec& spec);

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override;
  bool reads_from_nominal() const override;
  void difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                  Eigen::VectorXd& out) const override;
  void shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change, Eigen::VectorXd& out) const override;
  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override;
  void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const override;
  void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const override;
  Twist pull_back(const Sighting& sighting, const Adjoint& f) const override;
  bool sees(const Sighting& sighting) const override;
  std::optional<int> margins() const override;
  void margins_at(const Sighting& sighting, std::span<double> out) const override;

 private:
  struct Member {
    std::unique_ptr<MeasurementModel> model;
    int first_row = 0, own = 0;  ///< `own`: index of its first own parameter
    double variance = 1.0;       ///< of its readings, times that of the model
  };
  /// The sighting as it is one of the member.
  static Sighting of(const Member& member, const Sighting& sighting);
  template <class Apply>
  void member_by_member(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::VectorXd& out,
                        const Apply& apply) const;
  Adjoint adjoint_of(const Member& member, const Sighting& sighting, const Adjoint& f) const;

  std::vector<Member> members_;
};

}  // namespace posewright
