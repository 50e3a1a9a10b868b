#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "kernels/flow/axis_lines.hpp"
#include "kernels/flow/control.hpp"
#include "kernels/flow/mac_grid.hpp"
#include "kernels/flow/parameters.hpp"

namespace drogue::flow {

/// Constants that determine dt, from the parameters and the grid or a part of it. The least widths of the
/// cells limit dt, and the largest ones are damped least. Does not throw.
inline StepConstants step_constants(const Parameters& parameters, const MacGrid& grid) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  double squares = 0.0, least_square = infinite;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (grid.n[axis] == 1) continue;
    const double square = grid.inverse_h[axis] * grid.inverse_h[axis];
    squares += square;
    double widest = grid.h[axis];
    for (int i = 0; is_stretched(parameters, axis) && i < parameters.cells[axis]; ++i)
      widest = std::max(widest, cell_width(parameters, axis, i));
    least_square = std::min(least_square, is_stretched(parameters, axis) ? 1.0 / (widest * widest) : square);
  }
  const double nu = parameters.viscosity / parameters.density;
  const bool is_implicit = parameters.diffusion == Diffusion::crank_nicolson;
  const bool is_viscous = nu > 0.0 && squares > 0.0;
  const bool is_rk3 = parameters.time_scheme == TimeScheme::rk3;
  // Intervals of the negative real axis in which the methods are stable; the largest eigenvalue of the
  // viscous term is 4 nu times the sum of the squares.
  const double interval = is_rk3 ? 2.5 : 1.0;
  StepConstants constants{};
  constants.cfl = parameters.cfl > 0.0 ? parameters.cfl : default_cfl(parameters.time_scheme);
  constants.fixed_dt = parameters.fixed_dt;
  constants.max_dt = parameters.max_dt;
  const double diffusive_dt = is_viscous ? interval / (4.0 * nu * squares) : infinite;
  constants.diffusive_dt = is_implicit ? infinite : diffusive_dt;
  constants.implicit_dt = is_implicit ? diffusive_dt : infinite;
  constants.stable_cfl = stable_cfl(parameters.time_scheme);
  // Rates of advection are divided by the CFL number: the standard one, or, of a fixed dt, the largest.
  if (parameters.turbulence != Turbulence::none)
    constants.eddy_weight =
        4.0 * squares / interval *
        (parameters.fixed_dt > 0.0 ? constants.stable_cfl : constants.cfl / diffusive_reserve);
  // Implicit diffusion does not damp the velocity on outflows.
  const bool has_outflow = std::ranges::any_of(
      parameters.boundary, [](const Boundary& side) { return side.kind == BoundaryKind::outflow; });
  constants.damping_rate = is_implicit && !has_outflow && squares > 0.0 ? nu * least_square : 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double drop = parameters.pressure_drop[axis] / (parameters.high[axis] - parameters.low[axis]);
    constants.acceleration =
        std::max(constants.acceleration, std::abs(parameters.body_force[axis] + drop) / parameters.density);
  }
  constants.max_steps = parameters.max_steps;
  return constants;
}

}  // namespace drogue::flow
