#pragma once

#include "kernels/fabric/elastic/adjacency.hpp"
#include "kernels/fabric/parameters.hpp"
#include "kernels/fabric/points_transfer.hpp"

namespace drogue::fabric {

/// Number of vertices padded to whole slices.
[[nodiscard]] constexpr int padded_vertices(int vertices) { return (vertices + slice - 1) / slice * slice; }

/// Vectors of all vertices in any unit, zero, with the padding of the last slice. Throws std::runtime_error
/// if memory runs out.
template <class ExecutionSpace>
[[nodiscard]] PointsView<ExecutionSpace> make_points(const std::string& label, std::size_t vertices) {
  return PointsView<ExecutionSpace>(label,
                                    static_cast<std::size_t>(padded_vertices(static_cast<int>(vertices))));
}

/// Positions at rest, m. Blocks. Throws std::runtime_error if memory runs out.
template <class ExecutionSpace>
[[nodiscard]] PointsView<ExecutionSpace> make_rest_positions(const ExecutionSpace& space, const Mesh& mesh) {
  const auto rest = make_points<ExecutionSpace>("drogue::fabric::rest_positions", mesh.rest.size());
  copy_to_points<ExecutionSpace>(space, mesh.rest, rest);
  return rest;
}

/// Inverse masses, 1/kg, and fixed axes of all vertices. Vertices that pad the last slice have no inverse
/// mass and no free axis: they stay. Blocks. Throws std::runtime_error if memory runs out.
template <class ExecutionSpace>
void make_vertices(const ExecutionSpace& space, const Parameters& p, FabricViews<ExecutionSpace>& fabric) {
  const std::size_t n = p.mesh.rest.size();
  const auto padded = static_cast<std::size_t>(padded_vertices(static_cast<int>(n)));
  fabric.inverse_mass = decltype(fabric.inverse_mass)("drogue::fabric::inverse_mass", padded);
  const auto inverse_mass = Kokkos::create_mirror_view(fabric.inverse_mass);
  fabric.fixed_dofs = decltype(fabric.fixed_dofs)("drogue::fabric::fixed_dofs", padded);
  const auto fixed_dofs = Kokkos::create_mirror_view(fabric.fixed_dofs);
  for (std::size_t i = 0; i < padded; ++i) {
    if (i < n) inverse_mass(i) = 1.0 / p.mass[i];
    fixed_dofs(i) = i >= n ? 7 : p.pinned.empty() ? 0 : p.pinned[i];
  }
  for (const Motion& motion : p.motions)
    for (const int i : motion.vertices)
      fixed_dofs(i) |= static_cast<std::uint8_t>(1U << static_cast<unsigned>(motion.axis));
  device::copy(space, fabric.inverse_mass, inverse_mass);
  device::copy(space, fabric.fixed_dofs, fixed_dofs);
  space.fence("drogue::fabric::vertices");
}

/// Tables and constants of a fabric without loads, SI units. Blocks. Throws std::runtime_error if memory runs
/// out.
template <class ExecutionSpace>
[[nodiscard]] FabricViews<ExecutionSpace> make_fabric_views(const ExecutionSpace& space,
                                                            const Parameters& p) {
  FabricViews<ExecutionSpace> fabric;
  if (has_triangles(p.material.model)) {
    fabric.triangles = sliced_ell_views(space, ring_adjacency(p.mesh), device::is_host<ExecutionSpace>);
    if constexpr (!device::is_host<ExecutionSpace>) fabric.rest = make_rest_positions(space, p.mesh);
  }
  fabric.springs = sliced_ell_views(space, spring_adjacency(p.mesh, p.material));
  fabric.moduli = moduli(p.material.membrane_modulus, p.material.poisson);
  fabric.gravity = {p.gravity[0], p.gravity[1], p.gravity[2]};
  fabric.damping = p.integrator == Integrator::rk4 ? p.damping : 0.0;
  make_vertices(space, p, fabric);
  return fabric;
}

}  // namespace drogue::fabric
