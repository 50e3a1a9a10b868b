#pragma once

#include "kernels/coupling/sheet/drag_relaxation.hpp"
#include "kernels/coupling/sheet/no_slip.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::coupling {

/// Air at the vertices of a sheet, on a device. Rows are vertices; those without area have no air.
template <class ExecutionSpace>
struct LocalAir {
  using Memory = typename ExecutionSpace::memory_space;
  using Scalars = Kokkos::View<double*, Memory>;
  using Vectors = Kokkos::View<double* [3], Kokkos::LayoutLeft, Memory>;

  // Constant during the steps of the cloth in one step of the flow.
  Scalars area;              ///< m^2
  Vectors normal;            ///< of unit length
  Vectors inverse_air_mass;  ///< change of the local velocity per impulse per area, m^2/kg: `spread_row_sums`
  Vectors before;            ///< velocity at the beginning of the step of the flow, m/s
  Vectors acceleration;      ///< of the copies of the air beside the force of the sheet, m/s^2
  Vectors inverse_cloth_mass;  ///< along each axis, 1/kg; zero along pinned axes

  // Changed by each step of the cloth.
  Vectors velocity;  ///< local velocity, m/s
  Scalars impulse;   ///< per area along the normal, of the sheet on the air since `before`, Pa s
  /// Impulse per area of vertices without slip, Pa s, in place of `impulse`. Empty if all slip.
  Vectors no_slip_impulse;

  Kokkos::View<PorousLaw*, Memory> law;  ///< constant

  /// Force on the air in the last step of the flow, N, whose reaction acts during this one: explicit
  /// coupling. Empty if cloth and air relax against each other.
  Vectors last_force;

  /// True if the air does not slip along vertex i.
  KOKKOS_FUNCTION bool is_no_slip(int i) const { return no_slip_impulse.extent(0) > 0 && law(i).no_slip; }

  /// True if the cloth takes the force of the last step instead of relaxing.
  KOKKOS_FUNCTION bool is_explicit() const { return last_force.extent(0) > 0; }

  /// Velocity, m/s, of vertex i with area after it and the air beside it have relaxed against each other
  /// during dt, s. `inverse_mass`: of the vertex along each axis, 1/kg. Updates the local velocity and the
  /// impulse of the vertex.
  KOKKOS_FUNCTION spatial::Point relax(int i, const spatial::Point& of_vertex,
                                       const spatial::Point& inverse_mass, double dt) const {
    using spatial::load_vector;
    // All at once, so that a thread waits for memory once.
    const PorousLaw porous = law(i);
    const double size = area(i), impulse_before = impulse(i);
    const spatial::Point n = load_vector(normal, i), inverse_air = load_vector(inverse_air_mass, i),
                         now = load_vector(velocity, i) + dt * load_vector(acceleration, i);
    if (is_no_slip(i)) {
      const spatial::Point each =
          coupling::no_slip_impulse(porous, n, of_vertex - now, dt, size * inverse_mass + inverse_air);
      spatial::store_vector(velocity, i, now + product(inverse_air, each));
      spatial::store_vector(no_slip_impulse, i, load_vector(no_slip_impulse, i) + each);
      return of_vertex - size * product(inverse_mass, each);
    }
    const auto scaled = [&](const spatial::Point& by) { return product(by, n); };
    const double of_cloth = size * dot(n, scaled(inverse_mass)), of_air = dot(n, scaled(inverse_air));
    const double normal_impulse = porous_impulse(porous, dot(of_vertex - now, n), dt, of_cloth + of_air);
    spatial::store_vector(velocity, i, now + normal_impulse * scaled(inverse_air));
    impulse(i) = impulse_before + normal_impulse;
    return of_vertex - (normal_impulse * size) * scaled(inverse_mass);
  }
};

/// Relaxes the velocity of a vertex and that of the air beside it against each other by the porous law: a
/// `VertexForce` of the fabric solver. Both change by equal and opposite impulses: along the normal where the
/// sheet slips freely along its tangents, and such that no tangential motion remains where it does not. Drag
/// of lines and bodies, if any, acts before.
template <class ExecutionSpace>
struct AirRelaxation {
  LocalAir<ExecutionSpace> air;
  DragRelaxation<ExecutionSpace> drag;

  /// Velocity after the relaxation, or after the reaction of the last step, m/s. Updates the local velocity
  /// and the impulse of the vertex unless the coupling is explicit.
  KOKKOS_FUNCTION fabric::Vector3<double> relaxed_velocity(const fabric::VertexStage& at) const {
    const spatial::Point inverse_mass = spatial::load_vector(air.inverse_cloth_mass, at.vertex);
    const double area = air.area(at.vertex);
    const spatial::Point velocity = drag.is_empty() ? at.velocity : drag.relax(at, inverse_mass);
    if (!(area > 0.0)) return velocity;
    if (air.is_explicit())
      return velocity - at.dt * product(inverse_mass, spatial::load_vector(air.last_force, at.vertex));
    return air.relax(at.vertex, velocity, inverse_mass, at.dt);
  }
};

}  // namespace drogue::coupling
