#include "tests/kit/verify_cell.hpp"

#include <fcl/fcl.h>

#include <cstring>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

#include "tests/kit/plain_urdf.hpp"

namespace posewright {
namespace {

using Mesh = fcl::BVHModel<fcl::OBBRSSd>;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Binary STL: 80 bytes, count, then 50 bytes a triangle.
std::vector<Eigen::Vector3d> stl_corners(const std::filesystem::path& file) {
  const std::string bytes = bytes_of(file);
  std::uint32_t count = 0;
  if (bytes.size() < 84) throw std::runtime_error("no STL: " + file.string());
  std::memcpy(&count, bytes.data() + 80, 4);
  std::vector<Eigen::Vector3d> corners;
  for (std::uint32_t t = 0; t < count; ++t) {
    float v[12];
    std::memcpy(v, bytes.data() + 84 + 50 * std::size_t(t), 48);
    for (int k = 1; k < 4; ++k) corners.emplace_back(v[3 * k], v[3 * k + 1], v[3 * k + 2]);
  }
  return corners;
}

/// Two triangles a side.
std::vector<Eigen::Vector3d> box_corners(const Eigen::Vector3d& half) {
  std::vector<Eigen::Vector3d> corners;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto corner = [&](double u, double v) {
        Eigen::Vector3d c;
        c[axis] = side;
        c[(axis + 1) % 3] = u;
        c[(axis + 2) % 3] = v;
        return Eigen::Vector3d(c.cwiseProduct(half));
      };
      corners.insert(corners.end(), {corner(-1, -1), corner(1, -1), corner(1, 1)});
      corners.insert(corners.end(), {corner(-1, -1), corner(1, 1), corner(-1, 1)});
    }
  return corners;
}

}  // namespace

struct CellVerifier::Implementation {
  struct Link {
    std::string name;
    std::shared_ptr<Mesh> mesh;
    std::vector<Eigen::Vector3d> corners;
    Eigen::Isometry3d X_LinkMesh;
  };
  PlainUrdf urdf;
  std::vector<Link> links;
  std::vector<std::pair<std::shared_ptr<fcl::CollisionGeometryd>, Eigen::Isometry3d>> boxes;
  std::vector<Wall> walls;
  std::set<std::string> skipped;

  /// Moving joints between a link and the root: a base is where it stands.
  int moving(const std::string& link) const {
    const auto above = urdf.above.find(link);
    if (above == urdf.above.end()) return 0;
    return (above->second.type == "fixed" ? 0 : 1) + moving(above->second.parent);
  }

  /// The link that moves it: joints without a value stand.
  std::string carrier(const std::string& link, const std::map<std::string, double>& joints) const {
    const auto above = urdf.above.find(link);
    if (above == urdf.above.end() || joints.count(above->second.name) > 0) return link;
    return carrier(above->second.parent, joints);
  }

  bool adjacent(const Link& a, const Link& b, const std::map<std::string, double>& joints) const {
    for (const auto& [child, parent] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
      const auto above = urdf.above.find(child->name);
      if (above != urdf.above.end() && above->second.parent == parent->name) return true;
    }
    return carrier(a.name, joints) == carrier(b.name, joints);
  }
};

CellVerifier::CellVerifier(const std::filesystem::path& urdf, const std::filesystem::path& package_root)
    : implementation_(new Implementation{PlainUrdf(urdf), {}, {}, {}, {}}) {
  for (const auto& [name, shape] : implementation_->urdf.collision) {
    Implementation::Link entry{name, std::make_shared<Mesh>(), {}, shape.X_LinkShape};
    if (shape.mesh.empty()) {
      entry.corners = box_corners(0.5 * shape.size);
    } else {
      entry.corners = stl_corners(package_root / shape.mesh.substr(std::strlen("package://")));
      for (auto& c : entry.corners) c = c.cwiseProduct(shape.scale);
    }
    entry.mesh->beginModel();
    for (std::size_t i = 0; i < entry.corners.size(); i += 3)
      entry.mesh->addTriangle(entry.corners[i], entry.corners[i + 1], entry.corners[i + 2]);
    entry.mesh->endModel();
    implementation_->links.push_back(std::move(entry));
  }
}
CellVerifier::~CellVerifier() { delete implementation_; }

