#pragma once

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Sums in extended precision, one vertex after the other; the elastic energy is `energy`. J, kg m/s,
/// kg m^2/s about the origin.
struct Sums {
  long double kinetic = 0.0L, gravity = 0.0L, load = 0.0L;
  std::array<long double, 3> momentum{}, angular_momentum{};
};

/// `load` may be empty.
[[nodiscard]] Sums sums(const std::vector<double>& mass, const Vector& gravity,
                        const std::vector<Vector>& load, const std::vector<Vector>& x,
                        const std::vector<Vector>& v);

}  // namespace drogue::reference
