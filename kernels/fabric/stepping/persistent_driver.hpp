#pragma once

#include <algorithm>
#include <optional>

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
};

/// Persistent driver for the mesh and the integrator of `p`, which is not Verlet's, or none if the mesh does
/// not fit the device. `has_loads`: timed
/// loads or pressures are evaluated in every stage; `has_pressure`: some of them are pressures. Blocks.
template <class ExecutionSpace>
[[nodiscard]] std::optional<PersistentDriver<ExecutionSpace>> make_persistent_driver(
    const device::Instance<ExecutionSpace>& instance, const Parameters& p, bool has_loads,
    bool has_pressure) {
  using Grid = device::PersistentKernel<ExecutionSpace>;
  const int teams = Grid::most_teams(instance), vertices = static_cast<int>(p.mesh.rest.size());
  if (teams == 0) return std::nullopt;
  const auto share = [&](int parts) { return (vertices + parts - 1) / parts; };
  const int count = std::min(teams, share(p.patch > 0 ? p.patch : slice));
  if (share(count) > max_ring_threads) return std::nullopt;
  const bool rings = has_triangles(p.material.model) || has_pressure;
  const Patches patches =
      make_patches(p.mesh.rest, ring_adjacency(rings ? p.mesh : Mesh{.rest = p.mesh.rest}),
                   spring_adjacency(p.mesh, p.material), count);
  const PatchViews<ExecutionSpace> views = patch_views(instance.space(), patches);
  const bool pairs = patches.team <= max_pair_vertices && !has_loads;
  const bool euler = p.integrator == Integrator::symplectic_euler;
  if (euler && !pairs) return std::nullopt;
  constexpr ConstitutiveModel any{Model::edge};  // all models need the same memory
  const std::size_t scratch = euler   ? PersistentEulerFunctor<ExecutionSpace, any>::scratch_bytes(views)
                              : pairs ? PersistentPairsFunctor<ExecutionSpace, any>::scratch_bytes(views)
                                      : PersistentRingsFunctor<ExecutionSpace, any>::scratch_bytes(views);
  if (scratch > Grid::most_scratch_bytes(instance)) return std::nullopt;
  const int threads = pairs ? team_threads(patches, patches.max_rows, max_pair_threads)
                            : team_threads(patches, 0, max_ring_threads);
  return PersistentDriver<ExecutionSpace>{
      {instance, count, threads, scratch, static_cast<std::size_t>(patches.messages)}, views, pairs};
}

/// State and forces of a launch of the persistent driver.
template <class ExecutionSpace, class VertexForce>
struct PersistentInputs {
  FabricViews<ExecutionSpace> fabric;  ///< `load` holds the dead loads alone
  PointsView<ExecutionSpace> x, v;
  StepMonitor<ExecutionSpace> monitor;
  stepping::TimeState time;  ///< before the launch
  VertexForceTerm<VertexForce> vertex_force;
  External<ExecutionSpace> external;
  bool has_loads;  ///< `external` holds timed loads or pressures
};

/// Steps of a launch of `steps` steps of `stages` stages each. `captured`: the launch may be replayed, so
/// that it reads its step count on the device and clears the messages. Asynchronous.
template <bool loads, class ExecutionSpace, class VertexForce>
[[nodiscard]] PersistentSteps<ExecutionSpace, VertexForce, loads> prepare_persistent_steps(
    const ExecutionSpace& space, PersistentDriver<ExecutionSpace>& driver,
    const PersistentInputs<ExecutionSpace, VertexForce>& in, std::int64_t steps, std::uint64_t stages,
    bool captured) {
  if (captured) {
    device::copy_bytes(space, device::CopyKind::within, in.monitor.steps.data() + 1, in.monitor.steps.data(),
                       sizeof(std::int64_t));
    driver.grid.clear_messages();
    driver.epoch = 0;
  }
  const std::uint64_t epoch = driver.epoch;
  driver.epoch += stages * static_cast<std::uint64_t>(steps);
  PersistentLoads<ExecutionSpace, loads> load;
  if constexpr (loads) load = {in.external, in.time};
  return {.patches = driver.patches,
          .fabric = in.fabric,
          .x = in.x,
          .v = in.v,
          .monitor = in.monitor,
          .dt = in.time.dt,
          .previous_steps = captured ? -1 : in.time.step,
          .steps = steps,
          .epoch = epoch,
          .vertex_force = in.vertex_force,
          .load = load};
}

/// Enqueues `steps` Runge-Kutta steps as one launch; `captured` as above. Asynchronous.
template <ConstitutiveModel model, class ExecutionSpace, class VertexForce>
void launch_persistent_steps(const ExecutionSpace& space, PersistentDriver<ExecutionSpace>& driver,
                             const PersistentInputs<ExecutionSpace, VertexForce>& in, std::int64_t steps,
                             bool captured) {
  const auto prepared = [&]<bool loads>() {
    return prepare_persistent_steps<loads>(space, driver, in, steps, 4, captured);
  };
  if (in.has_loads)
    driver.grid.template launch<max_ring_threads, 1>(
        PersistentRingsFunctor<ExecutionSpace, model, VertexForce, true>{
            prepared.template operator()<true>()});
  else if (driver.pairs)
    driver.grid.template launch<max_pair_threads, 1>(
        PersistentPairsFunctor<ExecutionSpace, model, VertexForce>{prepared.template operator()<false>()});
  else
    driver.grid.template launch<max_ring_threads, 1>(
        PersistentRingsFunctor<ExecutionSpace, model, VertexForce>{prepared.template operator()<false>()});
}

/// Enqueues `steps` steps of the symplectic Euler method with the given damping, 1/s, as one launch;
/// `captured` as above. Asynchronous.
template <ConstitutiveModel model, class ExecutionSpace, class VertexForce>
void launch_persistent_euler(const ExecutionSpace& space, PersistentDriver<ExecutionSpace>& driver,
                             const PersistentInputs<ExecutionSpace, VertexForce>& in, double damping,
                             std::int64_t steps, bool captured) {
  driver.grid.template launch<max_pair_threads, 1>(PersistentEulerFunctor<ExecutionSpace, model, VertexForce>{
      {prepare_persistent_steps<false>(space, driver, in, steps, 1, captured)}, damping});
}

}  // namespace drogue::fabric
