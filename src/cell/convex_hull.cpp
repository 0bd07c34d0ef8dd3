#include <libqhull_r/qhull_ra.h>

#include <stdexcept>

#include "posewright/cell/solid.hpp"

namespace posewright {

TriangleMesh convex_hull(const TriangleMesh& mesh) {
  std::vector<double> points;
  for (const auto& v : mesh.vertices) points.insert(points.end(), v.data(), v.data() + 3);
  qhT state;
  qh_zero(&state, nullptr);
  char command[] = "qhull Qt Pp";
  std::FILE* silent = std::fopen("/dev/null", "w");
  const int failed = qh_new_qhull(&state, 3, int(mesh.vertices.size()), points.data(), False, command, nullptr, silent);
  TriangleMesh hull;
  if (failed == 0) {
    hull.vertices = mesh.vertices;
    const Eigen::Vector3d inside(state.interior_point[0], state.interior_point[1], state.interior_point[2]);
    qhT* qh = &state;
    facetT* facet = nullptr;
    vertexT *vertex = nullptr, **vertexp = nullptr;
    FORALLfacets {
      std::array<int, 3> triangle{};
      std::size_t k = 0;
      FOREACHvertex_(facet->vertices) if (k < 3) triangle[k++] = qh_pointid(qh, vertex->point);
      // Qhull's facets turn either way; outward is away from a point inside.
      const auto& v = hull.vertices;
      const Eigen::Vector3d &a = v[std::size_t(triangle[0])], &b = v[std::size_t(triangle[1])],
                            &c = v[std::size_t(triangle[2])];
      if ((b - a).cross(c - a).dot(a - inside) < 0) std::swap(triangle[1], triangle[2]);
      hull.triangles.push_back(triangle);
    }
  }
  qh_freeqhull(&state, !qh_ALL);
  int unused = 0, total = 0;
  qh_memfreeshort(&state, &unused, &total);
  if (silent != nullptr) std::fclose(silent);
  if (failed != 0) throw std::invalid_argument("its points lie in one plane");
  return hull;
}

}  // namespace posewright
