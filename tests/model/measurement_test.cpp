// Every instrument: rows against automatic differentiation, covariances against their definition.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "posewright/model/explicit_model.hpp"
#include "posewright/model/measurement_factory.hpp"
#include "posewright/model/serial_chain.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/support/error.hpp"
#include "src/model/compensator_geometry.hpp"
#include "src/model/distance_pair_model.hpp"
#include "src/model/pinhole.hpp"
#include "tests/kit/jets.hpp"
#include "tests/kit/random_chain.hpp"
#include "tests/kit/residuals.hpp"

namespace posewright {
namespace {

using Vector = Eigen::Matrix<Jet, 3, 1>;

const std::vector<TargetSpec> targets = {{"A", {0.1, 0.2, -0.3}, 0}, {"B", {-0.2, 0.05, 0.4}, 0}};

Placement placement(std::uint64_t seed, double distance) {
  Random random(seed, 9);
  Placement p;
  for (int k = 0; k < 3; ++k) p.position[k] = distance * random.uniform(-1, 1), p.rpy[k] = random.uniform(-1, 1);
  return p;
}

Eigen::Isometry3d at(const Placement& p) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return Eigen::Translation3d(p.position) * AngleAxisd(p.rpy.z(), Vector3d::UnitZ()) *
         AngleAxisd(p.rpy.y(), Vector3d::UnitY()) * AngleAxisd(p.rpy.x(), Vector3d::UnitX());
}

MeasurementSpec spec_of(InstrumentSpec instrument) {
  MeasurementSpec spec;
  spec.instrument = std::move(instrument);
  return spec;
}

struct Arm {
  ChainDescription chain = random_chain(7, true, false);
  ChainLayout layout{chain};

