// A calibration that is worse than none is refused. Judged by what nobody has who calibrates: the true robot.

#include "posewright/calibration/leave_out.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/calibration/gain_in_range.hpp"
#include "posewright/calibration/placing_columns.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/distributions.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/urdf_text.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

/// Three parallel axes between two crossed ones, as lightweight arms have them: their zeros and lengths are told apart
/// only where the arm is folded and stretched.
const std::vector<WrittenJoint> parallel_axes = {
    {'R', "0 0 0.128", "0 0 0", "0 0 1"},      {'R', "0 0.176 0", "0 0 0", "0 1 0"},
    {'R', "0 -0.128 0.612", "0 0 0", "0 1 0"}, {'R', "0 0 0.572", "0 0 0", "0 1 0"},
    {'R', "0 0.1157 0", "0 0 0", "0 0 1"},     {'R', "0 0 0.1157", "0 0 0", "0 1 0"}};

fs::path shared_arm() {
  return fs::path(POSEWRIGHT_SOURCE_DIR) /
         "../shared/robots/ur10/example-robot-data/robots/ur_description/urdf/ur10_robot.urdf";
}

/// 120 draws of the arm above, or as many as POSEWRIGHT_DRAWS says, of a UR10 where its URDF is at hand.
int arm_draws() {
  const char* text = std::getenv("POSEWRIGHT_DRAWS");
  return text == nullptr ? 120 : std::stoi(text);
}

/// An arm seen by a pose instrument; everything that a pose tells is estimated.
class PoseArm {
 public:
  PoseArm(double noise, double fraction) : noise_(noise), fraction_(fraction) {
    const bool real = arm_draws() >= 1000 && fs::exists(shared_arm());
    const std::string robot =
        real ? "{urdf: " + fs::canonical(shared_arm()).string() + ", base: base_link, tip: wrist_3_link}"
             : "{urdf: arm.urdf, base: base, tip: tip}";
    folder_.write("arm.urdf", urdf_text(parallel_axes, "0 0.0922 0"));
    problem_ = read_problem(folder_.write(
        "problem.yaml",
        "posewright: 1\nrobot: " + robot +
            "\nmeasurement:\n  type: pose\n  device: {type: isotropic, noise: {position: 0.05 mm, "
            "rotation: 0.1 mrad}}\nvariants: {all: {parameters: auto, nuisance: [\"base.*\", \"tool.*\"]}}\n"
            "design: {poses: 20}\n"));
    model_ = make_model(problem_);
    const VariantColumns all = select_columns(*model_, {problem_, problem_.variants.front()});
    std::vector<MeasuredPose> many = random_poses(*model_, 300, random_);
    for (MeasuredPose& pose : many) pose.y = Eigen::VectorXd::Zero(6);
    columns_ = determined(*model_, all, many, {}, Prior::none);
  }

  struct Draw {
    bool converged = false, gains = false, worse = false;
    double estimated = 0, placed = 0;  ///< m, root mean square at 50 other poses
  };
  Draw draw(int poses, Prior prior) {
    Draw result;
    const std::vector<double> truth = random_truth(*model_, columns_, fraction_, random_);
    std::vector<MeasuredPose> measured = random_poses(*model_, poses, random_),
                              others = random_poses(*model_, 50, random_);
    read_poses_of(*model_, truth, noise_, random_, measured);
    read_poses_of(*model_, truth, 0.0, random_, others);
    FitOptions options;
    options.prior = prior;
    const std::vector<double> start = options.start = placed(*model_, columns_, measured, options);
    result.placed = off(start, others);
    try {
      const Fit whole = fit(*model_, columns_, measured, options);
      result.converged = whole.converged;
      if (!whole.converged) return result;
      const LeaveOut judged = leave_out(*model_, columns_, measured, options, start, whole, Monitor{});
      result.gains = judged.gains();
      result.worse = judged.worse();
      result.estimated = off(whole.correction, others);
    } catch (const CannotDo&) {
      result.converged = false;
    }
    return result;
  }
  /// Chance of a gain over the range that an estimate from poses of a small region states, and whether there is one.
  std::pair<double, bool> draw_in_a_corner(int poses) {
    const std::vector<double> truth = random_truth(*model_, columns_, fraction_, random_);
    std::vector<MeasuredPose> measured = random_poses(*model_, poses, random_),
                              others = random_poses(*model_, 50, random_);
    for (MeasuredPose& pose : measured)
      for (std::size_t k = 0; k < pose.q.size(); ++k) pose.q[k] = k == 0 ? 0.3 : 0.5 + 0.1 * pose.q[k];
    read_poses_of(*model_, truth, noise_, random_, measured);
    read_poses_of(*model_, truth, 0.0, random_, others);
    FitOptions options;
    options.prior = Prior::manufactured;
    const std::vector<double> start = options.start = placed(*model_, columns_, measured, options);
    const Fit whole = fit(*model_, columns_, measured, options);
    const double gain = gain_in_range(*model_, columns_, measured, start, whole).value();
    return {normal_exceeded(-gain), off(whole.correction, others) < off(start, others)};
  }
  std::size_t parameters() const { return columns_.selected.size(); }

