// Ways between several tips of one arm, against automatic differentiation of kinematics along the URDF's tree.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "posewright/model/model_factory.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/three_tips.hpp"
#include "tests/kit/two_planar_arms.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

/// A way as a test has it: names of links, of the frames' parameters, and targets of an instrument, none: the pose.
struct Way {
  std::string in, of, base, tool, instrument;
  std::vector<std::pair<std::string, Eigen::Vector3d>> targets;
};

std::vector<Jet> rows_of(const PlainUrdf& urdf, const std::vector<Way>& ways, const IdentificationModel& model,
                         const std::vector<double>& q, const std::vector<Jet>& corrections) {
  ValuesByName<Jet> by_name;
  for (std::size_t i = 0; i < corrections.size(); ++i) by_name[model.parameters()[i].name] = corrections[i];
  std::vector<Jet> rows;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const Way& way = ways[k];
    const std::size_t first = rows.size();
    const Frame<Jet> tip =
        seen_tip<Jet>(urdf, way.in, way.of, way.base, way.tool, joints_of(model.coordinates(), q), by_name);
    for (const auto& [name, p] : way.targets) {
      Eigen::Matrix<Jet, 3, 1> at = p.cast<Jet>();
      for (int i = 0; i < 3; ++i)
        at[i] += by_name.at("target@" + way.instrument + "." + name + "." + std::string(1, "xyz"[i]));
      const Eigen::Matrix<Jet, 3, 1> x = tip * at;
      for (int i = 0; i < 3; ++i) rows.push_back(x[i]);
    }
    if (way.targets.empty()) {
      // ω from dR Rᵀ: the antisymmetric part of R R₀ᵀ has it as its derivative.
      Eigen::Matrix<Jet, 3, 3> nominal;
      for (int i = 0; i < 9; ++i) nominal(i) = Jet(tip.R(i).a);
      const Eigen::Matrix<Jet, 3, 3> D = tip.R * nominal.transpose();
      for (int i = 0; i < 3; ++i) rows.push_back(tip.p[i]);
      rows.push_back(0.5 * (D(2, 1) - D(1, 2)));
      rows.push_back(0.5 * (D(0, 2) - D(2, 0)));
      rows.push_back(0.5 * (D(1, 0) - D(0, 1)));
    }
    if (double(k) != q.back())
      for (std::size_t i = first; i < rows.size(); ++i) rows[i] = Jet(0.0);
  }
  return rows;
}

TEST(ForkedChain, JacobianOfThreeTipsEqualsAutomaticDifferentiation) {
  const ThreeTips three;
  const auto model = make_model(three.problem);
  const std::vector<Way> ways = {
      {"eye", "left_hand", "base@eye", "tool@left", "to_left", {}},
      {"eye", "rh", "base@eye", "tool@right", "to_right", {{"P", {0.1, 0.2, -0.1}}, {"Q", {0, -0.1, 0.2}}}},
      {"root",
       "rh",
       "base",
       "tool@right",
       "tracker",
       {{"R", {0.1, 0, 0.1}}, {"S", {0, 0.1, 0.05}}, {"T", {0.05, -0.1, 0}}}}};
  for (const double size : {0.0, 100.0})
    EXPECT_LT(worst_model_error(*model, 1000, size, 7,
                                [&](const std::vector<double>& q, const std::vector<Jet>& corrections) {
                                  return rows_of(three.plain, ways, *model, q, corrections);
                                }),
              1e-9)
        << size;
}

TEST(ForkedChain, JacobianOfATorsoWithTwoArmsAndAHeadEqualsAutomaticDifferentiation) {
  const TemporaryFolder folder;
  const std::filesystem::path urdf = examples_folder() / "humanoid/humanoid.urdf";
  const std::string text = R"(posewright: 1
robot: {urdf: )" + urdf.string() +
                           R"(, tips: {left: l_hand, right: r_hand, eye: head_camera}}
measurement:
  - {name: a, type: pose, of: left, in: eye, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}}
  - {name: b, type: pose, of: right, in: eye, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}}
  - {name: c, type: pose, of: right, in: left, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}}
  - {name: d, type: pose, of: left, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}}
