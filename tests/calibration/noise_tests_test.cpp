// Level and power of what judges the residuals. Noise is drawn here reading by reading, from instrument and robot
// apart; the model's own covariance of a pose is not asked.

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "posewright/calibration/lack_of_fit.hpp"
#include "posewright/calibration/residual_statistics.hpp"
#include "posewright/model/model_factory.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

constexpr double tau = 6e-5, sigma = 2e-5;

/// Draws of every setting: 500, or as many as POSEWRIGHT_DRAWS says.
int draws() {
  const char* text = std::getenv("POSEWRIGHT_DRAWS");
  return text == nullptr ? 500 : std::stoi(text);
}

struct Setting {
  bool tracker;
  int repeats, poses;
  double stated, true_size;  ///< of what stays at a pose, m
};

/// An arm whose base and joint offsets are estimated, read by an instrument with this noise.
class VirtualArm {
 public:
  explicit VirtualArm(const Setting& setting) : setting_(setting), random_(11, 1) {
    problem_ = example("kr270/problem.yaml");
    auto& points = std::get<PointsMeasurement>(problem_.measurement.instrument);
    if (setting.tracker) points.noise = tracker_;
    else points.noise = GaussianNoise{sigma * sigma * Eigen::Matrix3d::Identity()};
    problem_.measurement.repeatability.translation = setting.stated;
    problem_.measurement.repeats = setting.repeats;
    model_ = make_model(problem_);
    Problem alone = problem_;
    alone.measurement.repeatability = {};
    instrument_ = make_model(alone);
    for (int i = 0; i < int(model_->parameters().size()); ++i) {
      const Parameter& p = model_->parameters()[std::size_t(i)];
      if (!p.name.starts_with("base.") && !p.name.starts_with("target.P1") &&
          !(p.name.ends_with(".offset") && !p.name.starts_with("joint_a1") && !p.name.starts_with("joint_a6")))
        continue;
      columns_.selected.push_back(i);
      columns_.parameters.push_back(p);
    }
    wanted_ = random_poses(*model_, setting.poses, random_);
  }

  int columns() const { return int(columns_.selected.size()); }

  struct Judged {
    TestResult lack_of_fit, within, serial;
  };
  Judged draw() {
    std::vector<MeasuredPose> poses = wanted_;
    std::vector<RepeatedReadings> repeated;
    for (MeasuredPose& pose : poses) {
      EXPECT_TRUE(model_->predict(pose.q, {}, exact_));
      const Eigen::Vector3d stands_off = setting_.true_size * normal();
      Eigen::MatrixXd rows(exact_.size(), setting_.repeats);
      for (int k = 0; k < setting_.repeats; ++k)
        for (Eigen::Index t = 0; t < exact_.size(); t += 3) {
          const Eigen::Vector3d p = exact_.segment<3>(t);
          rows.col(k).segment<3>(t) = p + stands_off + reading_noise(p);
        }
      pose.y = rows.rowwise().mean();
      repeated.push_back({pose.q, rows.colwise() - pose.y});
    }
    const Fit result = fit(*model_, columns_, poses, {});
    ResidualTests tests;
    test_correlations(*model_, columns_, poses, result, tests);
    return {lack_of_fit(*model_, *instrument_, problem_.measurement, poses, repeated, result), tests.within,
            tests.serial};
  }

 private:
  Eigen::Vector3d normal() {
    Eigen::Vector3d z;
    for (double& value : z) value = random_.normal();
    return z;
  }
  Eigen::Vector3d reading_noise(const Eigen::Vector3d& p) {
    const Eigen::Vector3d z = normal();
    if (!setting_.tracker) return sigma * z;
    const double R = p.norm();
    const Eigen::Vector3d beam = p / R, side = beam.unitOrthogonal(), other = beam.cross(side);
    const double across = tracker_.transverse + tracker_.angle * R;
    return (tracker_.range + tracker_.range_per_m * R) * z[0] * beam + across * (z[1] * side + z[2] * other);
  }

  Setting setting_;
  TrackerNoise tracker_{5e-6, 1e-6, 1e-5, 2e-5};
  Random random_;
  Problem problem_;
  std::unique_ptr<IdentificationModel> model_, instrument_;
  VariantColumns columns_;
  std::vector<MeasuredPose> wanted_;
  Eigen::VectorXd exact_;
};

struct Rates {
  double lack_of_fit = 0, within = 0, serial = 0;
};
Rates rejected_at_five_percent(const Setting& setting) {
  VirtualArm arm(setting);
  EXPECT_EQ(arm.columns(), 13);
  Rates rates;
  for (int i = 0; i < draws(); ++i) {
    const VirtualArm::Judged judged = arm.draw();
    EXPECT_TRUE(judged.lack_of_fit.possible && judged.within.possible && judged.serial.possible);
    rates.lack_of_fit += (judged.lack_of_fit.probability < 0.05) / double(draws());
    rates.within += (judged.within.probability < 0.05) / double(draws());
    rates.serial += (judged.serial.probability < 0.05) / double(draws());
  }
  testing::Test::RecordProperty("lack_of_fit", std::to_string(rates.lack_of_fit));
  testing::Test::RecordProperty("within", std::to_string(rates.within));
  testing::Test::RecordProperty("serial", std::to_string(rates.serial));
  return rates;
}

class LevelOf : public testing::TestWithParam<Setting> {};

TEST_P(LevelOf, TestsOfGoodDataIsFivePercent) {
  const Rates rates = rejected_at_five_percent(GetParam());
  // 500 draws of a 5 % test lie within 3 to 7 % but once in 25 times; the seed is fixed.
  const double margin = draws() >= 10000 ? 0.01 : 0.02;
  EXPECT_NEAR(rates.lack_of_fit, 0.05, margin);
  EXPECT_NEAR(rates.within, 0.05, margin);
  // One of eight settings lies outside 3 to 7 % here (7.8 %; 4.7 % of 10,000 draws): three standard errors and a bit.
  EXPECT_NEAR(rates.serial, 0.05, draws() >= 10000 ? margin : 0.032);
}
std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const bool tracker : {false, true})
    for (const int repeats : {2, 3})
      for (const int poses : {8, 18})
        for (const double stays : {0.0, tau}) {
          // Each of the four values twice in CI; all sixteen settings in the long run.
          const int odd = int(tracker) + repeats + poses / 18 + int(stays > 0);
          if (odd % 2 == 0 || draws() >= 10000) all.push_back({tracker, repeats, poses, stays, stays});
        }
  return all;
}
INSTANTIATE_TEST_SUITE_P(Noise, LevelOf, testing::ValuesIn(settings()), [](const auto& named) {
  const Setting& s = named.param;
  return std::string(s.tracker ? "Tracker" : "Isotropic") + std::to_string(s.repeats) + "Readings" +
         std::to_string(s.poses) + "Poses" + (s.stated > 0 ? "Repeatability" : "");
});

TEST(PowerOf, LackOfFitSeesTwiceTheRepeatabilityThatIsStated) {
  EXPECT_GT(rejected_at_five_percent({false, 2, 18, tau, 2 * tau}).lack_of_fit, 0.95);
}

TEST(PowerOf, CorrelationWithinAPoseSeesARepeatabilityThatIsNotStated) {
  EXPECT_GT(rejected_at_five_percent({true, 2, 18, 0.0, tau}).within, 0.95);
}

}  // namespace
}  // namespace posewright
