// A robot with several tips from the problem file to plan, evaluation and calibration. The second roads: problems of
// one way each, kinematics along the URDF's tree, least squares of the test's own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "posewright/lists/measured_data.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/model/corrected_urdf.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/rotation_vector.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/file.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/recompute.hpp"
#include "tests/kit/three_tips.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

Eigen::MatrixXd whole_information(const IdentificationModel& model, const std::vector<double>& q) {
  const std::vector<int> all = all_parameters(model);
  BlockArray::RowMatrix J(model.block_rows(all), Eigen::Index(all.size()));
  Linearisation scratch;
  if (!whitened_block(model, q, {}, all, scratch, J.data(), int(J.cols()))) return {};
  return J.transpose() * J;
}

TEST(Tips, InformationIsTheSumOfThatOfSingleWays) {
  const ThreeTips three;
  const auto whole = make_model(three.problem);
  const auto& instruments = *instruments_of(three.problem.measurement);
  const char* const ends[][2] = {{"eye", "left_hand"}, {"eye", "rh"}, {"root", "rh"}};
  const auto size = Eigen::Index(whole->parameters().size());
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(size, size), sum = M;
  Random random(3, 1);
  for (std::size_t k = 0; k < 3; ++k) {
    Problem alone = three.problem;
    auto& arm = std::get<SerialArmSpec>(alone.robot);
    arm.ways.clear();
    arm.base = Located<std::string>{ends[k][0], 0};
    arm.tip = Located<std::string>{ends[k][1], 0};
    alone.measurement = instruments[k];
    alone.variants = {VariantSpec{}};
    const auto model = make_model(alone);
    std::vector<int> at;
    for (const Parameter& p : model->parameters()) {
      const std::size_t dot = p.name.rfind('.');
      std::string name = p.name;
      if (name.starts_with("base.")) name = (k == 2 ? "base" : "base@eye") + name.substr(dot);
      else if (name.starts_with("tool.")) name = "tool@left" + name.substr(dot);
      else if (name.starts_with("target")) name = "target@" + instruments[k].name + name.substr(6);
      const auto found = std::ranges::find(whole->parameters(), name, &Parameter::name);
      ASSERT_NE(found, whole->parameters().end()) << name;
      EXPECT_EQ(found->tolerance, p.tolerance) << name;
      at.push_back(int(found - whole->parameters().begin()));
    }
    for (int i = 0; i < 300; ++i) {
      std::vector<double> q = random_configuration(*whole, random), own;
      q.back() = double(k);
      for (const Coordinate& c : model->coordinates())
        for (std::size_t j = 0; j < q.size(); ++j)
          if (whole->coordinates()[j].name == c.name) own.push_back(q[j]);
      own.resize(model->coordinates().size(), 0.0);
      M += whole_information(*whole, q);
      sum(at, at) += whole_information(*model, own);
    }
  }
  Eigen::VectorXd unit = sum.diagonal().cwiseSqrt();
  unit = (unit.array() > 0).select(unit, 1.0);
  EXPECT_LT((M - sum).cwiseQuotient(unit * unit.transpose()).cwiseAbs().maxCoeff(), 1e-9);
}

/// What a plan file says, without the hash of its problem and the time it took.
nlohmann::json plan_without_hash(const Problem& problem) {
  nlohmann::json json = nlohmann::json::parse(plan_json(plan_problem(problem, {}, Monitor{})));
  EXPECT_EQ(json.count("problem"), 1U);
  json.erase("problem");
  json["statistics"].erase("seconds");
  return json;
}

TEST(Tips, OfOneWayPlanAsFromBaseToTip) {
  const std::filesystem::path file = examples_folder() / "humanoid/head_sees_hand.yaml";
  std::string text = read_file(file);
  const auto change = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  };
  change("candidates: 1000", "candidates: 200");
  const nlohmann::json before = plan_without_hash(parse_problem(text, file));
  change("  base: head_camera\n  tip: l_hand\n", "  tips: {hand: l_hand, eye: head_camera}\n");
  change("measurement:\n", "measurement:\n  of: hand\n  in: eye\n");
  EXPECT_TRUE(plan_without_hash(parse_problem(text, file)) == before);
}

