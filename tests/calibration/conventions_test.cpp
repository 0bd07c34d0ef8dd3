// Conventions that a file does not keep, named by what base and tool alone leave.

#include "posewright/calibration/conventions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "posewright/model/rotation_vector.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/virtual_file.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180;

std::string conditions(const ConventionSearch& search) {
  std::string text;
  for (const Convention& c : search.found) text += "[" + c.condition + "]";
  return text;
}

/// A KR 270 with errors within its tolerances, three reflectors, a tracker somewhere.
struct Arm : VirtualFile {
  Arm() : VirtualFile("kr270/problem.yaml", 25) {}
  std::string found() const { return conditions(find_conventions(problem, *model, poses, {})); }
  double clean() const { return find_conventions(problem, *model, poses, {}).left; }
};

TEST(Conventions, OfARightFileNothingIsNamed) {
  const Arm arm;
  EXPECT_EQ(arm.found(), "");
  EXPECT_LT(arm.clean(), 5e-3);
}

TEST(Conventions, SignZeroAndCouplingOfEveryJointAreNamed) {
  const Arm right;
  const auto& joints = right.model->coordinates();
  for (std::size_t j = 1; j < 5; ++j) {  // the first is the base, the last the tool
    Arm sign, zero, coupling;
    for (MeasuredPose& pose : sign.poses) pose.q[j] = -pose.q[j];
    EXPECT_THAT(sign.found(), HasSubstr("[" + joints[j].name + " counts the other way]")) << j;
    for (MeasuredPose& pose : zero.poses) pose.q[j] += 90 * degree;
    EXPECT_EQ(zero.found(), "[the zero of " + joints[j].name + " is 90 deg off]") << j;
    for (MeasuredPose& pose : coupling.poses) pose.q[j] += pose.q[j - 1];
    EXPECT_THAT(coupling.found(), HasSubstr("[" + joints[j].name + " turns by " + joints[j].name + " - " +
                                            joints[j - 1].name + " (a controller's coupling -1"))
        << j;
  }
}

TEST(Conventions, RowsUnitsAndMirrorsOfPointsAreNamed) {
  Arm late, inches, robot_in_inches, longer, mirrored, degrees;
  for (std::size_t i = late.poses.size() - 1; i > 0; --i) late.poses[i].y = late.poses[i - 1].y;
  EXPECT_EQ(late.found(), "[readings belong 1 row earlier]");
  for (MeasuredPose& pose : inches.poses) pose.y /= 0.0254;
  EXPECT_EQ(inches.found(), "[lengths that were read are inches]");
  for (MeasuredPose& pose : robot_in_inches.poses) pose.y *= 0.0254;
  const std::vector<Convention> own =
      find_conventions(robot_in_inches.problem, *robot_in_inches.model, robot_in_inches.poses, {}).found;
  ASSERT_EQ(own.size(), 1u);
  EXPECT_EQ(own[0].condition, "lengths of the robot are inches");
  EXPECT_EQ(own[0].remedy, "state the robot's lengths in m") << "no header of the readings mends that";
  for (MeasuredPose& pose : longer.poses) pose.y *= 0.8;
  EXPECT_THAT(longer.found(), testing::MatchesRegex("\\[lengths are 1.25[0-9]* times those that were read\\]"));
  for (MeasuredPose& pose : mirrored.poses)
    for (Eigen::Index i = 1; i < pose.y.size(); i += 3) pose.y[i] = -pose.y[i];
  EXPECT_EQ(mirrored.found(), "[the instrument's axes or the robot's are left-handed (mirrored)]");
  for (MeasuredPose& pose : degrees.poses)
    for (double& angle : pose.q) angle /= degree;
  EXPECT_EQ(degrees.found(), "[angles of the joints are degrees]");
}

TEST(Conventions, AnErrorThatIsNoConventionIsNotCalledOne) {
  Arm arm;
  for (MeasuredPose& pose : arm.poses) pose.q[2] += 10 * degree;
  EXPECT_EQ(arm.found(), "");
  EXPECT_GT(arm.clean(), 0.02);
}

