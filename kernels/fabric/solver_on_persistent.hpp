#pragma once

// Definitions of SolverOn: steps that share a launch.

#include <algorithm>

#include "kernels/fabric/persistent_pairs.hpp"
#include "kernels/fabric/persistent_rings.hpp"
#include "kernels/fabric/solver_on.hpp"

namespace drogue::fabric {

template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::make_persistent(const Parameters& p, const RingAdjacency& rings,
                                                    const SpringAdjacency& springs) {
  if constexpr (device::PersistentKernel<ExecutionSpace>::available) {
    using Grid = device::PersistentKernel<ExecutionSpace>;
    const bool wanted = p.driver == Driver::persistent || p.driver == Driver::automatic;
    if (!wanted || _acts || _prescribed || _contact) return;
    const int teams = Grid::most_teams(_instance);
    if (teams == 0) return;
    const auto share = [&](int parts) { return (_vertices + parts - 1) / parts; };
    const int count = std::min(teams, share(p.patch > 0 ? p.patch : slice));
    if (share(count) > most_ring_threads) return;
    const Patches patches = make_patches(p.mesh.rest, rings, springs, count);
    const PatchViews<ExecutionSpace> views = patch_views(_instance.space(), patches);
    const bool pairs = patches.team <= most_pair_vertices;
    const std::size_t scratch = pairs ? PersistentPairsFunctor<ExecutionSpace, law>::scratch_bytes(views)
                                      : PersistentRingsFunctor<ExecutionSpace, law>::scratch_bytes(views);
    if (scratch > Grid::most_scratch_bytes(_instance)) return;
    const int threads = pairs ? team_threads(patches, patches.most_rows, most_pair_threads)
                              : team_threads(patches, 0, most_ring_threads);
    _persistent.emplace(Persistent<ExecutionSpace>{
        {_instance, count, threads, scratch, static_cast<std::size_t>(patches.places)}, views});
  }
}

/// In one launch. Copies that are put aside end a launch too, so that none has more than `keep_every` steps:
/// a few milliseconds.
template <class ExecutionSpace, ConstitutiveModel law>
void SolverOn<ExecutionSpace, law>::take_persistent(std::int64_t steps) {
  if constexpr (device::PersistentKernel<ExecutionSpace>::available) {
    const PersistentSteps<ExecutionSpace> of{
        _persistent->patches, _cloth, _x, _v, _watch, _clock.dt, _clock.step, steps, _persistent->epoch};
    if (_persistent->patches.team <= most_pair_vertices)
      _persistent->grid.template launch<most_pair_threads, 1>(
          PersistentPairsFunctor<ExecutionSpace, law>{of});
    else
      _persistent->grid.template launch<most_ring_threads, 1>(
          PersistentRingsFunctor<ExecutionSpace, law>{of});
    _persistent->epoch += 4 * static_cast<std::uint64_t>(steps);
  }
}

}  // namespace drogue::fabric