TEST(Tips, APlanOfThreeTipsIsEvaluatedAndReadBackAlike) {
  for (const char* criterion : {"o1", "auto", "test_pose, test_poses: {random: 20}"}) {
    std::string text = three_tips_problem;
    text.replace(text.find("criterion: o1"), 13, std::string("criterion: ") + criterion);
    const ThreeTips three(text);
    const Plan plan = plan_problem(three.problem, {}, Monitor{});
    ASSERT_EQ(plan.instruments.size(), 3U) << criterion;
    int poses = 0;
    for (const InstrumentWorth& worth : plan.instruments) {
      EXPECT_GT(worth.poses, 0) << criterion << worth.name;
      poses += worth.poses;
    }
    EXPECT_EQ(poses, 24);
    const PoseList list = read_poses(three.folder.write("plan.json", plan_json(plan)), pose_coordinates(three.problem));
    EXPECT_EQ(evaluate_problem(three.problem, list, {}, Monitor{}).plan.log_det, plan.log_det) << criterion;
  }
}

/// Readings of a robot whose errors are known and least squares of them, by kinematics of the test's own.
class TreeReadings {
 public:
  TreeReadings(const ThreeTips& three, const IdentificationModel& model, const VariantColumns& columns, int count)
      : three_(three), model_(model) {
    for (const int i : columns.selected) names_.push_back(model.parameters()[std::size_t(i)].name);
    Random random(11, 0);
    truth_ = Eigen::VectorXd::Zero(Eigen::Index(names_.size()));
    for (std::size_t j = 0; j < names_.size(); ++j)
      truth_[Eigen::Index(j)] = 0.3 * columns.parameters[j].tolerance * random.normal();
    for (int i = 0; i < count; ++i) {
      MeasuredPose pose;
      pose.id = i + 1;
      pose.q = random_configuration(model, random);
      pose.q.back() = double(i % 3);
      pose.y = Eigen::VectorXd::Constant(model.rows(), std::numeric_limits<double>::quiet_NaN());
      Eigen::VectorXd own = read(truth_, pose.q);
      const Eigen::VectorXd sigma = sigma_of(pose.q);
      Eigen::VectorXd noise(own.size());
      for (Eigen::Index r = 0; r < own.size(); ++r) noise[r] = sigma[r] * random.normal();
      if (i % 3 == 0) {
        own.tail<3>() = rotation_vector(rotation_by(noise.tail<3>()) * rotation_by(own.tail<3>()));
        noise.tail<3>().setZero();
      }
      pose.y.segment(first_row(pose.q), own.size()) = own + noise;
      poses.push_back(std::move(pose));
    }
  }

  /// What the instrument of q reads: position and rotation vector, or points.
  Eigen::VectorXd read(const Eigen::VectorXd& x, const std::vector<double>& q) const {
    ValuesByName<double> values;
    for (std::size_t j = 0; j < names_.size(); ++j) values[names_[j]] = x[Eigen::Index(j)];
    const std::map<std::string, double> joints = joints_of(model_.coordinates(), q);
    if (q.back() == 0) {
      const auto tip = seen_tip(three_.plain, "eye", "left_hand", "base@eye", "tool@left", joints, values);
      Eigen::VectorXd y(6);
      y << tip.p, rotation_vector(tip.R);
      return y;
    }
    const bool by_eye = q.back() == 1;
    const auto tip =
        seen_tip(three_.plain, by_eye ? "eye" : "root", "rh", by_eye ? "base@eye" : "base", "none", joints, values);
    using Targets = std::vector<std::pair<std::string, Eigen::Vector3d>>;
    const Targets targets = by_eye ? Targets{{"P", {0.1, 0.2, -0.1}}, {"Q", {0, -0.1, 0.2}}}
                                   : Targets{{"R", {0.1, 0, 0.1}}, {"S", {0, 0.1, 0.05}}, {"T", {0.05, -0.1, 0}}};
    Eigen::VectorXd y(3 * Eigen::Index(targets.size()));
    for (std::size_t t = 0; t < targets.size(); ++t) {
      const std::string name = std::string(by_eye ? "target@to_right." : "target@tracker.") + targets[t].first;
      const Eigen::Vector3d off(value_of(values, name + ".x"), value_of(values, name + ".y"),
                                value_of(values, name + ".z"));
      y.segment<3>(3 * Eigen::Index(t)) = tip.R * (targets[t].second + off) + tip.p;
    }
    return y;
  }

  /// Of the noise and, of the pose, the visit's displacement.
  static Eigen::VectorXd sigma_of(const std::vector<double>& q) {
    if (q.back() == 1) return Eigen::VectorXd::Constant(6, 0.2e-3);
    if (q.back() == 2) return Eigen::VectorXd::Constant(9, 50e-6);
    Eigen::VectorXd sigma(6);
    sigma << Eigen::Vector3d::Constant(std::hypot(0.1e-3, 0.1e-3)), Eigen::Vector3d::Constant(0.2e-3);
    return sigma;
  }
  static Eigen::Index first_row(const std::vector<double>& q) { return q.back() == 0 ? 0 : q.back() == 1 ? 6 : 12; }

