// From a file of readings to calibrated parameters.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "posewright/calibration/rigid_fit.hpp"
#include "posewright/lists/measured_data.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/mutate.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/virtual_file.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(MeasuredData, ReadsBackWhatItWroteBitForBit) {
  for (const char* file : {"kr270/problem.yaml", "kr270/elastostatic.yaml", "telescope/problem.yaml",
                           "instruments/camera_on_hand.yaml", "instruments/tracker_two_stations.yaml",
                           "instruments/ball_bar.yaml", "five_bar/problem.yaml", "instruments/photogrammetry.yaml"}) {
    VirtualFile data(file, 12);
    const Eigen::Index holes = std::min<Eigen::Index>(2, data.poses[3].y.size() - 1);
    data.poses[3].y.tail(holes).setConstant(std::numeric_limits<double>::quiet_NaN());
    const MeasuredData back = read_measured_data(data.write(), data.problem, *data.model);
    ASSERT_EQ(back.poses.size(), data.poses.size()) << file;
    for (std::size_t k = 0; k < back.poses.size(); ++k) {
      EXPECT_EQ(back.poses[k].q, data.poses[k].q) << file;
      for (Eigen::Index i = 0; i < back.poses[k].y.size(); ++i) {
        if (std::isfinite(data.poses[k].y[i]) && std::isfinite(back.poses[k].y[i])) {
          EXPECT_EQ(back.poses[k].y[i], data.poses[k].y[i]) << file;
        }
        // A rotation vector with a hole is none.
        if (k != 3) {
          EXPECT_TRUE(std::isfinite(back.poses[k].y[i])) << file;
        }
      }
    }
    EXPECT_TRUE(holes == 0 || std::isnan(back.poses[3].y[back.poses[3].y.size() - 1])) << file;
  }
}

TEST(MeasuredData, RepeatsAreAveragedAndTheirSpreadIsTheNoise) {
  VirtualFile data("instruments/photogrammetry.yaml", 30, 0.0);
  std::vector<MeasuredPose> rows;
  for (const MeasuredPose& pose : data.poses)
    for (int i = 0; i < 8; ++i) {
      rows.push_back(pose);
      Eigen::VectorXd z(6);
      for (double& value : z) value = 1e-4 * data.random.normal();
      data.model->shifted(pose.y, z, rows.back().y);
    }
  data.write(measured_data_csv(*data.model, rows));
  const MeasuredData back = read_measured_data(data.options().data, data.problem, *data.model);
  EXPECT_EQ(back.poses.size(), 30U);
  EXPECT_EQ(back.rows, 240);
  EXPECT_DOUBLE_EQ(back.repeats, 8.0);
  ASSERT_EQ(back.repeated.size(), 30U);
  for (const RepeatedReadings& visit : back.repeated) {
    EXPECT_EQ(visit.deviations.cols(), 8);
    EXPECT_LT(visit.deviations.rowwise().sum().cwiseAbs().maxCoeff(), 1e-9) << "each less their mean";
  }
  for (const double spread : back.spread) EXPECT_NEAR(spread, 1e-4, 2e-5);
  Eigen::VectorXd off;
  for (std::size_t k = 0; k < 30; ++k) {
    data.model->difference(back.poses[k].y, data.poses[k].y, off);
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 5e-4 / std::sqrt(8.0));
  }
}

