#include "kernels/fabric/contact/features.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>

#include "kernels/mesh/edge_vector.hpp"
#include "kernels/mesh/edges.hpp"

namespace drogue::fabric {

CollisionEdges collision_edges(const Mesh& mesh) {
  const std::vector<mesh::Edge> of_triangles = triangle_edges(mesh);
  CollisionEdges edges;
  edges.ends = of_triangles;
  edges.first_line = static_cast<int>(of_triangles.size());
  std::ranges::set_difference(edges_of(mesh), of_triangles, std::back_inserter(edges.ends));
  for (const auto& [a, b] : edges.ends) edges.mean_length += rest_distance(mesh, a, b);
  edges.mean_length /= std::max(1.0, static_cast<double>(edges.ends.size()));
  return edges;
}

std::vector<int> edges_of_lines(const Mesh& mesh, const CollisionEdges& edges) {
  const auto first = edges.ends.begin() + edges.first_line;
  std::vector<int> numbers;
  for (const auto& [a, b] : mesh.lines) {
    const mesh::Edge edge = mesh::edge_between(a, b);
    const auto found = std::lower_bound(first, edges.ends.end(), edge);
    const bool is_listed = found != edges.ends.end() && *found == edge;
    numbers.push_back(is_listed ? static_cast<int>(found - edges.ends.begin()) : -1);
  }
  return numbers;
}

std::vector<int> long_lines(const Mesh& mesh, const CollisionEdges& edges) {
  std::vector<int> lines;
  for (int k = edges.first_line; k < static_cast<int>(edges.ends.size()); ++k) {
    const auto& [a, b] = edges.ends[static_cast<std::size_t>(k)];
    if (rest_distance(mesh, a, b) >= 4.0 * edges.mean_length) lines.push_back(k);
  }
  return lines;
}

std::vector<int> owned_features(const Mesh& mesh) {
  std::set<int> corners;
  std::set<mesh::Edge> edges;
  std::vector<int> owned;
  for (const auto& t : mesh.triangles) {
    int bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners.insert(t[k]).second) bits |= 1 << k;
      if (edges.insert(mesh::edge_between(t[k], t[(k + 1) % 3])).second) bits |= 8 << k;
    }
    owned.push_back(bits);
  }
  return owned;
}

double shortest_altitude(const Mesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const spatial::Vector3<double> base = edge_vector(mesh, t[(k + 1) % 3], t[(k + 2) % 3]),
                                     side = edge_vector(mesh, t[(k + 1) % 3], t[k]);
      least = std::min(least, mesh::stable_norm(cross(base, side)) / mesh::stable_norm(base));
    }
  return least;
}

}  // namespace drogue::fabric