/// A controller's pose as six joints, and an instrument that reads poses.
constexpr const char* cart = R"(<robot name="cart"><link name="b"/><link name="1"/><link name="2"/><link name="3"/>
<link name="4"/><link name="5"/><link name="t"/>
<joint name="px" type="prismatic"><parent link="b"/><child link="1"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="py" type="prismatic"><parent link="1"/><child link="2"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="pz" type="prismatic"><parent link="2"/><child link="3"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="rz" type="revolute"><parent link="3"/><child link="4"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="ry" type="revolute"><parent link="4"/><child link="5"/><axis xyz="0 1 0"/><limit lower="-1.5" upper="1.5" effort="1" velocity="1"/></joint>
<joint name="rx" type="revolute"><parent link="5"/><child link="t"/><axis xyz="1 0 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint></robot>)";
constexpr const char* cart_problem = R"(posewright: 1
robot: {urdf: cart.urdf, placement: {position: [0.3, -0.2, 0.5], rpy: ["40 deg", 0, "70 deg"]}}
measurement: {type: pose, device: {type: isotropic, noise: {position: "0.5 mm", rotation: "2 mrad"}}}
variants: {hand_eye: {parameters: ["tool.*"], nuisance: ["base.*"]}}
design: {poses: 15, candidates: 500}
)";

struct Cart {
  TemporaryFolder folder;
  Problem problem;
  std::unique_ptr<IdentificationModel> model;
  std::vector<MeasuredPose> poses;
  OrientationForm form{};

  Cart() {
    folder.write("cart.urdf", cart);
    problem = read_problem(folder.write("problem.yaml", cart_problem));
    model = make_model({problem, problem.variants.front()});
    Random random(7, 0);
    poses = random_poses(*model, 15, random);
    std::vector<double> truth(model->parameters().size(), 0.0);
    for (std::size_t i = 0; i < truth.size(); ++i)
      if (model->parameters()[i].places) truth[i] = 0.2 * random.normal();
    read_poses_of(*model, truth, 1.0, random, poses);
  }
  std::string found() const { return conditions(find_conventions(problem, *model, poses, form)); }
  /// Joints rz, ry, rx of an orientation.
  static Eigen::Matrix3d turned(const std::vector<double>& q) {
    return EulerTurns{true, {2, 1, 0}}.rotation({q[3], q[4], q[5]});
  }
};

TEST(Conventions, OrdersRotationVectorsAndQuaternionsOfARobotAreNamed) {
  EXPECT_EQ(Cart().found(), "");
  Cart order, vector, quaternion;
  for (MeasuredPose& pose : order.poses) {
    const Eigen::Vector3d xyz = EulerTurns{true, {0, 1, 2}}.angles(Cart::turned(pose.q));
    pose.q[5] = xyz[0], pose.q[4] = xyz[1], pose.q[3] = xyz[2];
  }
  EXPECT_EQ(order.found(), "[rz, ry, rx come from turns about moving axes xyz that were taken for zyx]");
  for (MeasuredPose& pose : vector.poses) {
    const Eigen::Vector3d v = rotation_vector(Cart::turned(pose.q));
    pose.q[5] = v[0], pose.q[4] = v[1], pose.q[3] = v[2];
  }
  EXPECT_EQ(vector.found(), "[rz, ry, rx come from rotation vectors that were taken for turns about moving axes zyx]");
  for (MeasuredPose& pose : quaternion.poses) {
    const Eigen::Quaterniond q(Cart::turned(pose.q));
    const Eigen::Quaterniond taken(q.z(), q.w(), q.x(), q.y());  // w, x, y, z taken for x, y, z, w
    const Eigen::Vector3d zyx = EulerTurns{true, {2, 1, 0}}.angles(taken.toRotationMatrix());
    pose.q[3] = zyx[0], pose.q[4] = zyx[1], pose.q[5] = zyx[2];
  }
  EXPECT_THAT(quaternion.found(), testing::StartsWith("[rz, ry, rx come from quaternions w, x, y, z"));
}

