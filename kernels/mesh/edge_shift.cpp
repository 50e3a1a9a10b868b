#include "kernels/mesh/edge_shift.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "kernels/mesh/edge_vector.hpp"
#include "kernels/mesh/incidence.hpp"
#include "kernels/spatial/closest_points.hpp"

namespace drogue::mesh {

namespace {

using spatial::Point;

Point point(const Vector& v) { return {v[0], v[1], v[2]}; }

/// Surface at rest with the triangles around each vertex.
class Surface {
 public:
  explicit Surface(const Mesh& mesh) : _mesh(mesh), _around(vertex_triangles(mesh)) {}

  [[nodiscard]] Point at(int i) const { return point(_mesh.rest[static_cast<std::size_t>(i)]); }

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

Point unit(const Point& v) {
  const double size = stable_norm(v);
  return size > 0.0 ? (1.0 / size) * v : v;
}

/// Nearest edge of a vertex.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  Point away{0.0, 0.0, 0.0};  ///< unit vector from the edge; of its ends, the sum of those into the surface
};

/// Calls `visit(vertex, distance, away)` for the vertices within `band` of an edge, as far as they connect to
/// it.
class Flood {
 public:
  explicit Flood(std::size_t vertices) : _seen_by(vertices, -1) {}

  template <class Visit>
  void operator()(const Surface& surface, const OpenEdge& edge, double band, const Visit& visit) {
    const auto& [first, second] = edge.ends;
    const Point a = surface.at(first), b = surface.at(second);
    ++_edge;
    _front.assign({first, second});
    for (const int i : edge.ends) _seen_by[static_cast<std::size_t>(i)] = _edge;
    while (!_front.empty()) {
      const int i = _front.back();
      _front.pop_back();
      const Point x = surface.at(i), foot = a + spatial::closest_on_segment(x, a, b) * (b - a);
      const bool is_end = i == first || i == second;
      const double distance = is_end ? 0.0 : stable_norm(x - foot);
      if (!(distance < band)) continue;
      visit(static_cast<std::size_t>(i), distance, is_end ? point(edge.inward) : unit(x - foot));
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

/// Largest distance from an edge, at most `band`, in the part of the mesh that hangs together with each
/// vertex.
std::vector<double> largest_distances(const Surface& surface, const std::vector<Nearest>& nearest,
                                      double band) {
  std::vector<double> largest(nearest.size(), -1.0);
  for (std::size_t first = 0; first < nearest.size(); ++first) {
    if (largest[first] >= 0.0) continue;
    std::vector<std::size_t> part{first};
    largest[first] = 0.0;
    double found = 0.0;
    for (std::size_t k = 0; k < part.size(); ++k) {
      found = std::max(found, std::min(nearest[part[k]].distance, band));
      surface.for_each_triangle(static_cast<int>(part[k]), [&](const std::array<int, 3>& triangle) {
        for (const int i : triangle) {
          const auto next = static_cast<std::size_t>(i);
          if (largest[next] >= 0.0) continue;
          largest[next] = 0.0;
          part.push_back(next);
        }
      });
    }
    for (const std::size_t i : part) largest[i] = found;
  }
  return largest;
}

/// Unit vector in the triangle of edge ab, normal to the edge, into the triangle with the third corner c.
Vector inward_of(const Mesh& mesh, int a, int b, int c) {
  const Point along = unit(edge_vector(mesh, a, b)), r = edge_vector(mesh, a, c),
              inward = unit(r - dot(r, along) * along);
  return {inward.x, inward.y, inward.z};
}

}  // namespace

std::vector<OpenEdge> open_edges(const Mesh& mesh) {
  std::vector<std::pair<Edge, int>> sides;  // with the third corner
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) sides.emplace_back(opposite_edge(triangle, k), triangle[k]);
  std::ranges::sort(sides);
  std::vector<OpenEdge> open;
  for (std::size_t n = 0; n < sides.size(); ++n) {
    const auto& [ends, corner] = sides[n];
    const bool repeats = n > 0 && ends == sides[n - 1].first;
    const bool is_repeated = n + 1 < sides.size() && ends == sides[n + 1].first;
    if (!repeats && !is_repeated) open.push_back({ends, inward_of(mesh, ends[0], ends[1], corner)});
  }
  return open;
}

std::vector<SurfacePoint> shifted_from_edges(const Mesh& mesh, const std::vector<OpenEdge>& edges,
                                             double shift, double band) {
  const Surface surface(mesh);
  std::vector<Nearest> nearest(mesh.rest.size());
  Flood flood(mesh.rest.size());
  for (const OpenEdge& edge : edges)
    flood(surface, edge, band, [&](std::size_t i, double distance, const Point& away) {
      Nearest& so_far = nearest[i];
      if (distance == 0.0 && so_far.distance == 0.0) {
        so_far.away = so_far.away + away;
      } else if (distance < so_far.distance) {
        so_far = {distance, away};
      }
    });
  const std::vector<double> widths = largest_distances(surface, nearest, band);
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const auto& [distance, away] = nearest[i];
    if (!(distance < widths[i])) continue;
    const int vertex = static_cast<int>(i);
    const double way = std::min(shift, 0.5 * widths[i]) * (1.0 - distance / widths[i]);
    points.push_back(surface.closest(vertex, surface.at(vertex) + way * unit(away)));
  }
  return points;
}

}  // namespace drogue::mesh
