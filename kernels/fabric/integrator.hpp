#pragma once

#include "kernels/stepping/driver.hpp"

namespace drogue::fabric {

/// Time integrators.
enum class Integrator {
  rk4,               ///< classical Runge-Kutta method
  verlet,            ///< velocity Verlet
  symplectic_euler,  ///< v += dt a(x), then x += dt v; velocities lag by half a step behind those of Verlet
};

/// Driver of Runge-Kutta steps; other steps are `plain`, or `persistent` for cloth that a `VertexForce`
/// relaxes. The persistent driver does not support dashpots, bending, prescribed motions and contact in every
/// step.
using stepping::Driver;

}  // namespace drogue::fabric
