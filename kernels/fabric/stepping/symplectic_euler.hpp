#pragma once

#include "kernels/fabric/stepping/kick.hpp"

namespace drogue::fabric {

/// One step of the symplectic Euler method: a kick of dt, the relaxation of the velocity by the VertexForce,
/// if it has one, and the drift.
template <class ExecutionSpace, ConstitutiveModel model, class VertexForce = NoVertexForce>
struct SymplecticEulerFunctor {
  using R = PackedReal<ExecutionSpace>;
  using Points = PointsView<ExecutionSpace>;
  using Bounds = Kokkos::LaunchBounds<128, 4>;  // for the registers of relaxation after tension-only forces
  static constexpr int lanes = device::Access<R>::lanes;

  FabricViews<ExecutionSpace> fabric;  ///< its damping is zero
  Points x, v, next;                   ///< `next` receives the positions
  StepMonitor<ExecutionSpace> monitor;
  double damping, dt;
  int parity;  ///< entry of `monitor.steps` that counts the completed steps
  VertexForceTerm<VertexForce> vertex_force;

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * lanes;
    Vector3<R> total_force = force<model, R>(fabric, x, i);
    const Vector3<R> position = load_points<R>(x, i), before = load_points<R>(v, i),
                     free = free_axes<R>(fabric, i);
    const std::int64_t step = monitor.steps(parity);
    const double* const inverse_mass = &fabric.inverse_mass(i);
    if constexpr (has_vertex_force<VertexForce>)
      total_force = vertex_force.add_to(total_force, position, before, inverse_mass, i, step, 0.0);
    Vector3<R> velocity = kicked(before, acceleration(fabric, total_force, before, i), free, damping, dt);
    if constexpr (has_vertex_force<VertexForce>)
      velocity = vertex_force.relaxed(position, velocity, free, inverse_mass, i, step);
    const Vector3<R> end = position + dt * velocity;
    store_points(next, i, end);
    store_points(v, i, velocity);
    record_divergence(monitor, step + 1, i, end, velocity);
    if (pack == 0) monitor.steps(1 - parity) = step + 1;
  }
};

/// Enqueues a step of the symplectic Euler method:
///     v += dt a(x),   v = relaxed velocity,   x += dt v
template <ConstitutiveModel model, class ExecutionSpace, class VertexForce>
void enqueue_symplectic_euler_step(const StepInputs<ExecutionSpace, VertexForce>& in,
                                   StepState<ExecutionSpace>& state) {
  const FabricForces<ExecutionSpace>& forces = in.forces;
  forces.evaluate_loads(state.x, state.v, state.at(0.0), forces.has_dashpots);
  // The relaxation is implicit: it needs the velocity of pins at the end of the step. Their positions go
  // where the kernel writes those after the drift.
  if constexpr (RelaxesVelocity<VertexForce>)
    forces.apply_dirichlet(state.spare_x, state.v, state.at(1.0), false);
  launch_packs(
      forces.space, "drogue::fabric::symplectic_euler", forces.padded,
      SymplecticEulerFunctor<ExecutionSpace, model, VertexForce>{.fabric = forces.fabric,
                                                                 .x = state.x,
                                                                 .v = state.v,
                                                                 .next = state.spare_x,
                                                                 .monitor = state.monitor,
                                                                 .damping = forces.parameters.damping,
                                                                 .dt = state.time.dt,
                                                                 .parity = state.parity,
                                                                 .vertex_force = in.vertex_force});
  end_drift(in, state);
}

}  // namespace drogue::fabric