TEST(MeasuredData, PosesAreNumberedByOrderAndHolesInRepeatsAreNoReadings) {
  VirtualFile data("kr270/problem.yaml", 6, 0.0);
  std::vector<MeasuredPose> rows;
  for (const MeasuredPose& pose : data.poses)
    for (int i = 0; i < 4; ++i) {
      rows.push_back(pose);
      rows.back().y.array() += 1e-4 * double(i % 2);
      if (i == 0) rows.back().y[0] = std::numeric_limits<double>::quiet_NaN();
    }
  std::string text = measured_data_csv(*data.model, rows);
  // Without ids, as most tables come; the last line holds nothing.
  std::string plain;
  for (const std::string& line : lines_of(text)) plain += line.substr(line.find(',') + 1);
  std::string empty = plain.substr(plain.rfind('\n', plain.size() - 2) + 1);
  for (std::size_t cell = 0, at = 0; (at = empty.find(',', at)) != std::string::npos; ++at)
    if (++cell == 6) {
      empty = empty.substr(0, at) + ",,,,,,,,,\n";
      break;
    }
  const MeasuredData back = read_measured_data(data.write(plain + empty), data.problem, *data.model);
  ASSERT_EQ(back.poses.size(), 6U);
  for (int k = 0; k < 6; ++k) EXPECT_EQ(back.poses[std::size_t(k)].id, k + 1);
  EXPECT_EQ(back.rows, 24);
  // The fourth reading has the numbers of the second.
  EXPECT_THAT(back.notes,
              testing::ElementsAre(HasSubstr("data.csv:26: no target was read"), HasSubstr("to the last digit")));
  // 0, 1, 0, 1 tenths of a millimetre: variance 1/3; without the first 2/3·1/2.
  EXPECT_NEAR(back.spread[1], 1e-4 / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(back.spread[0], 1e-4 / std::sqrt(3.0), 1e-9);
  ASSERT_EQ(back.repeated.size(), 6U);
  EXPECT_EQ(back.repeated[0].deviations.array().isNaN().count(), 1);
  // P1.x is the mean of three readings, the others of four, three of them read with P1.x.
  const Eigen::MatrixXd share = back.poses[0].reading_share / data.problem.measurement.repeats;
  EXPECT_DOUBLE_EQ(share(0, 0), 1.0 / 3);
  EXPECT_DOUBLE_EQ(share(1, 1), 1.0 / 4);
  EXPECT_DOUBLE_EQ(share(0, 1), 3.0 / (3 * 4));
}

TEST(MeasuredData, ActuatorsQuaternionsAndPhotogrammetricPointsStandForPoses) {
  VirtualFile telescope("telescope/problem.yaml", 10);
  std::string text = "id";
  for (const Coordinate& a : telescope.model->actuators()) text += "," + a.name + " [mm]";
  for (const Reading& r : telescope.model->readings()) text += "," + r.name;
  std::vector<double> actuators(6);
  for (const MeasuredPose& pose : telescope.poses) {
    ASSERT_TRUE(telescope.model->actuator_values(pose.q, actuators));
    text += "\n" + std::to_string(pose.id);
    for (const double a : actuators) text += "," + std::to_string(a * 1e3) + std::string("");
    for (const double y : pose.y) text += "," + std::to_string(y);
  }
  const MeasuredData back = read_measured_data(telescope.write(text + "\n"), telescope.problem, *telescope.model);
  for (std::size_t k = 0; k < 10; ++k)
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(back.poses[k].q[i], telescope.poses[k].q[i], 1e-5);

  VirtualFile pose("instruments/photogrammetry.yaml", 10);
  const auto& markers = std::get<PoseMeasurement>(pose.problem.measurement.instrument).photogrammetry;
  ASSERT_GE(markers.size(), 3U);
  std::string turned = "pose", seen = "pose";
  for (const Coordinate& c : pose.model->coordinates()) {
    turned += "," + c.name;
    seen += "," + c.name;
  }
  turned += ",pose.x,pose.y,pose.z,pose.qx,pose.qy,pose.qz,pose.qw\n";
  for (const TargetSpec& m : markers) seen += "," + m.name + ".x," + m.name + ".y," + m.name + ".z";
  seen += "\n";
  const auto cells = [](std::string& to, std::initializer_list<double> values) {
    for (const double value : values) {
      std::array<char, 32> digits{};
      std::snprintf(digits.data(), digits.size(), ",%.17g", value);
      to += digits.data();
    }
  };
  for (const MeasuredPose& p : pose.poses) {
    for (std::string* line : {&turned, &seen}) {
      *line += std::to_string(p.id);
      for (const double q : p.q) cells(*line, {q});
    }
    const Eigen::Vector3d v = p.y.tail<3>();
    const Eigen::Quaterniond q(Eigen::AngleAxisd(v.norm(), v.normalized()));
    cells(turned, {p.y[0], p.y[1], p.y[2], q.x(), q.y(), q.z(), q.w()});
    for (const TargetSpec& m : markers) {
      const Eigen::Vector3d at = q * m.position + p.y.head<3>();
      cells(seen, {at.x(), at.y(), at.z()});
    }
    turned += "\n";
    seen += "\n";
  }
  for (const std::string& form : {turned, seen}) {
    const MeasuredData read = read_measured_data(pose.write(form), pose.problem, *pose.model);
    Eigen::VectorXd off;
    for (std::size_t k = 0; k < 10; ++k) {
      pose.model->difference(read.poses[k].y, pose.poses[k].y, off);
      EXPECT_LT(off.norm(), 1e-12);
    }
  }
  // Of an instrument that reads two angles they count from the nominal orientation: whole ones are another thing.
  Problem part = pose.problem;
  std::get<PoseMeasurement>(part.measurement.instrument).components = {2, 3, 4};
  const auto two_angles = make_model(part);
  for (const std::string& form : {turned, seen}) {
    try {
      read_measured_data(pose.write(form), part, *two_angles);
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_THAT(std::string(error.what()), testing::HasSubstr("whole orientations"));
    }
  }
}

TEST(MeasuredData, PointsThatFitNoRigidBodyAreRefusedWithTheirLine) {
  VirtualFile pose("instruments/photogrammetry.yaml", 3);
  const auto& markers = std::get<PoseMeasurement>(pose.problem.measurement.instrument).photogrammetry;
  std::string header = "id", right, mixed;
  for (const Coordinate& c : pose.model->coordinates()) header += "," + c.name, right += ",0", mixed += ",0";
  for (std::size_t k = 0; k < markers.size(); ++k) {
    header += "," + markers[k].name + ".x," + markers[k].name + ".y," + markers[k].name + ".z";
    for (const auto& [line, at] : {std::pair{&right, k}, std::pair{&mixed, (k + 1) % markers.size()}})
      for (int i = 0; i < 3; ++i) *line += "," + std::to_string(markers[at].position[i]);
  }
  EXPECT_EQ(read_measured_data(pose.write(header + "\n1" + right + "\n"), pose.problem, *pose.model).rows, 1);
  try {
    // A square of markers turned by one is a square again; one of them elsewhere is none.
    mixed.insert(mixed.rfind(',') + 1, "9");
    read_measured_data(pose.write(header + "\n1" + right + "\n2" + mixed + "\n"), pose.problem, *pose.model);
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().line, 3);
    EXPECT_THAT(error.what(), HasSubstr("the points fit no rigid body"));
  }
}

