#pragma once

#include <algorithm>
#include <span>

#include "kernels/fabric/elastic/make_fabric_views.hpp"
#include "kernels/fabric/loads/external.hpp"
#include "kernels/fabric/parameters.hpp"

namespace drogue::fabric {

/// Forces that do not change with the state.
template <class ExecutionSpace>
struct DeadLoads {
  PointsView<ExecutionSpace> rest_forces;  ///< N, of Model::linear_vector springs at rest; may be empty
  PointsView<ExecutionSpace> total;        ///< N, with `Parameters::load`; empty if all are zero
  double rest_energy = 0.0;                ///< J, of these springs
};

/// Blocks.
template <class ExecutionSpace>
[[nodiscard]] DeadLoads<ExecutionSpace> make_dead_loads(const ExecutionSpace& space, const Parameters& p) {
  DeadLoads<ExecutionSpace> dead;
  const std::size_t n = p.mesh.rest.size();
  std::vector<Vector> load = rest_forces(p.mesh, p.material);
  if (!load.empty()) {
    dead.rest_forces = make_points<ExecutionSpace>("drogue::fabric::rest_forces", n);
    copy_to_points<ExecutionSpace>(space, load, dead.rest_forces);
    // Sum of k (X_j - X_i)^2 / 2 over the springs.
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        dead.rest_energy += 0.5 * load[i][axis] * p.mesh.rest[i][axis];
  }
  if (load.empty())
    load = p.load;
  else if (!p.load.empty())
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) load[i][axis] += p.load[i][axis];
  if (std::ranges::any_of(load, [](const Vector& v) { return v != Vector{}; })) {
    dead.total = make_points<ExecutionSpace>("drogue::fabric::dead_load", n);
    copy_to_points<ExecutionSpace>(space, load, dead.total);
  }
  return dead;
}

/// True if a kernel of its own evaluates loads in every stage: timed loads, pressures, bending, and dashpots
/// of the Runge-Kutta method. Does not throw.
[[nodiscard]] inline bool needs_load_kernel(const Parameters& p) {
  return !p.timed_loads.empty() || !p.follower_pressures.empty() || p.material.bending_stiffness > 0.0 ||
         (p.relative_damping > 0.0 && p.integrator != Integrator::verlet);
}

/// Upper bound of the decay rates of dashpots, 1/s, by Gershgorin's theorem: both ends of a dashpot, each
/// divided by its mass.
[[nodiscard]] inline double fastest_dashpot_decay(const DashpotAdjacency& dashpots,
                                                  const std::vector<double>& mass) {
  std::vector<double> row(mass.size(), 0.0);
  for (std::size_t slice_number = 0; slice_number + 1 < dashpots.first.size(); ++slice_number)
    for (int k = dashpots.first[slice_number]; k < dashpots.first[slice_number + 1]; ++k)
      for (std::size_t lane = 0; lane < slice; ++lane) {
        const std::size_t i = slice_number * slice + lane;
        if (i < row.size())
          row[i] += 2.0 * dashpots.value[0][static_cast<std::size_t>(k) * slice + lane] / mass[i];
      }
  return *std::ranges::max_element(row);
}

/// Expression programs in the memory of an execution space. Blocks.
template <class ExecutionSpace>
[[nodiscard]] ProgramsView<ExecutionSpace> make_programs(const ExecutionSpace& space,
                                                         const std::vector<device::ExpressionProgram>& from) {
  return list_view(space, "drogue::fabric::programs", from);
}

/// Rings of triangles on which pressures act. Blocks.
template <class ExecutionSpace>
[[nodiscard]] SlicedEllViews<ExecutionSpace, 3> make_surface(const ExecutionSpace& space, const Parameters& p,
                                                             const FabricViews<ExecutionSpace>& fabric) {
  return has_triangles(p.material.model) ? fabric.triangles
                                         : sliced_ell_views(space, ring_adjacency(p.mesh), false);
}

/// Timed loads: expressions and directions. Blocks.
template <class ExecutionSpace>
void make_timed_loads(const ExecutionSpace& space, const Parameters& p, External<ExecutionSpace>& external) {
  const std::size_t n = p.mass.size();
  std::vector<device::ExpressionProgram> strength;
  external.direction =
      decltype(external.direction)("drogue::fabric::load_directions", n, p.timed_loads.size());
  const auto direction = Kokkos::create_mirror_view(external.direction);
  for (std::size_t k = 0; k < p.timed_loads.size(); ++k) {
    strength.push_back(p.timed_loads[k].strength);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        direction(i, k, axis) = p.timed_loads[k].direction[i][axis];
  }
  device::copy(space, external.direction, direction);
  external.load = make_programs(space, strength);
}

/// Follower pressures: expressions and weights. Blocks.
template <class ExecutionSpace>
void make_pressures(const ExecutionSpace& space, const Parameters& p, External<ExecutionSpace>& external) {
  const std::size_t n = p.mass.size();
  std::vector<device::ExpressionProgram> strength;
  external.weight =
      decltype(external.weight)("drogue::fabric::pressure_weights", n, p.follower_pressures.size());
  const auto weight = Kokkos::create_mirror_view(external.weight);
  for (std::size_t k = 0; k < p.follower_pressures.size(); ++k) {
    const FollowerPressure& pressure = p.follower_pressures[k];
    strength.push_back(pressure.strength);
    for (std::size_t i = 0; i < n; ++i) weight(i, k) = pressure.weight.empty() ? 1.0 : pressure.weight[i];
  }
  device::copy(space, external.weight, weight);
  external.pressure = make_programs(space, strength);
}

}  // namespace drogue::fabric
