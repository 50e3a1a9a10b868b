#pragma once

namespace drogue::reference {

/// Porous piston in a channel of fluid with explicit staggered coupling, per area of the channel.
struct Piston {
  double velocity = 0.0;      ///< of the piston, m/s
  double fluid = 0.0;         ///< velocity of the fluid, m/s
  double acceleration = 0.0;  ///< filtered acceleration of the fluid without the piston, m/s^2
  double force = 0.0;         ///< of the piston on the fluid in the last step, Pa
};

/// Constants of a piston.
struct PistonParameters {
  double mass = 1.0;               ///< of the piston, kg/m^2
  double fluid_mass = 1.0;         ///< of the fluid in the channel, kg/m^2
  double inverse_air_mass = 1.0;   ///< row sum of interpolation after spreading, m^2/kg
  double alpha = 0.0, beta = 0.0;  ///< porous law, Pa s/m and Pa s^2/m^2
  double filter = 0.5;             ///< weight of the present step in the acceleration
  double dt = 0.01;                ///< s
};

/// Step of the piston, which takes the force of the last step, and of the fluid, on which it then imposes its
/// velocity through the porous law. `is_first`: no step precedes this one.
[[nodiscard]] Piston explicit_step(const Piston& state, const PistonParameters& parameters, bool is_first);

/// Largest magnitude by which a step multiplies small motions of an impermeable piston: of the roots z of
/// (z - 1)^2 + (r + s + f s) (z - 1) + f (r + s) = 0 with the filter f, r = 1 / (inverse_air_mass mass) and s
/// = 1 / (inverse_air_mass fluid_mass). Above 1 the coupling is unstable.
[[nodiscard]] double explicit_growth(const PistonParameters& parameters);

}  // namespace drogue::reference