  /// Tip of the arm; the instrument's parameters follow the chain's without its tool.
  Frame<Jet> tip(const double* q, const std::vector<Jet>& d) const {
    std::vector<Jet> all(d.begin(), d.begin() + layout.tool);
    all.resize(std::size_t(layout.count), Jet(0.0));
    return tip_pose<Jet>(chain, layout, q, all.data());
  }
  const Jet* own(const std::vector<Jet>& d) const { return d.data() + layout.tool; }
  ExplicitModel with(const MeasurementSpec& spec) const {
    return {std::make_unique<SerialChain>(chain), make_measurement(spec)};
  }
};

Vector moved(const Eigen::Vector3d& p, const Jet* d) { return p.cast<Jet>() + Vector(d[0], d[1], d[2]); }

PointsMeasurement from_two_stations(PointNoise noise) {
  return {targets, noise, {{"S", placement(1, 3)}, {"T", placement(2, 3)}}, {0, 1, 2}};
}

TEST(Points, RowsFromSeveralStationsEqualAutomaticDifferentiation) {
  const Arm arm;
  PointsMeasurement points = from_two_stations(GaussianNoise{1e-8 * Eigen::Matrix3d::Identity()});
  points.components = {0, 2};
  const ExplicitModel model = arm.with(spec_of(points));
  ASSERT_EQ(model.coordinates().back().name, "station");
  const auto oracle = [&](const std::vector<double>& q, const std::vector<Jet>& d) {
    const int station = int(q.back());
    const Frame<Jet> tip = arm.tip(q.data(), d);
    const Jet* own = arm.own(d);
    const Frame<Jet> from = displaced(at(points.stations[std::size_t(station)].placement), own + 6 + 6 * station);
    std::vector<Jet> rows;
    for (std::size_t t = 0; t < 2; ++t) {
      const Vector p = seen_from(from, tip * moved(targets[t].position, own + 3 * t));
      rows.insert(rows.end(), {p[0], p[2]});
    }
    return rows;
  };
  for (const double size : {0.0, 1.0, 100.0}) EXPECT_LT(worst_model_error(model, 1000, size, 1, oracle), 1e-9);
}

TEST(Points, TrackerNoiseIsAnEllipsoidAlongTheLineOfSight) {
  const Arm arm;
  const TrackerNoise noise{2e-6, 1e-6, 4e-6, 5e-6};
  MeasurementSpec spec = spec_of(from_two_stations(noise));
  spec.repeats = 4;
  const auto instrument = make_measurement(spec);
  const Eigen::Isometry3d X = at(placement(5, 1));
  for (int station = 0; station < 2; ++station) {
    Eigen::MatrixXd covariance(6, 6);
    instrument->covariance({X, {}, station}, covariance);
    const auto& stations = std::get<PointsMeasurement>(spec.instrument).stations;
    const Eigen::Vector3d p = at(stations[std::size_t(station)].placement).inverse() * (X * targets[1].position);
    const Eigen::Matrix3d block = covariance.bottomRightCorner<3, 3>();
    const double R = p.norm(), along = 2e-6 + 1e-6 * R, across = 4e-6 + 5e-6 * R;
    EXPECT_NEAR(p.dot(block * p) / (R * R), along * along / 4, 1e-20);
    const Eigen::Vector3d side = p.unitOrthogonal();
    EXPECT_NEAR(side.dot(block * side), across * across / 4, 1e-20);
    EXPECT_LT((block * p - p * (along * along / 4)).norm(), 1e-18) << "an axis of the ellipsoid";
    EXPECT_EQ((covariance.topRightCorner<3, 3>().norm()), 0);
  }
}

TEST(Points, OneStationInTheOriginIsNoStation) {
  const Arm arm;
  PointsMeasurement points{targets, GaussianNoise{1e-8 * Eigen::Matrix3d::Identity()}, {}, {0, 1, 2}};
  const ExplicitModel plain = arm.with(spec_of(points));
  points.stations = {{"S", {}}};
  const ExplicitModel named = arm.with(spec_of(points));
  Random random(1, 1);
  std::vector<double> q = random_configuration(plain.coordinates(), random);
  Linearisation a, b;
  const std::vector<int> shared = all_parameters(plain);
  ASSERT_TRUE(plain.linearise(q, {}, shared, a));
  q.push_back(0);
  ASSERT_TRUE(named.linearise(q, {}, shared, b));
  EXPECT_LT((a.G - b.G).norm(), 1e-14);
  EXPECT_LT((a.covariance - b.covariance).norm(), 1e-20);
}

TEST(Distance, RowsToAnchorsEqualAutomaticDifferentiation) {
  const Arm arm;
  DistanceMeasurement distance;
  distance.targets = targets;
  distance.anchors = {{"P", {2, 0.3, -1}, 0}, {"Q", {-1, 2, 0.5}, 0}, {"R", {0.2, -0.4, 3}, 0}};
  distance.sigma = 1e-5;
  const ExplicitModel model = arm.with(spec_of(distance));
  const auto oracle = [&](const std::vector<double>& q, const std::vector<Jet>& d) {
    const Frame<Jet> tip = arm.tip(q.data(), d);
    const Jet* own = arm.own(d);
    std::vector<Jet> rows;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t t = 0; t < 2; ++t) {
        const Vector between =
            tip * moved(targets[t].position, own + 3 * t) - moved(distance.anchors[a].position, own + 6 + 3 * a);
        rows.push_back(sqrt(between.dot(between)) + own[15 + a]);
      }
    return rows;
  };
  for (const double size : {0.0, 1.0, 10.0}) EXPECT_LT(worst_model_error(model, 1000, size, 2, oracle), 1e-9);
}

TEST(Distance, NoiseGrowsWithTheDistanceAndTheRangeIsKept) {
  const Arm arm;
  DistanceMeasurement distance;
  distance.targets = {targets[0]};
  distance.anchors = {{"P", {2, 0, 0}, 0}};
  distance.sigma = 1e-5;
  distance.sigma_per_m = 2e-6;
  distance.range_lower = 0.5, distance.range_upper = 1.0;
  const auto instrument = make_measurement(spec_of(distance));
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Vector3d(1.2, 0, 0) - targets[0].position;
  Eigen::MatrixXd covariance(1, 1);
  instrument->covariance({X, {}, 0}, covariance);
  EXPECT_NEAR(std::sqrt(covariance(0, 0)), 1e-5 + 0.8 * 2e-6, 1e-18);
  EXPECT_TRUE(instrument->sees({X, {}, 0}));
  X.translation().x() = -1;
  EXPECT_FALSE(instrument->sees({X, {}, 0}));
}

