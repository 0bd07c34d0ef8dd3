#include "urdf_tree.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "posewright/blocks/pose_choices.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/text.hpp"

namespace posewright {
namespace {

using Element = tinyxml2::XMLElement;

// Of a file; more is not a robot.
constexpr std::size_t most_joints = 50'000;

std::vector<const Element*> children(const Element& parent, const char* tag) {
  std::vector<const Element*> found;
  for (const Element* e = parent.FirstChildElement(tag); e != nullptr; e = e->NextSiblingElement(tag))
    found.push_back(e);
  return found;
}

/// Values of an element's attributes, or its place in an error.
class Values {
 public:
  Values(const Element& element, const std::string& file) : element_(element), file_(file) {}

  SourcePlace place() const { return {file_, element_.GetLineNum()}; }
  [[noreturn]] void fail(const std::string& what, const std::string& allowed) const {
    throw InputError(place(), what, allowed);
  }
  /// Throws InputError if there is none; `of` names the element.
  std::string text(const char* attribute, const std::string& of) const {
    const char* value = element_.Attribute(attribute);
    if (value == nullptr) fail(of + " has no " + attribute, std::string(attribute) + "=\"…\" is needed");
    return value;
  }
  /// Value of the attribute, or `value` if there is none.
  double number(const char* attribute, double value) const {
    const auto read = numbers(attribute, 1);
    return read.empty() ? value : read.front();
  }
  Eigen::Vector3d vector(const char* attribute, const Eigen::Vector3d& value) const {
    const auto read = numbers(attribute, 3);
    return read.empty() ? value : Eigen::Vector3d(read[0], read[1], read[2]);
  }
  /// As number() and vector(), of an attribute that must be there.
  double needed_number(const char* attribute) const {
    text(attribute, element_.Name());
    return number(attribute, 0);
  }
  Eigen::Vector3d needed_vector(const char* attribute) const {
    text(attribute, element_.Name());
    return vector(attribute, Eigen::Vector3d::Zero());
  }

 private:
  std::vector<double> numbers(const char* attribute, std::size_t count) const {
    const char* text = element_.Attribute(attribute);
    if (text == nullptr) return {};
    auto numbers = numbers_in(text);
    if (!numbers || numbers->size() != count)
      fail(std::string(element_.Name()) + " " + attribute + "=\"" + text + "\" is malformed",
           count == 1 ? "one finite number is allowed" : "three finite numbers separated by blanks are allowed");
    return *numbers;
  }

