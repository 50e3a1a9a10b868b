#pragma once

#include "kernels/reference/gas/euler.hpp"

namespace drogue::reference {

/// Minimum density and pressure of limited cells.
inline constexpr double positivity_floor = 1e-13;

struct LimitedFlux {
  Conserved flux{};
  bool limited = false;
};

/// Positivity-preserving flux limiter of Hu, Adams and Shu (2013). Blends the high-order flux between cells
/// `a` and `b` with the first-order one, first for density, then for pressure, so that a - 2 lambda flux and
/// b + 2 lambda flux stay above the floor. `lambda` is dt/dx of the stage, s/m, with lambda * max(|u|+c) <=
/// 1/2. Does not throw.
[[nodiscard]] LimitedFlux limit_flux(const Conserved& high, const Conserved& low, const Conserved& a,
                                     const Conserved& b, double lambda, double gamma);

}  // namespace drogue::reference
