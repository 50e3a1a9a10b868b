#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "kernels/device/backend_list.hpp"
#include "kernels/fabric/elastic/frequency.hpp"
#include "kernels/fabric/elastic/lanczos.hpp"
#include "kernels/fabric/elastic/stress_evaluator.hpp"
#include "kernels/fabric/loads/dirichlet.hpp"
#include "kernels/fabric/loads/make_loads.hpp"
#include "kernels/fabric/parameters.hpp"
#include "kernels/fabric/stepping/step_state.hpp"
#include "kernels/fabric/totals.hpp"
#include "kernels/fabric/vertex_force.hpp"
#include "kernels/mesh/edges.hpp"

namespace drogue::fabric {

/// Elastic forces and loads, N, at given positions.
template <class ExecutionSpace, ConstitutiveModel model>
struct ForceFunctor {
  using R = PackedReal<ExecutionSpace>;
  using Bounds = Kokkos::LaunchBounds<>;
  FabricViews<ExecutionSpace> fabric;
  PointsView<ExecutionSpace> x, out;

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * device::Access<R>::lanes;
    store_points(out, i, force<model, R>(fabric, x, i));
  }
};

/// Elastic forces, loads and prescribed motion of a fabric on an instance of an execution space, and what
/// follows from them at a given state: frequencies, stress and energies. Integrators read its Views.
/// Functions with results on the host block and throw as those of `Solver`.
template <class ExecutionSpace>
struct FabricForces {
  using Points = PointsView<ExecutionSpace>;
  using StageTime = stepping::StageTime<ExecutionSpace>;
  using State = StepState<ExecutionSpace>;

  /// Allocates all Views; blocks. `p` must outlive the forces.
  FabricForces(const ExecutionSpace& on, const Parameters& p);

  /// Enqueues the evaluation of `fabric.load`, N, at positions x, m, and velocities v, m/s, unless there are
  /// dead loads alone.
  void evaluate_loads(const Points& x, const Points& v, const StageTime& time, bool with_dashpots) const {
    if (has_load_kernel)
      launch_each(space, "drogue::fabric::loads", vertices, external_functor(x, v, time, with_dashpots));
  }

  /// Enqueues the prescribed motion, if any, of positions x, m, and velocities v, m/s.
  void apply_dirichlet(const Points& x, const Points& v, const StageTime& time,
                       bool checks_divergence) const {
    if (!dirichlet) return;
    launch_each(space, "drogue::fabric::dirichlet", static_cast<int>(dirichlet->vertex.extent(0)),
                DirichletFunctor<ExecutionSpace>{.prescribed = *dirichlet,
                                                 .x = x,
                                                 .v = v,
                                                 .stage_time = time,
                                                 .checks_divergence = checks_divergence});
  }

  /// Takes over E A of the lines of `parameters`, N. Blocks.
  void update_line_stiffness() {
    // The slots stay, so that graphs of the launcher remain valid.
    const SpringAdjacency springs = spring_adjacency(parameters.mesh, parameters.material);
    device::copy(space, fabric.springs.value,
                 table_view(space, "drogue::fabric::slot_values", springs.value));
    space.fence("drogue::fabric::update_line_stiffness");
  }

  /// Elastic forces and all loads, N, at positions x, m, and the time of a state. Evaluated in its `spare_x`.
  void forces(const State& state, const Points& x, PointsReader<ExecutionSpace>& reader,
              std::span<Vector> to) const;
  [[nodiscard]] double fastest_frequency(const State& state) const;
  [[nodiscard]] double frequency_at_least(const State& state) const;
  void stress(const State& state, StressMeasure measure, std::span<Stress> of_triangles);
  void vertex_stress(const State& state, StressMeasure measure, std::span<Stress> of_vertices);
  [[nodiscard]] Totals totals(const State& state) const;

  ExecutionSpace space;
  const Parameters& parameters;
  int vertices, padded;                ///< `padded`: in whole slices
  double decay;                        ///< 1/s, upper bound of the rates of damping
  FabricViews<ExecutionSpace> fabric;  ///< `load`: N, as evaluated last, or dead loads alone
  DeadLoads<ExecutionSpace> dead;
  External<ExecutionSpace> external;
  bool has_dashpots, has_load_kernel;
  std::optional<DirichletConditions<ExecutionSpace>> dirichlet;

