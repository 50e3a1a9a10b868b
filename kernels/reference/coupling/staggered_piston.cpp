#include "kernels/reference/coupling/staggered_piston.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "kernels/reference/coupling/porous_sheet.hpp"

namespace drogue::reference {

Piston explicit_step(const Piston& state, const PistonParameters& p, bool is_first) {
  Piston next;
  next.velocity = state.velocity - p.dt * state.force / p.mass;
  const double beside = state.fluid + p.dt * state.acceleration;
  next.force = porous_impulse(p.alpha, p.beta, next.velocity - beside, p.dt, p.inverse_air_mass) / p.dt;
  next.fluid = state.fluid + p.dt * next.force / p.fluid_mass;
  const double without_piston = (next.fluid - state.fluid) / p.dt - p.inverse_air_mass * next.force;
  const double weight = is_first ? 1.0 : p.filter;
  next.acceleration = (1.0 - weight) * state.acceleration + weight * without_piston;
  return next;
}

double explicit_growth(const PistonParameters& p) {
  const double r = 1.0 / (p.inverse_air_mass * p.mass), s = 1.0 / (p.inverse_air_mass * p.fluid_mass);
  const std::complex<double> half = 0.5 * (r + s + p.filter * s),
                             root = std::sqrt(half * half - p.filter * (r + s));
  return std::max(std::abs(1.0 - half + root), std::abs(1.0 - half - root));
}

}  // namespace drogue::reference
