#pragma once

#include "kernels/coupling/sheet/no_slip.hpp"
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
  /// Impulse per area of vertices without slip, Pa s, in place of `impulse`. Empty if all slip.
  Vectors no_slip_impulse;

  Kokkos::View<PorousLaw*, Memory> law;  ///< constant

  /// True if the air does not slip along vertex i.
  KOKKOS_FUNCTION bool is_no_slip(int i) const { return no_slip_impulse.extent(0) > 0 && law(i).no_slip; }
};

/// Relaxes the velocity of a vertex and that of the air beside it against each other by the porous law: a
/// `VertexForce` of the fabric solver. Both change by equal and opposite impulses: along the normal where the
/// sheet slips freely along its tangents, and such that no tangential motion remains where it does not.
template <class ExecutionSpace>
struct AirRelaxation {
  LocalAir<ExecutionSpace> air;

  /// Velocity after the relaxation, m/s. Updates the local velocity and the impulse of the vertex.
  KOKKOS_FUNCTION fabric::Vector3<double> relaxed_velocity(const fabric::VertexStage& at) const {
    using spatial::load_vector;
    const int i = at.vertex;
    const double area = air.area(i);
    if (!(area > 0.0)) return at.velocity;
    const fabric::Vector3<double> n = load_vector(air.normal, i), compliance = load_vector(air.compliance, i),
                                  inverse_mass = load_vector(air.inverse_mass, i),
                                  now =
                                      load_vector(air.velocity, i) + at.dt * load_vector(air.acceleration, i);
    if (air.is_no_slip(i)) {
      const fabric::Vector3<double> each =
          no_slip_impulse(air.law(i), n, at.velocity - now, at.dt, area * inverse_mass + compliance);
      spatial::store_vector(air.velocity, i, now + product(compliance, each));
      spatial::store_vector(air.no_slip_impulse, i, load_vector(air.no_slip_impulse, i) + each);
      return at.velocity - area * product(inverse_mass, each);
    }
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
