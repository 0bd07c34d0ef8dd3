// Data as metrologists bring them: several campaigns, configurations measured again, orientations as angles, several
// models. Second roads are readings moved as rigid bodies and sums of squares by hand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "posewright/calibration/revisits.hpp"
#include "posewright/tasks/model_choice.hpp"
#include "tests/kit/drawn_positioner.hpp"
#include "tests/kit/virtual_file.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

/// The points of a pose as an instrument sees them that was put somewhere else.
void see_from(const Eigen::Isometry3d& X, MeasuredPose& pose) {
  for (Eigen::Index i = 0; i + 2 < pose.y.size(); i += 3)
    pose.y.segment<3>(i) = X * Eigen::Vector3d(pose.y.segment<3>(i));
}

Eigen::Isometry3d far_away() {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Eigen::AngleAxisd(2.4, Eigen::Vector3d(0.1, -0.2, 1).normalized()).toRotationMatrix();
  X.translation() << 3.1, -1.7, 0.4;
  return X;
}

TEST(Campaigns, OfATrackerThatWasMovedShareTheRobot) {
  // Without noise: the second file alone moved as a rigid body, so everything must come out as it was drawn.
  VirtualFile data("kr270/problem.yaml", 40, 0.0);
  std::vector<MeasuredPose> first(data.poses.begin(), data.poses.begin() + 22),
      second(data.poses.begin() + 22, data.poses.end());
  for (MeasuredPose& pose : second) see_from(far_away(), pose);
  CalibrateOptions options;
  options.prior = Prior::none;
  options.data = data.folder.write("monday.csv", measured_data_csv(*data.model, first));
  options.campaigns = {data.folder.write("tuesday.csv", measured_data_csv(*data.model, second))};
  const Calibration result = calibrate_problem(data.problem, options, Monitor{});
  EXPECT_TRUE(result.fit.converged);
  EXPECT_EQ(result.poses, 40);
  EXPECT_LT(result.fit.chi_square, 1e-6);
  int bases = 0;
  for (const CalibratedParameter& p : result.parameters) {
    if (!p.estimated) continue;
    if (p.label.name.starts_with("base@tuesday.")) ++bases;
    for (std::size_t i = 0; i < data.truth.size(); ++i)
      if (data.model->parameters()[i].name == p.label.name && !p.label.places) {
        EXPECT_NEAR(p.value - p.label.nominal, data.truth[i], 1e-4 * p.label.tolerance) << p.label.name;
      }
  }
  EXPECT_EQ(bases, 6);
  // The robot's values alone go to the parameters file.
  for (const EstimatedValue& value : result.values) EXPECT_FALSE(value.value.name.starts_with("base@"));
  // One frame for both is none.
  options.campaigns.clear();
  options.validate = data.folder.path() / "tuesday.csv";
  const Calibration one = calibrate_problem(data.problem, options, Monitor{});
  EXPECT_THAT(one.notes, testing::Contains(HasSubstr(": check its frame.")));
}

/// Two files of the positioner's readings; before the second the tool was put on again, millimetres and degrees off.
class Remounted : public DrawnPositioner {
 protected:
  Remounted() : moved_(model_->parameters().size(), 0.0) {
    for (std::size_t i = 0; i < moved_.size(); ++i)
      if (const Parameter& p = model_->parameters()[i]; p.name.starts_with("tool."))
        moved_[i] = p.unit == "m" ? 2e-3 : -6e-3;
    options_.prior = Prior::none;
    options_.variant = "everything";
  }
  /// @param again  the tool was put on again
  Calibration calibrated(bool again, Moved moved) {
    for (const bool second : {false, true}) {
      std::vector<MeasuredPose> poses = drawn(20, 0.0, 1.0, 1.0, second ? 8 : 7);
      for (MeasuredPose& pose : poses) {
        Eigen::VectorXd nominal, there, change;
        model_->predict(pose.q, {}, nominal);
        model_->predict(pose.q, second && again ? moved_ : std::vector<double>{}, there);
        model_->difference(pose.y, nominal, change);
        model_->shifted(there, change, pose.y);
      }
      const auto file = folder_.write(second ? "b.csv" : "a.csv", measured_data_csv(*model_, poses));
      if (second) options_.campaigns = {file};
      else options_.data = file;
    }
    options_.moved = moved;
    return calibrate_problem(problem_, options_, Monitor{});
  }
  static std::vector<const CalibratedParameter*> own(const Calibration& c, const std::string& frame) {
    std::vector<const CalibratedParameter*> found;
    for (const CalibratedParameter& p : c.parameters)
      if (p.estimated && p.label.name.starts_with(frame + "@b.")) found.push_back(&p);
    return found;
  }
  TemporaryFolder folder_;
  std::vector<double> moved_;
  CalibrateOptions options_;
};

