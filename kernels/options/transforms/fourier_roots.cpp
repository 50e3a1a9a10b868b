#include "kernels/options/transforms/fourier_roots.hpp"

#include <cmath>
#include <numbers>

namespace drogue::options {

std::vector<double> fourier_roots() {
  std::vector<double> roots;
  std::vector<long double> parts{0.25L};  // fractions of a full circle; exact
  for (int level = 0; level < FourierRoots::levels; ++level) {
    for (int m = 1; m < 8; ++m)
      for (const long double part : parts) {
        const long double angle = 2.0L * std::numbers::pi_v<long double> * (part * m / 8);
        roots.push_back(static_cast<double>(std::cos(angle)));
        roots.push_back(static_cast<double>(std::sin(angle)));
      }
    std::vector<long double> next;
    for (const long double part : parts)
      for (int q = 0; q < 8; ++q) next.push_back((part + q) / 8);
    parts.swap(next);
  }
  return roots;
}

}  // namespace drogue::options
