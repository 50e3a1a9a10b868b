#pragma once

#include "kernels/coupling/sheet/local_air.hpp"

namespace drogue::coupling {

/// Impulses of a sheet that imposes its velocity on the air during a step of the flow, dt: the Dirichlet part
/// of explicit staggered coupling ([Shi], section 3.3.2, second method). The porous law relates the velocity
/// of the vertex at the end of its steps to the copy of the air beside it, and the vertex keeps its velocity:
/// the air alone gives way. The reaction acts on the vertex in the next step (`AirRelaxation`), as the
/// pressure difference of [Shi], eq. (3.15).
template <class ExecutionSpace>
struct ImposeVelocityFunctor {
  LocalAir<ExecutionSpace> air;
  fabric::PointsView<ExecutionSpace> velocities;  ///< of the vertices at the end of the step, m/s
  double dt;                                      ///< s

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (!(air.area(i) > 0.0)) return;
    const spatial::Point immovable{0.0, 0.0, 0.0};
    static_cast<void>(air.relax(i, spatial::load_vector(velocities, i), immovable, dt));
  }
};

}  // namespace drogue::coupling
