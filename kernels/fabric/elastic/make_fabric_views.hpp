#pragma once

#include "kernels/fabric/elastic/adjacency.hpp"
#include "kernels/fabric/points_transfer.hpp"

namespace drogue::fabric {

/// Number of vertices padded to whole slices.
[[nodiscard]] constexpr int padded_vertices(int vertices) { return (vertices + slice - 1) / slice * slice; }

/// Points of all vertices, with the padding of the last slice.
template <class ExecutionSpace>
[[nodiscard]] PointsView<ExecutionSpace> make_points(const std::string& label, std::size_t vertices) {
  return PointsView<ExecutionSpace>(label,
                                    static_cast<std::size_t>(padded_vertices(static_cast<int>(vertices))));
}

/// Positions at rest, m. Blocks.
template <class ExecutionSpace>
[[nodiscard]] PointsView<ExecutionSpace> make_rest_positions(const ExecutionSpace& space, const Mesh& mesh) {
  const auto rest = make_points<ExecutionSpace>("drogue::fabric::rest_positions", mesh.rest.size());
  copy_to_points<ExecutionSpace>(space, mesh.rest, rest);
  return rest;
}

/// Inverse masses and fixed axes of all vertices. Vertices that pad the last slice have no inverse mass and
/// no free axis: they stay. Blocks.
template <class ExecutionSpace>
void make_vertices(const ExecutionSpace& space, const Parameters& p, FabricViews<ExecutionSpace>& cloth) {
  const std::size_t n = p.mesh.rest.size();
  const auto padded = static_cast<std::size_t>(padded_vertices(static_cast<int>(n)));
  cloth.inverse_mass = decltype(cloth.inverse_mass)("drogue::fabric::inverse_mass", padded);
  const auto inverse_mass = Kokkos::create_mirror_view(cloth.inverse_mass);
  cloth.fixed_dofs = decltype(cloth.fixed_dofs)("drogue::fabric::fixed_dofs", padded);
  const auto fixed_dofs = Kokkos::create_mirror_view(cloth.fixed_dofs);
  for (std::size_t i = 0; i < padded; ++i) {
    if (i < n) inverse_mass(i) = 1.0 / p.mass[i];
    fixed_dofs(i) = i >= n ? 7 : p.pinned.empty() ? 0 : p.pinned[i];
  }
  for (const Motion& motion : p.motions)
    for (const int i : motion.vertices)
      fixed_dofs(i) |= static_cast<std::uint8_t>(1U << static_cast<unsigned>(motion.axis));
  device::copy(space, cloth.inverse_mass, inverse_mass);
  device::copy(space, cloth.fixed_dofs, fixed_dofs);
  space.fence("drogue::fabric::vertices");
}

/// Tables and constants of a fabric without loads. Blocks.
template <class ExecutionSpace>
[[nodiscard]] FabricViews<ExecutionSpace> make_fabric_views(const ExecutionSpace& space,
                                                            const Parameters& p) {
  FabricViews<ExecutionSpace> cloth;
  if (has_triangles(p.material.model)) {
    cloth.triangles = sliced_ell_views(space, ring_adjacency(p.mesh), device::is_host<ExecutionSpace>);
    if constexpr (!device::is_host<ExecutionSpace>) cloth.rest = make_rest_positions(space, p.mesh);
  }
  cloth.springs = sliced_ell_views(space, spring_adjacency(p.mesh, p.material));
  cloth.moduli = moduli(p.material.membrane_modulus, p.material.poisson);
  cloth.gravity = {p.gravity[0], p.gravity[1], p.gravity[2]};
  cloth.damping = p.integrator == Integrator::rk4 ? p.damping : 0.0;
  make_vertices(space, p, cloth);
  return cloth;
}

}  // namespace drogue::fabric
