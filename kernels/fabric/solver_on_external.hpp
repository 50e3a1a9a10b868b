#pragma once

// Definitions of SolverOn: loads that change, pressures, dashpots, motions.

#include <algorithm>

#include "kernels/fabric/solver_on.hpp"

namespace drogue::fabric {

template <class ExecutionSpace, ConstitutiveModel law>
ProgramsView<ExecutionSpace> SolverOn<ExecutionSpace, law>::programs(
    const std::vector<device::ExpressionProgram>& from) const {
  return list_view(_instance.space(), "drogue::fabric::programs", from);
}

/// Those that forces read, or loads, or new ones.
template <class ExecutionSpace, ConstitutiveModel law>
PointsView<ExecutionSpace> SolverOn<ExecutionSpace, law>::rest_places(const Parameters& p) const {
  if (_cloth.rest.extent(0) > 0) return _cloth.rest;
  if (_external.rest.extent(0) > 0) return _external.rest;
  const Points rest = points("drogue::fabric::rest_places");
  to_device(p.mesh.rest, rest);
  return rest;
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::prepare_external(const Parameters& p) {
  _drags = p.relative_damping > 0.0;
  const double bending = p.material.bending_stiffness;
  if (bending > 0.0)
    _external.bending = sliced_ell_views(_instance.space(), bending_adjacency(p.mesh, bending));
  _acts = !p.timed_loads.empty() || !p.follower_pressures.empty() || bending > 0.0 ||
          (_drags && _integrator == Integrator::rk4);
  if (_drags) {
    const DashpotAdjacency dashpots = dashpot_adjacency(p.mesh, p.mass, p.relative_damping);
    _external.dashpots = sliced_ell_views(_instance.space(), dashpots);
    // Gershgorin: both ends of a dashpot, each over its mass.
    std::vector<double> row(p.mass.size(), 0.0);
    for (std::size_t slice_number = 0; slice_number + 1 < dashpots.first.size(); ++slice_number)
      for (int k = dashpots.first[slice_number]; k < dashpots.first[slice_number + 1]; ++k)
        for (std::size_t lane = 0; lane < slice; ++lane) {
          const std::size_t i = slice_number * slice + lane;
          if (i < row.size())
            row[i] += 2.0 * dashpots.value[0][static_cast<std::size_t>(k) * slice + lane] / p.mass[i];
        }
    _decay += *std::ranges::max_element(row);
    if (_integrator == Integrator::verlet) _dragged = points("drogue::fabric::dragged");
  }
  if (!_acts) return;
  const std::size_t n = p.mass.size();
  _external.rest = rest_places(p);
  _cloth.load = points("drogue::fabric::load");
  std::vector<device::ExpressionProgram> strength;
  _external.direction =
      decltype(_external.direction)("drogue::fabric::load_directions", n, p.timed_loads.size());
  const auto direction = Kokkos::create_mirror_view(_external.direction);
  for (std::size_t k = 0; k < p.timed_loads.size(); ++k) {
    strength.push_back(p.timed_loads[k].strength);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        direction(i, k, axis) = p.timed_loads[k].direction[i][axis];
  }
  device::copy(_instance.space(), _external.direction, direction);
  _external.load = programs(strength);
  if (p.follower_pressures.empty()) return;
  if constexpr (has_triangles(law.model))
    _external.surface = _cloth.triangles;
  else
    _external.surface = sliced_ell_views(_instance.space(), ring_adjacency(p.mesh), false);
  strength.clear();
  _external.weight =
      decltype(_external.weight)("drogue::fabric::pressure_weights", n, p.follower_pressures.size());
  const auto weight = Kokkos::create_mirror_view(_external.weight);
  for (std::size_t k = 0; k < p.follower_pressures.size(); ++k) {
    const FollowerPressure& pressure = p.follower_pressures[k];
    strength.push_back(pressure.strength);
    for (std::size_t i = 0; i < n; ++i) weight(i, k) = pressure.weight.empty() ? 1.0 : pressure.weight[i];
  }
  device::copy(_instance.space(), _external.weight, weight);
  _external.pressure = programs(strength);
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::prepare_motions(const Parameters& p) {
  if (p.motions.empty()) return;
  std::vector<device::ExpressionProgram> displacement;
  std::vector<int> vertex, axis, program;
  for (const Motion& motion : p.motions) {
    for (const int i : motion.vertices) {
      vertex.push_back(i);
      axis.push_back(motion.axis);
      program.push_back(static_cast<int>(displacement.size()));
    }
    displacement.push_back(motion.displacement);
  }
  const Points rest = rest_places(p);
  const ExecutionSpace& space = _instance.space();
  _prescribed = Prescribed<ExecutionSpace>{rest, programs(displacement),
                                           list_view(space, "drogue::fabric::moved_vertices", vertex),
                                           list_view(space, "drogue::fabric::moved_axes", axis),
                                           list_view(space, "drogue::fabric::moved_by", program)};
}

template <class ExecutionSpace, ConstitutiveModel law>
ExternalFunctor<ExecutionSpace> SolverOn<ExecutionSpace, law>::loads_at(const Points& x, const Points& v,
                                                                        double part, bool damps) const {
  return {_external, _dead, x, v, _cloth.load, timing(part), damps};
}

/// Fills `_cloth.load`.
template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::act(const Points& x, const Points& v, double part, bool damps) const {
  launch_each("drogue::fabric::external", _vertices, loads_at(x, v, part, damps));
}

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::place(const Points& x, const Points& v, double part, bool looks) const {
  launch_each("drogue::fabric::place", static_cast<int>(_prescribed->vertex.extent(0)),
              PlaceFunctor<ExecutionSpace>{*_prescribed, x, v, timing(part), looks});
}

}  // namespace drogue::fabric
