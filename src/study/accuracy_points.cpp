#include "posewright/study/accuracy_points.hpp"

#include <cmath>

#include "posewright/model/instrument_choice.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/study/accuracy_configurations.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/error.hpp"

namespace posewright {

Problem with_pose_seen(Problem problem) {
  PoseMeasurement pose;
  pose.covariance.setIdentity();
  const auto* arm = std::get_if<SerialArmSpec>(&problem.robot);
  if (arm == nullptr || arm->ways.empty()) problem.measurement = {};
  for_each_instrument(problem.measurement, [&](MeasurementSpec& instrument) {
    MeasurementSpec seen;
    seen.instrument = pose;
    seen.name = instrument.name;
    seen.of = instrument.of;
    seen.in = instrument.in;
    instrument = std::move(seen);
  });
  return problem;
}

std::span<const double> seen_configuration(const IdentificationModel& model, std::span<const double> q, int tip) {
  if (!model.moving_coordinates().empty()) return q;
  return q.subspan(std::size_t(tip) * model.tip_coordinates(), model.tip_coordinates());
}

std::unique_ptr<IdentificationModel> make_pose_seen(const Variant& variant) {
  Problem seen = with_pose_seen(*variant.problem);
  seen.parameters.reset();
  if (auto* arm = std::get_if<SerialArmSpec>(&seen.robot)) arm->parameter_names.clear();
  VariantSpec plain = *variant.spec;
  plain.nominal.clear();
  std::unique_ptr<IdentificationModel> result = make_model({seen, plain});
  for (int i = 0; i < int(result->parameters().size()); ++i) {
    const Parameter& own = result->parameters()[std::size_t(i)];
    for (const Parameter& p : variant.model->parameters())
      if (p.name == own.name && p.nominal != own.nominal) {
        result->set_nominal(i, p.nominal);
        break;
      }
  }
  return result;
}

namespace {

/// The robot with its pose seen, and what its parameters do to a point of the tip.
class SeenPoses {
 public:
  SeenPoses(const Variant& variant, const VariantColumns& columns)
      : model_(make_pose_seen(variant)), columns_(Eigen::Index(columns.selected.size())) {
    // Columns by name: the instrument's own (targets, stations, a lens) do not move the robot.
    for (std::size_t j = std::size_t(columns.nuisance); j < columns.selected.size(); ++j) {
      const std::string& name = variant.model->parameters()[std::size_t(columns.selected[j])].name;
      for (int i = 0; i < int(model_->parameters().size()); ++i)
        if (model_->parameters()[std::size_t(i)].name == name) {
          selected_.push_back(i);
          where_.push_back(int(j));
        }
    }
    for (int k = 0; k < 6; ++k) selected_.push_back(model_->tip_column(0, k));
  }

  const IdentificationModel& model() const { return *model_; }

  bool at(const std::vector<double>& q, const Eigen::Vector3d& point, TestPoint& test, TestPlace& place) {
    if (!model_->linearise(q, {}, selected_, scratch_)) return false;
    test = {Eigen::MatrixXd::Zero(3, columns_), 1.0, Eigen::MatrixXd::Zero(3, columns_)};
    const Eigen::Vector3d from_tip = model_->tool_pose(q).linear() * point;
    auto G = scratch_.G.middleRows<6>(pose_row(model_->coordinates(), q));
    for (Eigen::Index c = 0; c < G.cols(); ++c)
      G.col(c).head<3>() += Eigen::Vector3d(G.col(c).tail<3>()).cross(from_tip);
    for (std::size_t c = 0; c < where_.size(); ++c) {
      test.A.col(where_[c]) = G.col(Eigen::Index(c)).head<3>();
      test.turn.col(where_[c]) = G.col(Eigen::Index(c)).tail<3>();
    }
    place = {q, G.rightCols<6>()};
    return true;
  }

 private:
  std::unique_ptr<IdentificationModel> model_;
  Eigen::Index columns_;
  std::vector<int> selected_, where_;
  Linearisation scratch_;
};

}  // namespace

std::vector<TestPoint> test_points_of(const Variant& variant, const VariantColumns& columns, std::uint64_t seed,
                                      std::vector<TestPlace>* test_places) {
  const Problem& problem = *variant.problem;
  std::vector<TestPoint> points;
  if (!problem.design.test_poses) return points;
  if (std::holds_alternative<CompensatorGeometrySpec>(problem.robot))
    throw CannotDo("design: test_poses are those of a robot with a tip; a compensator alone has none");
  const TestPosesSpec& spec = *problem.design.test_poses;
  SeenPoses seen(variant, columns);
  const TestConfigurations places = test_configurations(variant, seen.model(), seed);
  for (const std::vector<double>& q : places.configurations) {
    TestPoint point;
    TestPlace place;
    if (!seen.at(q, spec.point, point, place))
      throw InputError(problem.at(spec.line), "a test pose is out of reach", "configurations that the robot can take");
    if (!places.weights.empty()) point.weight = places.weights[points.size()];
    points.push_back(std::move(point));
    if (test_places != nullptr) test_places->push_back(std::move(place));
  }
  return points;
}

std::vector<TestPoint> test_points_at(const Variant& variant, const std::vector<std::vector<double>>& configurations,
                                      std::vector<TestPlace>& test_places) {
  SeenPoses seen(variant, variant.columns);
  std::vector<TestPoint> points;
  for (const std::vector<double>& q : configurations) {
    TestPoint point;
    TestPlace place;
    if (!seen.at(q, Eigen::Vector3d::Zero(), point, place)) continue;
    points.push_back(std::move(point));
    test_places.push_back(std::move(place));
  }
  return points;
}

std::vector<PlaceError> place_errors(const std::vector<TestPoint>& points, const Eigen::MatrixXd& covariance) {
  std::vector<PlaceError> errors;
  for (const TestPoint& t : points)
    errors.push_back({t.A * covariance * t.A.transpose(), t.turn * covariance * t.turn.transpose()});
  return errors;
}

double predicted_error(const std::vector<TestPoint>& points, const std::vector<PlaceError>& errors,
                       std::vector<double>& each) {
  double sum = 0, total = 0;
  each.clear();
  for (std::size_t t = 0; t < points.size(); ++t) {
    const double variance = errors[t].position.trace();
    each.push_back(std::sqrt(variance));
    sum += points[t].weight * variance;
    total += points[t].weight;
  }
  return std::sqrt(sum / total);
}

double predicted_error(const std::vector<TestPoint>& points, const Eigen::MatrixXd& covariance,
                       std::vector<double>& each) {
  return predicted_error(points, place_errors(points, covariance), each);
}

double predicted_turn(const std::vector<TestPoint>& points, const std::vector<PlaceError>& errors,
                      std::vector<std::array<double, 6>>& axes) {
  double sum = 0, total = 0;
  axes.clear();
  for (std::size_t t = 0; t < points.size(); ++t) {
    const Eigen::Vector3d moved = errors[t].position.diagonal(), turned = errors[t].turn.diagonal();
    std::array<double, 6> sigma{};
    for (std::size_t k = 0; k < 3; ++k) {
      sigma[k] = std::sqrt(moved[Eigen::Index(k)]);
      sigma[k + 3] = std::sqrt(turned[Eigen::Index(k)]);
    }
    axes.push_back(sigma);
    sum += points[t].weight * turned.sum();
    total += points[t].weight;
  }
  return std::sqrt(sum / total);
}

}  // namespace posewright