void CellVerifier::add(const Box& box) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Map<const Eigen::Vector3d>(box.at);
  implementation_->boxes.emplace_back(std::make_shared<fcl::Boxd>(box.size[0], box.size[1], box.size[2]), X);
}
void CellVerifier::add(const Cylinder& cylinder) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Map<const Eigen::Vector3d>(cylinder.at);
  implementation_->boxes.emplace_back(std::make_shared<fcl::Cylinderd>(cylinder.radius, cylinder.length), X);
}
void CellVerifier::add(const Wall& wall) { implementation_->walls.push_back(wall); }
void CellVerifier::skip(const std::vector<std::string>& pairs) {
  implementation_->skipped.insert(pairs.begin(), pairs.end());
}

double CellVerifier::nearest(const std::map<std::string, double>& joints, const std::string& tool) const {
  const Implementation& own = *implementation_;
  double least = 1e9;
  const auto look = [&](const fcl::CollisionGeometryd& a, const Eigen::Isometry3d& X_a,
                        const fcl::CollisionGeometryd& b, const Eigen::Isometry3d& X_b) {
    fcl::DistanceRequestd request(false);
    request.distance_tolerance = 1e-9;
    request.gjk_solver_type = fcl::GST_LIBCCD;
    fcl::DistanceResultd result(least);
    fcl::distance<double>(&a, X_a, &b, X_b, request, result);
    least = std::min(least, result.min_distance);
  };
  for (const auto& link : own.links) {
    if (own.moving(link.name) == 0) continue;
    const Eigen::Isometry3d X = own.urdf.pose(link.name, joints) * link.X_LinkMesh;
    for (const Wall& wall : own.walls) {
      const Eigen::Vector3d normal = Eigen::Map<const Eigen::Vector3d>(wall.normal).normalized();
      for (const auto& corner : link.corners)
        least = std::min(least, normal.dot(X * corner - Eigen::Map<const Eigen::Vector3d>(wall.at)));
    }
    for (const auto& [box, X_box] : own.boxes) look(*link.mesh, X, *box, X_box);
    if (link.name != tool) continue;
    for (const auto& other : own.links) {
      if (own.adjacent(link, other, joints) || own.skipped.count(tool + " and " + other.name) > 0 ||
          own.skipped.count(other.name + " and " + tool) > 0)
        continue;
      look(*link.mesh, X, *other.mesh, own.urdf.pose(other.name, joints) * other.X_LinkMesh);
    }
  }
  return least;
}

std::string CellVerifier::violation(const std::map<std::string, double>& joints, double clearance) const {
  const Implementation& own = *implementation_;
  std::vector<Eigen::Isometry3d> X;
  std::vector<int> moving;
  for (const auto& link : own.links) {
    X.push_back(own.urdf.pose(link.name, joints) * link.X_LinkMesh);
    moving.push_back(own.moving(link.name));
  }
  for (std::size_t i = 0; i < own.links.size(); ++i) {
    if (moving[i] == 0) continue;
    for (const Wall& wall : own.walls) {
      // The wall in the mesh's frame, so that its many corners stay where they are.
      const Eigen::Vector3d normal = Eigen::Map<const Eigen::Vector3d>(wall.normal).normalized();
      const Eigen::Vector3d along = X[i].linear().transpose() * normal;
      const double origin = normal.dot(X[i].translation() - Eigen::Map<const Eigen::Vector3d>(wall.at));
      for (const auto& corner : own.links[i].corners)
        if (along.dot(corner) + origin < clearance) return own.links[i].name + " at the wall";
    }
    for (const auto& [box, X_box] : own.boxes) {
      fcl::DistanceRequestd request(false);
      request.distance_tolerance = 1e-9;
      request.gjk_solver_type = fcl::GST_LIBCCD;
      fcl::DistanceResultd result(clearance);  // what is farther does not matter
      // Of geometries: a collision object goes through all vertices when it is made.
      fcl::distance<double>(own.links[i].mesh.get(), X[i], box.get(), X_box, request, result);
      if (result.min_distance < clearance - 1e-6) return own.links[i].name + " at a box";
    }
    for (std::size_t j = 0; j < i; ++j) {
      const std::string one = own.links[i].name, other = own.links[j].name;
      if (own.adjacent(own.links[i], own.links[j], joints) || own.skipped.count(one + " and " + other) > 0 ||
          own.skipped.count(other + " and " + one) > 0)
        continue;
      fcl::CollisionRequestd request;
      fcl::CollisionResultd result;
      if (fcl::collide<double>(own.links[i].mesh.get(), X[i], own.links[j].mesh.get(), X[j], request, result) > 0)
        return one + " and " + other;
    }
  }
  return {};
}

}  // namespace posewright
