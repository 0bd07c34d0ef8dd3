// The way from a base to a tip anywhere in the tree of a URDF.

#include "src/model/urdf_document.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <numeric>

#include "posewright/model/corrected_urdf.hpp"
#include "posewright/model/dh_chain.hpp"
#include "posewright/model/link_geometry.hpp"
#include "posewright/model/serial_chain.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/plain_urdf.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Values = std::map<std::string, double>;

std::string three(Random& random, double size) {
  return fmt::format("{} {} {}", random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
}

/// A tree of 14 links l0 … l13 with fixed, turning, sliding and following joints; each link has a shape.
std::string random_tree(std::uint64_t seed) {
  Random random(seed, 0);
  std::string text = "<robot name=\"tree\">\n", master;
  for (int i = 0; i < 14; ++i)
    text += fmt::format(
        "<link name=\"l{}\"><collision><origin xyz=\"{}\"/><geometry><sphere radius=\"0.1\"/></geometry>"
        "</collision></link>\n",
        i, three(random, 1));
  for (int i = 1; i < 14; ++i) {
    const int kind = i == 1 ? 1 : random.index(5);
    const bool follows = kind == 4 && !master.empty();
    text += fmt::format(
        "<joint name=\"j{0}\" type=\"{1}\"><parent link=\"l{2}\"/><child link=\"l{0}\"/><origin xyz=\"{3}\" "
        "rpy=\"{4}\"/><axis xyz=\"{5}\"/>{6}{7}</joint>\n",
        i, std::array{"fixed", "revolute", "continuous", "prismatic", "revolute"}[std::size_t(kind)], random.index(i),
        three(random, 1), three(random, 3), three(random, 1),
        kind == 0 ? "" : "<limit lower=\"-90\" upper=\"90\" effort=\"1\" velocity=\"1\"/>",
        follows ? fmt::format("<mimic joint=\"{}\" multiplier=\"-0.7\" offset=\"0.3\"/>", master) : "");
    if (kind != 0 && !follows && random.index(2) == 0) master = fmt::format("j{}", i);
  }
  return text + "</robot>";
}

SerialArmSpec arm_of(const std::filesystem::path& urdf, const std::string& base, const std::string& tip) {
  SerialArmSpec arm;
  arm.urdf = urdf;
  arm.base = Located<std::string>{base, 3};
  arm.tip = Located<std::string>{tip, 4};
  return arm;
}

/// Values of the joints that are held and of those that follow them.
Values held_by(const SerialArmSpec& arm) {
  Values values;
  for (const auto& [name, value] : arm.hold) values[name.value] = value.value;
  const UrdfDocument whole = UrdfDocument::whole(arm);
  for (const auto& [name, joint] : whole.tree().joints())
    if (joint.mimic && values.count(joint.mimic->master) > 0)
      values[name] = joint.mimic->multiplier * values.at(joint.mimic->master) + joint.mimic->offset;
  return values;
}

/// With those of all joints of the way.
Values values_of(Values values, const ChainDescription& chain, const std::vector<double>& q) {
  for (std::size_t i = 0; i < q.size(); ++i) values[chain.coordinates[i].name] = q[i];
  for (const ChainJoint& joint : chain.joints)
    values[joint.name] = joint.multiplier * q[std::size_t(joint.coordinate)] + joint.offset;
  return values;
}

std::vector<double> some_configuration(const ChainDescription& chain, Random& random) {
  std::vector<double> q;
  for (std::size_t i = 0; i < chain.coordinates.size(); ++i) q.push_back(random.uniform(-2, 2));
  return q;
}

Eigen::Isometry3d tip_of(const SerialChain& chain, const std::vector<double>& q,
                         const std::vector<double>& correction) {
  Eigen::Isometry3d X;
  Twists none;
  chain.linearise({q, correction}, {}, X, none, nullptr);
  return X;
}

/// The tip by the tree alone: each joint of the way is displaced in the sense of the URDF, whichever way it is passed.
Eigen::Isometry3d by_tree(const SerialArmSpec& arm, PlainUrdf plain, const Values& held, const SerialChain& model,
                          const std::vector<double>& q, const std::vector<double>& correction) {
  const ChainDescription& chain = model.description();
  std::map<std::string, double> of;
  for (std::size_t i = 0; i < correction.size(); ++i) of[model.parameters()[i].name] = correction[i];
  const auto displacement = [&](const std::string& name) {
    Eigen::Isometry3d D = Eigen::Isometry3d::Identity();
    D.translate(Eigen::Vector3d(of[name + ".x"], of[name + ".y"], of[name + ".z"]));
    D.rotate(Eigen::AngleAxisd(of[name + ".rz"], Eigen::Vector3d::UnitZ()));
    D.rotate(Eigen::AngleAxisd(of[name + ".ry"], Eigen::Vector3d::UnitY()));
    D.rotate(Eigen::AngleAxisd(of[name + ".rx"], Eigen::Vector3d::UnitX()));
    return D;
  };
  Values values = values_of(held, chain, q);
  for (const ChainJoint& joint : chain.joints) {
    for (const ChainJoint& own : chain.joints)
      if (!own.mimic && own.coordinate == joint.coordinate)
        values[joint.name] +=
            joint.multiplier * (of[own.name + ".gear"] * q[std::size_t(joint.coordinate)] + of[own.name + ".offset"]);
    for (auto& [link, above] : plain.above)
      if (above.name == joint.name) above.X_ParentJoint = above.X_ParentJoint * displacement(joint.name);
  }
  return displacement("base") * plain.pose(arm.base->value, values).inverse() * plain.pose(arm.tip->value, values) *
         displacement("tool");
}

double off(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

/// Calls act(arm, document, chain, random) for pairs of links of random trees with a joint that moves between; every
/// other one holds joints anywhere in the tree.
template <class Act>
int for_random_ways(const TemporaryFolder& folder, int trees, const Act& act) {
  int backward = 0;
  for (int seed = 1; seed <= trees; ++seed) {
    const std::filesystem::path urdf = folder.write(fmt::format("tree{}.urdf", seed), random_tree(std::uint64_t(seed)));
    Random random(std::uint64_t(seed), 1);
    for (int i = 0; i < 6; ++i) {
      SerialArmSpec arm = arm_of(urdf, fmt::format("l{}", random.index(14)), fmt::format("l{}", random.index(14)));
      const UrdfDocument whole = UrdfDocument::whole(arm);
      for (const auto& [name, joint] : whole.tree().joints())
        if (i % 2 == 1 && joint.moves() && !joint.mimic && random.index(4) == 0)
          arm.hold.push_back({{name, 5}, {random.uniform(-2, 2), Quantity::number}});
      const UrdfDocument document(arm, {"p.yaml", 1});
      if (std::ranges::none_of(document.way(), [](const UrdfStep& s) { return s.joint->moves(); })) continue;
      backward += document.moves_base() ? 1 : 0;
      act(arm, document, read_urdf_chain(arm, {"p.yaml", 1}), random);
    }
  }
  return backward;
}

TEST(UrdfDocument, HasTheWayUpToTheLinkThatBothHangOnAndDown) {
  const TemporaryFolder folder;
  const auto joint = [](const char* name, const char* parent, const char* child) {
    return fmt::format(
        "<link name=\"{2}\"/><joint name=\"{0}\" type=\"continuous\"><parent link=\"{1}\"/><child "
        "link=\"{2}\"/></joint>",
        name, parent, child);
  };
  const std::filesystem::path urdf = folder.write(
      "r.urdf", "<robot name=\"r\"><link name=\"pelvis\"/>" + joint("waist", "pelvis", "torso") +
                    joint("l1", "torso", "la") + joint("l2", "la", "lh") + joint("r1", "torso", "rh") + "</robot>");
  const auto way = [&](const char* base, const char* tip) {
    std::vector<std::string> names;
    const UrdfDocument document(arm_of(urdf, base, tip), {});
    for (const UrdfStep& step : document.way()) names.push_back((step.backward ? "-" : "+") + step.joint->name);
    return names;
  };
  EXPECT_THAT(way("lh", "rh"), ElementsAre("-l2", "-l1", "+r1"));
  EXPECT_THAT(way("lh", "pelvis"), ElementsAre("-l2", "-l1", "-waist"));
  EXPECT_THAT(way("torso", "lh"), ElementsAre("+l1", "+l2"));
  EXPECT_THAT(way("la", "la"), ElementsAre());
  EXPECT_TRUE(root_place(arm_of(urdf, "lh", "rh"), {}).base_moves());
  EXPECT_FALSE(root_place(arm_of(urdf, "torso", "rh"), {}).base_moves());
}

TEST(UrdfDocument, OfAnyTwoLinksIsTheChainBetweenThem) {
  const TemporaryFolder folder;
  const int backward =
      for_random_ways(folder, 40, [](const SerialArmSpec& arm, const auto&, const auto& chain, auto& random) {
        const PlainUrdf plain(arm.urdf);
        const SerialChain model(chain);
        for (int i = 0; i < 5; ++i) {
          const std::vector<double> q = some_configuration(chain, random);
          const Values values = values_of(held_by(arm), chain, q);
          const Eigen::Isometry3d expected =
              plain.pose(arm.base->value, values).inverse() * plain.pose(arm.tip->value, values);
          ASSERT_LT(off(tip_of(model, q, {}), expected), 1e-12) << arm.urdf << arm.base->value << arm.tip->value;
        }
      });
  EXPECT_GT(backward, 100);
}

TEST(UrdfDocument, OfAnyTwoLinksHasTheColumnsOfTheTreeWithDisplacedJoints) {
  const TemporaryFolder folder;
  constexpr double step = 1e-5;
  int configurations = 0;
  for_random_ways(folder, 250, [&](const SerialArmSpec& arm, const auto&, const auto& chain, auto& random) {
    ++configurations;
    const PlainUrdf plain(arm.urdf);
    const Values held = held_by(arm);
    const SerialChain model(chain);
    std::vector<int> all(model.parameters().size());
    std::iota(all.begin(), all.end(), 0);
    std::vector<double> q = some_configuration(chain, random), correction(all.size());
    for (double& c : correction) c = random.uniform(-0.01, 0.01);
    Eigen::Isometry3d X;
    Twists columns, readings;
    model.linearise({q, correction}, all, X, columns, nullptr);
    ASSERT_LT(off(X, by_tree(arm, plain, held, model, q, correction)), 1e-12) << arm.urdf;
    const auto expect_twist = [&](const Twist& column, const Eigen::Isometry3d& before, const Eigen::Isometry3d& after,
                                  const Eigen::Isometry3d& at) {
      const Eigen::Matrix3d W = (after.linear() - before.linear()) * at.linear().transpose() / (2 * step);
      const Eigen::Vector3d rotation(W(2, 1), W(0, 2), W(1, 0));
      const Eigen::Vector3d v =
          (after.translation() - before.translation()) / (2 * step) - rotation.cross(at.translation());
      ASSERT_LT((column.head<3>() - v).norm(), 1e-9 * std::max(1.0, at.translation().norm()) * 10) << arm.urdf;
      ASSERT_LT((column.tail<3>() - rotation).norm(), 1e-9) << arm.urdf;
    };
    for (std::size_t p = 0; p < all.size(); ++p) {
      std::vector<double> less = correction, more = correction;
      less[p] -= step;
      more[p] += step;
      expect_twist(columns.col(Eigen::Index(p)), by_tree(arm, plain, held, model, q, less),
                   by_tree(arm, plain, held, model, q, more), X);
    }
    // Readings by the other road: nothing is corrected.
    model.linearise({q, {}}, {}, X, columns, &readings);
    for (std::size_t i = 0; i < q.size(); ++i) {
      std::vector<double> less = q, more = q;
      less[i] -= step;
      more[i] += step;
      const auto pose = [&](const std::vector<double>& at) {
        const Values values = values_of(held, chain, at);
        return plain.pose(arm.base->value, values).inverse() * plain.pose(arm.tip->value, values);
      };
      expect_twist(readings.col(Eigen::Index(i)), pose(less), pose(more), pose(q));
    }
  });
  EXPECT_GE(configurations, 1000);
}

TEST(UrdfDocument, GivesJointsTheSameNominalValuesWhicheverWayTheyArePassed) {
  const TemporaryFolder folder;
  for_random_ways(folder, 20, [](const SerialArmSpec& arm, const auto&, const auto& chain, auto&) {
    const SerialChain own(chain);
    SerialArmSpec from_root = arm;
    from_root.base->value = "l0";
    for (const char* end : {"base", "tip"}) {
      from_root.tip = std::string(end) == "base" ? arm.base : arm.tip;
      const UrdfDocument way(from_root, {});
      if (std::ranges::none_of(way.way(), [](const UrdfStep& s) { return s.joint->moves(); })) continue;
      const SerialChain forward(read_urdf_chain(from_root, {}));
      for (const Parameter& p : own.parameters()) {
        const std::string joint = p.name.substr(0, p.name.rfind('.'));
        const bool backward =
            std::ranges::any_of(chain.joints, [&](const ChainJoint& j) { return j.name == joint && j.backward(); });
        if (!backward) continue;
        for (const Parameter& same : forward.parameters()) {
          if (same.name == p.name) ASSERT_NEAR(p.nominal, same.nominal, 1e-12) << p.name;
        }
      }
    }
  });
}

TEST(UrdfDocument, OfAnyTwoLinksPutsEveryLinkOnTheFrameThatMovesIt) {
  const TemporaryFolder folder;
  for_random_ways(folder, 30, [](const SerialArmSpec& arm, const auto&, const auto& chain, auto& random) {
    const PlainUrdf plain(arm.urdf);
    const std::vector<double> q = some_configuration(chain, random);
    const Values values = values_of(held_by(arm), chain, q);
    std::vector<Eigen::Isometry3d> frames{Eigen::Isometry3d::Identity()};
    Frame<double> at;
    for (const ChainJoint& joint : chain.joints) {
      at.then(joint.X_ParentJoint);
      const double value = joint.multiplier * q[std::size_t(joint.coordinate)] + joint.offset;
      if (joint.prismatic) at.then_translate(joint.axis * value);
      else at.then_rotate(joint.axis, value);
      frames.emplace_back();
      frames.back().setIdentity();
      frames.back().linear() = at.R;
      frames.back().translation() = at.p;
    }
    Values still = values;
    const UrdfDocument document(arm, {});
    for (const auto& [name, joint] : document.tree().joints())
      if (!joint.held && std::ranges::find(document.way(), &joint, &UrdfStep::joint) == document.way().end())
        still.erase(name);
    const std::vector<LinkGeometry> links = read_urdf_links(arm, {});
    ASSERT_EQ(links.size(), 14U);
    for (const LinkGeometry& link : links) {
      const UrdfShape shape = document.tree().collision_shapes(*document.tree().link(link.name)).front();
      const Eigen::Isometry3d expected =
          plain.pose(arm.base->value, still).inverse() * plain.pose(link.name, still) * shape.X_LinkShape;
      ASSERT_LT(off(frames[std::size_t(link.frame)] * link.shapes.front().X_FrameShape, expected), 1e-12)
          << arm.urdf << link.name << " from " << arm.base->value << " to " << arm.tip->value;
    }
  });
}

TEST(UrdfDocument, OfAnyTwoLinksIsCorrectedInTheFile) {
  const TemporaryFolder folder;
  int exact = 0;
  for_random_ways(
      folder, 40, [&](const SerialArmSpec& arm, const UrdfDocument& document, const auto& chain, auto& random) {
        const SerialChain model(chain);
        const UrdfStep& last = document.way().back();
        std::vector<CalibratedValue> values;
        std::vector<double> correction;
        for (const Parameter& p : model.parameters()) {
          // Not the robot's: its base, a tool without an origin, gears.
          const std::string name = p.name.substr(0, p.name.rfind('.'));
          const bool of_base = name == "base";
          const bool of_tool = name == "tool" && !last.backward && last.joint->type != UrdfJoint::Type::fixed;
          const bool stray = std::ranges::any_of(document.tree().joints(), [&](const auto& entry) {
            return entry.second.mimic && p.name == entry.second.mimic->master + ".offset";
          });
          const double shift =
              of_base || of_tool || stray || p.name.ends_with(".gear") ? 0.0 : random.uniform(-0.02, 0.02);
          values.push_back({p.name, p.unit, p.nominal, p.nominal + shift});
          correction.push_back(shift);
        }
        const CorrectedUrdf corrected = corrected_urdf(arm, {}, VariantSpec::Convention::frames, values);
        EXPECT_THAT(corrected.left_out, ElementsAre());
        const PlainUrdf plain(folder.write("written.urdf", corrected.text));
        for (int i = 0; i < 5; ++i) {
          const std::vector<double> q = some_configuration(chain, random);
          const Values at = values_of(held_by(arm), chain, q);
          const Eigen::Isometry3d found = plain.pose(arm.base->value, at).inverse() * plain.pose(arm.tip->value, at);
          ASSERT_LT(off(tip_of(model, q, correction), found), 1e-11) << arm.urdf << arm.base->value << arm.tip->value;
        }
        ++exact;
      });
  EXPECT_GT(exact, 100);
}

TEST(UrdfDocument, CorrectsTheOffsetOfAJointThatIsPassedBackwardInItsOwnOrigin) {
  const TemporaryFolder folder;
  for_random_ways(
      folder, 20, [&](const SerialArmSpec& arm, const UrdfDocument& document, const auto& chain, auto& random) {
        const SerialChain model(chain);
        Values offsets;
        std::vector<CalibratedValue> values;
        for (const UrdfStep& step : document.way())
          if (step.joint->moves() && !step.joint->mimic) {
            const bool master = std::ranges::any_of(document.tree().joints(), [&](const auto& entry) {
              return entry.second.mimic && entry.second.mimic->master == step.joint->name;
            });
            offsets[step.joint->name] = master ? 0.0 : random.uniform(-0.1, 0.1);
            values.push_back({step.joint->name + ".offset", "rad", 0.0, offsets[step.joint->name]});
          }
        const PlainUrdf before(arm.urdf);
        const PlainUrdf after(
            folder.write("written.urdf", corrected_urdf(arm, {}, VariantSpec::Convention::frames, values).text));
        // Every link of the robot is where the old file puts it with readings that are right.
        const Values at = values_of(held_by(arm), chain, some_configuration(chain, random));
        Values right = at;
        for (const auto& [name, offset] : offsets) right[name] += offset;
        for (const auto& [name, link] : document.tree().links())
          ASSERT_LT(off(before.pose(name, right), after.pose(name, at)), 1e-11) << arm.urdf << name;
      });
}

TEST(UrdfDocument, IsCorrectedByDenavitHartenbergParametersOfAnyWay) {
  const TemporaryFolder folder;
  int backward = 0;
  for_random_ways(
      folder, 40, [&](const SerialArmSpec& arm, const UrdfDocument& document, const auto& chain, auto& random) {
        if (std::ranges::any_of(chain.joints, [](const ChainJoint& j) { return j.multiplier != 1 || j.offset != 0; }))
          return;
        const DhChain model(denavit_hartenberg(chain, DhConvention::distal));
        std::vector<CalibratedValue> values;
        std::vector<double> correction;
        for (const Parameter& p : model.parameters()) {
          correction.push_back(random.uniform(-0.02, 0.02));
          values.push_back({p.name, p.unit, p.nominal, p.nominal + correction.back()});
        }
        const auto convention = VariantSpec::Convention::dh;
        const ChainCorrection parts = chain_correction(chain, convention, values);
        const PlainUrdf plain(folder.write("written.urdf", corrected_urdf(arm, {}, convention, values).text));
        const UrdfStep& last = document.way().back();
        const bool has_tool = last.backward || last.joint->type == UrdfJoint::Type::fixed;
        for (int i = 0; i < 5; ++i) {
          const std::vector<double> q = some_configuration(chain, random);
          Eigen::Isometry3d X;
          Twists none;
          model.linearise({q, correction}, {}, X, none, nullptr);
          const Values at = values_of(held_by(arm), chain, q);
          Eigen::Isometry3d found =
              parts.base.X * plain.pose(arm.base->value, at).inverse() * plain.pose(arm.tip->value, at);
          if (!has_tool) found = found * parts.tip.X;
          ASSERT_LT(off(X, found), 1e-9) << arm.urdf << arm.base->value << arm.tip->value;
          ASSERT_LT(off(X, tip_of(SerialChain(corrected_chain(chain, parts)), q, {})), 1e-9);
        }
        backward += document.moves_base() ? 1 : 0;
      });
  EXPECT_GT(backward, 20);
}

TEST(UrdfDocument, RefusesToHoldWhatCannotBeHeld) {
  const TemporaryFolder folder;
  SerialArmSpec arm = arm_of(folder.write("r.urdf", R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
    <link name="d"/><link name="e"/>
    <joint name="head_pan" type="revolute"><parent link="a"/><child link="b"/><limit lower="-1" upper="1" effort="1"
      velocity="1"/></joint>
    <joint name="lift" type="prismatic"><parent link="b"/><child link="c"/><limit lower="0" upper="1" effort="1"
      velocity="1"/></joint>
    <joint name="finger" type="continuous"><parent link="c"/><child link="d"/><mimic joint="lift"/></joint>
    <joint name="mount" type="fixed"><parent link="d"/><child link="e"/></joint></robot>)"),
                             "a", "e");
  const auto message = [&](const std::vector<std::pair<std::string, Measured>>& hold) -> std::string {
    arm.hold.clear();
    for (const auto& [name, value] : hold) arm.hold.push_back({{name, 7}, value});
    try {
      read_urdf_chain(arm, {"p.yaml", 1});
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(message({{"head_*", {0.5, Quantity::angle}}}), "");
  EXPECT_THAT(message({{"haed_pan", {}}}), HasSubstr("p.yaml:7: hold: 'haed_pan' is no joint of r.urdf that moves"));
  EXPECT_THAT(message({{"mount", {}}}), HasSubstr("'mount' is no joint of r.urdf that moves"));
  EXPECT_THAT(message({{"finger", {}}}), HasSubstr("joint 'finger' follows 'lift'"));
  EXPECT_THAT(message({{"f*", {}}}), HasSubstr("'f*' is no joint"));
  EXPECT_THAT(message({{"lift", {0.5, Quantity::angle}}}), HasSubstr("joint 'lift' slides, and is held at an angle"));
  EXPECT_THAT(message({{"head_pan", {0.5, Quantity::length}}}), HasSubstr("turns, and is held at a length"));
  EXPECT_THAT(message({{"head_pan", {2, Quantity::angle}}}), HasSubstr("held at 2, beyond its limits"));
  EXPECT_THAT(message({{"head_pan", {}}, {"head_*", {}}}), HasSubstr("joint 'head_pan' is held twice"));
  EXPECT_THAT(message({{"*", {}}}), HasSubstr("no joint moves between 'a' and 'e'"));
}

TEST(UrdfDocument, OfAMovedBaseHasNoSprings) {
  const TemporaryFolder folder;
  SerialArmSpec arm = arm_of(folder.write("r.urdf", random_tree(1)), "l1", "l0");
  arm.elastostatic.emplace();
  arm.elastostatic->line = 7;
  try {
    read_urdf_chain(arm, {"p.yaml", 1});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("p.yaml:7: elastostatic needs a base that stands"));
  }
}

}  // namespace
}  // namespace posewright
