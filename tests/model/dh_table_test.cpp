// The table of a calibrated arm in Denavit–Hartenberg parameters has the arm's tip.

#include "posewright/model/dh_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "posewright/model/serial_chain.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/jets.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/urdf_text.hpp"

namespace posewright {
namespace {

using Convention = VariantSpec::Convention;
constexpr DhConvention tables[] = {DhConvention::distal, DhConvention::proximal};

TEST(DhTable, HasTheTipOfTheCorrectedArm) {
  const TemporaryFolder folder;
  for (const NamedChain& named : named_chains()) {
    SerialArmSpec arm;
    arm.urdf = folder.write(std::string(named.name) + ".urdf", urdf_text(named.joints));
    arm.placement.position = {0.3, -0.2, 0.1};
    arm.placement.rpy = {0.2, 0.1, -0.4};
    const ChainDescription chain = read_urdf_chain(arm, {});
    std::vector<std::unique_ptr<TipModel>> models;
    models.push_back(std::make_unique<SerialChain>(chain));
    models.push_back(std::make_unique<DhChain>(denavit_hartenberg(chain, DhConvention::distal)));
    models.push_back(std::make_unique<DhChain>(denavit_hartenberg(chain, DhConvention::proximal)));
    const Convention names[] = {Convention::frames, Convention::dh, Convention::mdh};
    for (std::size_t k = 0; k < models.size(); ++k)
      for (const double size : {0.0, 1e-4, 0.05})
        for (const DhConvention convention : tables) {
          Random random(7, 0);
          std::vector<CalibratedValue> values;
          std::vector<double> correction;
          for (const Parameter& p : models[k]->parameters()) {
            correction.push_back(p.name.ends_with(".gear") ? 0.0 : random.uniform(-size, size));
            values.push_back({p.name, p.unit, p.nominal, p.nominal + correction.back()});
          }
          const DhTable table = dh_table(arm, {}, names[k], values, convention);
          EXPECT_TRUE(table.left_out.empty());
          Eigen::Isometry3d X;
          Twists none;
          for (int i = 0; i < 20; ++i) {
            const std::vector<double> q = random_configuration(chain.coordinates, random);
            models[k]->linearise({q, correction}, {}, X, none, nullptr);
            ASSERT_LT((X.matrix() - table.tip(q).matrix()).cwiseAbs().maxCoeff(), 1e-9) << named.name;
          }
        }
  }
}

TEST(DhTable, OfAPlanarArmHasItsLinkLengthsAndHayatisAngle) {
  const TemporaryFolder folder;
  SerialArmSpec arm;
  arm.urdf = folder.write("planar.urdf", urdf_text({{'R', "0 0 0.5", "0 0 0", "0 0 1"},
                                                    {'R', "0.4 0 0", "0 0 0", "0 0 1"},
                                                    {'R', "0.3 0 0", "0 0 0", "0 0 1"}}));
  const DhTable distal = dh_table(arm, {}, Convention::frames, {{"j2.x", "m", 0.4, 0.401}, {"j2.ry", "rad", 0, 1e-4}},
                                  DhConvention::distal);
  ASSERT_EQ(distal.rows.size(), 3U);
  EXPECT_NEAR(distal.rows[0].a, 0.401, 1e-15);
  EXPECT_NEAR(distal.rows[0].beta.value(), 1e-4, 1e-12);
  EXPECT_NEAR(distal.rows[1].a, 0.3, 1e-12);
  EXPECT_FALSE(distal.rows[2].beta.has_value());
  EXPECT_NEAR(distal.X_BaseFirst.translation().z(), 0.5, 1e-15);
  const DhTable proximal = dh_table(arm, {}, Convention::frames, {}, DhConvention::proximal);
  EXPECT_NEAR(proximal.rows[1].a, 0.4, 1e-15);
  EXPECT_NEAR(proximal.rows[2].a, 0.3, 1e-15);
  // As a calibration leaves them: no row goes to where the axes meet.
  for (const double tilt : {1e-4, 2e-3, 1e-2})
    for (const DhConvention convention : tables) {
      const DhTable tilted =
          dh_table(arm, {}, Convention::frames, {{"j2.ry", "rad", 0, tilt}, {"j3.rx", "rad", 0, tilt}}, convention);
      EXPECT_LT(tilted.X_LastTip.translation().norm(), 0.3) << tilt;  // the tip of all these arms is 0.23 m off
      for (const DhRow& row : tilted.rows) {
        EXPECT_LT(std::abs(row.d), 0.1) << tilt;
        EXPECT_LT(row.a, 0.41) << tilt;
      }
    }
}

TEST(DhTable, NamesGearsAndSpringsAsLeftOut) {
  const TemporaryFolder folder;
  SerialArmSpec arm;
  arm.urdf = folder.write("one.urdf", urdf_text({{'R', "0 0 0.5", "0 0 0", "0 0 1"}}));
  const DhTable table = dh_table(arm, {}, Convention::frames, {{"j1.gear", "1", 0, 0.001}}, DhConvention::distal);
  ASSERT_EQ(table.left_out.size(), 1U);
  EXPECT_TRUE(table.left_out.front().starts_with("j1.gear = 0.001: ")) << table.left_out.front();
}

}  // namespace
}  // namespace posewright
