#include "kernels/fabric/contact_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace drogue::fabric {

namespace {

Vector way(const Mesh& mesh, int from, int to) {
  const Vector &a = mesh.rest[static_cast<std::size_t>(from)], &b = mesh.rest[static_cast<std::size_t>(to)];
  return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

std::array<int, 2> ordered(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

double size_of(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }

}  // namespace

ContactEdges contact_edges(const Mesh& mesh) {
  std::set<std::array<int, 2>> of_triangles, of_lines;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) of_triangles.insert(ordered(t[k], t[(k + 1) % 3]));
  for (const auto& line : mesh.lines)
    if (const auto edge = ordered(line[0], line[1]); !of_triangles.contains(edge)) of_lines.insert(edge);
  ContactEdges edges;
  edges.ends.assign(of_triangles.begin(), of_triangles.end());
  edges.first_line = static_cast<int>(edges.ends.size());
  edges.ends.insert(edges.ends.end(), of_lines.begin(), of_lines.end());
  for (const auto& [a, b] : edges.ends) edges.mean_length += size_of(way(mesh, a, b));
  edges.mean_length /= std::max(1.0, static_cast<double>(edges.ends.size()));
  return edges;
}

std::vector<int> owned_parts(const Mesh& mesh) {
  std::set<int> corners;
  std::set<std::array<int, 2>> edges;
  std::vector<int> owned;
  for (const auto& t : mesh.triangles) {
    int bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners.insert(t[k]).second) bits |= 1 << k;
      if (edges.insert(ordered(t[k], t[(k + 1) % 3])).second) bits |= 8 << k;
    }
    owned.push_back(bits);
  }
  return owned;
}

double least_height(const Mesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector base = way(mesh, t[(k + 1) % 3], t[(k + 2) % 3]), side = way(mesh, t[(k + 1) % 3], t[k]);
      const Vector across = {base[1] * side[2] - base[2] * side[1], base[2] * side[0] - base[0] * side[2],
                             base[0] * side[1] - base[1] * side[0]};
      least = std::min(least, size_of(across) / size_of(base));
    }
  return least;
}

}  // namespace drogue::fabric
