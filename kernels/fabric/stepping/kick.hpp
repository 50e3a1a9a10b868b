#pragma once

#include "kernels/fabric/fabric_forces.hpp"

namespace drogue::fabric {

/// Velocity after an acceleration a, m/s^2, during `kick`, s; unchanged along pinned axes. `damping`, 1/s, is
/// evaluated at the middle of the kick, so that no rate makes it unstable.
template <class R>
KOKKOS_INLINE_FUNCTION Vector3<R> kicked(const Vector3<R>& now, const Vector3<R>& a, const Vector3<R>& free,
                                         double damping, double kick) {
  const double half = 0.5 * damping * kick;
  const double retained = (1.0 - half) / (1.0 + half), gained = kick / (1.0 + half);
  const auto along = [&](R velocity, R acceleration, R is_free) {
    return device::select(is_free > R(0.0), retained * velocity, velocity) + gained * acceleration;
  };
  return {along(now.x, a.x, free.x), along(now.y, a.y, free.y), along(now.z, a.z, free.z)};
}

/// Makes the positions after a drift those of the state, with pins where they are prescribed. Asynchronous.
template <class ExecutionSpace, class VertexForce>
void end_drift(const StepInputs<ExecutionSpace, VertexForce>& in, StepState<ExecutionSpace>& state) {
  std::swap(state.x, state.spare_x);
  state.parity = 1 - state.parity;
  in.forces.apply_dirichlet(state.x, state.v, state.at(0.0), true);
}

}  // namespace drogue::fabric
