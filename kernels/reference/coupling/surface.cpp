#include "kernels/reference/coupling/surface.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::reference {

namespace {

using Real = long double;
using Extended = std::array<Real, 3>;

Extended extended_difference(const Vector& a, const Vector& b) {
  return {Real(a[0]) - b[0], Real(a[1]) - b[1], Real(a[2]) - b[2]};
}

Real norm(const Extended& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

/// Heron's formula in the stable order of Kahan.
Real heron(Extended sides) {
  std::ranges::sort(sides);
  const auto& [c, b, a] = sides;
  return 0.25L * std::sqrt((a + (b + c)) * std::max(0.0L, c - (a - b)) * (c + (a - b)) * (a + (b - c)));
}

/// Unit vector of the right-hand rule; zero for parallel edges.
Extended unit_normal(const Extended& u, const Extended& v) {
  Extended n{};
  for (std::size_t k = 0; k < 3; ++k)
    n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
  const Real size = norm(n);
  for (Real& value : n) value = size > 0.0L ? value / size : 0.0L;
  return n;
}

Real area_of(const std::vector<Vector>& x, const std::array<int, 3>& triangle) {
  const auto side = [&](std::size_t k) {
    return norm(extended_difference(x[static_cast<std::size_t>(triangle[(k + 1) % 3])],
                                    x[static_cast<std::size_t>(triangle[k])]));
  };
  return heron({side(0), side(1), side(2)});
}

}  // namespace

std::vector<double> smoothed_along(const Mesh& mesh, const std::vector<Vector>& x, std::vector<double> values,
                                   int times) {
  for (int k = 0; k < times; ++k) {
    std::vector<Real> sums(x.size(), 0.0L), weights(x.size(), 0.0L);
    for (const auto& triangle : mesh.triangles) {
      const Real area = area_of(x, triangle);
      for (const int to : triangle)
        for (const int from : triangle) {
          weights[static_cast<std::size_t>(to)] += area;
          sums[static_cast<std::size_t>(to)] += area * values[static_cast<std::size_t>(from)];
        }
    }
    for (std::size_t i = 0; i < x.size(); ++i)
      values[i] = weights[i] > 0.0L ? static_cast<double>(sums[i] / weights[i]) : 0.0;
  }
  return values;
}

SurfaceGeometry surface_geometry(const Mesh& mesh, const std::vector<Vector>& x) {
  SurfaceGeometry result;
  std::vector<Real> area(x.size(), 0.0L);
  std::vector<Extended> weighted(x.size(), Extended{});
  for (const auto& triangle : mesh.triangles) {
    const Vector &a = x[static_cast<std::size_t>(triangle[0])], &b = x[static_cast<std::size_t>(triangle[1])],
                 &c = x[static_cast<std::size_t>(triangle[2])];
    const Extended ab = extended_difference(b, a), ac = extended_difference(c, a);
    const Real size = area_of(x, triangle);
    const Extended normal = unit_normal(ab, ac);
    for (const int corner : triangle) {
      const auto i = static_cast<std::size_t>(corner);
      area[i] += size / 3.0L;
      for (std::size_t k = 0; k < 3; ++k) weighted[i][k] += size * normal[k];
    }
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    result.area.push_back(static_cast<double>(area[i]));
    const Real size = norm(weighted[i]);
    Vector& normal = result.normal.emplace_back();
    if (size > 0.0L)
      for (std::size_t k = 0; k < 3; ++k) normal[k] = static_cast<double>(weighted[i][k] / size);
  }
  return result;
}

}  // namespace drogue::reference
