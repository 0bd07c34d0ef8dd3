// A tool that slipped, a tracker that was pushed: where in the file, and which.

#include "posewright/calibration/frame_step.hpp"

#include "posewright/model/campaigns.hpp"
#include "tests/kit/drawn_positioner.hpp"

namespace posewright {
namespace {

class Stepped : public DrawnPositioner {
 protected:
  /// Readings with 1σ noise; from `first` on (counted from 0) the frame stands some millimetres elsewhere.
  std::optional<FrameStep> step_of(const std::string& frame, int first, double size, std::uint64_t seed) const {
    std::vector<MeasuredPose> poses = drawn(30, 0.0, 1.0, 1.0, seed);
    std::vector<double> moved(model_->parameters().size(), 0.0);
    for (const int i : frame_parameters(*model_, {frame}))
      moved[std::size_t(i)] = (model_->parameters()[std::size_t(i)].unit == "m" ? 1.0 : 2.0) * size;
    for (std::size_t k = std::size_t(first); k < poses.size(); ++k) {
      Eigen::VectorXd there, moved_there, change;
      model_->predict(poses[k].q, {}, there);
      model_->predict(poses[k].q, moved, moved_there);
      model_->difference(poses[k].y, there, change);
      model_->shifted(moved_there, change, poses[k].y);
    }
    return frame_step(*model_, columns_, poses, fitted(poses), effects_);
  }
  std::vector<EffectToTest> effects_ = {{"base", frame_parameters(*model_, {"base"})},
                                        {"tool", frame_parameters(*model_, {"tool"})}};
};

TEST_F(Stepped, FramesAreNamedWithTheRowsBetweenWhichTheyMoved) {
  for (const char* frame : {"base", "tool"})
    for (const int first : {3, 11, 27}) {
      const std::optional<FrameStep> step = step_of(frame, first, 3e-3, std::uint64_t(first));
      ASSERT_TRUE(step.has_value()) << frame << first;
      EXPECT_EQ(step->frame, frame) << first;
      EXPECT_EQ(step->before, first) << frame;
      EXPECT_EQ(step->after, first + 1) << frame;
      EXPECT_GT(step->share, 0.8);
      EXPECT_LT(step->chance, 1e-6);
    }
}

TEST_F(Stepped, FramesThatStayedAreNotNamed) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) EXPECT_FALSE(step_of("tool", 15, 0.0, seed).has_value()) << seed;
}

}  // namespace
}  // namespace posewright