  const Element& element_;
  const std::string& file_;
};

/// By half angles and a quaternion, as most readers of URDFs: other roads differ in the last bits.
Eigen::Isometry3d origin_of(const Element& parent, const std::string& file) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  const Element* origin = parent.FirstChildElement("origin");
  if (origin == nullptr) return X;
  const Values values(*origin, file);
  X.translation() = values.vector("xyz", Eigen::Vector3d::Zero());
  const Eigen::Vector3d half = values.vector("rpy", Eigen::Vector3d::Zero()) / 2.0;
  const double s[] = {std::sin(half[0]), std::sin(half[1]), std::sin(half[2])};
  const double c[] = {std::cos(half[0]), std::cos(half[1]), std::cos(half[2])};
  const double x = s[0] * c[1] * c[2] - c[0] * s[1] * s[2];
  const double y = c[0] * s[1] * c[2] + s[0] * c[1] * s[2];
  const double z = c[0] * c[1] * s[2] - s[0] * s[1] * c[2];
  const double w = c[0] * c[1] * c[2] + s[0] * s[1] * s[2];
  const double length = std::sqrt(x * x + y * y + z * z + w * w);
  X.linear() = Eigen::Quaterniond(w / length, x / length, y / length, z / length).normalized().toRotationMatrix();
  return X;
}

/// Names of joints become columns of lists and words of programs: names that would break those are refused here.
void check_name(const std::string& name, const Values& joint) {
  const bool broken = has_control_character(name) || name.find_first_of(",;\"'[]#") != std::string::npos ||
                      trimmed_blanks(name) != name;
  if (broken)
    joint.fail("joint name " + in_quotes(name) + " would break lists of poses",
               "no comma, semicolon, quote, bracket, # or line break, no blank at either end");
  if (name == "pose" || name == "id" || name == "weight" || choice_key(name) != nullptr)
    joint.fail("joint name " + in_quotes(name) + " is a column of its own in lists", "rename the joint");
}

UrdfJoint::Type type_of(const std::string& name, const Values& joint) {
  using enum UrdfJoint::Type;
  const std::string type = joint.text("type", "joint '" + name + "'");
  for (const auto& [word, value] :
       {std::pair("revolute", revolute), std::pair("continuous", continuous), std::pair("prismatic", prismatic),
        std::pair("fixed", fixed), std::pair("floating", floating), std::pair("planar", planar)})
    if (type == word) return value;
  joint.fail("joint '" + name + "' has the unknown type " + in_quotes(type),
             "revolute, continuous, prismatic, fixed, floating, planar");
}

void read_limits(const Element& element, const std::string& file, UrdfJoint& joint) {
  if (const Element* limit = element.FirstChildElement("limit"); limit != nullptr) {
    const Values values(*limit, file);
    for (const char* attribute : {"effort", "velocity"}) values.text(attribute, "limit of joint '" + joint.name + "'");
    values.number("effort", 0);
    joint.limits = UrdfLimits{values.number("lower", 0), values.number("upper", 0), values.number("velocity", 0)};
  } else if (joint.type == UrdfJoint::Type::revolute || joint.type == UrdfJoint::Type::prismatic) {
    Values(element, file)
        .fail("joint '" + joint.name + "' has no <limit>", "lower and upper are needed, or type continuous");
  }
  const Element* safety = element.FirstChildElement("safety_controller");
  if (safety == nullptr) return;
  const Values values(*safety, file);
  values.text("k_velocity", "safety_controller of joint '" + joint.name + "'");
  joint.soft_lower = values.number("soft_lower_limit", 0);
  joint.soft_upper = values.number("soft_upper_limit", 0);
}

/// All of a joint but the links that it joins.
UrdfJoint read_joint(const Element& element, const std::string& file) {
  const Values values(element, file);
  UrdfJoint joint;
  joint.name = values.text("name", "joint");
  joint.place = values.place();
  check_name(joint.name, values);
  joint.type = type_of(joint.name, values);
  joint.X_ParentJoint = origin_of(element, file);
  if (const Element* axis = element.FirstChildElement("axis"); axis != nullptr)
    joint.axis = Values(*axis, file).vector("xyz", Eigen::Vector3d::Zero());
  read_limits(element, file, joint);
  if (const Element* mimic = element.FirstChildElement("mimic"); mimic != nullptr) {
    const Values of(*mimic, file);
    joint.mimic = UrdfMimic{of.text("joint", "mimic of joint '" + joint.name + "'"), of.number("multiplier", 1),
                            of.number("offset", 0)};
  }
  return joint;
}

UrdfLink read_link(const Element& element, const std::string& file) {
  const Values values(element, file);
  UrdfLink link;
  link.name = values.text("name", "link");
  link.place = values.place();
  link.element = &element;
  const Element* inertial = element.FirstChildElement("inertial");
  if (inertial == nullptr) return link;
  link.centre_of_mass = origin_of(*inertial, file).translation();
  if (const Element* mass = inertial->FirstChildElement("mass"); mass != nullptr)
    link.mass = Values(*mass, file).number("value", 0);
  return link;
}

/// The uppermost ancestor of each link so far; ways that were gone once are short afterwards, so that long chains cost
/// no more than short ones.
class Roots {
 public:
  const UrdfLink* of(const UrdfLink* link) {
    for (auto at = above_.find(link); at != above_.end(); at = above_.find(link)) {
      if (const auto next = above_.find(at->second); next != above_.end()) at->second = next->second;
      link = at->second;
    }
    return link;
  }
  void hang(const UrdfLink* child, const UrdfLink* parent) { above_.emplace(child, parent); }