TEST_F(Remounted, ToolIsFoundBesideTheBaseWhereResidualsAskForIt) {
  const Calibration one = calibrated(true, Moved::base), found = calibrated(true, Moved::automatic);
  EXPECT_GT(one.fit.scale, 3);
  EXPECT_LT(found.fit.scale, 1.2);
  EXPECT_TRUE(own(one, "tool").empty());
  EXPECT_EQ(own(found, "tool").size(), 6u);
  EXPECT_EQ(own(found, "base").size(), 6u);
  EXPECT_THAT(found.notes, testing::Contains(HasSubstr("a tool of its own")));
  EXPECT_TRUE(std::ranges::any_of(found.frames, [](const PlacedFrame& f) { return f.name == "tool@b"; }));
}

TEST_F(Remounted, ToolIsRightWithTheBaseHeld) {
  const Calibration found = calibrated(true, Moved::tool);
  EXPECT_LT(found.fit.scale, 1.2);
  EXPECT_TRUE(own(found, "base").empty());
  const auto tool = own(found, "tool");
  ASSERT_EQ(tool.size(), 6u);
  for (const CalibratedParameter* p : tool) {
    const double truth = p->label.nominal + (p->label.unit == "m" ? 2e-3 : -6e-3);
    EXPECT_NEAR(p->value, truth, 5 * p->sigma + 1e-9) << p->label.name;
  }
}

TEST_F(Remounted, ToolThatStayedIsOne) {
  const Calibration stayed = calibrated(false, Moved::automatic);
  EXPECT_TRUE(own(stayed, "tool").empty());
  EXPECT_EQ(own(stayed, "base").size(), 6u);
  const Calibration held = calibrated(false, Moved::nothing);
  EXPECT_TRUE(own(held, "base").empty());
  EXPECT_LT(held.fit.scale, 1.2);
}

TEST(Campaigns, TellAsMuchAsTheirReadingsTogether) {
  // σ by both files is below that by either, and above what all poses in one frame would give.
  VirtualFile data("kr270/problem.yaml", 40, 1.0);
  const std::vector<MeasuredPose> first(data.poses.begin(), data.poses.begin() + 20),
      second(data.poses.begin() + 20, data.poses.end());
  const auto sigma_of = [&](const std::vector<std::vector<MeasuredPose>>& files) {
    CalibrateOptions options;
    options.prior = Prior::none;
    for (std::size_t f = 0; f < files.size(); ++f) {
      const auto file =
          data.folder.write("file" + std::to_string(f) + ".csv", measured_data_csv(*data.model, files[f]));
      if (f == 0) options.data = file;
      else options.campaigns.push_back(file);
    }
    std::map<std::string, double> sigma;
    const Calibration result = calibrate_problem(data.problem, options, Monitor{});
    for (const CalibratedParameter& p : result.parameters)
      if (p.estimated && p.label.role == Role::interest) sigma[p.label.name] = p.sigma / result.fit.noise_factor;
    return sigma;
  };
  const auto alone = sigma_of({first}), both = sigma_of({first, second}), together = sigma_of({data.poses});
  ASSERT_EQ(both.size(), together.size());
  for (const auto& [name, sigma] : both) {
    EXPECT_LT(sigma, 1.0001 * alone.at(name)) << name;
    EXPECT_GT(sigma, 0.98 * together.at(name)) << name;
  }
}

TEST(MeasuredRows, OfOneConfigurationButForTheEncodersJitterAreRepeats) {
  VirtualFile data("instruments/photogrammetry.yaml", 4, 0.0);
  const auto rows_with = [&](double jitter, bool one_id) {
    std::vector<MeasuredPose> rows;
    for (const MeasuredPose& pose : data.poses)
      for (int i = 0; i < 3; ++i) {
        rows.push_back(pose);
        rows.back().id = one_id ? pose.id : int(rows.size());
        rows.back().q[1] += jitter * (i - 1);
      }
    return read_measured_data(data.write(measured_data_csv(*data.model, rows)), data.problem, *data.model);
  };
  const MeasuredData small = rows_with(4e-6, false);
  ASSERT_EQ(small.poses.size(), 4u);
  EXPECT_NEAR(small.poses[2].q[1], data.poses[2].q[1], 1e-12);
  EXPECT_EQ(rows_with(4e-4, true).poses.size(), 4u);
  EXPECT_EQ(rows_with(4e-4, false).poses.size(), 12u);
}