TEST(Plane, RowsEqualAutomaticDifferentiation) {
  const Arm arm;
  PlaneMeasurement plane;
  plane.probe = {"probe", {0.1, 0.2, -0.3}, 0};
  plane.point = {0.4, -0.2, 0.7};
  plane.normal = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  plane.radius = 100, plane.range_lower = -100, plane.range_upper = 100, plane.sigma = 1e-5;
  const ExplicitModel model = arm.with(spec_of(plane));
  // x is the axis most across the normal.
  const Eigen::Vector3d v = plane.normal.cross(Eigen::Vector3d::UnitX()).normalized(), u = v.cross(plane.normal);
  const auto oracle = [&](const std::vector<double>& q, const std::vector<Jet>& d) {
    const Jet* own = arm.own(d);
    Vector n = plane.normal.cast<Jet>() + own[4] * u.cast<Jet>() + own[5] * v.cast<Jet>();
    n = (n / sqrt(n.dot(n))).eval();
    const Vector from = arm.tip(q.data(), d) * moved(plane.probe.position, own) - plane.point.cast<Jet>();
    return std::vector<Jet>{n.dot(from) - own[3]};
  };
  for (const double size : {0.0, 1.0, 10.0}) EXPECT_LT(worst_model_error(model, 1000, size, 3, oracle), 1e-9);
}

TEST(Plane, IsReachedWithinItsRangeAndItsRadius) {
  PlaneMeasurement plane;
  plane.probe = {"probe", {0, 0, 0.1}, 0};
  plane.point = {1, 0, 0.5};
  plane.radius = 0.2, plane.range_lower = -1e-3, plane.range_upper = 2e-3, plane.sigma = 1e-5;
  const auto instrument = make_measurement(spec_of(plane));
  const auto sees = [&](double x, double above) {
    const Eigen::Isometry3d X(Eigen::Translation3d(x, 0, 0.4 + above));
    return instrument->sees({X, {}, 0});
  };
  EXPECT_TRUE(sees(1.19, 1.9e-3));
  EXPECT_FALSE(sees(1.21, 1.9e-3));
  EXPECT_FALSE(sees(1.19, 2.1e-3));
  EXPECT_FALSE(sees(1.19, -1.1e-3));
}

LineMeasurement wide_line() {
  LineMeasurement line;
  line.sensor = placement(5, 0.3);
  line.point = {0.4, -0.2, 0.7};
  line.direction = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  line.length = 200, line.width = 200, line.range_lower = -100, line.range_upper = 100, line.sigma = 1e-5;
  return line;
}

TEST(Line, RowsEqualAutomaticDifferentiation) {
  const Arm arm;
  const LineMeasurement line = wide_line();
  const ExplicitModel model = arm.with(spec_of(line));
  // x is the axis most across the direction.
  const Eigen::Vector3d v = line.direction.cross(Eigen::Vector3d::UnitX()).normalized(), u = v.cross(line.direction);
  const auto oracle = [&](const std::vector<double>& q, const std::vector<Jet>& d) {
    const Jet* own = arm.own(d);
    Frame<Jet> sensor = arm.tip(q.data(), d);
    sensor.then(at(line.sensor));
    sensor.then_displace(own);
    const Vector along = line.direction.cast<Jet>() + own[8] * u.cast<Jet>() + own[9] * v.cast<Jet>();
    const Vector p = line.point.cast<Jet>() + own[6] * u.cast<Jet>() + own[7] * v.cast<Jet>();
    const Vector a = seen_from(sensor, p), b = seen_from(sensor, p + along);
    const Jet share = a[1] / (a[1] - b[1]);
    return std::vector<Jet>{a[0] + share * (b[0] - a[0]), a[2] + share * (b[2] - a[2])};
  };
  for (const double size : {0.0, 1.0, 10.0}) EXPECT_LT(worst_model_error(model, 1000, size, 3, oracle), 1e-9);
}

TEST(Line, IsSeenWithinRangeAndFieldWhereItCrossesTheLight) {
  LineMeasurement line;
  line.point = {0, 0, 0.5};
  line.direction = {0, 1, 0};
  line.length = 0.4, line.width = 0.1, line.range_lower = 0.1, line.range_upper = 0.3, line.sigma = 1e-5;
  const auto instrument = make_measurement(spec_of(line));
  const auto sees = [&](double x, double y, double z, double turn) {
    const Eigen::Isometry3d X = Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
    return instrument->sees({X, {}, 0});
  };
  EXPECT_TRUE(sees(0.04, 0.19, 0.21, 0));
  EXPECT_FALSE(sees(0.06, 0, 0.3, 0)) << "beside the field";
  EXPECT_FALSE(sees(0, 0.21, 0.3, 0)) << "beyond the end";
  EXPECT_FALSE(sees(0, 0, 0.19, 0)) << "too far";
  EXPECT_FALSE(sees(0, 0, 0.41, 0)) << "too near";
  EXPECT_TRUE(sees(0, 0, 0.3, 1.3));
  EXPECT_FALSE(sees(0, 0, 0.3, 1.4)) << "along the light";
}

