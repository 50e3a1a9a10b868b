#pragma once

#include <array>
#include <cmath>

namespace drogue::reference {

/// Scalar product, and length, of vectors. Do not throw.
[[nodiscard]] inline double product(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline double norm(const std::array<double, 3>& a) { return std::sqrt(product(a, a)); }

}  // namespace drogue::reference