 private:
  std::unordered_map<const UrdfLink*, const UrdfLink*> above_;
};

/// Nothing for an element that is no shape.
std::optional<ShapeSpec> shape_of(const Element& element, const std::string& file) {
  const Values values(element, file);
  const std::string_view kind = element.Name();
  if (kind == "box") return BoxShape{values.needed_vector("size")};
  if (kind == "sphere") return SphereShape{values.needed_number("radius")};
  if (kind == "cylinder") return CylinderShape{values.needed_number("radius"), values.needed_number("length")};
  if (kind == "mesh")
    return MeshShape{values.text("filename", "mesh"), values.vector("scale", Eigen::Vector3d::Ones())};
  return std::nullopt;
}

void check_sizes(const Element& shape, const std::string& file) {
  for (const char* size : {"size", "radius", "length"})
    if (const char* text = shape.Attribute(size); text != nullptr)
      if (!std::ranges::all_of(numbers_in(text).value_or(std::vector<double>{}), [](double v) { return v > 0; }))
        Values(shape, file)
            .fail(std::string(shape.Name()) + " " + size + "=\"" + text + "\" is not positive",
                  "sizes > 0 are allowed");
}

const Element* geometry_of(const Element& shape) {
  const Element* geometry = shape.FirstChildElement("geometry");
  return geometry == nullptr ? nullptr : geometry->FirstChildElement();
}

/// Colour of a <material>; nothing if it is only a name.
std::optional<std::optional<std::array<double, 3>>> material_of(const Element& material) {
  const Element *color = material.FirstChildElement("color"), *texture = material.FirstChildElement("texture");
  const char* rgba = color == nullptr ? nullptr : color->Attribute("rgba");
  const auto c = numbers_in(rgba == nullptr ? "" : rgba);
  if (c && c->size() == 4 && std::ranges::all_of(*c, [](double v) { return v >= 0 && v <= 1; })) {
    const std::array<double, 3> colour = {(*c)[0], (*c)[1], (*c)[2]};
    // Black is the colour of files that mean none.
    if ((*c)[3] > 0 && colour != std::array<double, 3>{}) return std::optional(colour);
    return std::optional<std::array<double, 3>>();
  }
  if (texture != nullptr && texture->Attribute("filename") != nullptr) return std::optional<std::array<double, 3>>();
  return std::nullopt;
}

std::string name_of(const Element& element) {
  const char* name = element.Attribute("name");
  return name == nullptr ? "" : name;
}

}  // namespace