TEST(Calibrate, OfAPlatformWhoseJointCentresAreReadSaysHowItDeforms) {
  VirtualFile data("telescope/problem.yaml", 40);
  // The targets stand where the rigid platform has them; the second joint centre is lifted by its own actuator.
  std::string text = "id";
  for (const Coordinate& c : data.model->coordinates()) text += "," + c.name;
  for (const Reading& reading : data.model->readings()) text += "," + reading.name;
  for (int leg = 1; leg <= 6; ++leg)
    for (const char* axis : {".x", ".y", ".z"}) text += ",leg_" + std::to_string(leg) + axis;
  const auto& targets = std::get<PointsMeasurement>(data.problem.measurement.instrument).targets;
  const auto cell = [](double value) {
    std::array<char, 32> digits{};
    std::snprintf(digits.data(), digits.size(), ",%.17g", value);
    return std::string(digits.data());
  };
  std::vector<double> at(6), reference(6);
  ASSERT_TRUE(data.model->actuator_values(std::vector<double>(6, 0.0), reference));
  for (const MeasuredPose& pose : data.poses) {
    text += "\n" + std::to_string(pose.id);
    for (const double q : pose.q) text += cell(q);
    for (const double y : pose.y) text += cell(y);
    std::vector<Eigen::Vector3d> body, seen;
    for (std::size_t t = 0; t < targets.size(); ++t) {
      body.push_back(targets[t].position);
      seen.emplace_back(pose.y.segment<3>(3 * Eigen::Index(t)));
    }
    const Eigen::Isometry3d X = rigid_fit(body, seen).X;
    ASSERT_TRUE(data.model->actuator_values(pose.q, at));
    for (int leg = 0; leg < 6; ++leg) {
      const double lift = leg == 1 ? 0.02 * (at[1] - reference[1]) : 0.0;
      const Eigen::Vector3d centre = X * Eigen::Vector3d(0.1 * leg, 0.1 - 0.05 * leg, lift);
      for (const double value : centre) text += cell(value);
    }
  }
  data.write(text + "\n");
  CalibrateOptions options = data.options();
  options.variant = "rigid_6";
  const Calibration result = calibrate_problem(data.problem, options, Monitor{});
  ASSERT_TRUE(result.platform);
  EXPECT_EQ(result.platform->images, 40);
  EXPECT_GT(result.platform->freedom, 100);
  for (std::size_t leg = 0; leg < 6; ++leg) {
    const JointDeformation& joint = result.platform->joints[leg];
    // Target noise of 3 um turns and lifts the platform a little.
    EXPECT_NEAR(joint.kappa, leg == 1 ? 0.02 : 0.0, 5 * joint.kappa_sigma + 1e-4) << leg;
    EXPECT_LT(joint.kappa_sigma, 0.003);
  }
}

