#include "kernels/mesh/edges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/mesh/edge_vector.hpp"

namespace drogue::mesh {

namespace {

std::vector<Edge> sorted_unique(std::vector<Edge> edges) {
  std::ranges::sort(edges);
  const auto repeated = std::ranges::unique(edges);
  edges.erase(repeated.begin(), repeated.end());
  return edges;
}

}  // namespace

Edge edge_between(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

double rest_distance(const Mesh& mesh, int a, int b) { return stable_norm(edge_vector(mesh, a, b)); }

double rest_length(const Mesh& mesh, std::size_t line) {
  if (!mesh.line_length.empty() && mesh.line_length[line] > 0.0) return mesh.line_length[line];
  return rest_distance(mesh, mesh.lines[line][0], mesh.lines[line][1]);
}

Edge opposite_edge(const std::array<int, 3>& triangle, std::size_t k) {
  return edge_between(triangle[(k + 1) % 3], triangle[(k + 2) % 3]);
}

std::vector<Edge> triangle_edges(const Mesh& mesh) {
  std::vector<Edge> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(opposite_edge(t, k));
  return sorted_unique(std::move(edges));
}

std::vector<Edge> edges_of(const Mesh& mesh) {
  std::vector<Edge> edges = triangle_edges(mesh);
  for (const auto& [i, j] : mesh.lines) edges.push_back(edge_between(i, j));
  return sorted_unique(std::move(edges));
}

double shortest_edge(const Mesh& mesh) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& [i, j] : edges_of(mesh)) shortest = std::min(shortest, rest_distance(mesh, i, j));
  return std::isfinite(shortest) ? shortest : 0.0;
}

}  // namespace drogue::mesh
