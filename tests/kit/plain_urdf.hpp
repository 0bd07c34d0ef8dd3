#pragma once

#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>

namespace posewright {

/// Links and joints of a URDF in a few lines, apart from the program's reader; files are well-formed.
struct PlainUrdf {
  struct Joint {
    std::string name, type, parent;
    Eigen::Isometry3d X_ParentJoint;
    Eigen::Vector3d axis;
    double lower, upper, velocity, soft_lower, soft_upper;
  };
  /// A box has a size, a mesh a file.
  struct Shape {
    Eigen::Isometry3d X_LinkShape;
    Eigen::Vector3d size, scale;
    std::string mesh;
  };
  std::map<std::string, Joint> above;      // by the link below it
  std::map<std::string, Shape> collision;  // the first of each link that has one

  explicit PlainUrdf(const std::filesystem::path& file) {
    tinyxml2::XMLDocument document;
    if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) throw std::runtime_error(file.string());
    const tinyxml2::XMLElement* robot = document.RootElement();
    for (const auto* e = robot->FirstChildElement("joint"); e != nullptr; e = e->NextSiblingElement("joint"))
      above[text(e->FirstChildElement("child"), "link")] = joint_of(*e);
    for (const auto* e = robot->FirstChildElement("link"); e != nullptr; e = e->NextSiblingElement("link"))
      if (const auto* shape = e->FirstChildElement("collision"); shape != nullptr) {
        const auto* geometry = shape->FirstChildElement("geometry");
        const auto *box = geometry->FirstChildElement("box"), *mesh = geometry->FirstChildElement("mesh");
        if (box == nullptr && mesh == nullptr) continue;
        collision[e->Attribute("name")] = {origin(*shape), vector(box, "size", {0, 0, 0}),
                                           vector(mesh, "scale", {1, 1, 1}), text(mesh, "filename")};
      }
  }

  /// Pose of a link in the root; joints without a value stand at zero.
  Eigen::Isometry3d pose(const std::string& link, const std::map<std::string, double>& joints) const {
    const auto found = above.find(link);
    if (found == above.end()) return Eigen::Isometry3d::Identity();
    const Joint& joint = found->second;
    Eigen::Isometry3d X = pose(joint.parent, joints) * joint.X_ParentJoint;
    const auto value = joints.find(joint.name);
    if (value == joints.end()) return X;
    if (joint.type == "prismatic") X.translate(joint.axis.normalized() * value->second);
    else X.rotate(Eigen::AngleAxisd(value->second, joint.axis.normalized()));
    return X;
  }

 private:
  using Element = tinyxml2::XMLElement;

  static std::string text(const Element* e, const char* attribute, const char* none = "") {
    const char* value = e == nullptr ? nullptr : e->Attribute(attribute);
    return value == nullptr ? none : value;
  }
  static double number(const Element* e, const char* attribute) { return std::atof(text(e, attribute, "0").c_str()); }
  static Eigen::Vector3d vector(const Element* e, const char* attribute, Eigen::Vector3d value) {
    const std::string numbers = text(e, attribute);
    char* at = const_cast<char*>(numbers.c_str());
    for (int i = 0; i < 3 && !numbers.empty(); ++i) value[i] = std::strtod(at, &at);
    return value;
  }
  static Eigen::Isometry3d origin(const Element& parent) {
    const Element* e = parent.FirstChildElement("origin");
    const Eigen::Vector3d rpy = vector(e, "rpy", {0, 0, 0});
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translate(vector(e, "xyz", {0, 0, 0}));
    X.rotate(Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()));
    X.rotate(Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()));
    X.rotate(Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()));
    return X;
  }
  static Joint joint_of(const Element& e) {
    const auto *limit = e.FirstChildElement("limit"), *soft = e.FirstChildElement("safety_controller");
    return {e.Attribute("name"),
            e.Attribute("type"),
            text(e.FirstChildElement("parent"), "link"),
            origin(e),
            vector(e.FirstChildElement("axis"), "xyz", {1, 0, 0}),
            number(limit, "lower"),
            number(limit, "upper"),
            number(limit, "velocity"),
            number(soft, "soft_lower_limit"),
            number(soft, "soft_upper_limit")};
  }
};

}  // namespace posewright