TEST(RigidFit, CovarianceIsThatOfManyFitsToNoisyPoints) {
  const std::vector<Eigen::Vector3d> body = {{0.2, 0, 0}, {-0.1, 0.15, 0.02}, {-0.1, -0.15, 0}, {0, 0.05, 0.1}};
  const Eigen::Isometry3d X =
      Eigen::Translation3d(1, -2, 0.5) * Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 2, 3).normalized());
  Random random(9, 1);
  Eigen::Matrix<double, 6, 6> observed = Eigen::Matrix<double, 6, 6>::Zero(), predicted;
  const int draws = 4000;
  for (int d = 0; d < draws; ++d) {
    std::vector<Eigen::Vector3d> measured;
    for (const Eigen::Vector3d& p : body)
      measured.emplace_back(X * p + 1e-5 * Eigen::Vector3d(random.normal(), random.normal(), random.normal()));
    const RigidFit fit = rigid_fit(body, measured);
    const Eigen::AngleAxisd turn(fit.X.linear() * X.linear().transpose());
    Eigen::Matrix<double, 6, 1> off;
    off << (fit.X.translation() - X.translation()), turn.angle() * turn.axis();
    observed += off * off.transpose() / (1e-10 * draws);
    predicted = fit.covariance;
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR(observed(i, j), predicted(i, j),
                  5 * std::sqrt(2.0 / draws) * std::sqrt(predicted(i, i) * predicted(j, j)));
  EXPECT_THROW(rigid_fit({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}), CannotDo);
}

TEST(Calibrate, TheTruthLiesInTheIntervalsAndHeldBackPosesAreAsGoodAsFittedOnes) {
  VirtualFile data("kr270/problem.yaml", 60);
  data.write();
  CalibrateOptions options = data.options();
  options.hold_back = 3;
  const Calibration result = calibrate_problem(data.problem, options, Monitor{});
  EXPECT_EQ(result.poses, 40);
  EXPECT_EQ(result.held_back, 20);
  int inside = 0, count = 0;
  for (const CalibratedParameter& p : result.parameters) {
    ASSERT_TRUE(p.estimated);
    const auto at = std::find_if(data.columns.parameters.begin(), data.columns.parameters.end(),
                                 [&](const Parameter& label) { return label.name == p.label.name; });
    const double truth =
        p.label.nominal +
        data.truth[std::size_t(data.columns.selected[std::size_t(at - data.columns.parameters.begin())])];
    inside += truth > p.lower && truth < p.upper ? 1 : 0;
    ++count;
  }
  EXPECT_EQ(count, 33);
  EXPECT_GE(inside, 27);
  EXPECT_TRUE(result.tests.chi_square.possible);
  EXPECT_GT(result.tests.chi_square.probability, 1e-3);
  EXPECT_EQ(result.fit.noise_factor, 1.0);
  double fitted = 0, beyond = 0, nominal = 0;
  for (const ResidualSet& set : result.residuals) {
    ASSERT_EQ(set.kinds.size(), 2U);
    if (set.parameters == "calibrated") (set.poses == "fitted" ? fitted : beyond) = set.kinds[1].rms;
    if (set.parameters == "nominal") nominal = set.kinds[1].rms;
  }
  // 0.1 mm a reading, three readings averaged, three coordinates.
  EXPECT_NEAR(fitted, 0.1e-3, 0.02e-3);
  EXPECT_NEAR(beyond, 0.1e-3, 0.03e-3);
  EXPECT_GT(nominal, 10 * beyond);
}

