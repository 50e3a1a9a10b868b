#pragma once

#include <algorithm>
#include <optional>

#include "kernels/fabric/parameters.hpp"
#include "kernels/fabric/stepping/persistent_euler.hpp"
#include "kernels/fabric/stepping/persistent_rings.hpp"

namespace drogue::fabric {

/// Launcher and mesh partition of the persistent driver.
template <class ExecutionSpace>
struct PersistentDriver {
  device::PersistentKernel<ExecutionSpace> grid;
  PatchViews<ExecutionSpace> patches;
  bool pairs;               ///< runs PersistentPairsFunctor, else PersistentRingsFunctor
  std::uint64_t epoch = 0;  ///< of the last stage launched

  /// Clears the messages of replays, which the next launch must not take for its own. Asynchronous.
  void forget_messages() {
    grid.clear_messages();
    epoch = 0;
  }
};

/// Persistent driver for the mesh and the integrator of `forces.parameters`, which is not Verlet's, or none
/// if the mesh does not fit the device or a step needs what the driver does not support. Blocks.
template <class ExecutionSpace>
[[nodiscard]] std::optional<PersistentDriver<ExecutionSpace>> make_persistent_driver(
    const device::Instance<ExecutionSpace>& instance, const FabricForces<ExecutionSpace>& forces) {
  using Grid = device::PersistentKernel<ExecutionSpace>;
  const Parameters& p = forces.parameters;
  // The stencil of bending exceeds the halo; dashpots need the velocities of neighbours.
  if (p.material.bending_stiffness > 0.0 || forces.has_dashpots || forces.dirichlet ||
      (p.contact.is_enabled() && p.contact.interval == 1))
    return std::nullopt;
  const int teams = Grid::most_teams(instance), vertices = forces.vertices;
  if (teams == 0) return std::nullopt;
  const auto share = [&](int parts) { return (vertices + parts - 1) / parts; };
  const int count = std::min(teams, share(p.patch > 0 ? p.patch : slice));
  if (share(count) > max_ring_threads) return std::nullopt;
  const bool rings = has_triangles(p.material.model) || forces.external.has_pressure();
  const Patches patches =
      make_patches(p.mesh.rest, ring_adjacency(rings ? p.mesh : Mesh{.rest = p.mesh.rest}),
                   spring_adjacency(p.mesh, p.material), count);
  const PatchViews<ExecutionSpace> views = patch_views(instance.space(), patches);
  const bool pairs = patches.team <= max_pair_vertices && !forces.has_load_kernel;
  const bool euler = p.integrator == Integrator::symplectic_euler;
  if (euler && !pairs) return std::nullopt;
  constexpr ConstitutiveModel any{Model::edge};  // all models need the same memory
  const std::size_t scratch = euler   ? PersistentEulerFunctor<ExecutionSpace, any>::scratch_bytes(views)
                              : pairs ? PersistentPairsFunctor<ExecutionSpace, any>::scratch_bytes(views)
                                      : PersistentRingsFunctor<ExecutionSpace, any>::scratch_bytes(views);
  if (scratch > Grid::most_scratch_bytes(instance)) return std::nullopt;
  const int spring_rows = euler ? static_cast<int>(views.max_spring_slots) / slice : 0,
            threads = pairs ? team_threads(patches, patches.max_rows + spring_rows, max_pair_threads)
                            : team_threads(patches, 0, max_ring_threads);
  return PersistentDriver<ExecutionSpace>{
      {instance, count, threads, scratch, static_cast<std::size_t>(patches.messages)}, views, pairs};
}

/// Steps of a launch of `steps` steps of `stages` stages each. `captured`: the launch may be replayed, so
/// that it reads its step count on the device and clears the messages. Asynchronous.
template <bool loads, class ExecutionSpace, class VertexForce>
[[nodiscard]] PersistentSteps<ExecutionSpace, VertexForce, loads> prepare_persistent_steps(
    PersistentDriver<ExecutionSpace>& driver, const StepInputs<ExecutionSpace, VertexForce>& in,
    const StepState<ExecutionSpace>& state, std::int64_t steps, std::uint64_t stages, bool captured) {
  if (captured) {
    device::copy_bytes(in.forces.space, device::CopyKind::within, state.monitor.steps.data() + 1,
                       state.monitor.steps.data(), sizeof(std::int64_t));
    driver.forget_messages();
  }
  const std::uint64_t epoch = driver.epoch;
  driver.epoch += stages * static_cast<std::uint64_t>(steps);
  FabricViews<ExecutionSpace> fabric = in.forces.fabric;
  fabric.load = in.forces.dead.total;
  PersistentLoads<ExecutionSpace, loads> load;
  if constexpr (loads) load = {in.forces.external, state.time};
  return {.patches = driver.patches,
          .fabric = fabric,
          .x = state.x,
          .v = state.v,
          .monitor = state.monitor,
          .dt = state.time.dt,
          .previous_steps = captured ? -1 : state.time.step,
          .steps = steps,
          .epoch = epoch,
          .vertex_force = in.vertex_force,
          .load = load};
}

/// Enqueues `steps` steps as one launch, of the symplectic Euler method for a VertexForce that relaxes
/// velocities and else of the Runge-Kutta method; `captured` as above. Checkpoints end launches, so that none
/// has more than `checkpoint_interval` steps, which take a few milliseconds. Asynchronous.
template <ConstitutiveModel model, class ExecutionSpace, class VertexForce>
void launch_persistent_steps(PersistentDriver<ExecutionSpace>& driver,
                             const StepInputs<ExecutionSpace, VertexForce>& in,
                             const StepState<ExecutionSpace>& state, std::int64_t steps, bool captured) {
  const auto prepared = [&]<bool loads>(std::uint64_t stages) {
    return prepare_persistent_steps<loads>(driver, in, state, steps, stages, captured);
  };
  if constexpr (RelaxesVelocity<VertexForce>)
    driver.grid.template launch<max_pair_threads, 1>(
        PersistentEulerFunctor<ExecutionSpace, model, VertexForce>{{prepared.template operator()<false>(1)},
                                                                   in.forces.parameters.damping});
  else if (in.forces.has_load_kernel)
    driver.grid.template launch<max_ring_threads, 1>(
        PersistentRingsFunctor<ExecutionSpace, model, VertexForce, true>{
            prepared.template operator()<true>(4)});
  else if (driver.pairs)
    driver.grid.template launch<max_pair_threads, 1>(
        PersistentPairsFunctor<ExecutionSpace, model, VertexForce>{prepared.template operator()<false>(4)});
  else
    driver.grid.template launch<max_ring_threads, 1>(
        PersistentRingsFunctor<ExecutionSpace, model, VertexForce>{prepared.template operator()<false>(4)});
}

}  // namespace drogue::fabric
