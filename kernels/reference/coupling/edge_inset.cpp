#include "kernels/reference/coupling/edge_inset.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/reference/vectors.hpp"

namespace drogue::reference {

namespace {

/// Distance from an edge at which a vertex is an end of it, m.
constexpr double rounding = 1e-12;

Vector combination(double a, const Vector& u, double b, const Vector& v) {
  return {a * u[0] + b * v[0], a * u[1] + b * v[1], a * u[2] + b * v[2]};
}

Vector normalised(const Vector& v) { return combination(1.0 / norm(v), v, 0.0, v); }

/// Part of v that is normal to a unit vector.
Vector rejected(const Vector& v, const Vector& along) {
  return combination(1.0, v, -product(v, along), along);
}

const Vector& at(const std::vector<Vector>& points, int i) { return points[static_cast<std::size_t>(i)]; }

Vector from_to(const std::vector<Vector>& points, int a, int b) {
  return combination(1.0, at(points, b), -1.0, at(points, a));
}

/// Vector from the nearest point of edge ab to p.
Vector from_edge(const std::vector<Vector>& points, const std::array<int, 2>& edge, const Vector& p) {
  const Vector &a = at(points, edge[0]), along = from_to(points, edge[0], edge[1]);
  const double part = product(combination(1.0, p, -1.0, a), along) / product(along, along);
  const Vector foot = combination(1.0, a, std::clamp(part, 0.0, 1.0), along);
  return combination(1.0, p, -1.0, foot);
}

/// Weights of the corners at the point of a triangle nearest to p: its foot on the plane by Cramer's rule, or
/// the nearest point of the boundary.
std::array<double, 3> nearest_weights(const std::vector<Vector>& points, const std::array<int, 3>& corner,
                                      const Vector& p) {
  const Vector u = from_to(points, corner[0], corner[1]), v = from_to(points, corner[0], corner[2]),
               r = combination(1.0, p, -1.0, at(points, corner[0]));
  const double uu = product(u, u), uv = product(u, v), vv = product(v, v), ru = product(r, u),
               rv = product(r, v), determinant = uu * vv - uv * uv;
  const double second = (ru * vv - rv * uv) / determinant, third = (rv * uu - ru * uv) / determinant;
  if (second >= 0.0 && third >= 0.0 && second + third <= 1.0) return {1.0 - second - third, second, third};
  std::array<double, 3> best{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Vector away = from_edge(points, {corner[k], corner[next]}, p),
                 side = from_to(points, corner[k], corner[next]);
    if (!(norm(away) < least)) continue;
    least = norm(away);
    const Vector foot = combination(1.0, p, -1.0, away);
    const double part =
        product(combination(1.0, foot, -1.0, at(points, corner[k])), side) / product(side, side);
    best = {};
    best[k] = 1.0 - part, best[next] = part;
  }
  return best;
}

Vector weighted(const std::vector<Vector>& points, const std::array<int, 3>& corner,
                const std::array<double, 3>& weight) {
  Vector sum{};
  for (std::size_t k = 0; k < 3; ++k) sum = combination(1.0, sum, weight[k], at(points, corner[k]));
  return sum;
}

struct Side {
  std::array<int, 2> ends;
  Vector inward;  ///< of unit length
};

/// Edges that no other triangle has.
std::vector<Side> open_sides(const Mesh& mesh) {
  std::vector<Side> sides;
  for (const auto& corner : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = corner[k], b = corner[(k + 1) % 3], c = corner[(k + 2) % 3];
      const auto holds_both = [&](const auto& other) {
        return std::ranges::count(other, a) == 1 && std::ranges::count(other, b) == 1;
      };
      if (std::ranges::count_if(mesh.triangles, holds_both) > 1) continue;
      const Vector along = normalised(from_to(mesh.rest, a, b));
      sides.push_back({{a, b}, normalised(rejected(from_to(mesh.rest, a, c), along))});
    }
  return sides;
}

}  // namespace

std::vector<Vector> inset_positions(const Mesh& mesh, const std::function<bool(const Vector&)>& is_left_out,
                                    double shift, double band, const std::vector<Vector>& x) {
  std::vector<Side> sides = open_sides(mesh);
  std::erase_if(sides, [&](const Side& side) { return is_left_out(side.inward); });
  std::vector<Vector> away(x.size());
  std::vector<double> distance(x.size(), -1.0);  // negative without triangles
  double width = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto has_vertex = [&](const auto& corner) {
      return std::ranges::find(corner, static_cast<int>(i)) != corner.end();
    };
    if (std::ranges::none_of(mesh.triangles, has_vertex)) continue;
    distance[i] = std::numeric_limits<double>::infinity();
    Vector inward{};
    for (const Side& side : sides) {
      const Vector candidate = from_edge(mesh.rest, side.ends, mesh.rest[i]);
      if (norm(candidate) < rounding) inward = combination(1.0, inward, 1.0, side.inward);
      if (norm(candidate) < distance[i]) distance[i] = norm(candidate), away[i] = candidate;
    }
    if (distance[i] < rounding) distance[i] = 0.0, away[i] = inward;
    width = std::max(width, std::min(distance[i], band));
  }
  std::vector<Vector> moved = x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (distance[i] < 0.0 || !(distance[i] < width)) continue;
    const double way = std::min(shift, 0.5 * width) * (1.0 - distance[i] / width);
    const Vector target = combination(1.0, mesh.rest[i], way, normalised(away[i]));
    double least = std::numeric_limits<double>::infinity();
    for (const auto& corner : mesh.triangles) {
      const std::array<double, 3> weight = nearest_weights(mesh.rest, corner, target);
      const double off = norm(combination(1.0, weighted(mesh.rest, corner, weight), -1.0, target));
      if (!(off < least)) continue;
      least = off;
      moved[i] = weighted(x, corner, weight);
    }
  }
  return moved;
}

}  // namespace drogue::reference