TEST(Calibrate, ABaseThatNobodyMeasuredIsFound) {
  VirtualFile data("kr270/problem.yaml", 40);
  // The tracker's axes lie anyhow to the robot's.
  const Eigen::Isometry3d X =
      Eigen::Translation3d(3, -4, 1) * Eigen::AngleAxisd(2.8, Eigen::Vector3d(1, -1, 2).normalized());
  for (MeasuredPose& pose : data.poses)
    for (Eigen::Index i = 0; i < pose.y.size(); i += 3)
      pose.y.segment<3>(i) = X * Eigen::Vector3d(pose.y.segment<3>(i));
  data.write();
  const Calibration result = calibrate_problem(data.problem, data.options(), Monitor{});
  EXPECT_TRUE(result.fit.converged);
  EXPECT_GT(result.tests.chi_square.probability, 1e-3);
}

TEST(Calibrate, WhatTheDataCannotTellStaysNominalAndIsNamed) {
  VirtualFile data("kr270/problem.yaml", 40);
  // Joint 4 at one angle: nothing tells its zero from a twist of the link before.
  for (MeasuredPose& pose : data.poses) pose.q[3] = 0.3;
  read_poses_of(*data.model, data.truth, 1.0, data.random, data.poses);
  data.write();
  CalibrateOptions options = data.options();
  const Calibration known = calibrate_problem(data.problem, options, Monitor{});
  for (const CalibratedParameter& p : known.parameters) EXPECT_TRUE(p.estimated) << p.label.name << " has a tolerance";
  options.prior = Prior::none;
  const Calibration result = calibrate_problem(data.problem, options, Monitor{});
  int left_out = 0;
  for (const CalibratedParameter& p : result.parameters)
    if (!p.estimated) {
      ++left_out;
      EXPECT_EQ(p.value, p.label.nominal);
      EXPECT_THAT(p.why_not, HasSubstr(p.label.name));
    }
  EXPECT_GT(left_out, 0);
  EXPECT_LE(result.tests.chi_square.probability, 1.0);
}

TEST(Calibrate, NoiseLargerThanStatedStretchesTheIntervals) {
  VirtualFile data("kr270/problem.yaml", 40, 4.0);
  data.write();
  const Calibration result = calibrate_problem(data.problem, data.options(), Monitor{});
  EXPECT_NEAR(result.fit.noise_factor, 4.0, 0.5);
  EXPECT_LT(result.tests.chi_square.probability, 1e-6);
}

