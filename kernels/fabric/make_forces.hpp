#pragma once

#include "kernels/fabric/fabric_forces.hpp"
#include "kernels/fabric/loads/make_loads.hpp"

namespace drogue::fabric {

template <class ExecutionSpace>
FabricForces<ExecutionSpace>::FabricForces(const ExecutionSpace& on, const Parameters& p)
    : space(on),
      parameters(p),
      mesh(p.mesh),
      material(p.material),
      vertices(static_cast<int>(p.mesh.rest.size())),
      padded(padded_vertices(vertices)),
      decay(p.integrator == Integrator::rk4 ? p.damping : 0.0),
      fabric(make_fabric_views(space, p)),
      dead(make_dead_loads(space, p)),
      has_dashpots(p.relative_damping > 0.0),
      has_load_kernel(needs_load_kernel(p)),
      _totals(vertices) {
  fabric.load = dead.total;
  const double bending = p.material.bending_stiffness;
  if (bending > 0.0) external.bending = sliced_ell_views(space, bending_adjacency(p.mesh, bending));
  if (has_dashpots) {
    const DashpotAdjacency dashpots = dashpot_adjacency(p.mesh, p.mass, p.relative_damping);
    external.dashpots = sliced_ell_views(space, dashpots);
    decay += fastest_dashpot_decay(dashpots, p.mass);
  }
  if (has_load_kernel) {
    external.rest = rest_positions();
    fabric.load = make_points<ExecutionSpace>("drogue::fabric::load", p.mass.size());
    make_timed_loads(space, p, external);
  }
  if (!p.follower_pressures.empty()) {
    external.surface = make_surface(space, p, fabric);
    make_pressures(space, p, external);
  }
  if (external.has_pressure() || bending > 0.0)
    _load_stiffness = decltype(_load_stiffness)("drogue::fabric::load_stiffness", p.mass.size());
  if (!p.motions.empty()) dirichlet = make_dirichlet(space, p.motions, rest_positions());
}

}  // namespace drogue::fabric
