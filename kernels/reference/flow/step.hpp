#pragma once

#include "kernels/reference/flow/domain.hpp"

namespace drogue::reference {

/// Velocity, kinematic pressure at the cells, and rate of change without pressure of the previous step.
struct FlowState {
  StaggeredField velocity;       ///< m/s
  std::vector<double> pressure;  ///< m^2/s^2
  StaggeredField old_rate;       ///< m/s^2
  double last_dt = 0.0;          ///< s; 0: no previous step
};

/// Velocity with the prescribed normal components on the sides at a time (s).
[[nodiscard]] StaggeredField with_side_velocity(const FlowDomain& domain, StaggeredField u, double time);

/// Subtracts dt times the pressure gradient that makes `u` free of divergence, by conjugate gradients to
/// round-off. Returns the kinematic pressure, m^2/s^2, zero on outflows, or of mean zero.
std::vector<double> project(const FlowDomain& domain, StaggeredField& u, double dt);

/// Kinematic pressure of a velocity free of divergence at a time (s), m^2/s^2, from the divergence of its
/// rates of change. Accelerations of sides are central differences over 2e-6 s.
[[nodiscard]] std::vector<double> present_pressure(const FlowDomain& domain, const StaggeredField& u,
                                                   double time);

/// Step of Adams-Bashforth of second order from `time`, with a variable dt (s); the first step is Euler's.
[[nodiscard]] FlowState adams_bashforth_step(const FlowDomain& domain, const FlowState& state, double time,
                                             double dt);

/// Step with Adams-Bashforth advection and Crank-Nicolson diffusion from `time`, with a variable dt (s): the
/// pressure of the previous step acts in the implicit equation, the projection adds an increment phi, and the
/// pressure is p + phi - nu dt/2 lap phi (Brown, Cortez and Minion 2001), and p + phi in cells beside an
/// outflow, whose velocity is explicit. The first step is Euler's.
[[nodiscard]] FlowState crank_nicolson_step(const FlowDomain& domain, const FlowState& state, double time,
                                            double dt);

/// Step of the third-order strong-stability-preserving Runge-Kutta method (Shu and Osher 1988), each stage
/// projected.
[[nodiscard]] FlowState runge_kutta_step(const FlowDomain& domain, const FlowState& state, double time,
                                         double dt);

}  // namespace drogue::reference
