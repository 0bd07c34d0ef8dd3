#include <cmath>

#include "obstacle_files.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/read_number.hpp"
#include "posewright/support/text.hpp"
#include "posewright/support/text_file.hpp"
#include "posewright/support/trimmed.hpp"

// Form: MoveIt's PlanningScene::saveGeometryToStream and geometric_shapes' saveAsText; docs/cell.md.

namespace posewright {
namespace {

constexpr std::uintmax_t largest_scene = 100'000'000;  // bytes
constexpr long most_parts = 10'000'000;                // vertices or triangles of one mesh

/// Words and lines of a text, with the line that they stand on.
class SceneWords {
 public:
  SceneWords(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {}

  int line() const { return line_; }
  [[noreturn]] void fail(const std::string& what, const std::string& allowed) const {
    throw InputError({file_, line_}, what, allowed);
  }

  /// Rest of the line.
  std::string rest() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string result(trimmed(std::string_view(text_).substr(at_, end - at_)));
    at_ = end;
    return result;
  }

  std::string word(const std::string& expected) {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0)
      line_ += text_[at_++] == '\n';
    const std::size_t begin = at_;
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) == 0) ++at_;
    if (begin == at_) fail("ends where " + expected + " is expected", "the file is cut");
    return text_.substr(begin, at_ - begin);
  }

  double number(const std::string& expected) {
    const std::string text = word(expected);
    const std::optional<double> value = read_double(text);
    if (!value || !std::isfinite(*value))
      fail("has " + in_quotes(text) + " where " + expected + " is expected", "a number is needed");
    return *value;
  }

  double length(const std::string& expected) {
    const double value = number(expected);
    if (!(value > 0)) fail("has " + expected + " that is not above zero", "lengths in m are needed");
    return value;
  }

  long count(const std::string& expected) {
    const double value = number(expected);
    if (value != std::floor(value) || value < 0 || value > double(most_parts))
      fail("has no whole number of " + expected, "0 to " + std::to_string(most_parts));
    return long(value);
  }

  Eigen::Vector3d vector(const std::string& expected) {
    const double x = number(expected), y = number(expected), z = number(expected);
    return {x, y, z};
  }

  /// Position, then quaternion x y z w.
  Eigen::Isometry3d pose() {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = vector("a position");
    Eigen::Quaterniond rotation;
    for (const int k : {0, 1, 2, 3}) rotation.coeffs()[k] = number("a quaternion");
    if (std::abs(rotation.norm() - 1) > 1e-2) fail("has a quaternion that is not of length 1", "x y z w of a rotation");
    X.linear() = rotation.normalized().matrix();
    return X;
  }

 private:
  std::string text_, file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

ShapeSpec read_triangles(SceneWords& words) {
  auto mesh = std::make_shared<TrianglesShape>();
  const long vertices = words.count("vertices"), triangles = words.count("triangles");
  for (long i = 0; i < vertices; ++i) mesh->vertices.push_back(words.vector("a vertex"));
  for (long i = 0; i < triangles; ++i) {
    std::array<int, 3> triangle{};
    for (int& corner : triangle) {
      corner = int(words.count("vertices before"));
      if (corner >= vertices)
        words.fail("has a triangle whose corner is not there", "0 to " + std::to_string(vertices - 1));
    }
    mesh->triangles.push_back(triangle);
  }
  if (mesh->triangles.empty()) words.fail("has a mesh without triangles", "");
  return std::shared_ptr<const TrianglesShape>(std::move(mesh));
}

/// `X` gets what the shape itself is moved by.
ShapeSpec read_scene_shape(SceneWords& words, Eigen::Isometry3d& X) {
  const std::string kind = words.word("a shape");
  if (kind == "box") {
    const double x = words.length("an edge"), y = words.length("an edge"), z = words.length("an edge");
    return BoxShape{{x, y, z}};
  }
  if (kind == "sphere") return SphereShape{words.length("a radius")};
  if (kind == "cylinder") {
    const double radius = words.length("a radius");
    return CylinderShape{radius, words.length("a length")};
  }
  if (kind == "mesh") return read_triangles(words);
  if (kind != "plane") words.fail("has the shape " + in_quotes(kind), "box, sphere, cylinder, plane, mesh are read");
  // a x + b y + c z + d = 0
  const Eigen::Vector3d normal = words.vector("a normal");
  const double d = words.number("a plane's distance");
  if (!(normal.norm() > 1e-9)) words.fail("has a plane without normal", "a direction is needed");
  X.translation() = -d / normal.squaredNorm() * normal;
  return HalfSpaceShape{normal.normalized()};
}

/// True if objects have poses of their own: the line after the first name has more than a number.
bool has_object_poses(SceneWords words) {
  if (words.word("an object") != "*") return false;
  words.rest();
  words.word("a pose or a number of shapes");
  return !words.rest().empty();
}

}  // namespace

std::vector<PlacedShape> read_moveit_shapes(const ObstacleFileSpec& spec) {
  SceneWords words(read_text(spec.file, largest_scene), spec.file.string());
  words.rest();  // name of the scene
  const bool poses = has_object_poses(words);
  std::vector<PlacedShape> shapes;
  for (;;) {
    const std::string mark = words.word("'*' or '.'");
    if (mark == ".") return shapes;
    if (mark != "*")
      words.fail("has " + in_quotes(mark) + " where an object is expected", "'* NAME', or '.' at the end");
    const std::string name = words.rest();
    if (name.empty()) words.fail("has an object without name", "'* NAME'");
    const Eigen::Isometry3d X_World = poses ? words.pose() : Eigen::Isometry3d::Identity();
    for (long left = words.count("shapes"); left > 0; --left) {
      Eigen::Isometry3d X_Shape = Eigen::Isometry3d::Identity();
      const int line = words.line();
      ShapeSpec shape = read_scene_shape(words, X_Shape);
      shapes.push_back({name, std::move(shape), X_World * words.pose() * X_Shape, line});
      for (const char* colour : {"red", "green", "blue", "opacity"}) words.number(colour);
    }
    for (long left = poses ? words.count("frames") : 0; left > 0; --left) {
      words.word("a frame's name");
      words.pose();
    }
  }
}

}  // namespace posewright
