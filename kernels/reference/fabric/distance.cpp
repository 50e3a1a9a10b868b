#include "kernels/reference/fabric/distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace drogue::reference {

namespace {

using Real = long double;
using Long3 = std::array<Real, 3>;

Long3 minus(const Long3& a, const Long3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Real product(const Long3& a, const Long3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Long3 wide(const Place3& a) { return {a[0], a[1], a[2]}; }

/// Solves a symmetric system of up to three unknowns by Gaussian elimination with partial pivoting. Returns
/// false if it is singular.
bool solve(std::vector<std::vector<Real>> m, std::vector<Real> right, std::vector<Real>& x) {
  const std::size_t n = right.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i)
      if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
    std::swap(m[k], m[pivot]), std::swap(right[k], right[pivot]);
    if (m[k][k] == 0.0L) return false;
    for (std::size_t i = k + 1; i < n; ++i) {
      const Real factor = m[i][k] / m[k][k];
      for (std::size_t j = k; j < n; ++j) m[i][j] -= factor * m[k][j];
      right[i] -= factor * right[k];
    }
  }
  x.assign(n, 0.0L);
  for (std::size_t k = n; k-- > 0;) {
    x[k] = right[k];
    for (std::size_t j = k + 1; j < n; ++j) x[k] -= m[k][j] * x[j];
    x[k] /= m[k][k];
  }
  return true;
}

/// Distance of the affine hulls of two faces, m, if their closest points lie in the faces; else infinity.
Real face_distance(const std::vector<Long3>& a, const std::vector<Long3>& b) {
  const Long3 between = minus(b[0], a[0]);
  std::vector<Long3> edges;  // edges of a from a[0], and reversed edges of b from b[0]
  for (std::size_t k = 1; k < a.size(); ++k) edges.push_back(minus(a[k], a[0]));
  for (std::size_t k = 1; k < b.size(); ++k) edges.push_back(minus(b[0], b[k]));
  std::vector<Real> share;
  if (!edges.empty()) {
    std::vector<std::vector<Real>> m;
    std::vector<Real> right;
    for (const Long3& row : edges) {
      m.emplace_back();
      for (const Long3& column : edges) m.back().push_back(product(row, column));
      right.push_back(product(row, between));
    }
    if (!solve(m, right, share)) return std::numeric_limits<Real>::infinity();
  }
  Real first_a = 1.0L, first_b = 1.0L;
  Long3 rest = between;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (!(share[k] >= 0.0L)) return std::numeric_limits<Real>::infinity();
    (k + 1 < a.size() ? first_a : first_b) -= share[k];
    for (std::size_t axis = 0; axis < 3; ++axis) rest[axis] -= share[k] * edges[k][axis];
  }
  if (first_a < 0.0L || first_b < 0.0L) return std::numeric_limits<Real>::infinity();
  return std::sqrt(product(rest, rest));
}

std::vector<Long3> chosen(std::span<const Place3> places, unsigned bits) {
  std::vector<Long3> face;
  for (std::size_t k = 0; k < places.size(); ++k)
    if ((bits >> k & 1U) != 0) face.push_back(wide(places[k]));
  return face;
}

using Four = std::array<Long3, 4>;

Four places_at(const std::array<Place3, 4>& from, const std::array<Place3, 4>& to, Real part) {
  Four at;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[k][axis] = from[k][axis] + part * (Real(to[k][axis]) - Real(from[k][axis]));
  return at;
}

/// Six times the signed volume of a tetrahedron, m^3.
Real volume(const Four& p) {
  const Long3 a = minus(p[1], p[0]), b = minus(p[2], p[0]), c = minus(p[3], p[0]);
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

}  // namespace

double hull_distance(std::span<const Place3> a, std::span<const Place3> b) {
  Real least = std::numeric_limits<Real>::infinity();
  for (unsigned of_a = 1; of_a < 1U << a.size(); ++of_a)
    for (unsigned of_b = 1; of_b < 1U << b.size(); ++of_b)
      least = std::min(least, face_distance(chosen(a, of_a), chosen(b, of_b)));
  return static_cast<double>(least);
}

std::optional<double> first_meeting(const std::array<Place3, 4>& from, const std::array<Place3, 4>& to,
                                    std::size_t split, double touching) {
  const auto at = [&](Real part) { return volume(places_at(from, to, part)); };
  // Coefficients of the cubic from four of its values.
  const Real f0 = at(0.0L), f1 = at(1.0L / 3.0L), f2 = at(2.0L / 3.0L), f3 = at(1.0L);
  const Real c = 0.5L * (-11.0L * f0 + 18.0L * f1 - 9.0L * f2 + 2.0L * f3),
             b = 4.5L * (2.0L * f0 - 5.0L * f1 + 4.0L * f2 - f3),
             a = 4.5L * (f3 - 3.0L * f2 + 3.0L * f1 - f0);
  // The cubic has at most one root between neighbouring extrema.
  std::vector<Real> ends = {0.0L};
  if (const Real inner = b * b - 3.0L * a * c; inner > 0.0L) {
    const Real q = -(b + std::copysign(std::sqrt(inner), b));
    for (const Real turn : {q / (3.0L * a), c / q})
      if (turn > 0.0L && turn < 1.0L) ends.push_back(turn);
  }
  ends.push_back(1.0L);
  std::ranges::sort(ends);
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    Real low = ends[k], high = ends[k + 1];
    if (at(low) * at(high) > 0.0L) continue;
    const bool rising = at(low) < at(high);
    for (int halving = 0; halving < 80; ++halving) {
      const Real middle = 0.5L * (low + high);
      ((at(middle) < 0.0L) == rising ? low : high) = middle;
    }
    std::array<Place3, 4> there;
    const Four exact = places_at(from, to, low);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) there[i][axis] = static_cast<double>(exact[i][axis]);
    const std::span<const Place3> all(there);
    if (hull_distance(all.first(split), all.subspan(split)) <= touching) return static_cast<double>(low);
  }
  return std::nullopt;
}

}  // namespace drogue::reference
