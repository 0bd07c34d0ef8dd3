// Every analytic Jacobian against automatic differentiation (ceres::Jet).

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

#include "posewright/model/explicit_model.hpp"
#include "posewright/model/measurement_factory.hpp"
#include "posewright/model/serial_chain.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/jets.hpp"
#include "tests/kit/random_chain.hpp"
#include "tests/kit/residuals.hpp"

namespace posewright {
namespace {

constexpr int partials = jet_partials;

MeasurementSpec points() {
  PointsMeasurement measurement;
  measurement.targets = {{"A", {0.1, 0.2, -0.3}, 0}, {"B", {-0.2, 0.05, 0.4}, 0}, {"C", {0.3, -0.1, 0.1}, 0}};
  measurement.noise = GaussianNoise{1e-8 * Eigen::Matrix3d::Identity()};
  MeasurementSpec spec;
  spec.instrument = measurement;
  return spec;
}

/// Oracle: rows measured of the chain's tip, in a scalar T, by the forward kinematics alone.
template <class T>
std::vector<T> measured(const ChainDescription& chain, const ChainLayout& layout, const MeasurementSpec& spec,
                        const double* q, const std::vector<T>& correction, std::size_t chain_parameters) {
  std::vector<T> all(correction.begin(), correction.begin() + std::ptrdiff_t(chain_parameters));
  all.resize(std::size_t(layout.count), T(0.0));
  const Frame<T> tip = tip_pose<T>(chain, layout, q, all.data());
  std::vector<T> rows;
  if (const auto* m = std::get_if<PointsMeasurement>(&spec.instrument)) {
    for (std::size_t t = 0; t < m->targets.size(); ++t) {
      Eigen::Matrix<T, 3, 1> p = m->targets[t].position.cast<T>();
      for (int k = 0; k < 3; ++k) p[k] += correction[chain_parameters + 3 * t + std::size_t(k)];
      const Eigen::Matrix<T, 3, 1> x = tip.R * p + tip.p;
      for (int k = 0; k < 3; ++k) rows.push_back(x[k]);
    }
    return rows;
  }
  // Rotation rows: ω from dR Rᵀ; the antisymmetric part of R R₀ᵀ has it as its derivative.
  for (int k = 0; k < 3; ++k) rows.push_back(tip.p[k]);
  std::vector<double> plain;
  for (const T& c : all)
    if constexpr (std::is_same_v<T, double>) plain.push_back(c);
    else plain.push_back(c.a);
  const Frame<double> nominal = tip_pose<double>(chain, layout, q, plain.data());
  const Eigen::Matrix<T, 3, 3> D = tip.R * nominal.R.transpose().cast<T>();
  rows.push_back(0.5 * (D(2, 1) - D(1, 2)));
  rows.push_back(0.5 * (D(0, 2) - D(2, 0)));
  rows.push_back(0.5 * (D(1, 0) - D(0, 1)));
  return rows;
}

double worst_relative_error(const ChainDescription& chain, const MeasurementSpec& spec, int configurations, double size,
                            std::uint64_t seed) {
  const ChainLayout layout(chain);
  const ExplicitModel model(std::make_unique<SerialChain>(chain), make_measurement(spec));
  const std::size_t count = model.parameters().size();
  const bool own = std::holds_alternative<PointsMeasurement>(spec.instrument);
  const std::size_t chain_parameters = own ? std::size_t(layout.tool) : std::size_t(layout.count);
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  Random random(seed, 1);
  Linearisation scratch;
  double worst = 0;
  for (int i = 0; i < configurations; ++i) {
    std::vector<double> q, correction(count, 0.0);
    for (const Coordinate& c : model.coordinates()) q.push_back(random.uniform(c.lower, c.upper));
    for (double& c : correction) c = size * random.uniform(-1, 1);
    EXPECT_TRUE(model.linearise(q, size == 0 ? std::span<const double>() : correction, all, scratch));
    for (std::size_t first = 0; first < count; first += partials) {
      const std::size_t last = std::min(count, first + partials);
      std::vector<Jet> jets(correction.begin(), correction.end());
      for (std::size_t j = first; j < last; ++j) jets[j].v[Eigen::Index(j - first)] = 1;
      const std::vector<Jet> rows = measured<Jet>(chain, layout, spec, q.data(), jets, chain_parameters);
      for (std::size_t j = first; j < last; ++j) {
        double scale = 1e-3, error = 0;
        for (std::size_t r = 0; r < rows.size(); ++r) {
          const double expected = rows[r].v[Eigen::Index(j - first)];
          scale = std::max(scale, std::abs(expected));
          error = std::max(error, std::abs(expected - scratch.G(Eigen::Index(r), Eigen::Index(j))));
        }
        worst = std::max(worst, error / scale);
      }
    }
  }
  return worst;
}

TEST(SerialChain, JacobianEqualsAutomaticDifferentiation) {
  MeasurementSpec pose;
  pose.instrument = PoseMeasurement{1e-8 * Eigen::Matrix<double, 6, 6>::Identity(), {0, 1, 2, 3, 4, 5}, {}, 0};
  for (const bool prismatic : {false, true})
    for (const bool mimic : {false, true})
      for (const bool backward : {false, true})
        for (const double size : {0.0, 1e-3, 0.1}) {
          const ChainDescription chain = random_chain(7, prismatic, mimic, backward);
          EXPECT_LT(worst_relative_error(chain, points(), 250, size, 1), 1e-10)
              << prismatic << mimic << backward << size;
          EXPECT_LT(worst_relative_error(chain, pose, 250, size, 2), 1e-10) << prismatic << mimic << backward << size;
        }
}

TEST(SerialChain, JacobianOfSharedRobotsEqualsAutomaticDifferentiation) {
  const std::filesystem::path robots = std::filesystem::path(POSEWRIGHT_SHARED_DIR) / "robots";
  if (!std::filesystem::exists(robots)) GTEST_SKIP() << "the folder of shared robots is absent";
  int checked = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(robots)) {
    if (entry.path().extension() != ".urdf") continue;
    SerialArmSpec arm;
    arm.urdf = entry.path();
    arm.tip = Located<std::string>{entry.path().stem() == "panda" ? "panda_link8" : "tool0", 0};
    EXPECT_LT(worst_relative_error(read_urdf_chain(arm, {}), points(), 100, 0.0, 3), 1e-10) << entry.path();
    ++checked;
  }
  EXPECT_EQ(checked, 6);
}

TEST(SerialChain, MovingTheBaseTurnsRowsAndNothingElse) {
  ChainDescription chain = random_chain(3, false, false);
  Random random(5, 0);
  const Eigen::Isometry3d move = random_pose(random);
  const SerialChain before(chain);
  chain.X_MeasureBase = move * chain.X_MeasureBase;
  const SerialChain after(chain);
  const std::vector<double> q = {0.1, -0.4, 1.2, 0.3, -0.8, 0.5};
  std::vector<int> all(before.parameters().size());
  std::iota(all.begin(), all.end(), 0);
  Twists a, b;
  Eigen::Isometry3d X, Y;
  before.linearise({q, {}}, all, X, a, nullptr);
  after.linearise({q, {}}, all, Y, b, nullptr);
  EXPECT_TRUE(Y.isApprox(move * X, 1e-13));
  // A twist transforms by the adjoint.
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    const Eigen::Vector3d w = move.linear() * a.col(j).tail<3>();
    EXPECT_LT((b.col(j).tail<3>() - w).norm(), 1e-13);
    EXPECT_LT((b.col(j).head<3>() - (move.linear() * a.col(j).head<3>() + move.translation().cross(w))).norm(), 1e-12);
  }
}

