#include "kernels/mesh/edge_shift.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "kernels/mesh/edge_vector.hpp"
#include "kernels/mesh/incidence.hpp"
#include "kernels/spatial/closest_points.hpp"

namespace drogue::mesh {

namespace {

using spatial::Point;

/// Surface at rest with the triangles around each vertex.
class Surface {
 public:
  explicit Surface(const Mesh& mesh) : _mesh(mesh), _around(vertex_triangles(mesh)) {}

  [[nodiscard]] Point at(int i) const {
    const Vector& x = _mesh.rest[static_cast<std::size_t>(i)];
    return {x[0], x[1], x[2]};
  }

  /// Calls `visit(triangle)` for each triangle around a vertex.
  template <class Visit>
  void for_each_triangle(int vertex, const Visit& visit) const {
    const auto i = static_cast<std::size_t>(vertex);
    for (int n = _around.first[i]; n < _around.first[i + 1]; ++n)
      visit(_mesh.triangles[static_cast<std::size_t>(_around.triangle[static_cast<std::size_t>(n)])]);
  }

  /// Point of the surface that is closest to `target` near the vertex that is closest to it on a path of
  /// edges from `vertex` that come closer and closer.
  [[nodiscard]] SurfacePoint closest(int vertex, const Point& target) const {
    const int near = walk_towards(vertex, target);
    SurfacePoint best{vertex, {vertex, vertex, vertex}, {1.0, 0.0, 0.0}};
    double squared = std::numeric_limits<double>::infinity();
    const auto take_closer = [&](const std::array<int, 3>& triangle) {
      const Point corner[3] = {at(triangle[0]), at(triangle[1]), at(triangle[2])};
      const spatial::ClosestOnTriangle found = spatial::closest_on_triangle(target, corner);
      if (!(found.squared < squared)) return;
      squared = found.squared;
      best.corner = triangle;
      best.weight = {found.weight[0], found.weight[1], found.weight[2]};
    };
    for_each_triangle(near, [&](const std::array<int, 3>& triangle) {
      for (const int i : triangle) for_each_triangle(i, take_closer);
    });
    return best;
  }

 private:
  [[nodiscard]] double squared_distance(int i, const Point& target) const {
    const Point r = at(i) - target;
    return dot(r, r);
  }

  [[nodiscard]] int walk_towards(int vertex, const Point& target) const {
    while (true) {
      int next = vertex;
      for_each_triangle(vertex, [&](const std::array<int, 3>& triangle) {
        for (const int i : triangle)
          if (squared_distance(i, target) < squared_distance(next, target)) next = i;
      });
      if (next == vertex) return vertex;
      vertex = next;
    }
  }

  const Mesh& _mesh;
  VertexTriangles _around;
};

/// Nearest edge of a vertex, and the direction away from it.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();  ///< m
  Point away{0.0, 0.0, 0.0};  ///< of unit length; of a vertex of an edge, the sum of those into the triangles
};

Point unit(const Point& v) {
  const double size = stable_norm(v);
  return size > 0.0 ? (1.0 / size) * v : v;
}

/// Unit vector in the triangle of edge ab, normal to the edge, into the triangle.
Point into_triangle(const Surface& surface, const Edge& edge) {
  const Point a = surface.at(edge[0]), along = unit(surface.at(edge[1]) - a);
  Point inward{0.0, 0.0, 0.0};
  surface.for_each_triangle(edge[0], [&](const std::array<int, 3>& triangle) {
    if (std::ranges::find(triangle, edge[1]) == triangle.end()) return;
    for (const int i : triangle)
      if (i != edge[0] && i != edge[1]) {
        const Point r = surface.at(i) - a;
        inward = unit(r - dot(r, along) * along);
      }
  });
  return inward;
}

/// Lets the vertices within `band` of an edge, as far as they connect to it, take it if none is nearer.
class Spread {
 public:
  explicit Spread(std::size_t vertices) : _seen_by(vertices, -1) {}

  void operator()(const Surface& surface, const Edge& edge, double band, std::vector<Nearest>& nearest) {
    const Point a = surface.at(edge[0]), b = surface.at(edge[1]);
    ++_edge;
    _front.assign(edge.begin(), edge.end());
    for (const int i : edge) _seen_by[static_cast<std::size_t>(i)] = _edge;
    while (!_front.empty()) {
      const int i = _front.back();
      _front.pop_back();
      const Point x = surface.at(i), foot = a + spatial::closest_on_segment(x, a, b) * (b - a);
      const double distance = i == edge[0] || i == edge[1] ? 0.0 : stable_norm(x - foot);
      if (!(distance < band)) continue;
      Nearest& so_far = nearest[static_cast<std::size_t>(i)];
      if (distance == 0.0)
        so_far = {0.0, (so_far.distance == 0.0 ? so_far.away : Point{0.0, 0.0, 0.0}) +
                           into_triangle(surface, edge)};
      else if (distance < so_far.distance)
        so_far = {distance, unit(x - foot)};
      surface.for_each_triangle(i, [&](const std::array<int, 3>& triangle) {
        for (const int next : triangle) {
          int& seen = _seen_by[static_cast<std::size_t>(next)];
          if (seen == _edge) continue;
          seen = _edge;
          _front.push_back(next);
        }
      });
    }
  }

 private:
  std::vector<int> _seen_by;  ///< number of the edge that has reached a vertex last
  std::vector<int> _front;
  int _edge = -1;
};

}  // namespace

std::vector<Edge> open_edges(const Mesh& mesh) {
  std::vector<Edge> edges;
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(opposite_edge(triangle, k));
  std::ranges::sort(edges);
  std::vector<Edge> open;
  for (std::size_t n = 0; n < edges.size(); ++n) {
    const bool repeats = n > 0 && edges[n] == edges[n - 1];
    const bool is_repeated = n + 1 < edges.size() && edges[n] == edges[n + 1];
    if (!repeats && !is_repeated) open.push_back(edges[n]);
  }
  return open;
}

std::vector<SurfacePoint> shifted_from_edges(const Mesh& mesh, const std::vector<Edge>& edges, double shift,
                                             double band) {
  const Surface surface(mesh);
  std::vector<Nearest> nearest(mesh.rest.size());
  Spread spread(mesh.rest.size());
  for (const Edge& edge : edges) spread(surface, edge, band, nearest);
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const auto& [distance, away] = nearest[i];
    if (!(distance < band)) continue;
    const int vertex = static_cast<int>(i);
    const double way = shift * (1.0 - distance / band);
    points.push_back(surface.closest(vertex, surface.at(vertex) + way * unit(away)));
  }
  return points;
}

}  // namespace drogue::mesh
