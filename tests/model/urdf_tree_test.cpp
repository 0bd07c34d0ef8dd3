#include "src/model/urdf_tree.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "posewright/support/random.hpp"

namespace posewright {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// One link `base` with this inside it.
UrdfTree tree_of(const std::string& link, const std::string& beside = "") {
  return {fmt::format("<robot name=\"r\">\n{}\n<link name=\"base\">\n{}\n</link></robot>", beside, link), "r.urdf"};
}

std::string collision_error(const std::string& link) {
  try {
    const UrdfTree tree = tree_of(link);
    static_cast<void>(tree.collision_shapes(tree.root()));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(UrdfTree, HasEachJointAsTheFileHasIt) {
  const UrdfTree tree(R"(<robot name="r" version="1.0"><link name="b"/><link name="a"/><link name="c"/>
<joint name="second" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="0 0 -2"/>
  <origin xyz="1 -2e-1 +3" rpy="0.1 0.2 0.3"/><limit lower="-0.5" upper="1.5" effort="9" velocity="0.7"/>
  <safety_controller k_velocity="1" soft_lower_limit="-0.4" soft_upper_limit="1.4"/></joint>
<joint name="first" type="floating"><parent link="b"/><child link="a"/><mimic joint="second" offset="0.25"/></joint>
</robot>)",
                      "r.urdf");
  EXPECT_EQ(tree.robot(), "r");
  EXPECT_EQ(tree.root().name, "b");
  ASSERT_EQ(tree.root().below.size(), 2U);
  EXPECT_EQ(tree.root().below[0]->name, "first") << "in the order of their names";
  const UrdfJoint& joint = *tree.joint("second");
  EXPECT_EQ(joint.index, 0U);
  EXPECT_EQ(joint.place.line, 2);
  EXPECT_EQ(joint.type, UrdfJoint::Type::prismatic);
  EXPECT_EQ(joint.parent, &tree.root());
  EXPECT_EQ(joint.child, tree.link("c"));
  EXPECT_EQ(joint.child->above, &joint);
  EXPECT_EQ(joint.axis, Eigen::Vector3d(0, 0, -2));
  EXPECT_EQ(joint.X_ParentJoint.translation(), Eigen::Vector3d(1, -0.2, 3));
  const Eigen::Matrix3d R =
      (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  EXPECT_LT((joint.X_ParentJoint.linear() - R).norm(), 1e-15);
  EXPECT_EQ(joint.limits->lower, -0.5);
  EXPECT_EQ(joint.limits->upper, 1.5);
  EXPECT_EQ(joint.limits->velocity, 0.7);
  EXPECT_EQ(joint.soft_lower, -0.4);
  EXPECT_EQ(joint.soft_upper, 1.4);
  EXPECT_TRUE(joint.moves() && joint.has_axis());
  const UrdfJoint& other = *tree.joint("first");
  EXPECT_TRUE(other.moves() && !other.has_axis());
  EXPECT_EQ(other.axis, Eigen::Vector3d::UnitX()) << "the format's axis of a joint that names none";
  EXPECT_TRUE(other.X_ParentJoint.isApprox(Eigen::Isometry3d::Identity(), 0));
  EXPECT_FALSE(other.limits);
  EXPECT_EQ(other.mimic->master, "second");
  EXPECT_EQ(other.mimic->multiplier, 1);
  EXPECT_EQ(other.mimic->offset, 0.25);
  EXPECT_EQ(tree.joint("third"), nullptr);
  EXPECT_EQ(tree.link("third"), nullptr);
}

TEST(UrdfTree, HasTheDoublesNearestToTheDecimals) {
  Random random(11, 0);
  for (int i = 0; i < 300; ++i) {
    const std::string mass = fmt::format("{:.{}f}e{}", random.uniform(0, 10), random.index(20), random.index(40) - 20);
    const UrdfTree tree = tree_of("<inertial><mass value=\"" + mass + "\"/></inertial>");
    EXPECT_EQ(tree.root().mass, std::strtod(mass.c_str(), nullptr)) << mass;
  }
}

TEST(UrdfTree, KeepsShapesAndMassOfALinkWithoutInertia) {
  const std::string box = "<collision><geometry><box size=\"1 2 3\"/></geometry></collision>";
  for (const char* inertial :
       {"<inertial><origin xyz=\"0 0 0.5\"/><mass value=\"2\"/></inertial>",
        "<inertial><mass value=\"2\"/><origin xyz=\"0 0 0.5\"/><inertia ixx=\"x\"/></inertial>"}) {
    const UrdfTree tree = tree_of(inertial + box);
    EXPECT_EQ(tree.root().mass, 2);
    EXPECT_EQ(tree.root().centre_of_mass.z(), 0.5);
    ASSERT_EQ(tree.collision_shapes(tree.root()).size(), 1U);
  }
  EXPECT_EQ(tree_of("<inertial/>").root().mass, 0);
}

TEST(UrdfTree, HasTheShapesOfALinkInTheirOrder) {
  const UrdfTree tree = tree_of(R"(<collision><geometry><box size="1 2 3"/></geometry></collision>
<collision><origin xyz="0 0 4"/><geometry><cylinder length="5" radius="6"/></geometry></collision>
<collision><geometry><sphere radius="7"/></geometry></collision>
<collision><geometry><mesh filename="package://p/m.stl" scale="0.001 0.001 -0.001"/></geometry></collision>)");
  const std::vector<UrdfShape> shapes = tree.collision_shapes(tree.root());
  ASSERT_EQ(shapes.size(), 4U);
  EXPECT_EQ(std::get<BoxShape>(shapes[0].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<CylinderShape>(shapes[1].shape).length, 5);
  EXPECT_EQ(std::get<CylinderShape>(shapes[1].shape).radius, 6);
  EXPECT_EQ(shapes[1].X_LinkShape.translation().z(), 4);
  EXPECT_EQ(std::get<SphereShape>(shapes[2].shape).radius, 7);
  EXPECT_EQ(std::get<MeshShape>(shapes[3].shape).file, "package://p/m.stl");
  EXPECT_EQ(std::get<MeshShape>(shapes[3].shape).scale, Eigen::Vector3d(0.001, 0.001, -0.001));
  EXPECT_TRUE(tree.visual_shapes(tree.root()).empty());
}

TEST(UrdfTree, RefusesACollisionThatItCannotReadAtItsLine) {
  const auto of = [](const std::string& geometry) {
    return collision_error("<collision>\n<geometry>" + geometry + "</geometry></collision>");
  };
  EXPECT_THAT(of("<box/>"), HasSubstr("r.urdf:5: box has no size"));
  EXPECT_THAT(of("<box size=\"1 2\"/>"), HasSubstr("r.urdf:5: box size=\"1 2\" is malformed"));
  EXPECT_THAT(of("<box size=\"1 2 0\"/>"), HasSubstr("r.urdf:5: box size=\"1 2 0\" is not positive"));
  EXPECT_THAT(of("<cylinder radius=\"1\"/>"), HasSubstr("r.urdf:5: cylinder has no length"));
  EXPECT_THAT(of("<sphere radius=\"-1\"/>"), HasSubstr("r.urdf:5: sphere radius=\"-1\" is not positive"));
  EXPECT_THAT(of("<mesh/>"), HasSubstr("r.urdf:5: mesh has no filename"));
  EXPECT_THAT(of("<mesh filename=\"m.stl\" scale=\"1\"/>"), HasSubstr("r.urdf:5: mesh scale=\"1\" is malformed"));
  EXPECT_THAT(
      of("<capsule radius=\"1\" length=\"2\"/>"),
      HasSubstr(
          "r.urdf:5: collision of link 'base' has the unknown geometry 'capsule'; box, cylinder, sphere or mesh"));
  EXPECT_THAT(of(""), HasSubstr("r.urdf:4: collision has no geometry"));
  EXPECT_THAT(collision_error("<collision/>"), HasSubstr("r.urdf:4: collision has no geometry"));
}

TEST(UrdfTree, PassesOverAVisualOfNoKnownGeometry) {
  const UrdfTree tree = tree_of(R"(<visual><geometry><capsule radius="1"/></geometry></visual><visual/>
<visual><geometry><sphere radius="2"/></geometry></visual>)");
  const std::vector<UrdfShape> shapes = tree.visual_shapes(tree.root());
  ASSERT_EQ(shapes.size(), 1U);
  EXPECT_EQ(std::get<SphereShape>(shapes[0].shape).radius, 2);
}

TEST(UrdfTree, ColoursALinkByTheFirstDefinitionOfItsMaterial) {
  const auto colour = [](const std::string& material, const std::string& beside = "") {
    const UrdfTree tree = tree_of("<visual>" + material + "</visual>", beside);
    return tree.colour(tree.root());
  };
  const auto rgba = [](const char* name, const char* text) {
    return fmt::format("<material name=\"{}\"><color rgba=\"{}\"/></material>", name, text);
  };
  EXPECT_THAT(*colour(rgba("", "0.5 0.25 1 1")), ElementsAre(0.5, 0.25, 1));
  EXPECT_THAT(*colour(rgba("m", "0 0 1 1"), rgba("m", "1 0 0 1")), ElementsAre(1, 0, 0));
  EXPECT_THAT(*colour("<material name=\"m\"/>", rgba("m", "1 0 0 1")), ElementsAre(1, 0, 0));
  EXPECT_THAT(*colour("<material name=\"m\"/>", "<link name=\"l\"><visual>" + rgba("m", "0 1 0 1") +
                                                    "</visual></link><joint name=\"j\" type=\"fixed\">"
                                                    "<parent link=\"base\"/><child link=\"l\"/></joint>"),
              ElementsAre(0, 1, 0));
  EXPECT_FALSE(colour("<material name=\"m\"/>")) << "nobody defines it";
  EXPECT_FALSE(colour(rgba("", "0 0 0 1"))) << "black means none";
  EXPECT_FALSE(colour(rgba("", "1 1 1 0"))) << "it is not to be seen";
  EXPECT_FALSE(colour(rgba("", "255 0 0 1")));
  EXPECT_FALSE(colour(""));
  EXPECT_FALSE(colour("<material name=\"m\"/>", "<material name=\"m\"><texture filename=\"t.png\"/></material>"));
}

TEST(UrdfTree, KeepsItsPointersWhenItIsMoved) {
  UrdfTree first(
      "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/><joint name=\"j\" type=\"fixed\"><parent "
      "link=\"a\"/><child link=\"b\"/></joint></robot>",
      "r.urdf");
  const UrdfTree tree = std::move(first);
  EXPECT_EQ(tree.link("a"), &tree.root());
  EXPECT_EQ(tree.root().below.front(), tree.joint("j"));
  EXPECT_TRUE(tree.collision_shapes(*tree.link("b")).empty());
}

}  // namespace
}  // namespace posewright