TEST(SerialChain, Kr270ColumnsAreThoseOfThePublishedProduct) {
  SerialArmSpec arm;
  arm.urdf = std::filesystem::path(POSEWRIGHT_SOURCE_DIR) / "examples/kr270/kr270.urdf";
  const ExplicitModel model(std::make_unique<SerialChain>(read_urdf_chain(arm, {})), make_measurement(points()));
  const std::vector<std::string> names = {
      "joint_a2.x",  "joint_a2.y",      "joint_a2.rx", "joint_a2.offset", "joint_a3.x",  "joint_a3.rx",
      "joint_a3.rz", "joint_a3.offset", "joint_a4.x",  "joint_a4.z",      "joint_a4.rz", "joint_a4.offset",
      "joint_a5.y",  "joint_a5.z",      "joint_a5.rz", "joint_a5.offset", "joint_a6.z",  "joint_a6.rz"};
  std::vector<int> selected;
  for (const std::string& name : names)
    for (int i = 0; i < int(model.parameters().size()); ++i)
      if (model.parameters()[std::size_t(i)].name == name) selected.push_back(i);
  ASSERT_EQ(selected.size(), 18U);
  // T = Rz(q1) Tx(px1) Ty(py1) Rx(φx1) · Ry(q2+Δq2) Tx(px2) Rx(φx2) Rz(φz2) · Ry(q3+Δq3) Tx(px3) Tz(pz3) Rz(φz3)
  //     · Rx(q4+Δq4) Ty(py4) Tz(pz4) Rz(φz4) · Ry(q5+Δq5) Tz(pz5) Rz(φz5) · Rx(q6), parameters in the order of `names`.
  const auto product = [](const std::vector<double>& q, const std::vector<Jet>& d) {
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
    Frame<Jet> f;
    const auto move = [&](const Eigen::Vector3d& axis, const Jet& length) {
      f.then_translate(axis.cast<Jet>() * length);
    };
    f.then_rotate(z, Jet(q[0])), move(x, d[0] + 0.35), move(y, d[1]), f.then_rotate(x, d[2]);
    f.then_rotate(y, d[3] + q[1]), move(x, d[4] + 1.25), f.then_rotate(x, d[5]), f.then_rotate(z, d[6]);
    f.then_rotate(y, d[7] + q[2]), move(x, d[8] + 1.1), move(z, d[9] - 0.055), f.then_rotate(z, d[10]);
    f.then_rotate(x, d[11] + q[3]), move(y, d[12]), move(z, d[13]), f.then_rotate(z, d[14]);
    f.then_rotate(y, d[15] + q[4]), move(z, d[16]), f.then_rotate(z, d[17]), f.then_rotate(x, Jet(q[5]));
    return f;
  };
  const MeasurementSpec measurement = points();
  const auto& targets = std::get<PointsMeasurement>(measurement.instrument).targets;
  Random random(1, 0);
  Linearisation scratch;
  for (int i = 0; i < 1000; ++i) {
    std::vector<double> q;
    for (const Coordinate& c : model.coordinates()) q.push_back(random.uniform(c.lower, c.upper));
    ASSERT_TRUE(model.linearise(q, {}, selected, scratch));
    for (std::size_t j = 0; j < 18; ++j) {
      std::vector<Jet> d(18, Jet(0.0));
      d[j].v[0] = 1;
      const Frame<Jet> tip = product(q, d);
      for (std::size_t t = 0; t < 3; ++t) {
        const Eigen::Matrix<Jet, 3, 1> p = tip.R * targets[t].position.cast<Jet>() + tip.p;
        for (int k = 0; k < 3; ++k)
          ASSERT_NEAR(scratch.G(Eigen::Index(3 * t) + k, Eigen::Index(j)), p[k].v[0], 1e-10) << names[j];
      }
    }
  }
}

}  // namespace
}  // namespace posewright
