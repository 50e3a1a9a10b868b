#pragma once

#include "kernels/fabric/vertex_force.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::coupling {

/// Drag of lines and bodies on the vertices of a fabric in a step of the flow, on a device: `drive` - `rate`
/// v for the velocity v of a vertex, from `AirDrag`. Rows are vertices; all Views are empty without drag.
template <class ExecutionSpace>
struct DragRelaxation {
  using Memory = typename ExecutionSpace::memory_space;
  using Scalars = Kokkos::View<double*, Memory>;
  using Vectors = Kokkos::View<double* [3], Kokkos::LayoutLeft, Memory>;

  // Constant during the steps of the cloth in one step of the flow.
  Vectors drive;  ///< N
  Scalars rate;   ///< kg/s

  Vectors impulse;  ///< on each vertex since the beginning of the step of the flow, N s

  [[nodiscard]] KOKKOS_FUNCTION bool is_empty() const { return rate.extent(0) == 0; }

  /// Velocity, m/s, of a vertex after dt of its drag by the backward Euler method. `inverse_mass`: of the
  /// vertex along each axis, 1/kg. Updates its impulse.
  KOKKOS_FUNCTION spatial::Point relax(const fabric::VertexStage& at,
                                       const spatial::Point& inverse_mass) const {
    const spatial::Point force = spatial::load_vector(drive, at.vertex);
    const double loss = at.dt * rate(at.vertex);
    const auto along = [&](double velocity, double of_drive, double inverse) {
      return (velocity + at.dt * inverse * of_drive) / (1.0 + inverse * loss);
    };
    const spatial::Point velocity{along(at.velocity.x, force.x, inverse_mass.x),
                                  along(at.velocity.y, force.y, inverse_mass.y),
                                  along(at.velocity.z, force.z, inverse_mass.z)};
    spatial::store_vector(impulse, at.vertex,
                          spatial::load_vector(impulse, at.vertex) + at.dt * force - loss * velocity);
    return velocity;
  }
};

}  // namespace drogue::coupling