variants: {v: {parameters: auto}}
)";
  const auto model = make_model(read_problem(folder.write("p.yaml", text)));
  EXPECT_EQ(model->coordinates().size(), 18U);
  const std::vector<Way> ways = {{"head_camera", "l_hand", "base@eye", "tool@left", "a", {}},
                                 {"head_camera", "r_hand", "base@eye", "tool@right", "b", {}},
                                 {"l_hand", "r_hand", "base@left", "tool@right", "c", {}},
                                 {"stand", "l_hand", "base", "tool@left", "d", {}}};
  const PlainUrdf plain(urdf);
  EXPECT_LT(worst_model_error(*model, 1000, 10.0, 8,
                              [&](const std::vector<double>& q, const std::vector<Jet>& corrections) {
                                return rows_of(plain, ways, *model, q, corrections);
                              }),
            1e-9);
}

TEST(ForkedChain, TwoArmsWithJoinedTipsTellWhatTheClosedChainTells) {
  constexpr double encoder = 1e-4;
  Random random(4, 0);
  for (int geometry = 0; geometry < 20; ++geometry) {
    FiveBarSpec spec;
    for (int i = 0; i < 2; ++i) {
      // As many digits as the URDF has.
      const auto drawn = [&](double lower, double upper) {
        return std::round(1e3 * random.uniform(lower, upper)) / 1e3;
      };
      const double side = i == 0 ? -1 : 1;
      spec.legs[std::size_t(i)] = {
          {side * drawn(0.1, 0.2), drawn(-0.05, 0.05)}, drawn(0.2, 0.3), drawn(0.3, 0.4), -side};
    }
    spec.x_lower = -0.1, spec.x_upper = 0.1, spec.y_lower = 0.3, spec.y_upper = 0.42;
    spec.encoder_noise = encoder;
    const TemporaryFolder folder;
    folder.write("arms.urdf", two_planar_arms(spec));
    // The joint that joins them lets them turn and has next to no play.
    const auto arms = make_model(read_problem(folder.write("p.yaml", R"(posewright: 1
robot: {urdf: arms.urdf, tips: {left: tip1, right: tip2}, encoder_noise: 0.1 mrad}
measurement:
  - {name: loop, type: pose, components: [x, y], of: right, in: left, device: {type: isotropic, noise: {position: 1e-12 m, rotation: 1}}}
  - {name: tracker, type: position, target: [0, 0, 0], of: right, device: {type: isotropic, noise: 1 mm}}
variants: {v: {parameters: auto}}
)")));
    const auto chain = five_bar_with_elbow_sensors(spec, encoder);

    // The left arm carries the frame of the reading: where it grows, the frame goes on.
    std::vector<std::pair<std::string, double>> names;
    std::vector<int> of_arms, of_chain;
    for (const char* leg : {"1", "2"}) {
      names.insert(names.end(), {{"rho" + std::string(leg) + ".x", 1.0},
                                 {"rho" + std::string(leg) + ".y", 1.0},
                                 {"elbow" + std::string(leg) + ".x", 1.0}});
      names.emplace_back(leg[0] == '1' ? "base@left.x" : "tool@right.x", leg[0] == '1' ? -1.0 : 1.0);
      names.insert(names.end(),
                   {{"rho" + std::string(leg) + ".offset", 1.0}, {"elbow" + std::string(leg) + ".offset", 1.0}});
      for (const char* own : {"ax", "ay", "proximal", "distal", "offset", "sensor_offset"})
        of_chain.push_back(parameter_index(*chain, "leg_" + std::string(leg) + "." + own));
    }
    Eigen::VectorXd sense(Eigen::Index(names.size()));
    for (std::size_t i = 0; i < names.size(); ++i) {
      of_arms.push_back(parameter_index(*arms, names[i].first));
      sense[Eigen::Index(i)] = names[i].second;
    }
    for (int pose = 0; pose < 10; ++pose) {
      const std::vector<double> at = {random.uniform(spec.x_lower, spec.x_upper),
                                      random.uniform(spec.y_lower, spec.y_upper)};
      const std::vector<double> q = closed_configuration(*arms, *chain, at);
      Eigen::VectorXd gap;
      ASSERT_TRUE(arms->predict(q, {}, gap));
      EXPECT_LT(gap.head<2>().norm(), 1e-12) << "the tips meet";
      const auto information = [](const IdentificationModel& model, const std::vector<double>& there,
                                  const std::vector<int>& selected) -> Eigen::MatrixXd {
        Linearisation out;
        EXPECT_TRUE(model.linearise(there, {}, selected, out));
        return out.G.transpose() * out.covariance.ldlt().solve(out.G);
      };
      const Eigen::MatrixXd expected = information(*chain, at, of_chain);
      const Eigen::MatrixXd found = sense.asDiagonal() * information(*arms, q, of_arms) * sense.asDiagonal();
      EXPECT_LT((found - expected).norm(), 1e-9 * expected.norm());
    }
  }
}

TEST(ForkedChain, StandsWhereAHeldJointPutsIt) {
  std::string text = three_tips_problem;
  text.replace(text.find("urdf: three.urdf"), 16, "urdf: three.urdf, hold: {waist: 0.3, tilt: -0.2}");
  const ThreeTips three, held(text);
  const auto free = make_model(three.problem), model = make_model(held.problem);
  ASSERT_EQ(model->coordinates().size() + 2, free->coordinates().size());
  Random random(5, 0);
  for (int i = 0; i < 100; ++i) {
    const std::vector<double> q = random_configuration(model->coordinates(), random);
    std::vector<double> all;
    for (const Coordinate& c : free->coordinates()) {
      const auto at = std::ranges::find(model->coordinates(), c.name, &Coordinate::name) - model->coordinates().begin();
      all.push_back(c.name == "waist" ? 0.3 : c.name == "tilt" ? -0.2 : q[std::size_t(at)]);
    }
    EXPECT_TRUE(model->tool_pose(q).isApprox(free->tool_pose(all), 1e-12));
  }
}

TEST(ForkedChain, OfAJointThatFollowsOneOfAnotherWayIsRefused) {
  std::string urdf = three_tips_urdf;
  const std::string child = R"(<child link="lh"/>)";
  urdf.insert(urdf.find(child) + child.size(), R"(<mimic joint="r1" multiplier="0.1"/>)");
  const ThreeTips three(three_tips_problem, urdf);
  try {
    make_model(three.problem);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("follows 'r1'"));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

TEST(ForkedChain, GradientAlongTheConfigurationIsThatOfDifferences) {
  const ThreeTips three;
  const auto model = make_model(three.problem);
  const std::vector<int> all = all_parameters(*model);
  Random random(3, 0);
  Linearisation at;
  for (int i = 0; i < 60; ++i) {
    const std::vector<double> q = random_configuration(model->coordinates(), random);
    Eigen::MatrixXd by_G(model->rows(), Eigen::Index(all.size())), by_covariance(model->rows(), model->rows());
    for (double& x : by_G.reshaped()) x = random.uniform(-1, 1);
    by_covariance.setZero();
    std::vector<double> gradient(q.size());
    ASSERT_TRUE(model->pull_back(q, all, by_G, by_covariance, gradient));
    for (std::size_t k = 0; k + 1 < q.size(); ++k) {
      double f[2];
      for (const int side : {0, 1}) {
        std::vector<double> near = q;
        near[k] += side == 0 ? -1e-5 : 1e-5;
        ASSERT_TRUE(model->linearise(near, {}, all, at));
        f[side] = at.G.cwiseProduct(by_G).sum();
      }
      EXPECT_NEAR(gradient[k], (f[1] - f[0]) / 2e-5, 1e-6 * (1 + std::abs(gradient[k]))) << k;
    }
  }
}

}  // namespace
}  // namespace posewright