TEST(Inclination, RowsEqualAutomaticDifferentiation) {
  const Arm arm;
  InclinationMeasurement inclination;
  inclination.axes = {0, 2};
  inclination.rpy = {0.4, -0.3, 1.2};
  inclination.up = Eigen::Vector3d(0.1, -0.2, 1).normalized();
  inclination.range = 1.5, inclination.sigma = 1e-4;
  const ExplicitModel model = arm.with(spec_of(inclination));
  const Eigen::Matrix3d R_TipSensor = at({Eigen::Vector3d::Zero(), inclination.rpy}).linear();
  const auto oracle = [&](const std::vector<double>& q, const std::vector<Jet>& d) {
    const Frame<Jet> tip = tip_pose<Jet>(arm.chain, arm.layout, q.data(), d.data());
    std::vector<Jet> rows;
    for (const int axis : inclination.axes) {
      const Vector s = tip.R * R_TipSensor.col(axis).cast<Jet>();
      rows.push_back(asin(s.dot(inclination.up.cast<Jet>())));
    }
    return rows;
  };
  for (const double size : {0.0, 1.0, 10.0}) EXPECT_LT(worst_model_error(model, 1000, size, 4, oracle), 1e-9);
}

/// One or two angles: fixed and on the hand, rows at the nominal parameters are those of the small rotation from the
/// nominal orientation.
TEST(Pose, SomeOfItsAnglesAreThoseOfTheSmallRotationFromTheNominalOrientation) {
  const Arm arm;
  for (const bool on_hand : {false, true}) {
    PoseMeasurement pose;
    pose.covariance.setIdentity();
    pose.components = {2, 3, 4};
    pose.on_hand = on_hand;
    const ExplicitModel model = arm.with(spec_of(pose));
    const auto oracle = [&](const std::vector<double>& q, const std::vector<Jet>& d) {
      const auto seen = [&](const std::vector<Jet>& at) {
        Frame<Jet> tip = tip_pose<Jet>(arm.chain, arm.layout, q.data(), at.data());
        if (on_hand) tip = {tip.R.transpose(), -(tip.R.transpose() * tip.p)};
        return tip;
      };
      const Frame<Jet> now = seen(d);
      const Eigen::Matrix<Jet, 3, 3> turn = now.R * seen(std::vector<Jet>(d.size(), Jet(0.0))).R.transpose();
      // Of a small rotation the skew part is the rotation vector.
      return std::vector<Jet>{now.p[2], 0.5 * (turn(2, 1) - turn(1, 2)), 0.5 * (turn(0, 2) - turn(2, 0))};
    };
    EXPECT_LT(worst_model_error(model, 1000, 0.0, 5, oracle), 1e-9) << on_hand;
    // Readings too, for corrections whose squares are under rounding's reach.
    Random random(8, 1);
    const std::vector<double> q = random_configuration(model.coordinates(), random);
    std::vector<double> correction(model.parameters().size());
    for (double& c : correction) c = 1e-6 * random.uniform(-1, 1);
    Eigen::VectorXd y;
    ASSERT_TRUE(model.predict(q, correction, y));
    const std::vector<Jet> expected = oracle(q, {correction.begin(), correction.end()});
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(y[i], expected[std::size_t(i)].a, 1e-15) << i;
  }
}

TEST(DistancePair, RowsEqualAutomaticDifferentiationAndTheBaseHasNoEffect) {
  const Arm arm;
  DistanceMeasurement distance;
  distance.targets = targets;
  distance.sigma = 1e-5;
  const DistancePairModel model(std::make_unique<SerialChain>(arm.chain), spec_of(distance));
  ASSERT_EQ(model.coordinates().size(), 12U);
  const auto oracle = [&](const std::vector<double>& q, const std::vector<Jet>& d) {
    const Frame<Jet> first = arm.tip(q.data(), d), second = arm.tip(q.data() + 6, d);
    std::vector<Jet> rows;
    for (std::size_t t = 0; t < 2; ++t) {
      const Vector p = moved(targets[t].position, arm.own(d) + 3 * t);
      const Vector between = second * p - first * p;
      rows.push_back(sqrt(between.dot(between)));
    }
    return rows;
  };
  for (const double size : {0.0, 1.0}) EXPECT_LT(worst_model_error(model, 1000, size, 3, oracle), 1e-9);
  Linearisation out;
  Random random(4, 4);
  ASSERT_TRUE(model.linearise(random_configuration(model.coordinates(), random), {}, all_parameters(model), out));
  EXPECT_LT(out.G.leftCols<6>().cwiseAbs().maxCoeff(), 1e-12);
}