  /// Gauss–Newton with central differences.
  /// @param factors  of each instrument's noise
  void solve(const std::vector<double>& factors, Eigen::VectorXd& x, Eigen::MatrixXd& covariance) const {
    const Eigen::Index m = truth_.size();
    x = Eigen::VectorXd::Zero(m);
    for (int round = 0; round < 12; ++round) {
      Eigen::MatrixXd M = Eigen::MatrixXd::Zero(m, m);
      Eigen::VectorXd b = Eigen::VectorXd::Zero(m);
      for (const MeasuredPose& pose : poses) {
        const Eigen::VectorXd at = read(x, pose.q);
        const Eigen::VectorXd weight = (factors[std::size_t(pose.q.back())] * sigma_of(pose.q)).cwiseInverse();
        const bool turns = pose.q.back() == 0;
        Eigen::MatrixXd J(at.size(), m);
        for (Eigen::Index j = 0; j < m; ++j) {
          const Eigen::VectorXd h = 1e-6 * Eigen::VectorXd::Unit(m, j);
          J.col(j) = change(read(x - h, pose.q), read(x + h, pose.q), turns) / 2e-6;
        }
        const Eigen::VectorXd r = change(at, pose.y.segment(first_row(pose.q), at.size()), turns);
        M += J.transpose() * weight.cwiseAbs2().asDiagonal() * J;
        b += J.transpose() * weight.cwiseAbs2().asDiagonal() * r;
      }
      x += M.ldlt().solve(b);
      covariance = M.inverse();
    }
  }

  const std::vector<std::string>& names() const { return names_; }
  std::vector<MeasuredPose> poses;

 private:
  static Eigen::VectorXd change(const Eigen::VectorXd& from, const Eigen::VectorXd& to, bool turns) {
    Eigen::VectorXd d = to - from;
    if (turns) d.tail<3>() = rotation_vector(rotation_by(to.tail<3>()) * rotation_by(from.tail<3>()).transpose());
    return d;
  }

  const ThreeTips& three_;
  const IdentificationModel& model_;
  std::vector<std::string> names_;
  Eigen::VectorXd truth_;
};

TEST(Tips, MixedDataGiveTheLeastSquaresOfAnotherRoadAndTheCorrectedUrdf) {
  const ThreeTips three;
  const auto model = make_model(three.problem);
  const VariantColumns columns = select_columns(*model, {three.problem, three.problem.variants.front()});
  const TreeReadings data(three, *model, columns, 60);
  CalibrateOptions options;
  options.data = three.folder.write("data.csv", measured_data_csv(*model, data.poses));
  options.prior = Prior::none;
  const Calibration result = calibrate_problem(three.problem, options, Monitor{});
  ASSERT_EQ(result.fit.noise_factor, 1.0);
  ASSERT_EQ(result.instruments.size(), 3U);
  std::vector<double> factors;
  for (const InstrumentResiduals& one : result.instruments) {
    factors.push_back(one.noise_factor);
    EXPECT_EQ(one.poses, 20);
    EXPECT_GT(one.test.probability, 1e-3);
  }
  Eigen::VectorXd x;
  Eigen::MatrixXd C;
  data.solve(factors, x, C);
  std::vector<CalibratedValue> values;
  ASSERT_EQ(result.parameters.size(), data.names().size());
  for (const CalibratedParameter& p : result.parameters) {
    const auto j = std::ranges::find(data.names(), p.label.name) - data.names().begin();
    EXPECT_NEAR(p.value - p.label.nominal, x[j], 1e-3 * std::sqrt(C(j, j))) << p.label.name;
    EXPECT_NEAR(p.sigma, std::sqrt(C(j, j)), 1e-4 * p.sigma) << p.label.name;
    values.push_back({p.label.name, p.label.unit, p.label.nominal, p.value});
  }
  ASSERT_EQ(result.frames.size(), 3U);
  EXPECT_EQ(result.frames[0].name, "base@eye");
  EXPECT_EQ(result.frames[1].name, "base");
  EXPECT_EQ(result.frames[2].name, "tool@left");

  // Each joint of the file is turned by its own offset, and the left hand's frame is where its tool was found.
  const auto& arm = std::get<SerialArmSpec>(three.problem.robot);
  const CorrectedUrdf corrected = corrected_urdf(arm, {}, VariantSpec::Convention::frames, values);
  const PlainUrdf after(three.folder.write("after.urdf", corrected.text));
  ValuesByName<double> found;
  for (const CalibratedValue& value : values) found[value.name] = value.correction();
  for (const auto& [link, joint] : three.plain.above) {
    Eigen::Isometry3d X = joint.X_ParentJoint;
    if (found.count(joint.name + ".offset") > 0)
      X.rotate(Eigen::AngleAxisd(found.at(joint.name + ".offset"), joint.axis.normalized()));
    if (link == "left_hand") {
      const Frame<double> tool = displacement_of(found, "tool@left");
      Eigen::Isometry3d D = Eigen::Isometry3d::Identity();
      D.linear() = tool.R;
      D.translation() = tool.p;
      X = X * D;
    }
    EXPECT_TRUE(after.above.at(link).X_ParentJoint.isApprox(X, 1e-9)) << joint.name;
  }
  EXPECT_THAT(corrected.left_out, Contains(HasSubstr("l2.gear")));
  EXPECT_THAT(corrected.left_out, Contains(HasSubstr("base@eye.x")));
  EXPECT_THAT(corrected.left_out, Contains(HasSubstr("target@tracker.R.x")));
  EXPECT_THAT(corrected.left_out, Not(Contains(HasSubstr(".offset"))));
  EXPECT_THAT(corrected.left_out, Not(Contains(HasSubstr("tool@left"))));
}

