// The command `calibrate` as a user meets it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "posewright/lists/measured_data.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/json.hpp"
#include "tests/kit/run_program.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

const std::string kr270_problem = std::string(POSEWRIGHT_SOURCE_DIR) + "/examples/kr270/problem.yaml";

class CalibrateCommand : public testing::Test {
 protected:
  void SetUp() override {
    const Problem problem = read_problem(kr270_problem);
    const auto model = make_model(problem);
    Random random(2, 1);
    std::vector<MeasuredPose> poses = random_poses(*model, 40, random);
    const VariantColumns columns = select_columns(*model, {problem, problem.variants.front()});
    read_poses_of(*model, random_truth(*model, columns, 0.3, random), 1.0, random, poses);
    for (const std::size_t k : {4, 11}) poses[k].y[1] += 10e-3;
    folder_.write("data.csv", measured_data_csv(*model, poses));
  }
  ProgramRun run(const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"calibrate", kr270_problem, "data.csv"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(folder_.path(), words);
  }
  TemporaryFolder folder_;
};

TEST_F(CalibrateCommand, ShowsParametersResidualsAndWhatTheyMean) {
  const ProgramRun shown = run({"--hold-back", "4"});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("geometric: 30 poses fitted, 10 held back; 270 readings for 33 parameters"));
  EXPECT_THAT(shown.out, HasSubstr("px1"));
  EXPECT_THAT(shown.out, HasSubstr("distance of a target  held back  calibrated"));
  EXPECT_THAT(shown.out, HasSubstr("Try --weights robust"));
  EXPECT_THAT(shown.out, HasSubstr("σ and intervals are scaled by"));
}

TEST_F(CalibrateCommand, RobustNamesThePosesThatLostWeight) {
  const ProgramRun shown = run({"--weights", "robust"});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("Poses with readings that lost weight: 5 (0.00), 12 (0.00)"));
  EXPECT_THAT(shown.out, HasSubstr("Noise estimated from the residuals: "));
}

TEST_F(CalibrateCommand, JsonHasEveryPoseAndTheCovariance) {
  const ProgramRun shown = run({"--weights", "ols", "--json"});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  const auto json = parse_json(shown.out);
  EXPECT_EQ(json["schema"], "posewright/calibration/1");
  EXPECT_EQ(json["poses"].size(), 40U);
  EXPECT_EQ(json["covariance"]["rows"].size(), 33U);
  EXPECT_TRUE(json["tests"]["chi_square"].is_null());
  for (std::size_t j = 0; j < 18; ++j) {
    const auto& p = json["parameters"][j];
    EXPECT_EQ(p["role"], "interest");
    EXPECT_LT(p["interval"][0], p["value"]);
  }
}

TEST_F(CalibrateCommand, GivesTheRobotToItsUsers) {
  const ProgramRun shown = run({"-o", "calibrated.yaml", "--urdf", "calibrated.urdf", "--dh", "distal", "--no-prior"});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("Denavit–Hartenberg parameters (distal)"));
  EXPECT_THAT(shown.out, HasSubstr("Written: calibrated.yaml, calibrated.urdf"));
  EXPECT_THAT(shown.err, HasSubstr("not in the URDF: target.P1.x"));
  // With its own parameters the robot has nothing left to be corrected, and nothing to gain.
  const ProgramRun nothing = run({"--parameters", "calibrated.yaml"});
  EXPECT_EQ(nothing.exit_code, 0) << nothing.err;
  EXPECT_THAT(nothing.out, HasSubstr("Verdict: gain not shown."));
  const ProgramRun again =
      run({"--parameters", "calibrated.yaml", "--json", "--dh", "proximal", "--force", "--no-prior"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const auto json = parse_json(again.out);
  for (const auto& p : json["parameters"])
    EXPECT_NEAR(p["value"].get<double>(), p["nominal"].get<double>(), 0.01 * p["sigma"].get<double>()) << p["name"];
  EXPECT_EQ(json["denavit_hartenberg"]["rows"].size(), 6U);
  EXPECT_EQ(run({"--dh", "best"}).exit_code, 2);
  EXPECT_EQ(run({"-o", "data.csv"}).exit_code, 2);
  folder_.write("precious.urdf", "<robot/>");
  EXPECT_EQ(run({"--urdf", "precious.urdf"}).exit_code, 1);
}

TEST_F(CalibrateCommand, SaysWhatIsWrong) {
  EXPECT_THAT(run_program(folder_.path(), {"calibrate", kr270_problem}).err, HasSubstr("DATA.csv is missing"));
  const ProgramRun words = run({"--weights", "best"});
  EXPECT_EQ(words.exit_code, 2);
  EXPECT_THAT(words.err, HasSubstr("--weights best; allowed: ols, wls, robust"));
  EXPECT_THAT(run({"--hold-back", "1"}).err, HasSubstr("a whole number from 2"));
  EXPECT_THAT(run({"--variant", "none"}).err, HasSubstr("none"));
  EXPECT_EQ(run({"more.csv"}).exit_code, 2);
  EXPECT_THAT(run({"--validate", "missing.csv"}).err, HasSubstr("missing.csv"));
}

}  // namespace
}  // namespace posewright