CameraMeasurement camera(bool on_hand) {
  CameraMeasurement c;
  c.fx = 900, c.fy = 880, c.cx = 640, c.cy = 480;
  c.distortion = {-0.2, 0.05, 1e-3, -2e-3, 0.01};
  c.width = 1280, c.height = 960;
  c.on_hand = on_hand;
  c.rows = 3, c.columns = 4;
  c.spacing = 0.03;
  c.sigma = 0.2;
  return c;
}

/// A camera and a board that see each other for joints near zero, by putting the fixed one where the other looks.
CameraMeasurement facing(const Arm& arm, bool on_hand) {
  CameraMeasurement c = camera(on_hand);
  const std::vector<Jet> none(std::size_t(arm.layout.tool), Jet(0.0));
  const std::vector<double> zero(6, 0.0);
  const Frame<Jet> tip = arm.tip(zero.data(), none);
  Eigen::Isometry3d X_MeasureTip = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    X_MeasureTip.translation()[i] = tip.p[i].a;
    for (int j = 0; j < 3; ++j) X_MeasureTip.linear()(i, j) = tip.R(i, j).a;
  }
  Eigen::Isometry3d X_CameraBoard = Eigen::Isometry3d::Identity();
  X_CameraBoard.translation() = Eigen::Vector3d(-0.05, -0.03, 0.6);
  const Placement hand = placement(11, 0.1);
  const Eigen::Isometry3d X_MeasureHand = X_MeasureTip * at(hand);
  const Eigen::Isometry3d fixed = on_hand ? X_MeasureHand * X_CameraBoard : X_MeasureHand * X_CameraBoard.inverse();
  Placement there;
  there.position = fixed.translation();
  const Eigen::Vector3d zyx = fixed.linear().eulerAngles(2, 1, 0);
  there.rpy = {zyx[2], zyx[1], zyx[0]};
  (on_hand ? c.camera : c.board) = hand;
  (on_hand ? c.board : c.camera) = there;
  return c;
}

TEST(Camera, RowsEqualAutomaticDifferentiationEyeInHandAndEyeToHand) {
  Arm arm;
  for (Coordinate& c : arm.chain.coordinates) c.lower = -0.08, c.upper = 0.08;
  for (const bool on_hand : {true, false}) {
    const CameraMeasurement c = facing(arm, on_hand);
    const ExplicitModel model = arm.with(spec_of(c));
    EXPECT_EQ(model.rows(), 24);
    const auto oracle = [&](const std::vector<double>& q, const std::vector<Jet>& d) {
      const Jet* own = arm.own(d);
      const Frame<Jet> tip = arm.tip(q.data(), d);
      const auto carried = [&](const Placement& p, const Jet* correction, bool by_tip) {
        Frame<Jet> frame = by_tip ? tip : Frame<Jet>{};
        frame.then(at(p));
        frame.then_displace(correction);
        return frame;
      };
      const Frame<Jet> eye = carried(c.camera, own, on_hand), board = carried(c.board, own + 6, !on_hand);
      Jet lens[9] = {own[12] + c.fx, own[13] + c.fy, own[14] + c.cx, own[15] + c.cy};
      for (std::size_t k = 0; k < 5; ++k) lens[4 + k] = own[16 + k] + c.distortion[k];
      std::vector<Jet> rows;
      for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 4; ++k) {
          const Vector point = Eigen::Vector3d(k * 0.03, r * 0.03, 0).cast<Jet>() * (own[21] + 1.0);
          const Vector p = seen_from(eye, board * point);
          Jet pixel[2];
          project(p.data(), lens, pixel);
          rows.insert(rows.end(), {pixel[0], pixel[1]});
        }
      return rows;
    };
    for (const double size : {0.0, 0.1}) EXPECT_LT(worst_model_error(model, 250, size, 5, oracle), 1e-9) << on_hand;
  }
}

