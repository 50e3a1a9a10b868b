#include "kernels/mesh/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kernels/mesh/edges.hpp"
#include "kernels/mesh/vectors.hpp"

namespace drogue::mesh {
namespace {

/// One of the two sides of a common edge.
struct Neighbour {
  int triangle = -1;
  bool agrees = false;  ///< both traverse the edge in opposite directions
};

using Neighbours = std::vector<std::array<Neighbour, 3>>;

/// Neighbour of each triangle across its three edges.
Neighbours neighbours_of(const Mesh& mesh) {
  struct Side {
    Edge edge;
    int triangle, corner;
    bool ascends;
  };
  std::vector<Side> sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({edge_between(a, b), static_cast<int>(t), static_cast<int>(k), a < b});
    }
  std::ranges::sort(sides, {}, [](const Side& side) { return std::pair(side.edge, side.triangle); });
  Neighbours result(mesh.triangles.size());
  for (std::size_t k = 1; k < sides.size(); ++k) {
    const Side &one = sides[k - 1], &other = sides[k];
    if (one.edge != other.edge) continue;
    const bool agrees = one.ascends != other.ascends;
    const auto at = [&result](const Side& side) -> Neighbour& {
      return result[static_cast<std::size_t>(side.triangle)][static_cast<std::size_t>(side.corner)];
    };
    at(one) = {other.triangle, agrees};
    at(other) = {one.triangle, agrees};
  }
  return result;
}

Vector from_to(const Mesh& mesh, const Vector& origin, int vertex) {
  return difference(at(mesh.rest, vertex), origin);
}

/// Six times the volume of the tetrahedron of three vectors.
double triple(const Vector& a, const Vector& b, const Vector& c) { return dot(a, cross(b, c)); }

/// Solid angle that a part covers from a point, sr, over 4 pi: the number of turns of a closed part around
/// it. van Oosterom and Strackee 1983, eq. (8).
double turns_around(const Mesh& mesh, const Orientation& orientation, int part, const Vector& point) {
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (orientation.part_of[t] != part) continue;
    const auto& [i, j, k] = mesh.triangles[t];
    const Vector a = from_to(mesh, point, i), b = from_to(mesh, point, j), c = from_to(mesh, point, k);
    const double la = std::sqrt(dot(a, a)), lb = std::sqrt(dot(b, b)), lc = std::sqrt(dot(c, c));
    sum += 2.0 * std::atan2(triple(a, b, c), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4.0 * std::numbers::pi);
}

/// Visits the triangles of a part from its first one on, and decides which must be turned.
void visit_part(const Neighbours& neighbours, int first, Orientation& result) {
  const int number = static_cast<int>(result.parts.size());
  SurfacePart& part = result.parts.emplace_back();
  part.first = first;
  std::vector<int> visited = {first};
  result.part_of[static_cast<std::size_t>(first)] = number;
  for (std::size_t k = 0; k < visited.size(); ++k) {
    const auto t = static_cast<std::size_t>(visited[k]);
    for (const Neighbour& next : neighbours[t]) {
      if (next.triangle < 0) {
        ++part.free_edges;
        continue;
      }
      const auto n = static_cast<std::size_t>(next.triangle);
      const auto wanted = static_cast<char>((result.turned[t] != 0) != !next.agrees);
      if (result.part_of[n] < 0) {
        result.part_of[n] = number;
        result.turned[n] = wanted;
        visited.push_back(next.triangle);
      } else if (result.turned[n] != wanted && !result.one_sided) {
        result.one_sided = {static_cast<int>(std::min(t, n)), static_cast<int>(std::max(t, n))};
      }
    }
  }
  part.triangles = visited.size();
  const auto turned =
      std::ranges::count_if(visited, [&](int t) { return result.turned[static_cast<std::size_t>(t)] != 0; });
  if (2 * static_cast<std::size_t>(turned) <= visited.size()) return;
  for (const int t : visited)
    result.turned[static_cast<std::size_t>(t)] = result.turned[static_cast<std::size_t>(t)] == 0 ? 1 : 0;
}

}  // namespace

std::size_t Orientation::turns() const { return static_cast<std::size_t>(std::ranges::count(turned, 1)); }

Orientation orientation_of(const Mesh& mesh) {
  const Neighbours neighbours = neighbours_of(mesh);
  Orientation result;
  result.part_of.assign(mesh.triangles.size(), -1);
  result.turned.assign(mesh.triangles.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (result.part_of[t] < 0) visit_part(neighbours, static_cast<int>(t), result);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    SurfacePart& part = result.parts[static_cast<std::size_t>(result.part_of[t])];
    if (part.free_edges > 0 || result.one_sided) continue;
    // From a vertex of the part: far from the origin, the differences of large volumes would be lost.
    const Vector& origin =
        mesh.rest[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(part.first)][0])];
    const double volume = volume_between({&mesh.triangles[t], 1}, mesh.rest, origin);
    part.volume += result.turned[t] != 0 ? -volume : volume;
  }
  return result;
}

double volume_between(std::span<const std::array<int, 3>> triangles, std::span<const Vector> x,
                      const Vector& point) {
  const auto from_point = [&](int vertex) { return difference(x[static_cast<std::size_t>(vertex)], point); };
  double sum = 0.0;
  for (const auto& [a, b, c] : triangles) sum += triple(from_point(a), from_point(b), from_point(c));
  return sum / 6.0;
}

void turn(Mesh& mesh, const Orientation& orientation) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (orientation.turned[t] != 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
}

double enclosed_volume(const Mesh& mesh, const Orientation& orientation) {
  double sum = 0.0;
  const auto parts = static_cast<int>(orientation.parts.size());
  for (int part = 0; part < parts; ++part) {
    const SurfacePart& one = orientation.parts[static_cast<std::size_t>(part)];
    const Vector& point =
        mesh.rest[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(one.first)][0])];
    bool is_inside = false;
    for (int other = 0; other < parts; ++other)
      if (other != part && orientation.parts[static_cast<std::size_t>(other)].volume != 0.0)
        is_inside = is_inside || std::abs(turns_around(mesh, orientation, other, point)) > 0.5;
    if (!is_inside) sum += std::abs(one.volume);
  }
  return sum;
}

}  // namespace drogue::mesh
