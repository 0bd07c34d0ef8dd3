#pragma once

#include <array>
#include <span>
#include <vector>

#include "posewright/criterion/criterion_data.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

struct Variant;

/// Robot measured by the pose of its tip: no targets, so the tool counts. Where instruments see different tips, each of
/// them measures that of its own, under its name.
Problem with_pose_seen(Problem problem);
/// A configuration of the problem's own model as the one with its pose seen has it.
std::span<const double> seen_configuration(const IdentificationModel& model, std::span<const double> q, int tip = 0);
/// Model of the variant with that measurement, at the nominal values of its own model: values of the instrument's own
/// parameters (targets, stations, a lens) are none of it.
std::unique_ptr<IdentificationModel> make_pose_seen(const Variant& variant);

/// Motion of the point of interest at a test pose by the tip's displacement.
struct TestPlace {
  std::vector<double> q;               ///< as seen_configuration() gives it
  Eigen::Matrix<double, 6, 6> twists;  ///< position and turn of the point of interest along the tip's unit twists
};

/// Position Jacobians of the problem's test poses for these columns of a variant (3 × m, raw, SI); nuisance columns and
/// what does not move the robot are zero. Empty if the problem has none. Throws InputError for configurations that do
/// not fit the robot, CannotDo for a robot without a tip.
std::vector<TestPoint> test_points_of(const Variant& variant, const VariantColumns& columns, std::uint64_t seed,
                                      std::vector<TestPlace>* test_places = nullptr);

/// Overload for the variant's own columns and configurations as seen_configuration() gives them, all of one weight, for
/// the origin of the tip.
std::vector<TestPoint> test_points_at(const Variant& variant, const std::vector<std::vector<double>>& configurations,
                                      std::vector<TestPlace>& test_places);

/// Covariance of the error at a test pose.
struct PlaceError {
  Eigen::Matrix3d position = Eigen::Matrix3d::Zero();  ///< m²
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();      ///< of the rotation vector, rad²
};

/// Errors at every point by parameter errors with this covariance.
std::vector<PlaceError> place_errors(const std::vector<TestPoint>& points, const Eigen::MatrixXd& covariance);

/// Root of the weighted mean square of the predicted position error (m), and that of each point.
double predicted_error(const std::vector<TestPoint>& points, const std::vector<PlaceError>& errors,
                       std::vector<double>& each);
/// Overload for parameter errors with this covariance.
double predicted_error(const std::vector<TestPoint>& points, const Eigen::MatrixXd& covariance,
                       std::vector<double>& each);
/// Orientation error (norm of the rotation vector, rad), and 1σ of every point along x, y, z (m) and about
/// them (rad), in the measurement frame.
double predicted_turn(const std::vector<TestPoint>& points, const std::vector<PlaceError>& errors,
                      std::vector<std::array<double, 6>>& axes);

}  // namespace posewright
