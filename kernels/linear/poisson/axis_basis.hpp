#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace drogue::linear {

/// Condition on the solution at an end of an axis, at the face of the outermost cell.
enum class EndCondition {
  neumann,    ///< zero normal derivative
  dirichlet,  ///< zero value
};

/// Boundary conditions along an axis, and the places of the unknowns.
struct AxisConditions {
  bool periodic = true;
  EndCondition low = EndCondition::neumann;   ///< not used if periodic
  EndCondition high = EndCondition::neumann;  ///< not used if periodic
  /// The n unknowns of a bounded axis are at the inner faces of n + 1 cells, not at the centres of n cells;
  /// the outermost faces have the value zero. Those of a periodic axis are at the low faces of n cells.
  bool on_faces = false;

  /// Whether the unknowns are at the inner faces of a bounded axis. Does not throw.
  [[nodiscard]] bool on_inner_faces() const { return on_faces && !periodic; }

  friend bool operator==(const AxisConditions&, const AxisConditions&) = default;
};

/// Eigenvalue k, 1/m^2, of the second difference of n unknowns of spacing h (m): at most 0. Does not throw.
///
/// The wave number times h is 2 pi k / n (periodic), pi k / n (both ends Neumann), pi (k + 1) / n (both
/// Dirichlet), pi (k + 1/2) / n (one of each), and pi (k + 1) / (n + 1) on faces; Schumann and Sweet 1988,
/// table 1.
inline double axis_eigenvalue(const AxisConditions& axis, int n, double h, int k) {
  double angle = 0.0;
  if (axis.periodic)
    angle = 2.0 * k / n;
  else if (axis.on_faces)
    angle = (k + 1.0) / (n + 1.0);
  else if (axis.low != axis.high)
    angle = (k + 0.5) / n;
  else
    angle = static_cast<double>(axis.low == EndCondition::neumann ? k : k + 1) / n;
  const double root = 2.0 / h * std::sin(0.5 * std::numbers::pi * angle);
  return -root * root;
}

/// Component i of the normalised eigenvector k of `axis_eigenvalue`. Periodic: the Hartley basis, whose
/// matrix is symmetric. Does not throw.
inline double axis_eigenvector(const AxisConditions& axis, int n, int k, int i) {
  const double pi = std::numbers::pi, x = i + 0.5;
  const double scale = std::sqrt(2.0 / n);
  if (axis.periodic) {
    // Reduced before the multiplication by pi: k i may have no exact angle otherwise.
    const double angle = 2.0 * pi * static_cast<double>(static_cast<long long>(k) * i % n) / n;
    return std::sqrt(1.0 / n) * (std::cos(angle) + std::sin(angle));
  }
  if (axis.on_faces) return std::sqrt(2.0 / (n + 1.0)) * std::sin(pi * (k + 1.0) * (i + 1.0) / (n + 1.0));
  if (axis.low == EndCondition::neumann && axis.high == EndCondition::neumann)
    return (k == 0 ? std::sqrt(1.0 / n) : scale) * std::cos(pi * k * x / n);
  if (axis.low == EndCondition::neumann) return scale * std::cos(pi * (k + 0.5) * x / n);
  if (axis.high == EndCondition::neumann) return scale * std::sin(pi * (k + 0.5) * x / n);
  return (k + 1 == n ? std::sqrt(1.0 / n) : scale) * std::sin(pi * (k + 1) * x / n);
}

}  // namespace drogue::linear
