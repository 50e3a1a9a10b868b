#include "kernels/reference/coupling/sheet_mode.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace drogue::reference {

SheetMode coupled_step(const SheetMode& state, const SheetModeParameters& p, bool is_first) {
  const double tau = p.dt / p.substeps, lighter = 1.0 - p.counted_once,
               inverse_copy = p.inverse_air_mass / lighter, inverse_mass = 1.0 / p.mass + inverse_copy;
  SheetMode next = state;
  double beside = state.air, impulse = 0.0;
  for (int substep = 0; substep < p.substeps; ++substep) {
    next.velocity -= tau * p.stiffness / p.mass * next.displacement;
    beside += tau / lighter * (state.acceleration + state.trend + state.defect);
    const double relative = next.velocity - beside;
    const double normal_impulse = std::isinf(p.alpha)
                                      ? relative / inverse_mass
                                      : tau * p.alpha * relative / (1.0 + tau * p.alpha * inverse_mass);
    next.velocity -= normal_impulse / p.mass;
    beside += inverse_copy * normal_impulse;
    impulse += normal_impulse;
    next.displacement += tau * next.velocity;
  }
  impulse += p.counted_once / p.inverse_air_mass * (beside - state.air);
  next.air = state.air + p.response * impulse;
  const double without_sheet = (p.response - p.spread) * impulse / p.dt,
               weight = is_first && p.filter > 0.0 ? 1.0 : p.filter;
  const double foretold = state.acceleration + state.trend, missed = without_sheet - foretold;
  next.acceleration = foretold + weight * missed;
  next.trend = is_first ? 0.0 : 0.5 * state.trend + p.trend * missed;
  next.defect = 0.0;
  if (p.leak_filter > 0.0)
    next.defect =
        state.defect +
        p.leak_filter * (p.smoothing * (p.spread - p.inverse_air_mass) * impulse / p.dt - state.defect);
  return next;
}

SheetModeMatrix amplification(const SheetModeParameters& p) {
  SheetModeMatrix matrix{};
  for (std::size_t column = 0; column < 6; ++column) {
    const auto unit = [column](std::size_t k) { return k == column ? 1.0 : 0.0; };
    const SheetMode image = coupled_step({.displacement = p.dt * unit(0),
                                          .velocity = unit(1),
                                          .air = unit(2),
                                          .acceleration = unit(3) / p.dt,
                                          .trend = unit(4) / p.dt,
                                          .defect = unit(5) / p.dt},
                                         p);
    matrix[0][column] = image.displacement / p.dt;
    matrix[1][column] = image.velocity;
    matrix[2][column] = image.air;
    matrix[3][column] = image.acceleration * p.dt;
    matrix[4][column] = image.trend * p.dt;
    matrix[5][column] = image.defect * p.dt;
  }
  return matrix;
}

double spectral_radius(SheetModeMatrix matrix) {
  constexpr int squarings = 30;
  // The power of the matrix is `matrix` times the exponential of `logarithm`.
  double logarithm = 0.0;
  for (int k = 0; k <= squarings; ++k) {
    double largest = 0.0;
    for (const auto& row : matrix)
      for (const double entry : row) largest = std::max(largest, std::abs(entry));
    if (largest == 0.0) return 0.0;
    logarithm += std::log(largest);
    for (auto& row : matrix)
      for (double& entry : row) entry /= largest;
    if (k == squarings) break;
    SheetModeMatrix square{};
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j)
        for (std::size_t l = 0; l < 6; ++l) square[i][j] += matrix[i][l] * matrix[l][j];
    matrix = square;
    logarithm *= 2.0;
  }
  return std::exp(std::ldexp(logarithm, -squarings));
}

}  // namespace drogue::reference