 private:
  double off(const std::vector<double>& correction, const std::vector<MeasuredPose>& poses) const {
    double sum = 0;
    try {
      for (const Eigen::VectorXd& r : residuals_of(*model_, correction, poses)) sum += r.head<3>().squaredNorm();
    } catch (const CannotDo&) {
      return 1e9;
    }
    return std::sqrt(sum / double(poses.size()));
  }

  double noise_, fraction_;  // in units of what is stated: noise, tolerance
  TemporaryFolder folder_;
  Random random_{17, 1};
  Problem problem_;
  std::unique_ptr<IdentificationModel> model_;
  VariantColumns columns_;
};

TEST(LeaveOut, AGainOverTheRangeIsAsFrequentAsPosesOfACornerStateIt) {
  PoseArm arm(4, 1);
  double expected = 0, variance = 0;
  int found = 0, unsure = 0;
  for (int i = 0; i < 200; ++i) {
    const auto [chance, gained] = arm.draw_in_a_corner(8);
    expected += chance;
    variance += chance * (1 - chance);
    found += gained ? 1 : 0;
    unsure += chance < 0.9 ? 1 : 0;
  }
  RecordProperty("found", found);
  RecordProperty("unsure", unsure);
  EXPECT_NEAR(found, expected, 3 * std::sqrt(variance));
  EXPECT_GT(unsure, 20);
}

TEST(LeaveOut, ShowsNoGainOfEstimatesThatAreWorseThanBaseAndToolAlone) {
  // A robot that is nearly as nominal, read with twenty times the noise that is stated: estimating spoils it.
  PoseArm arm(20, 0.3);
  ASSERT_EQ(arm.parameters(), 30U);
  int worse = 0, caught = 0;
  double missed = 0;
  for (int i = 0; i < arm_draws(); ++i) {
    const PoseArm::Draw draw = arm.draw(20, Prior::none);
    ASSERT_TRUE(draw.converged);
    if (draw.estimated <= draw.placed) continue;
    ++worse;
    if (!draw.gains) ++caught;
    else missed = std::max(missed, draw.estimated / draw.placed);
  }
  RecordProperty("worse", worse);
  RecordProperty("caught", caught);
  RecordProperty("worst_missed", std::to_string(missed));
  EXPECT_GT(worse, arm_draws() / 2) << "little to catch";
  EXPECT_GE(caught, 0.98 * worse) << "what is hardly worse cannot be told from what is hardly better";
  EXPECT_LT(missed, 2) << "as many times as far off as with base and tool alone";
}

TEST(LeaveOut, PassesEveryEstimateThatGainsMuch) {
  PoseArm arm(1, 1.0);
  for (int i = 0; i < arm_draws() / 4; ++i) {
    const PoseArm::Draw draw = arm.draw(20, Prior::none);
    ASSERT_TRUE(draw.converged);
    EXPECT_LT(draw.estimated, 0.2 * draw.placed);
    EXPECT_TRUE(draw.gains) << i;
    EXPECT_FALSE(draw.worse) << i;
  }
}

TEST(LeaveOut, TolerancesOfWhatWasManufacturedKeepAnEstimateFromBeingMuchWorse) {
  // Twenty times the noise that is stated, six poses for thirty parameters.
  PoseArm arm(20, 1.0);
  int worse = 0, worse_without = 0;
  for (int i = 0; i < arm_draws() / 4; ++i) {
    const PoseArm::Draw with = arm.draw(6, Prior::manufactured), without = arm.draw(6, Prior::none);
    ASSERT_TRUE(with.converged);
    worse += with.estimated > 1.5 * with.placed ? 1 : 0;
    worse_without += without.estimated > 1.5 * without.placed ? 1 : 0;
  }
  RecordProperty("worse", worse);
  RecordProperty("worse_without", worse_without);
  EXPECT_EQ(worse, 0);
  EXPECT_GT(worse_without, 0);
}

}  // namespace
}  // namespace posewright