 private:
  /// Positions at rest, m, shared with forces or loads if they have them.
  [[nodiscard]] Points rest_positions() const {
    if (fabric.rest.extent(0) > 0) return fabric.rest;
    return external.rest.extent(0) > 0 ? external.rest : make_rest_positions(space, parameters.mesh);
  }
  [[nodiscard]] ExternalFunctor<ExecutionSpace> external_functor(const Points& x, const Points& v,
                                                                 const StageTime& time,
                                                                 bool with_dashpots) const {
    return {.external = external,
            .dead = dead.total,
            .x = x,
            .v = v,
            .out = fabric.load,
            .stage_time = time,
            .with_dashpots = with_dashpots};
  }

  ListView<ExecutionSpace, double> _load_stiffness;  ///< N/m, of pressure and bending; empty without
  TotalsEvaluator<ExecutionSpace> _totals;
  StressEvaluator<ExecutionSpace> _stress;
};

/// What the kernels of a step read besides the state.
template <class ExecutionSpace, class VertexForce>
struct StepInputs {
  const FabricForces<ExecutionSpace>& forces;
  VertexForceTerm<VertexForce> vertex_force;
};

template <class ExecutionSpace>
FabricForces<ExecutionSpace>::FabricForces(const ExecutionSpace& on, const Parameters& p)
    : space(on),
      parameters(p),
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

template <class ExecutionSpace>
void FabricForces<ExecutionSpace>::forces(const State& state, const Points& x,
                                          PointsReader<ExecutionSpace>& reader, std::span<Vector> to) const {
  evaluate_loads(x, state.v, state.at(0.0), false);
  dispatch_model(parameters.material, [&]<ConstitutiveModel model>() {
    launch_packs(space, "drogue::fabric::force", padded,
                 ForceFunctor<ExecutionSpace, model>{fabric, x, state.spare_x});
  });
  reader.read(space, state.spare_x, to);
}

template <class ExecutionSpace>
double FabricForces<ExecutionSpace>::fastest_frequency(const State& state) const {
  if (_load_stiffness.extent(0) > 0)
    launch_each(space, "drogue::fabric::load_stiffness", vertices,
                LoadStiffnessFunctor<ExecutionSpace>{external_functor(state.x, state.v, state.at(0.0), false),
                                                     _load_stiffness});
  return frequency_bound(space, parameters.material, fabric, state.x, _load_stiffness, vertices);
}

template <class ExecutionSpace>
double FabricForces<ExecutionSpace>::frequency_at_least(const State& state) const {
  const auto n = static_cast<std::size_t>(vertices);
  const auto inverse_mass = Kokkos::create_mirror_view(fabric.inverse_mass);
  const auto fixed_dofs = Kokkos::create_mirror_view(fabric.fixed_dofs);
  device::copy(space, inverse_mass, fabric.inverse_mass);
  device::copy(space, fixed_dofs, fabric.fixed_dofs);
  space.fence("drogue::fabric::masses");
  std::vector<double> root(3 * n);
  for (std::size_t k = 0; k < root.size(); ++k)
    root[k] = (fixed_dofs(k / 3) >> k % 3 & 1U) != 0U ? 0.0 : std::sqrt(inverse_mass(k / 3));
  // Short enough for linear forces, long enough for forces above round-off.
  const double displacement = 1e-5 * shortest_edge(parameters.mesh);
  PointsReader<ExecutionSpace> reader;
  std::vector<Vector> now(n);
  reader.read(space, state.x, now);
  const Points trial = make_points<ExecutionSpace>("drogue::fabric::trial", n);
  return lanczos_frequency(root, now, displacement,
                           [&](const std::vector<Vector>& positions, std::vector<Vector>& to) {
                             copy_to_points<ExecutionSpace>(space, positions, trial);
                             forces(state, trial, reader, to);
                           });
}

template <class ExecutionSpace>
void FabricForces<ExecutionSpace>::stress(const State& state, StressMeasure measure,
                                          std::span<Stress> of_triangles) {
  _stress.triangles(space, parameters, fabric.moduli, state.x, measure, of_triangles);
}

template <class ExecutionSpace>
void FabricForces<ExecutionSpace>::vertex_stress(const State& state, StressMeasure measure,
                                                 std::span<Stress> of_vertices) {
  _stress.vertices(space, parameters, fabric.moduli, state.x, measure, of_vertices);
}

template <class ExecutionSpace>
Totals FabricForces<ExecutionSpace>::totals(const State& state) const {
  FabricViews<ExecutionSpace> with_dead_loads = fabric;
  with_dead_loads.load = dead.total;
  Totals totals = _totals.evaluate(space, parameters.material, with_dead_loads, state.x, state.v,
                                   dead.rest_forces, external.bending);
  totals.elastic += dead.rest_energy;
  return totals;
}

// One translation unit per backend compiles them: solvers with a VertexForce of their own compile steps
// alone.
DROGUE_EXTERN_INSTANCES(struct FabricForces)

}  // namespace drogue::fabric