TEST(Calibrate, BadFilesSayWhereAndWhat) {
  VirtualFile data("kr270/problem.yaml", 6);
  const std::string good = measured_data_csv(*data.model, data.poses);
  const auto message = [&](const std::string& text) {
    data.write(text);
    try {
      calibrate_problem(data.problem, data.options(), Monitor{});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const std::string header = good.substr(0, good.find('\n'));
  EXPECT_THAT(message(""), HasSubstr("has no poses"));
  EXPECT_THAT(message("joint_a1,joint_a2\n0,0\n"), HasSubstr("has no column of a reading"));
  EXPECT_THAT(message(header + ",P1.x\n"), HasSubstr("has no poses"));
  std::string broken = good;
  broken.replace(broken.rfind(','), 3, ",1x");
  EXPECT_THAT(message(broken), HasSubstr("data.csv:7: '1x"));
  std::string twice = good;
  twice.replace(twice.find("P2.x"), 4, "P1.x");
  EXPECT_THAT(message(twice), HasSubstr("twice"));
  std::string id = good;
  id.replace(id.find('\n') + 1, 1, "x");
  EXPECT_THAT(message(id), HasSubstr("data.csv:2: id 'x'"));
  CalibrateOptions nowhere = data.options();
  nowhere.data = data.folder / "missing.csv";
  EXPECT_THROW(calibrate_problem(data.problem, nowhere, Monitor{}), InputError);
}

TEST(Calibrate, DamagedFilesGiveOneLineAndNothingElse) {
  VirtualFile data("instruments/photogrammetry.yaml", 8);
  const std::string good = measured_data_csv(*data.model, data.poses);
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, 1);
    data.write(mutated(good, random));
    try {
      read_measured_data(data.options().data, data.problem, *data.model);
    } catch (const InputError& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    } catch (const CannotDo&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

TEST(Calibrate, TheMeasuredFanucIsAsItsDataSetSays) {
  const fs::path folder = fs::path(POSEWRIGHT_SHARED_DIR) / "data/fanuc_r2000";
  if (!fs::exists(folder)) GTEST_SKIP() << "../shared/data is absent";
  std::vector<std::string> files;
  for (const char* name : {"fanuc_q.csv", "fanuc_mA.csv", "fanuc_mB.csv", "fanuc_mC.csv"})
    files.push_back(read_file(folder / name));
  std::string text = "joint_1,joint_2,joint_3,joint_4,joint_5,joint_6";
  for (const char* target : {"A", "B", "C"})
    for (const char* axis : {".x", ".y", ".z"}) text += std::string(",") + target + axis;
  text += "\n";
  std::vector<std::istringstream> streams;
  for (const std::string& file : files) streams.emplace_back(file);
  for (std::string q; std::getline(streams[0], q);) {
    text += q;
    for (std::size_t k = 1; k < 4; ++k) {
      std::string point;
      std::getline(streams[k], point);
      text += "," + point;
    }
    text += "\n";
  }
  std::erase(text, '\r');
  TemporaryFolder out;
  CalibrateOptions options;
  options.data = out.write("fanuc.csv", text);
  options.weighting = Weighting::ordinary;
  options.prior = Prior::none;
  const Calibration result = calibrate_problem(example("real_data/fanuc_r2000/problem.yaml"), options, Monitor{});
  EXPECT_EQ(result.poses, 24);
  EXPECT_EQ(result.rows, 240);
  EXPECT_EQ(result.fit.change.size(), 33);
  // ../shared/data/README.md: 0.136 mm on the pose means; spread 0.059, 0.060, 0.033 mm in x, y, z.
  double calibrated = 0, placed = 0;
  for (const ResidualSet& set : result.residuals)
    if (set.parameters != "nominal") (set.parameters == "placed" ? placed : calibrated) = set.kinds[1].rms;
  EXPECT_NEAR(calibrated, 0.136e-3, 1e-6);
  const auto spread = [&](std::size_t axis) {
    double squares = 0;
    for (std::size_t t = 0; t < 3; ++t) squares += result.spread[3 * t + axis] * result.spread[3 * t + axis] / 3;
    return std::sqrt(squares);
  };
  EXPECT_NEAR(spread(0), 0.059e-3, 2e-6);
  EXPECT_NEAR(spread(1), 0.060e-3, 2e-6);
  EXPECT_NEAR(spread(2), 0.033e-3, 2e-6);
  EXPECT_NEAR(placed, 0.615e-3, 1e-6);
  // More stays at a pose than readings tell; the problem states how much.
  EXPECT_GT(result.lack_of_fit.probability, 0.01);
  Problem silent = example("real_data/fanuc_r2000/problem.yaml");
  silent.measurement.repeatability = {};
  EXPECT_LT(calibrate_problem(silent, options, Monitor{}).lack_of_fit.probability, 1e-6);
}

/// Notes of a calibration that is validated by poses of another day, the base moved by (x, y, z, rx, ry, rz).
std::vector<std::string> notes_with_base_moved(const std::array<double, 6>& motion) {
  VirtualFile data("kr270/problem.yaml", 40);
  data.write();
  std::vector<MeasuredPose> later = random_poses(*data.model, 12, data.random);
  std::vector<double> truth = data.truth;
  const auto& all = data.model->parameters();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k)
      if (all[i].name == std::string("base.") + std::array{"x", "y", "z", "rx", "ry", "rz"}[k]) truth[i] += motion[k];
  read_poses_of(*data.model, truth, 1.0, data.random, later);
  CalibrateOptions options = data.options();
  options.validate = data.folder.write("later.csv", measured_data_csv(*data.model, later));
  const Calibration found = calibrate_problem(data.problem, options, Monitor{});
  EXPECT_TRUE(found.fit.converged);
  return found.notes;
}

TEST(Calibrate, SaysThatValidationPosesWereReadInAnotherFrame) {
  EXPECT_THAT(notes_with_base_moved({}), testing::Not(testing::Contains(HasSubstr("check its frame"))));
  EXPECT_THAT(notes_with_base_moved({0.003, 0, 0, 0, 0, 0}),
              testing::Contains(testing::AllOf(HasSubstr("With the base moved by 3"), HasSubstr(" mm and "))));
  EXPECT_THAT(notes_with_base_moved({4.6, -1, 0.2, 0, 0.01, 2.5}),
              testing::Contains(testing::AllOf(HasSubstr("With the base moved by 4"), HasSubstr("143"))));
}

}  // namespace
}  // namespace posewright
