#pragma once

#include <algorithm>
#include <optional>

#include "kernels/fabric/stepping/persistent_pairs.hpp"
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

/// Persistent driver for the mesh of `p`, or none if the mesh does not fit the device. `has_loads`: timed
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
      make_patches(p.mesh.rest, ring_adjacency(rings ? p.mesh : Mesh{p.mesh.rest, {}, {}, {}, {}, {}}),
                   spring_adjacency(p.mesh, p.material), count);
  const PatchViews<ExecutionSpace> views = patch_views(instance.space(), patches);
  const bool pairs = patches.team <= max_pair_vertices && !has_loads;
  constexpr ConstitutiveModel any{Model::edge};  // all models need the same memory
  const std::size_t scratch = pairs ? PersistentPairsFunctor<ExecutionSpace, any>::scratch_bytes(views)
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

/// Enqueues `steps` steps as one launch. `captured`: the launch may be replayed, so that it reads its step
/// count on the device and clears the messages. Asynchronous.
template <ConstitutiveModel model, class ExecutionSpace, class VertexForce>
void launch_persistent_steps(const ExecutionSpace& space, PersistentDriver<ExecutionSpace>& driver,
                             const PersistentInputs<ExecutionSpace, VertexForce>& in, std::int64_t steps,
                             bool captured) {
  if (captured) {
    device::copy_bytes(space, device::CopyKind::within, in.monitor.steps.data() + 1, in.monitor.steps.data(),
                       sizeof(std::int64_t));
    driver.grid.clear_messages();
    driver.epoch = 0;
  }
  const std::int64_t before = captured ? -1 : in.time.step;
  const auto with = [&]<bool loads>(const PersistentLoads<ExecutionSpace, loads>& load) {
    return PersistentSteps<ExecutionSpace, VertexForce, loads>{driver.patches, in.fabric,       in.x,   in.v,
                                                               in.monitor,     in.time.dt,      before, steps,
                                                               driver.epoch,   in.vertex_force, load};
  };
  if (in.has_loads)
    driver.grid.template launch<max_ring_threads, 1>(
        PersistentRingsFunctor<ExecutionSpace, model, VertexForce, true>{
            with(PersistentLoads<ExecutionSpace, true>{in.external, in.time})});
  else if (driver.pairs)
    driver.grid.template launch<max_pair_threads, 1>(
        PersistentPairsFunctor<ExecutionSpace, model, VertexForce>{
            with(PersistentLoads<ExecutionSpace, false>{})});
  else
    driver.grid.template launch<max_ring_threads, 1>(
        PersistentRingsFunctor<ExecutionSpace, model, VertexForce>{
            with(PersistentLoads<ExecutionSpace, false>{})});
  driver.epoch += 4 * static_cast<std::uint64_t>(steps);
}

}  // namespace drogue::fabric
