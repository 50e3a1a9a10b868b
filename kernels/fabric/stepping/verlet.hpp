#pragma once

#include "kernels/fabric/stepping/kick.hpp"

namespace drogue::fabric {

/// Velocity Verlet (Swope et al. 1982) with one elastic force per step: half a kick that ends the step
/// before, half a kick that begins the next, and its drift. The sequence of operations does not depend on how
/// steps are distributed over launches.
template <class ExecutionSpace, ConstitutiveModel model, class VertexForce = NoVertexForce>
struct VerletFunctor {
  using R = PackedReal<ExecutionSpace>;
  using Points = PointsView<ExecutionSpace>;
  using Bounds = Kokkos::LaunchBounds<128, 6>;
  static constexpr int lanes = device::Access<R>::lanes;

  FabricViews<ExecutionSpace> fabric;  ///< its damping is zero
  Points x, v, next;                   ///< `next` receives the positions
  StepMonitor<ExecutionSpace> monitor;
  double damping, dt;
  int parity;         ///< entry of `monitor.steps` that counts the completed steps
  bool ends, begins;  ///< performs the half kick that ends, or begins, a step
  bool drifts;        ///< false if another kernel performs the drift
  VertexForceTerm<VertexForce> vertex_force;

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * lanes;
    Vector3<R> velocity = load_points<R>(v, i);
    const Vector3<R> total_force = force<model, R>(fabric, x, i),
                     a = acceleration(fabric, total_force, velocity, i), free = free_axes<R>(fabric, i),
                     position = load_points<R>(x, i);
    const std::int64_t step = monitor.steps(parity);
    const auto kick = [&] {
      if constexpr (has_vertex_force<VertexForce>) {
        // Evaluated for each half, since the first one changes the velocity.
        const Vector3<R> sum =
            vertex_force.add_to(total_force, position, velocity, &fabric.inverse_mass(i), i, step, 0.0);
        velocity = kicked(velocity, acceleration(fabric, sum, velocity, i), free, damping, 0.5 * dt);
      } else {
        velocity = kicked(velocity, a, free, damping, 0.5 * dt);
      }
    };
    if (ends) {
      kick();
      record_divergence(monitor, step, i, position, velocity);
    }
    if (begins) {
      kick();
      if (drifts) store_points(next, i, position + dt * velocity);
      if (pack == 0) monitor.steps(1 - parity) = step + 1;
    }
    store_points(v, i, velocity);
  }
};

/// Dashpots in velocity Verlet's method: they act for a whole dt on the velocities in the middle of a step,
/// and the drift follows. Stable if dt times the fastest decay is at most 1.
template <class ExecutionSpace>
struct DashpotDampingFunctor {
  FabricViews<ExecutionSpace> fabric;
  SlicedEllViews<ExecutionSpace, 1> dashpots;
  PointsView<ExecutionSpace> x, v, damped_v, next;
  double dt;

  KOKKOS_FUNCTION void operator()(const int i) const {
    const Vector3<double> gained = (dt * fabric.inverse_mass(i)) * dashpot_force(dashpots, x, v, i),
                          free = free_axes<double>(fabric, i);
    const Vector3<double> velocity =
        load_points<double>(v, i) + Vector3<double>{free.x * gained.x, free.y * gained.y, free.z * gained.z};
    store_points(damped_v, i, velocity);
    store_points(next, i, load_points<double>(x, i) + dt * velocity);
  }
};

/// Enqueues half a kick that ends a step, or begins the next one with its drift, or both.
template <ConstitutiveModel model, class ExecutionSpace, class VertexForce>
void enqueue_verlet_kicks(const StepInputs<ExecutionSpace, VertexForce>& in, StepState<ExecutionSpace>& state,
                          bool ends, bool begins) {
  const FabricForces<ExecutionSpace>& forces = in.forces;
  forces.evaluate_loads(state.x, state.v, state.at(0.0), false);
  launch_packs(in.forces.space, "drogue::fabric::verlet", forces.padded,
               VerletFunctor<ExecutionSpace, model, VertexForce>{.fabric = forces.fabric,
                                                                 .x = state.x,
                                                                 .v = state.v,
                                                                 .next = state.spare_x,
                                                                 .monitor = state.monitor,
                                                                 .damping = forces.parameters.damping,
                                                                 .dt = state.time.dt,
                                                                 .parity = state.parity,
                                                                 .ends = ends,
                                                                 .begins = begins,
                                                                 .drifts = !forces.has_dashpots,
                                                                 .vertex_force = in.vertex_force});
  if (!begins) return;
  if (forces.has_dashpots) {
    launch_each(in.forces.space, "drogue::fabric::dashpot_damping", forces.vertices,
                DashpotDampingFunctor<ExecutionSpace>{.fabric = forces.fabric,
                                                      .dashpots = forces.external.dashpots,
                                                      .x = state.x,
                                                      .v = state.v,
                                                      .damped_v = state.spare_v,
                                                      .next = state.spare_x,
                                                      .dt = state.time.dt});
    std::swap(state.v, state.spare_v);
  }
  end_drift(in, state);
}

/// Enqueues steps of the velocity Verlet method (Swope et al. 1982), of which successive half kicks share one
/// kernel:
///     v += dt/2 a(x),   x += dt v,   v += dt/2 a(x)
/// `at_new_positions()` is called once in each step, when its positions are those of its end.
template <ConstitutiveModel model, class ExecutionSpace, class VertexForce, class AtNewPositions>
void enqueue_verlet_steps(const StepInputs<ExecutionSpace, VertexForce>& in, StepState<ExecutionSpace>& state,
                          std::int64_t steps, const AtNewPositions& at_new_positions) {
  enqueue_verlet_kicks<model>(in, state, false, true);
  for (std::int64_t k = 1; k < steps; ++k) {
    at_new_positions();
    enqueue_verlet_kicks<model>(in, state, true, true);
  }
  at_new_positions();
  enqueue_verlet_kicks<model>(in, state, true, false);
}

}  // namespace drogue::fabric
