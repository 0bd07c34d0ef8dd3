// Angles of frames in one range, whatever side a fit came from.

#include "posewright/calibration/placing_columns.hpp"

#include "posewright/model/placement.hpp"
#include "tests/kit/drawn_positioner.hpp"

namespace posewright {
namespace {

class CanonicalAngles : public DrawnPositioner {
 protected:
  std::size_t index_of(const std::string& name) const {
    const auto& all = model_->parameters();
    return std::size_t(std::ranges::find(all, name, &Parameter::name) - all.begin());
  }
  Eigen::Vector3d angles(const std::string& frame) const {
    return {correction_[index_of(frame + ".rx")], correction_[index_of(frame + ".ry")],
            correction_[index_of(frame + ".rz")]};
  }
  void set(const std::string& frame, const Eigen::Vector3d& angles) {
    correction_[index_of(frame + ".rx")] = angles[0];
    correction_[index_of(frame + ".ry")] = angles[1];
    correction_[index_of(frame + ".rz")] = angles[2];
  }
  std::vector<double> correction_ = std::vector<double>(model_->parameters().size(), 0.0);
};

TEST_F(CanonicalAngles, AreTheSameRotationWithinHalfATurn) {
  Random random(3, 1);
  for (int draw = 0; draw < 200; ++draw) {
    for (const char* frame : {"base", "tool"})
      set(frame, {random.uniform(-7, 7), random.uniform(-7, 7), random.uniform(-7, 7)});
    const Eigen::Matrix3d base = rotation_of_rpy(angles("base")), tool = rotation_of_rpy(angles("tool"));
    take_canonical_angles(*model_, columns_, correction_);
    EXPECT_LT((rotation_of_rpy(angles("base")) - base).norm(), 1e-12);
    EXPECT_LT((rotation_of_rpy(angles("tool")) - tool).norm(), 1e-12);
    for (const char* frame : {"base", "tool"}) {
      EXPECT_LE(angles(frame).cwiseAbs().maxCoeff(), pi + 1e-12);
      EXPECT_LE(std::abs(angles(frame)[1]), pi / 2 + 1e-12);
    }
    EXPECT_FALSE(take_canonical_angles(*model_, columns_, correction_));
  }
}

TEST_F(CanonicalAngles, OfAFrameWithAHeldAngleStayAsTheyAre) {
  std::vector<int> kept;
  for (int j = 0; j < int(columns_.parameters.size()); ++j)
    if (columns_.parameters[std::size_t(j)].name != "tool.rz") kept.push_back(j);
  const VariantColumns columns = subset(columns_, kept);
  const Eigen::Vector3d beyond(0.1, 2.0, 0.0);
  set("tool", beyond);
  EXPECT_FALSE(take_canonical_angles(*model_, columns, correction_));
  EXPECT_EQ(angles("tool"), beyond);
}

}  // namespace
}  // namespace posewright
