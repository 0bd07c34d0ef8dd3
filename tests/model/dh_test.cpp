// Denavit–Hartenberg parameters of any chain: same kinematics, same number of parameters, analytic columns.

#include <gtest/gtest.h>

#include <filesystem>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/model/dh_chain.hpp"
#include "posewright/model/explicit_model.hpp"
#include "posewright/model/measurement_factory.hpp"
#include "posewright/model/serial_chain.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/jets.hpp"
#include "tests/kit/residuals.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/urdf_text.hpp"

namespace posewright {
namespace {

MeasurementSpec full_pose() {
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity() * 1e-8;
  MeasurementSpec spec;
  spec.instrument = PoseMeasurement{covariance, {0, 1, 2, 3, 4, 5}, {}, 0};
  return spec;
}

ChainDescription read_arm(const TemporaryFolder& folder, const NamedChain& chain) {
  SerialArmSpec arm;
  arm.urdf = folder.write(std::string(chain.name) + ".urdf", urdf_text(chain.joints));
  arm.placement.position = {0.3, -0.2, 0.1};
  arm.placement.rpy = {0.2, 0.1, -0.4};
  return read_urdf_chain(arm, {});
}

constexpr DhConvention conventions[] = {DhConvention::distal, DhConvention::proximal};

TEST(DenavitHartenberg, ChainHasTheSameTipAsTheUrdfEverywhere) {
  const TemporaryFolder folder;
  for (const NamedChain& named : named_chains()) {
    const ChainDescription chain = read_arm(folder, named);
    const SerialChain frames(chain);
    for (const DhConvention convention : conventions) {
      const DhChain dh(denavit_hartenberg(chain, convention));
      Random random(1, 0);
      Eigen::Isometry3d X, Y;
      Twists none;
      for (int i = 0; i < 20; ++i) {
        const std::vector<double> q = random_configuration(chain.coordinates, random);
        frames.linearise({q, {}}, {}, X, none, nullptr);
        dh.linearise({q, {}}, {}, Y, none, nullptr);
        ASSERT_TRUE(X.isApprox(Y, 1e-9)) << named.name;
      }
    }
  }
}

TEST(DenavitHartenberg, ColumnsEqualAutomaticDifferentiation) {
  const TemporaryFolder folder;
  MeasurementSpec points;
  points.instrument =
      PointsMeasurement{{{"A", {0.1, 0.2, -0.3}, 0}}, GaussianNoise{1e-8 * Eigen::Matrix3d::Identity()}, {}, {0, 1, 2}};
  for (const NamedChain& named : named_chains())
    for (const DhConvention convention : conventions) {
      const DhDescription dh = denavit_hartenberg(read_arm(folder, named), convention);
      const ExplicitModel model(std::make_unique<DhChain>(dh), make_measurement(points));
      const auto oracle = [&](const std::vector<double>& q, const std::vector<Jet>& d) {
        std::vector<Jet> all(d.begin(), d.end() - 3);
        all.resize(all.size() + 6, Jet(0.0));
        const Frame<Jet> tip = dh_tip_pose<Jet>(dh, q.data(), all.data());
        const Eigen::Matrix<Jet, 3, 1> y =
            tip * Eigen::Matrix<Jet, 3, 1>(d[d.size() - 3] + 0.1, d[d.size() - 2] + 0.2, d[d.size() - 1] - 0.3);
        return std::vector<Jet>{y[0], y[1], y[2]};
      };
      for (const double size : {0.0, 10.0})
        EXPECT_LT(worst_model_error(model, 250, size, 1, oracle), 1e-9) << named.name;
    }
}

/// Structure of the parameters that `auto` chooses from.
Identifiability identified(const IdentificationModel& model, int configurations, std::vector<Parameter>& labels) {
  Random random(5, 0);
  std::vector<int> all;
  for (const auto& preference : model.geometric_parameters()) all.push_back(preference.parameter);
  labels.clear();
  for (const int i : all) labels.push_back(model.parameters()[std::size_t(i)]);
  BlockArray sample(std::size_t(configurations), model.block_rows(all), int(all.size()));
  Linearisation scratch;
  for (std::size_t i = 0; i < sample.count(); ++i)
    whitened_block(model, random_configuration(model.coordinates(), random), {}, all, scratch, sample.row(i, 0),
                   sample.stride());
  IdentifiabilityOptions options;
  options.threshold = 1e-7;
  return identifiability(sample, labels, options);
}

/// Joint frames and both conventions.
std::vector<std::unique_ptr<ExplicitModel>> models_of(const ChainDescription& chain) {
  std::vector<std::unique_ptr<ExplicitModel>> models;
  models.push_back(
      std::make_unique<ExplicitModel>(std::make_unique<SerialChain>(chain), make_measurement(full_pose())));
  for (const DhConvention convention : conventions)
    models.push_back(std::make_unique<ExplicitModel>(std::make_unique<DhChain>(denavit_hartenberg(chain, convention)),
                                                     make_measurement(full_pose())));
  return models;
}

TEST(Conventions, NumberOfIdentifiableParametersIs4RPlus2PPlus6InEveryOne) {
  const TemporaryFolder folder;
  int chains = 0, with_prismatic = 0;
  std::vector<Parameter> labels;
  for (const NamedChain& named : named_chains()) {
    int expected = 6;
    for (const WrittenJoint& joint : named.joints) expected += joint.kind == 'P' ? 2 : 4;
    ++chains;
    with_prismatic +=
        std::any_of(named.joints.begin(), named.joints.end(), [](const auto& j) { return j.kind == 'P'; });
    const auto models = models_of(read_arm(folder, named));
    for (const auto& model : models)
      EXPECT_EQ(identified(*model, 200, labels).rank, expected + (model == models.front() ? 0 : named.dh_deficit))
          << named.name;
  }
  EXPECT_GE(chains, 10);
  EXPECT_GE(with_prismatic, 5);
}

/// The equation that explains why a parameter is dropped.
std::string equation_of(const Identifiability& found, const std::vector<Parameter>& labels, const std::string& name) {
  for (const Dependency& d : found.dependencies)
    if (labels[std::size_t(d.dropped)].name == name) return describe(d, labels);
  return name + " is kept";
}

TEST(Conventions, SpecialGeometryIsExplainedByEquations) {
  const TemporaryFolder folder;
  const auto find = [](const std::string& name) {
    for (const NamedChain& named : named_chains())
      if (named.name == name) return named;
    throw std::logic_error("no such chain");
  };
  std::vector<Parameter> labels;
  // Parallel axes: a shift along the next joint's axis is one along the joint's own.
  const ChainDescription parallel = read_arm(folder, find("anthropomorphic_6R"));
  Identifiability found = identified(*models_of(parallel).front(), 200, labels);
  for (const char* pair : {"j3.y j2.y", "j3.ry j3.offset", "j5.ry j5.offset"}) {
    const std::string text = pair, dropped = text.substr(0, text.find(' ')), kept = text.substr(text.find(' ') + 1);
    const bool either = equation_of(found, labels, dropped) == dropped + " = " + kept ||
                        equation_of(found, labels, kept) == kept + " = " + dropped;
    EXPECT_TRUE(either) << equation_of(found, labels, dropped) << "; " << equation_of(found, labels, kept);
  }
  // Coaxial joints: the offsets of both and a turn of the base are one and the same.
  found = identified(*models_of(read_arm(folder, find("coaxial_pair_RRR"))).front(), 200, labels);
  std::string text = equation_of(found, labels, "j2.offset") + "; " + equation_of(found, labels, "j1.offset");
  EXPECT_NE(text.find("j1.offset = base.r"), std::string::npos) << text;
  EXPECT_NE(text.find("j2.offset = base.r"), std::string::npos) << text;
}

TEST(DenavitHartenberg, ParallelAxesGetHayatisAngleInPlaceOfAnOffset) {
  const TemporaryFolder folder;
  const DhDescription dh = denavit_hartenberg(read_arm(folder, named_chains()[1]), DhConvention::distal);
  std::vector<std::string> names;
  for (const ElementaryMotion& motion : dh.motions) names.push_back(motion.name);
  // Joints 2 and 3 of the anthropomorphic arm are parallel.
  EXPECT_NE(std::find(names.begin(), names.end(), "j2.beta"), names.end());
  EXPECT_EQ(std::find(names.begin(), names.end(), "j2.d"), names.end());
  EXPECT_EQ(std::find(names.begin(), names.end(), "j1.beta"), names.end());
  for (const ElementaryMotion& motion : dh.motions) {
    if (motion.name == "j1.a") {
      EXPECT_NEAR(motion.nominal, 0.35, 1e-9);
    }
    if (motion.name == "j2.a") {
      EXPECT_NEAR(motion.nominal, 1.25, 1e-9);
    }
  }
}

TEST(DenavitHartenberg, AlmostParallelAxesOfARoundedUrdfAreParallel) {
  const TemporaryFolder folder;
  NamedChain rounded = named_chains()[1];
  rounded.joints[2].rpy = "3.14159 0 0.000003";  // axis 3 against axis 2, as five digits of π have it
  const ChainDescription chain = read_arm(folder, rounded);
  for (const DhConvention convention : conventions) {
    const DhDescription dh = denavit_hartenberg(chain, convention);
    for (const ElementaryMotion& motion : dh.motions) EXPECT_LT(std::abs(motion.nominal), 7) << motion.name;
    const SerialChain frames(chain);
    const DhChain converted(dh);
    Random random(2, 0);
    Eigen::Isometry3d X, Y;
    Twists none;
    for (int i = 0; i < 20; ++i) {
      const std::vector<double> q = random_configuration(chain.coordinates, random);
      frames.linearise({q, {}}, {}, X, none, nullptr);
      converted.linearise({q, {}}, {}, Y, none, nullptr);
      EXPECT_TRUE(X.isApprox(Y, 1e-9));
    }
    std::vector<Parameter> labels;
    const ExplicitModel model(std::make_unique<DhChain>(dh), make_measurement(full_pose()));
    EXPECT_EQ(identified(model, 200, labels).rank, 30);
  }
}

TEST(DenavitHartenberg, MimicJointsAreRefused) {
  ChainDescription chain;
  chain.joints.resize(2);
  chain.joints[1].mimic = true;
  chain.coordinates.resize(1);
  EXPECT_THROW(denavit_hartenberg(chain, DhConvention::distal), CannotDo);
}

}  // namespace
}  // namespace posewright