TEST(Tips, HaveAsManyParametersAsATreeOfTheirJoints) {
  ObserveOptions options;
  options.variant = "geometry";
  options.candidates = 400;
  const Observation o = observe_problem(example("humanoid/both_hands.yaml"), options, Monitor{}).front();
  // Four of each joint that turns, six of base, camera, both boards and the reflectors, three between the reflectors.
  EXPECT_EQ(o.identifiability.rank, 4 * 17 + 6 * 5 - 6 + 3);
}

/// The tool of a tip whose joint carries another tip, too, would move that one.
TEST(Tips, ATipOnTheWayToAnotherLeavesItsToolOutOfTheUrdf) {
  std::string text = three_tips_problem;
  const std::string tips = "tips: {left: left_hand, right: rh, eye: eye}";
  text.replace(text.find(tips), tips.size(), "tips: {left: eye, right: left_hand, eye: rh}");
  text.replace(text.find("type: points, of: right, in: eye"), 32, "type: points, of: right, in: left");
  const ThreeTips three(text);
  const auto& arm = std::get<SerialArmSpec>(three.problem.robot);
  const CorrectedUrdf corrected =
      corrected_urdf(arm, {}, VariantSpec::Convention::frames, {{"tool@left.x", "m", 0.0, 0.01}});
  EXPECT_EQ(corrected.text, three_tips_urdf);
  EXPECT_THAT(corrected.left_out, Contains(HasSubstr("no joint of its own ends in tip 'left'")));
}

TEST(Tips, OfLinksThatAreNotThereAreNamed) {
  std::string text = three_tips_problem;
  text.replace(text.find("right: rh"), 9, "right: rhh");
  const ThreeTips three(text);
  EXPECT_THAT(message_of<std::runtime_error>([&] { make_model(three.problem); }),
              testing::AllOf(HasSubstr("p.yaml:2: "), HasSubstr("tip 'rhh' is not a link of three.urdf")));
  std::string eye = three_tips_problem;
  eye.replace(eye.find("eye: eye"), 8, "eye: eyes");
  EXPECT_THAT(message_of<std::runtime_error>([&] { make_model(ThreeTips(eye).problem); }),
              HasSubstr("tip 'eyes' is not a link of three.urdf (did you mean 'eye'?)"));
}

TEST(Tips, WithoutAJointBetweenAreNamed) {
  std::string text = three_tips_problem;
  text.replace(text.find("right: rh"), 9, "right: head");
  const ThreeTips three(text);
  EXPECT_THAT(message_of<std::runtime_error>([&] { make_model(three.problem); }),
              testing::AllOf(HasSubstr("p.yaml:2: "), HasSubstr("no joint moves between 'eye' and 'head'")));
}

TEST(Tips, AreManyForWhatWorksWithOne) {
  const ThreeTips three;
  const auto& arm = std::get<SerialArmSpec>(three.problem.robot);
  EXPECT_THAT(message_of<std::runtime_error>([&] { read_urdf_chain(arm, three.problem.at(arm.line)); }),
              HasSubstr("p.yaml:2: the instruments see several tips, and this is for one alone"));
  VariantSpec variant = three.problem.variants.front();
  variant.convention = VariantSpec::Convention::dh;
  EXPECT_THAT(message_of<std::runtime_error>([&] {
                make_model({three.problem, variant});
              }),
              HasSubstr("parameters dh and mdh are those of one way alone"));
}

}  // namespace
}  // namespace posewright