TEST(MeasuredRows, OrientationsAreReadAsAnglesAboutFixedAndMovingAxes) {
  VirtualFile data("instruments/photogrammetry.yaml", 6, 0.0);
  const MeasuredData vectors = read_measured_data(data.write(), data.problem, *data.model);
  const auto by_angles = [&](const std::string& kind, const std::array<int, 3>& axes, bool reversed) {
    std::string text = "id";
    for (const Coordinate& c : data.model->coordinates()) text += "," + c.name + " [" + c.unit + "]";
    text += ",pose.x [m],pose.y [m],pose.z [m]";
    for (int k = 1; k <= 3; ++k) text += ",pose." + kind + "." + std::to_string(k) + " [deg]";
    text += "\n";
    for (const MeasuredPose& pose : data.poses) {
      text += std::to_string(pose.id);
      for (const double q : pose.q) text += "," + fmt::format("{}", q);
      for (Eigen::Index i = 0; i < 3; ++i) text += "," + fmt::format("{}", pose.y[i]);
      const Eigen::Vector3d v = pose.y.tail<3>();
      Eigen::Vector3d angles =
          Eigen::AngleAxisd(v.norm(), v.normalized()).toRotationMatrix().eulerAngles(axes[0], axes[1], axes[2]);
      if (reversed) angles.reverseInPlace();
      for (const double angle : angles) text += "," + fmt::format("{}", angle * 180 / pi);
      text += "\n";
    }
    return read_measured_data(data.write(text), data.problem, *data.model);
  };
  for (const MeasuredData& read : {by_angles("moving_zyx", {2, 1, 0}, false), by_angles("moving_zyz", {2, 1, 2}, false),
                                   by_angles("fixed_xyz", {2, 1, 0}, true), by_angles("fixed_xzy", {1, 2, 0}, true)}) {
    ASSERT_EQ(read.poses.size(), vectors.poses.size());
    for (std::size_t k = 0; k < read.poses.size(); ++k) EXPECT_LT((read.poses[k].y - vectors.poses[k].y).norm(), 1e-9);
  }
  data.write(measured_data_csv(*data.model, data.poses));
}

/// Every configuration of `places` again after the others, `rounds` times.
std::vector<MeasuredPose> in_rounds(const IdentificationModel& model, const std::vector<MeasuredPose>& places,
                                    int rounds, double noise, double drift, Random& random) {
  std::vector<MeasuredPose> poses;
  const double last = double(places.size()) * rounds - 1;
  for (int round = 0; round < rounds; ++round)
    for (const MeasuredPose& place : places) {
      poses.push_back(place);
      Eigen::VectorXd change(6);
      for (Eigen::Index k = 0; k < 6; ++k) change[k] = noise * (k < 3 ? 0.23e-3 : 0.5e-3) * random.normal();
      change[1] += drift * double(poses.size() - 1) / last;
      model.shifted(place.y, change, poses.back().y);
    }
  return poses;
}

class Revisited : public DrawnPositioner {
 protected:
  std::vector<MeasuredPose> places_ = drawn(5, 0.0, 1.0, 0.0, 3);
};

