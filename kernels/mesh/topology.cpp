#include "kernels/mesh/topology.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "kernels/mesh/edges.hpp"
#include "kernels/mesh/vectors.hpp"

namespace drogue::mesh {
namespace {

double length(const Vector& a) { return std::hypot(a[0], a[1], a[2]); }

/// Height over longest edge below which a triangle counts as degenerate: the size of rounded coordinates.
constexpr double degenerate_ratio = 1e-12;

/// First entry that equals an earlier one, and the earlier one; {size, -1} without repetition.
template <class T>
std::pair<int, int> first_repeated(const std::vector<T>& values) {
  std::vector<int> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  const auto value = [&](int i) -> const T& { return values[static_cast<std::size_t>(i)]; };
  std::ranges::sort(order, [&](int i, int j) { return value(i) != value(j) ? value(i) < value(j) : i < j; });
  std::pair<int, int> first{static_cast<int>(values.size()), -1};
  for (std::size_t k = 1; k < order.size(); ++k)
    if (value(order[k]) == value(order[k - 1]) && order[k] < first.first) first = {order[k], order[k - 1]};
  return first;
}

std::optional<Defect> vertex_defect(const Mesh& mesh) {
  if (const auto [second, first] = first_repeated(mesh.rest); first >= 0)
    return Defect{DefectKind::duplicate_vertex, static_cast<std::size_t>(second), first};
  std::vector<char> used(mesh.rest.size(), 0);
  for (const auto& triangle : mesh.triangles)
    for (const int i : triangle) used[static_cast<std::size_t>(i)] = 1;
  for (const auto& line : mesh.lines)
    for (const int i : line) used[static_cast<std::size_t>(i)] = 1;
  const auto orphan = std::ranges::find(used, 0);
  if (orphan == used.end()) return std::nullopt;
  return Defect{DefectKind::orphan_vertex, static_cast<std::size_t>(orphan - used.begin())};
}

std::optional<Defect> triangle_defect(const Mesh& mesh) {
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    double longest = 0.0;
    for (std::size_t e = 0; e < 3; ++e)
      longest = std::max(longest, rest_distance(mesh, mesh.triangles[k][e], mesh.triangles[k][(e + 1) % 3]));
    const double twice = length(doubled_area(mesh.rest, mesh.triangles[k]));
    if (!(twice > degenerate_ratio * longest * longest) || !std::isfinite(longest))
      return Defect{DefectKind::degenerate_triangle, k};
  }
  std::vector<std::array<int, 3>> sorted = mesh.triangles;
  for (auto& triangle : sorted) std::ranges::sort(triangle);
  if (const auto [second, first] = first_repeated(sorted); first >= 0)
    return Defect{DefectKind::duplicate_triangle, static_cast<std::size_t>(second), first};
  std::vector<std::array<int, 3>> edges;  // two vertices and the triangle
  for (std::size_t k = 0; k < sorted.size(); ++k)
    for (const auto& [a, b] : {std::pair{0U, 1U}, std::pair{0U, 2U}, std::pair{1U, 2U}})
      edges.push_back({sorted[k][a], sorted[k][b], static_cast<int>(k)});
  std::ranges::sort(edges);
  std::array<int, 3> worst{0, 0, static_cast<int>(sorted.size())};
  for (std::size_t k = 2; k < edges.size(); ++k)
    if (edges[k][0] == edges[k - 2][0] && edges[k][1] == edges[k - 2][1] && edges[k][2] < worst[2])
      worst = edges[k];
  if (worst[2] == static_cast<int>(sorted.size())) return std::nullopt;
  return Defect{DefectKind::non_manifold_edge, static_cast<std::size_t>(worst[2]), -1, {worst[0], worst[1]}};
}

std::optional<Defect> line_defect(const Mesh& mesh) {
  std::vector<std::array<int, 2>> sorted = mesh.lines;
  for (auto& line : sorted) std::ranges::sort(line);
  const auto [second, first] = first_repeated(sorted);
  if (first < 0) return std::nullopt;
  return Defect{DefectKind::duplicate_line, static_cast<std::size_t>(second), first,
                sorted[static_cast<std::size_t>(second)]};
}

}  // namespace

Vector doubled_area(const std::vector<Vector>& points, const std::array<int, 3>& triangle) {
  const Vector u = difference(at(points, triangle[1]), at(points, triangle[0])),
               v = difference(at(points, triangle[2]), at(points, triangle[0]));
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

bool is_planar(const Mesh& mesh) {
  const auto unit_normal = [&](const std::array<int, 3>& triangle) {
    Vector normal = doubled_area(mesh.rest, triangle);
    const double size = length(normal);
    for (double& value : normal) value /= size;
    return normal;
  };
  if (mesh.triangles.empty()) return true;
  const Vector first = unit_normal(mesh.triangles.front());
  return std::ranges::all_of(mesh.triangles, [&](const std::array<int, 3>& triangle) {
    const Vector normal = unit_normal(triangle);
    const double cosine = first[0] * normal[0] + first[1] * normal[1] + first[2] * normal[2];
    return std::abs(cosine) > 1.0 - 1e-13;
  });
}

std::optional<std::array<int, 2>> inconsistent_triangles(const Mesh& mesh) {
  // Consistently oriented neighbours traverse their common edge in opposite directions.
  std::vector<std::array<int, 3>> directed;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    for (std::size_t e = 0; e < 3; ++e)
      directed.push_back({mesh.triangles[k][e], mesh.triangles[k][(e + 1) % 3], static_cast<int>(k)});
  std::ranges::sort(directed);
  for (std::size_t k = 1; k < directed.size(); ++k)
    if (directed[k][0] == directed[k - 1][0] && directed[k][1] == directed[k - 1][1])
      return std::array{directed[k - 1][2], directed[k][2]};
  return std::nullopt;
}

double extent_of(const Mesh& mesh) {
  if (mesh.rest.empty()) return 0.0;
  Vector low = mesh.rest.front(), high = low;
  for (const Vector& x : mesh.rest)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], x[axis]);
      high[axis] = std::max(high[axis], x[axis]);
    }
  return length(difference(high, low));
}

std::optional<std::array<int, 2>> near_vertices(const Mesh& mesh, double distance) {
  // Along a direction in which no rows of vertices lie, few of them share an interval of this length.
  constexpr Vector direction = {0.39670, 0.53910, 0.74295};
  std::vector<std::pair<double, int>> order;
  for (std::size_t i = 0; i < mesh.rest.size(); ++i) {
    double along = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) along += direction[axis] * mesh.rest[i][axis];
    order.push_back({along, static_cast<int>(i)});
  }
  std::ranges::sort(order);
  for (std::size_t k = 0; k < order.size(); ++k)
    for (std::size_t l = k + 1; l < order.size() && order[l].first - order[k].first <= distance; ++l) {
      const int i = order[k].second, j = order[l].second;
      if (rest_distance(mesh, i, j) < distance) return std::array{std::min(i, j), std::max(i, j)};
    }
  return std::nullopt;
}

std::optional<Defect> find_defect(const Mesh& mesh) {
  if (const auto defect = vertex_defect(mesh)) return defect;
  if (const auto defect = triangle_defect(mesh)) return defect;
  return line_defect(mesh);
}

}  // namespace drogue::mesh