TEST(Conventions, PosesThatAreInvertedTransposedOrMirroredAreNamed) {
  Cart inverted, transposed, mirrored;
  for (MeasuredPose& pose : inverted.poses) {
    const Eigen::Matrix3d R = rotation_by(pose.y.tail<3>());
    pose.y.head<3>() = Eigen::Vector3d(-R.transpose() * pose.y.head<3>());
    pose.y.tail<3>() = -pose.y.tail<3>();
  }
  EXPECT_THAT(inverted.found(), testing::StartsWith("[poses of the instrument or those of the robot are inverted"));
  for (MeasuredPose& pose : transposed.poses) pose.y.tail<3>() = -pose.y.tail<3>();
  EXPECT_EQ(transposed.found(), "[orientations of the instrument are transposed]");
  for (MeasuredPose& pose : mirrored.poses) pose.y[1] = -pose.y[1], pose.y[3] = -pose.y[3], pose.y[5] = -pose.y[5];
  EXPECT_EQ(mirrored.found(), "[the instrument's axes or the robot's are left-handed (mirrored)]");
}

TEST(Conventions, OrientationsThatAreOtherNumbersAreNamedWithTheirColumns) {
  Cart angles, quaternion, vector;
  for (MeasuredPose& pose : angles.poses)
    pose.y.tail<3>() = EulerTurns{false, {0, 1, 2}}.angles(rotation_by(pose.y.tail<3>()));
  const ConventionSearch search = find_conventions(angles.problem, *angles.model, angles.poses, angles.form);
  ASSERT_FALSE(search.found.empty());
  EXPECT_EQ(search.found.front().remedy, "name pose.rz, pose.ry, pose.rx pose.moving_zyx.1, .2, .3");

  quaternion.form.kind = OrientationForm::quaternion;
  for (MeasuredPose& pose : quaternion.poses) {
    const Eigen::Quaterniond q(rotation_by(pose.y.tail<3>()));
    pose.y.tail<3>() = rotation_vector(Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()).toRotationMatrix());
  }
  EXPECT_EQ(quaternion.found(),
            "[orientations that were read come from quaternions w, x, y, z that were taken for x, y, z, w]");

  vector.form = {OrientationForm::angles, {true, {2, 1, 0}}};
  // A second angle within 90 deg, so that all are read back alike.
  std::erase_if(vector.poses, [](const MeasuredPose& pose) { return std::abs(pose.y[4]) > 1.5; });
  ASSERT_GT(vector.poses.size(), 6u);
  for (MeasuredPose& pose : vector.poses)
    pose.y.tail<3>() = rotation_vector(vector.form.turns.rotation(pose.y.tail<3>().reverse()));
  EXPECT_THAT(vector.found(), HasSubstr("come from rotation vectors that were taken for turns about moving axes zyx"));
}

TEST(Conventions, APictureOfABoardIsJudgedAsItsPose) {
  VirtualFile right("instruments/camera_on_hand.yaml", 15);
  const auto& camera = std::get<CameraMeasurement>(right.problem.measurement.instrument);
  const auto found = [&](const std::vector<MeasuredPose>& poses) {
    return conditions(find_conventions(right.problem, *right.model, poses, {}));
  };
  EXPECT_EQ(found(right.poses), "");
  std::vector<MeasuredPose> flipped = right.poses, late = right.poses, sign = right.poses;
  for (MeasuredPose& pose : flipped)
    for (Eigen::Index i = 0; i < pose.y.size(); i += 2) pose.y[i] = camera.width - pose.y[i];
  EXPECT_THAT(found(flipped), testing::StartsWith("[the picture is flipped]"));
  for (std::size_t i = 0; i + 1 < late.size(); ++i) late[i].y = late[i + 1].y;
  EXPECT_EQ(found(late), "[readings belong 1 row later]");
  for (MeasuredPose& pose : sign) pose.q[2] = -pose.q[2];
  EXPECT_THAT(found(sign), HasSubstr(right.model->coordinates()[2].name + " counts the other way"));
}