TEST_F(Revisited, DriftOfNoiselessReadingsIsFoundToTheLastDigit) {
  Random random(1, 1);
  const Revisits found = revisits(*model_, in_rounds(*model_, places_, 3, 0.0, 1e-3, random), {});
  EXPECT_EQ(found.places, 5);
  EXPECT_EQ(found.visits, 15);
  EXPECT_NEAR(found.noise, 0.0, 1e-6);
  ASSERT_EQ(found.moved.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(found.moved[i].change, i == 1 ? 1e-3 : 0.0, 1e-9);
}

TEST_F(Revisited, NoiseAndDriftAreToldApartAtTheirLevel) {
  Random random(7, 1);
  int large = 0, drifts = 0;
  double noise = 0;
  constexpr int draws = 400;
  for (int i = 0; i < draws; ++i) {
    const Revisits found = revisits(*model_, in_rounds(*model_, places_, 3, 1.0, 0.0, random), {});
    large += found.larger.probability < 0.05 ? 1 : 0;
    drifts += found.drift.probability < 0.05 ? 1 : 0;
    noise += found.noise * found.noise / draws;
  }
  // 20 of 400 are expected; a chance below 1 in 1000 to be farther off.
  EXPECT_NEAR(large, 20, 15);
  EXPECT_NEAR(drifts, 20, 15);
  EXPECT_NEAR(noise, 1.0, 0.03);
  const Revisits twice = revisits(*model_, in_rounds(*model_, places_, 6, 2.0, 2e-3, random), {});
  EXPECT_NEAR(twice.noise, 2.0, 0.4);
  EXPECT_LT(twice.drift.probability, 1e-3);
  EXPECT_NEAR(twice.moved[1].change, 2e-3, 1e-3);
}

TEST_F(Revisited, ConfigurationsThatAControllerMissesByHalfAMilliradianAreVisits) {
  Random random(4, 1);
  std::vector<MeasuredPose> poses = in_rounds(*model_, places_, 3, 0.0, 0.0, random);
  for (MeasuredPose& pose : poses) {
    Eigen::VectorXd there, read = pose.y, change;
    model_->predict(pose.q, {}, there);
    model_->difference(read, there, change);
    for (double& q : pose.q) q += random.uniform(-5e-4, 5e-4);
    model_->predict(pose.q, {}, there);
    model_->shifted(there, change, pose.y);
  }
  const Revisits found = revisits(*model_, poses, {});
  EXPECT_EQ(found.places, 5);
  EXPECT_EQ(found.visits, 15);
  // The robot stood elsewhere by a millimetre, and the model says so.
  EXPECT_NEAR(found.noise, 0.0, 1e-3);
}

TEST_F(Revisited, PosesWithoutAReturnTellNothing) { EXPECT_FALSE(revisits(*model_, places_, {}).larger.possible); }

/// The positioner with and without gear errors, fitted to readings of a robot with that gear error.
class Choices : public DrawnPositioner {
 protected:
  std::vector<Calibration> fitted_models(double gear, std::uint64_t seed) {
    Problem problem = problem_;
    VariantSpec small = find_variant(problem, "everything"), large = small;
    small.name = "small";
    large.name = "large";
    small.automatic = large.automatic = false;
    const auto words = [](std::initializer_list<const char*> names) {
      std::vector<Located<std::string>> list;
      for (const char* name : names) list.push_back({name, 1});
      return list;
    };
    small.parameters = words({"base.*", "tool.*", "joint_2.x", "joint_2.rx"});
    large.parameters = words({"base.*", "tool.*", "joint_2.x", "joint_2.rx", "joint_1.gear", "joint_2.gear"});
    problem.variants = {small, large};
    auto poses = drawn(20, 0.0, 1.0, 1.0, seed);
    std::vector<double> truth(model_->parameters().size(), 0.0);
    // Of the second joint's place in both models, so that either is better than base and tool alone.
    for (std::size_t i = 0; i < truth.size(); ++i)
      if (const std::string& name = model_->parameters()[i].name; name == "joint_1.gear") truth[i] = gear;
      else if (name == "joint_2.x") truth[i] = 2e-3;
      else if (name == "joint_2.rx") truth[i] = 5e-3;
    for (MeasuredPose& pose : poses) {
      Eigen::VectorXd nominal, moved, change;
      model_->predict(pose.q, {}, nominal);
      model_->predict(pose.q, truth, moved);
      model_->difference(pose.y, nominal, change);
      model_->shifted(moved, change, pose.y);
    }
    CalibrateOptions options;
    options.prior = Prior::none;
    options.data = folder_.write("data.csv", measured_data_csv(*model_, poses));
    std::vector<Calibration> models;
    for (const char* name : {"small", "large"}) {
      options.variant = name;
      models.push_back(calibrate_problem(problem, options, Monitor{}));
    }
    return models;
  }
  TemporaryFolder folder_;
};

TEST_F(Choices, FallOnTheModelThatTheReadingsNeed) {
  int small = 0, large = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    small += choose_model(fitted_models(0.0, seed)).recommended == "small" ? 1 : 0;
    large += choose_model(fitted_models(2e-3, seed)).recommended == "large" ? 1 : 0;
  }
  // One standard error lets chance win one time in six.
  EXPECT_GE(small, 7);
  EXPECT_GE(large, 9);
}

TEST_F(Choices, AreJudgedByFAndAkaikesCriterionAsTheirDefinitionsHaveThem) {
  const std::vector<Calibration> models = fitted_models(1e-3, 3);
  const ModelChoice choice = choose_model(models);
  ASSERT_EQ(choice.models.size(), 2u);
  EXPECT_EQ(choice.models[0].against, "");
  EXPECT_EQ(choice.models[1].against, "small");
  const double n = 120, a = double(models[0].columns.size()), b = double(models[1].columns.size());
  const double A = models[0].fit.chi_square, B = models[1].fit.chi_square;
  EXPECT_NEAR(*choice.models[1].f / ((A - B) / (b - a) / (B / (n - b))), 1, 1e-6);
  const auto aicc = [&](double squares, double k) {
    return n * std::log(squares / n) + 2 * (k + 1) + 2 * (k + 1) * (k + 2) / (n - k - 2);
  };
  EXPECT_NEAR(*choice.models[0].aicc, aicc(A, a), 1e-4);
  EXPECT_NEAR(*choice.models[1].aicc, aicc(B, b), 1e-4);
}

}  // namespace
}  // namespace posewright