TEST(Camera, BlocksOfManyPixelsHaveFewRowsAndTheSameInformation) {
  Arm arm;
  for (Coordinate& c : arm.chain.coordinates) c.lower = -0.05, c.upper = 0.05;
  const ExplicitModel model = arm.with(spec_of(facing(arm, true)));
  Random random(6, 0);
  const std::vector<int> all = all_parameters(model);
  EXPECT_EQ(model.block_rows(all), 16) << "six for the motion, nine for the lens, one for the board";
  const auto m = Eigen::Index(all.size());
  for (int i = 0; i < 20; ++i) {
    const std::vector<double> q = random_configuration(model.coordinates(), random);
    Linearisation scratch;
    std::vector<double> out(16 * all.size());
    ASSERT_TRUE(whitened_block(model, q, {}, all, scratch, out.data(), int(all.size())));
    const Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> J(out.data(), 16, m);
    ASSERT_TRUE(model.linearise(q, {}, all, scratch));
    const Eigen::MatrixXd expected = scratch.G.transpose() * scratch.covariance.inverse() * scratch.G;
    EXPECT_LT((J.transpose() * J - expected).norm(), 1e-10 * expected.norm());
  }
}

TEST(Camera, ABoardBehindTheCameraIsNotSeen) {
  const auto instrument = make_measurement(spec_of(camera(true)));  // camera and board in the same place, at z = 0
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Vector3d(0.05, 0.03, -0.5);
  EXPECT_TRUE(instrument->sees({X, {}, 0}));
  X.translation().z() = 0.5;
  EXPECT_FALSE(instrument->sees({X, {}, 0})) << "behind";
  X.translation() = Eigen::Vector3d(2, 0, -0.5);
  EXPECT_FALSE(instrument->sees({X, {}, 0})) << "outside the image";
}

TEST(Pose, PhotogrammetryGivesTheCovarianceOfTheRigidFit) {
  // Monte Carlo: fit a pose to noisy points, compare the scatter with the covariance.
  PoseMeasurement pose;
  pose.photogrammetry = {{"A", {0.18, 0, 0}, 0}, {"B", {0, 0.18, 0.02}, 0}, {"C", {-0.18, 0, 0}, 0}};
  pose.point_sigma = 3e-6;
  const auto instrument = make_measurement(spec_of(pose));
  const Eigen::Isometry3d X = at(placement(8, 0.5));
  Eigen::MatrixXd covariance(6, 6);
  instrument->covariance({X, {}, 0}, covariance);
  Random random(3, 3);
  Eigen::Matrix3Xd model(3, 3), measured(3, 3);
  for (int i = 0; i < 3; ++i) model.col(i) = pose.photogrammetry[std::size_t(i)].position;
  Eigen::Matrix<double, 6, 6> scatter = Eigen::Matrix<double, 6, 6>::Zero();
  constexpr int draws = 20000;
  for (int i = 0; i < draws; ++i) {
    for (int k = 0; k < 3; ++k) {
      measured.col(k) = X * Eigen::Vector3d(model.col(k));
      for (int c = 0; c < 3; ++c) measured(c, k) += 3e-6 * random.normal();
    }
    const Eigen::Matrix4d fit = Eigen::umeyama(model, measured, false);
    const Eigen::Matrix3d D = fit.topLeftCorner<3, 3>() * X.linear().transpose();
    Twist error;
    error << fit.topRightCorner<3, 1>() - X.translation(),
        0.5 * Eigen::Vector3d(D(2, 1) - D(1, 2), D(0, 2) - D(2, 0), D(1, 0) - D(0, 1));
    scatter += error * error.transpose() / draws;
  }
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(scatter(k, k) / covariance(k, k), 1, 0.03) << k;
}

TEST(Pose, PointsInLineDoNotFixAPose) {
  PoseMeasurement pose;
  pose.photogrammetry = {{"A", {0, 0, 0}, 0}, {"B", {0.1, 0, 0}, 0}, {"C", {0.2, 0, 0}, 0}};
  pose.point_sigma = 3e-6;
  try {
    make_measurement(spec_of(pose));
    FAIL() << "accepted";
  } catch (const CannotDo& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("three points that are not in line are needed"));
  }
}

