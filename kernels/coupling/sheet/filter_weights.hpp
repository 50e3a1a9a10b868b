#pragma once

#include "kernels/coupling/sheet/sheet_parameters.hpp"
#include "kernels/device/pack.hpp"

namespace drogue::coupling {

/// Weights of the present step in the running mean of the acceleration of the air at a vertex, and of what it
/// adds to the mean in the trend of the mean. The trend is added to the mean, and loses half of itself in
/// each step.
struct FilterWeights {
  double mean, trend;
};

/// The largest weights with which modes of light cloth decay (`SheetModes.DecayWithTheWeightsOfTheLaw`). They
/// follow from the slope of the law at a pressure difference, Pa, the duration of a step, s, and the change
/// of the velocity of the air that a vertex moves alone by an impulse per area, m^2/kg. Does not throw.
KOKKOS_INLINE_FUNCTION FilterWeights filter_weights(const PorousLaw& law, double pressure, double dt,
                                                    double inverse_air_mass) {
  constexpr double with_trend = 10.0, without_lag = 30.0, least = 0.2;
  if (law.impermeable) return {least, 0.0};
  const double slope = device::square_root(law.alpha * law.alpha + 4.0 * law.beta * Kokkos::fabs(pressure)),
               resistance = slope * dt * inverse_air_mass;
  if (resistance <= with_trend) return {1.0, 0.5};
  if (resistance <= without_lag) return {1.0, 0.0};
  return {Kokkos::fmax(without_lag / resistance, least), 0.0};
}

}  // namespace drogue::coupling
