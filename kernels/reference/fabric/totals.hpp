#pragma once

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Sequential sums over the vertices in extended precision, without the elastic energy: energies, J,
/// momentum, kg m/s, and angular momentum about the origin, kg m^2/s.
struct Sums {
  long double kinetic = 0.0L, gravity = 0.0L, load = 0.0L;
  std::array<long double, 3> momentum{}, angular_momentum{};
};

/// Sums for positions x, m, and velocities v, m/s. `load`, N, may be empty. Does not throw.
[[nodiscard]] Sums sums(const std::vector<double>& mass, const Vector& gravity,
                        const std::vector<Vector>& load, const std::vector<Vector>& x,
                        const std::vector<Vector>& v);

}  // namespace drogue::reference