TEST(CompensatorGeometry, RowsEqualAutomaticDifferentiation) {
  const CompensatorGeometrySpec spec{0.18472, 0.68593, 0.1233, -2.4, 0, 0};
  PointsMeasurement points;
  points.targets = {{"P0", {0, 0, 0}, 0}, {"P1", {0, 0, 0}, 0}};
  points.noise = GaussianNoise{1e-8 * Eigen::Matrix3d::Identity()};
  const CompensatorGeometry model(spec, spec_of(points));
  const auto oracle = [&](const std::vector<double>& q, const std::vector<Jet>& d) {
    const Frame<Jet> base = displaced(Eigen::Isometry3d::Identity(), d.data() + 4);
    const Jet angle = d[3] + q[0], L = d[0] + spec.L;
    const Vector P0 = base * Vector(-(d[1] + spec.ax), -(d[2] + spec.ay), Jet(0.0));
    const Vector P1 = base * Vector(L * sin(angle), L * cos(angle), Jet(0.0));
    return std::vector<Jet>{P0[0], P0[1], P0[2], P1[0], P1[1], P1[2]};
  };
  for (const double size : {0.0, 1.0}) EXPECT_LT(worst_model_error(model, 1000, size, 1, oracle), 1e-9);
  points.targets.pop_back();
  EXPECT_THROW(CompensatorGeometry(spec, spec_of(points)), CannotDo);
}

TEST(ErrorsInVariables, ScatterOfLinearisedEstimatesMatchesThePredictedCovariance) {
  // Noise on points and joint readings, propagated exactly; the estimate is the weighted linear one.
  ChainDescription chain = random_chain(21, false, false);
  chain.encoder_noise.assign(6, 2e-4);
  PointsMeasurement points{targets, GaussianNoise{1e-8 * Eigen::Matrix3d::Identity()}, {}, {0, 1, 2}};
  const ExplicitModel model(std::make_unique<SerialChain>(chain), make_measurement(spec_of(points)));
  const ChainLayout layout(chain);
  const std::vector<int> selected = {0,
                                     1,
                                     2,
                                     3,
                                     4,
                                     5,
                                     layout.offset[1],
                                     layout.offset[2],
                                     layout.offset[3],
                                     layout.offset[4],
                                     layout.displacement[2],
                                     layout.displacement[3] + 1};
  const auto m = Eigen::Index(selected.size());
  constexpr int poses = 8;
  Random random(9, 0);
  std::vector<std::vector<double>> q;
  Eigen::MatrixXd G(6 * poses, m), W = Eigen::MatrixXd::Zero(6 * poses, 6 * poses);
  Linearisation scratch;
  for (int i = 0; i < poses; ++i) {
    q.push_back(random_configuration(model.coordinates(), random));
    ASSERT_TRUE(model.linearise(q.back(), {}, selected, scratch));
    G.middleRows(6 * i, 6) = scratch.G;
    W.block(6 * i, 6 * i, 6, 6) = scratch.covariance.inverse();
  }
  const Eigen::MatrixXd covariance = (G.transpose() * W * G).inverse();
  const Eigen::MatrixXd estimator = covariance * G.transpose() * W;
  const std::vector<double> zero(std::size_t(layout.count), 0.0);
  const auto readings = [&](const std::vector<double>& joints, Eigen::Ref<Eigen::VectorXd> y) {
    const Frame<double> tip = tip_pose<double>(chain, layout, joints.data(), zero.data());
    for (int t = 0; t < 2; ++t) y.segment<3>(3 * t) = tip.R * targets[std::size_t(t)].position + tip.p;
  };
  constexpr int draws = 20000;
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(m), residual(6 * poses), model_y(6), true_y(6);
  for (int n = 0; n < draws; ++n) {
    for (int i = 0; i < poses; ++i) {
      std::vector<double> actual = q[std::size_t(i)];
      for (double& angle : actual) angle += 2e-4 * random.normal();
      readings(actual, true_y);
      readings(q[std::size_t(i)], model_y);
      for (int k = 0; k < 6; ++k) residual[6 * i + k] = true_y[k] - model_y[k] + 1e-4 * random.normal();
    }
    variance += (estimator * residual).cwiseAbs2() / draws;
  }
  for (Eigen::Index j = 0; j < m; ++j) EXPECT_NEAR(variance[j] / covariance(j, j), 1, 0.03) << j;
}

}  // namespace
}  // namespace posewright
