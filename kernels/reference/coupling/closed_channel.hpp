#pragma once

#include <vector>

namespace drogue::reference {

/// Sheet across a channel: a porous law, and its velocity at the end of a step, m/s.
struct ClosedChannelSheet {
  double alpha = 0.0, beta = 0.0;  ///< Pa s/m and Pa s^2/m^2
  bool impermeable = false;
  double velocity = 0.0;
};

/// Fluid of a channel after a step.
struct ClosedChannelStep {
  double velocity = 0.0;              ///< m/s
  std::vector<double> pressure_jump;  ///< of each sheet on the fluid, Pa
};

/// Backward Euler step of dt, s, of fluid that moves as a whole through sheets across a channel, of the mass
/// `mass` per area, kg/m^2, under an acceleration, m/s^2. One sheet at most is impermeable.
[[nodiscard]] ClosedChannelStep closed_channel_step(double velocity, double acceleration, double mass,
                                                    const std::vector<ClosedChannelSheet>& sheets, double dt);

}  // namespace drogue::reference