UrdfTree::UrdfTree(const std::string& text, const std::string& file)
    : file_(file), document_(std::make_unique<tinyxml2::XMLDocument>()) {
  if (document_->Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw InputError({file, document_->ErrorLineNum()}, "is not well-formed XML", "a URDF file is needed");
  const Element* robot = document_->RootElement();
  if (robot == nullptr || std::string_view(robot->Name()) != "robot")
    throw InputError({file, robot == nullptr ? 0 : robot->GetLineNum()}, "has no <robot> at its root",
                     "a URDF file is needed");
  const Values values(*robot, file_);
  robot_ = values.text("name", "<robot>");
  if (const char* version = robot->Attribute("version"); version != nullptr && std::string_view(version) != "1.0")
    values.fail("version " + in_quotes(version) + " of URDF is not known", "1.0");
  read_links(*robot);
  read_joints(*robot);
  find_root();
  read_materials(*robot);
}

Eigen::Isometry3d UrdfJoint::X_ParentChild() const {
  if (!held) return X_ParentJoint;
  if (type == Type::prismatic) return X_ParentJoint * Eigen::Translation3d(*held * axis.normalized());
  return X_ParentJoint * Eigen::AngleAxisd(*held, axis.normalized());
}

UrdfTree::UrdfTree(UrdfTree&&) noexcept = default;
UrdfTree::~UrdfTree() = default;

void UrdfTree::read_links(const Element& robot) {
  for (const Element* e : children(robot, "link")) {
    UrdfLink link = read_link(*e, file_);
    const std::string name = link.name;
    if (!links_.emplace(name, std::move(link)).second)
      Values(*e, file_).fail("link '" + name + "' is in the file twice", "names of links are unique");
  }
  if (links_.empty()) Values(robot, file_).fail("has no <link>", "a URDF file is needed");
}

const UrdfLink* UrdfTree::end_of(const Element& joint, const std::string& name, const char* end) const {
  const Element* element = joint.FirstChildElement(end);
  if (element == nullptr)
    Values(joint, file_).fail("joint '" + name + "' has no <" + end + ">", "parent and child are needed");
  const std::string link = Values(*element, file_).text("link", std::string(end) + " of joint '" + name + "'");
  const UrdfLink* found = this->link(link);
  if (found != nullptr) return found;
  std::vector<std::string> names;
  for (const auto& entry : links_) names.push_back(entry.first);
  Values(*element, file_)
      .fail(std::string(end) + " link '" + link + "' of joint '" + name + "' is not in the file" +
                meant_instead(link, names),
            "each link has a <link>");
}

void UrdfTree::read_joints(const Element& robot) {
  Roots roots;
  for (const Element* e : children(robot, "joint")) {
    const Values values(*e, file_);
    if (joints_.size() == most_joints)
      values.fail("has more than " + std::to_string(most_joints) + " joints", "a robot, not a building");
    UrdfJoint joint = read_joint(*e, file_);
    joint.index = joints_.size();
    joint.parent = end_of(*e, joint.name, "parent");
    joint.child = end_of(*e, joint.name, "child");
    const auto [at, is_new] = joints_.emplace(joint.name, joint);
    if (!is_new) values.fail("joint '" + joint.name + "' is in the file twice", "names of joints are unique");
    UrdfLink& child = links_.at(joint.child->name);
    if (child.above != nullptr)
      values.fail("link '" + child.name + "' is the child of two joints", "a robot is a tree: one parent a link");
    if (roots.of(joint.parent) == &child)
      values.fail("link '" + child.name + "' is its own ancestor",
                  "a robot is a tree: closed chains cannot be described in a URDF");
    roots.hang(&child, joint.parent);
    child.above = &at->second;
  }
  for (const auto& [name, joint] : joints_) links_.at(joint.parent->name).below.push_back(&joint);
}

void UrdfTree::find_root() {
  for (const auto& [name, link] : links_) {
    if (link.above != nullptr) continue;
    if (root_ != nullptr)
      throw InputError(
          std::max(*root_, link, [](const auto& a, const auto& b) { return a.place.line < b.place.line; }).place,
          "neither link '" + root_->name + "' nor '" + name + "' hangs on a joint", "a robot is a tree with one root");
    root_ = &link;
  }
}

void UrdfTree::hold(const std::map<std::string, double>& values) {
  for (const auto& [name, value] : values) joints_.at(name).held = value;
  for (bool more = true; more;) {
    more = false;
    for (auto& [name, joint] : joints_) {
      if (!joint.mimic || joint.held || !joint.has_axis()) continue;
      const auto master = joints_.find(joint.mimic->master);
      if (master == joints_.end() || !master->second.held) continue;
      joint.held = joint.mimic->multiplier * *master->second.held + joint.mimic->offset;
      more = true;
    }
  }
}

/// The first definition of a name counts: those beside the links, then those in them.
void UrdfTree::read_materials(const Element& robot) {
  for (const Element* e : children(robot, "material"))
    if (!materials_.emplace(name_of(*e), material_of(*e).value_or(std::nullopt)).second)
      Values(*e, file_).fail("material '" + name_of(*e) + "' is in the file twice", "names of materials are unique");
  for (const Element* link : children(robot, "link"))
    for (const Element* visual : children(*link, "visual"))
      if (const Element* material = visual->FirstChildElement("material"); material != nullptr)
        if (const auto colour = material_of(*material)) materials_.emplace(name_of(*material), *colour);
}

const UrdfLink* UrdfTree::link(const std::string& name) const {
  const auto found = links_.find(name);
  return found == links_.end() ? nullptr : &found->second;
}

const UrdfJoint* UrdfTree::joint(const std::string& name) const {
  const auto found = joints_.find(name);
  return found == joints_.end() ? nullptr : &found->second;
}

std::vector<UrdfShape> UrdfTree::collision_shapes(const UrdfLink& link) const {
  std::vector<UrdfShape> shapes;
  for (const Element* e : children(*link.element, "collision")) {
    const Eigen::Isometry3d X = origin_of(*e, file_);
    const Element* geometry = geometry_of(*e);
    if (geometry == nullptr) Values(*e, file_).fail("collision has no geometry", "box, cylinder, sphere or mesh");
    const auto shape = shape_of(*geometry, file_);
    if (!shape)
      Values(*geometry, file_)
          .fail("collision of link '" + link.name + "' has the unknown geometry " + in_quotes(geometry->Name()),
                "box, cylinder, sphere or mesh");
    check_sizes(*geometry, file_);
    shapes.push_back({*shape, X});
  }
  return shapes;
}

std::vector<UrdfShape> UrdfTree::visual_shapes(const UrdfLink& link) const {
  std::vector<UrdfShape> shapes;
  for (const Element* e : children(*link.element, "visual"))
    if (const Element* geometry = geometry_of(*e); geometry != nullptr)
      if (const auto shape = shape_of(*geometry, file_)) shapes.push_back({*shape, origin_of(*e, file_)});
  return shapes;
}

std::optional<std::array<double, 3>> UrdfTree::colour(const UrdfLink& link) const {
  const Element* visual = link.element->FirstChildElement("visual");
  const Element* material = visual == nullptr ? nullptr : visual->FirstChildElement("material");
  if (material == nullptr) return std::nullopt;
  if (name_of(*material).empty()) return material_of(*material).value_or(std::nullopt);
  const auto found = materials_.find(name_of(*material));
  return found == materials_.end() ? std::nullopt : found->second;
}

}  // namespace posewright