TEST(Conventions, AColumnThatWasNeverWrittenIsNotCalledOne) {
  VirtualFile data("instruments/camera_on_hand.yaml", 60);
  for (MeasuredPose& pose : data.poses) pose.q[2] = 0.3;
  const ConventionSearch search = find_conventions(data.problem, *data.model, data.poses, {});
  EXPECT_EQ(conditions(search), "");
  EXPECT_GT(search.left, 0.02);
}

const fs::path cases = fs::path(POSEWRIGHT_SHARED_DIR) / "cases";

/// What `calibrate` says of a file; empty: it fits.
std::string refusal_of(const std::string& problem, const std::string& data) {
  CalibrateOptions options;
  options.data = cases / data;
  return message_of<CannotDo>([&] { calibrate_problem(read_problem(cases / problem), options, Monitor{}); });
}

/// What `calibrate` says of the readings of a camera whose problem estimates the hand-eye transform alone.
std::string refusal_of_pictures(VirtualFile& data) {
  data.write();
  CalibrateOptions options = data.options();
  options.variant = "hand_eye";
  return message_of<CannotDo>([&] { calibrate_problem(data.problem, options, Monitor{}); });
}

TEST(Conventions, OfPicturesAreNamedByCalibrate) {
  const int width =
      std::get<CameraMeasurement>(example("instruments/camera_on_hand.yaml").measurement.instrument).width;
  VirtualFile right("instruments/camera_on_hand.yaml", 15);
  EXPECT_EQ(refusal_of_pictures(right), "");
  VirtualFile flipped("instruments/camera_on_hand.yaml", 15);
  for (MeasuredPose& pose : flipped.poses)
    for (Eigen::Index i = 0; i < pose.y.size(); i += 2) pose.y[i] = width - pose.y[i];
  EXPECT_THAT(refusal_of_pictures(flipped), HasSubstr("the picture is flipped: write width - u for u"));
  VirtualFile late("instruments/camera_on_hand.yaml", 15);
  for (std::size_t i = 0; i + 1 < late.poses.size(); ++i) late.poses[i].y = late.poses[i + 1].y;
  EXPECT_THAT(refusal_of_pictures(late), HasSubstr("readings belong 1 row later"));
}

TEST(Conventions, OfTheSharedCasesAreNamedAndOfRightOnesNone) {
  if (!fs::exists(cases)) GTEST_SKIP() << "../shared/cases is absent";
  EXPECT_EQ(refusal_of("conventions/problem.yaml", "conventions/ok.csv"), "");
  EXPECT_EQ(refusal_of("coupling/told.yaml", "coupling/controller.csv"), "");
  for (const auto& [file, words] :
       {std::pair("euler_order", "turns about moving axes zyx that were taken for xyz"),
        std::pair("index_shift", "readings from pose 10 on belong 2 rows later"), std::pair("mirrored", "left-handed"),
        std::pair("not_inverted", "are inverted"), std::pair("tcp_inverted", "are inverted"),
        std::pair("rotvec_as_euler", "come from rotation vectors that were taken for turns"),
        std::pair("wxyz", "come from quaternions w, x, y, z")})
    EXPECT_THAT(refusal_of("conventions/problem.yaml", std::string("conventions/") + file + ".csv"), HasSubstr(words));
  EXPECT_THAT(refusal_of("coupling/problem.yaml", "coupling/controller.csv"),
              testing::AllOf(HasSubstr("joint_3 turns by joint_3 - joint_2 (a controller's coupling -1"),
                             HasSubstr("joint_effects: {joint_3: {coupling: [joint_2]}}")));
}

}  // namespace
}  // namespace posewright
