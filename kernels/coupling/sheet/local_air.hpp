#pragma once

#include "kernels/coupling/sheet/porous_law.hpp"
#include "kernels/fabric/vertex_force.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::coupling {

/// Air at the vertices of a sheet, on a device. Rows are vertices; those without area have no air.
template <class ExecutionSpace>
struct LocalAir {
  using Memory = typename ExecutionSpace::memory_space;
  using Scalars = Kokkos::View<double*, Memory>;
  using Vectors = Kokkos::View<double* [3], Kokkos::LayoutLeft, Memory>;

  // Constant during the steps of the cloth in one step of the flow.
  Scalars area;          ///< m^2
  Vectors normal;        ///< of unit length
  Vectors compliance;    ///< change of the local velocity per impulse per area, m^2/kg: `spread_row_sums`
  Vectors before;        ///< velocity at the beginning of the step of the flow, m/s
  Vectors acceleration;  ///< of the air without the force of the sheet, m/s^2
  Vectors inverse_mass;  ///< of the cloth along each axis, 1/kg; zero along pinned axes

  // Changed by each step of the cloth.
  Vectors velocity;  ///< local velocity, m/s
  Scalars impulse;   ///< per area along the normal, of the sheet on the air since `before`, Pa s

  Kokkos::View<PorousLaw*, Memory> law;  ///< constant
};

/// Relaxes the velocity of a vertex and that of the air beside it against each other by the porous law: a
/// `VertexForce` of the fabric solver. Both change by equal and opposite impulses along the normal; the sheet
/// slips freely along its tangents.
template <class ExecutionSpace>
struct AirRelaxation {
  LocalAir<ExecutionSpace> air;

  /// Velocity after the relaxation, m/s. Updates `LocalAir::velocity` and `LocalAir::impulse` of the vertex.
  KOKKOS_FUNCTION fabric::Vector3<double> relaxed_velocity(const fabric::VertexStage& at) const {
    using spatial::load_vector;
    const int i = at.vertex;
    const double area = air.area(i);
    if (!(area > 0.0)) return at.velocity;
    const fabric::Vector3<double> n = load_vector(air.normal, i), compliance = load_vector(air.compliance, i),
                                  inverse_mass = load_vector(air.inverse_mass, i),
                                  now =
                                      load_vector(air.velocity, i) + at.dt * load_vector(air.acceleration, i);
    const auto scaled = [&](const fabric::Vector3<double>& by) {
      return fabric::Vector3<double>{by.x * n.x, by.y * n.y, by.z * n.z};
    };
    const double of_cloth = area * dot(n, scaled(inverse_mass)), of_air = dot(n, scaled(compliance));
    const double given = porous_impulse(air.law(i), dot(at.velocity - now, n), at.dt, of_cloth + of_air);
    spatial::store_vector(air.velocity, i, now + given * scaled(compliance));
    air.impulse(i) += given;
    return at.velocity - (given * area) * scaled(inverse_mass);
  }
};

}  // namespace drogue::coupling
