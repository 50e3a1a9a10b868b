#include "kernels/mesh/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/mesh/topology.hpp"
#include "kernels/mesh/vectors.hpp"

namespace drogue::mesh {
namespace {

double distance(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Polygon whose ears are cut off one after the other.
class Ears {
 public:
  Ears(const std::vector<Vector>& points, std::vector<int> polygon)
      : _points(points), _polygon(std::move(polygon)) {
    // The area vector of a fan, whatever its shape: Newell's normal.
    for (std::size_t k = 1; k + 1 < _polygon.size(); ++k) {
      const Vector area = doubled_area(points, {_polygon[0], _polygon[k], _polygon[k + 1]});
      for (std::size_t axis = 0; axis < 3; ++axis) _normal[axis] += area[axis];
    }
  }

  [[nodiscard]] std::size_t corners() const { return _polygon.size(); }

  /// Cuts off the ear with the shortest diagonal. Empty if there is none.
  [[nodiscard]] std::vector<std::array<int, 3>> cut() {
    const std::size_t n = _polygon.size();
    std::size_t best = n;
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k <= (n == 3 ? 1 : n); ++k) {
      const std::array<int, 3> ear = ear_at(k % n);
      const double diagonal = distance(at(_points, ear[0]), at(_points, ear[2]));
      constexpr double rounding = 1e-12;  // equal diagonals
      if (!(diagonal < (1.0 - rounding) * shortest) || !is_inside(ear)) continue;
      best = k % n;
      shortest = diagonal;
    }
    if (best == n) return {};
    const std::array<int, 3> ear = ear_at(best);
    _polygon.erase(_polygon.begin() + static_cast<std::ptrdiff_t>(best));
    return {ear};
  }

 private:
  [[nodiscard]] std::array<int, 3> ear_at(std::size_t k) const {
    const std::size_t n = _polygon.size();
    return {_polygon[(k + n - 1) % n], _polygon[k], _polygon[(k + 1) % n]};
  }

  /// Part of twice the area of a triangle along the normal of the polygon, times its size.
  [[nodiscard]] double turn(int a, int b, int c) const {
    return dot(_normal, doubled_area(_points, {a, b, c}));
  }

  /// True if the ear turns as the polygon does, and no other corner lies in it or on its sides.
  [[nodiscard]] bool is_inside(const std::array<int, 3>& ear) const {
    const auto [a, b, c] = ear;
    if (!(turn(a, b, c) > 0.0)) return false;
    return std::ranges::none_of(_polygon, [&](int i) {
      if (i == a || i == b || i == c) return false;
      return turn(a, b, i) >= 0.0 && turn(b, c, i) >= 0.0 && turn(c, a, i) >= 0.0;
    });
  }

  const std::vector<Vector>& _points;
  std::vector<int> _polygon;
  Vector _normal{};
};

}  // namespace

std::vector<std::array<int, 3>> triangulate(const std::vector<Vector>& points, std::vector<int> polygon) {
  if (polygon.size() == 3) return {{polygon[0], polygon[1], polygon[2]}};
  std::vector<std::array<int, 3>> triangles;
  Ears rest(points, std::move(polygon));
  while (rest.corners() > 2) {
    const auto ear = rest.cut();
    if (ear.empty()) return {};
    triangles.push_back(ear.front());
  }
  return triangles;
}

}  // namespace drogue::mesh
