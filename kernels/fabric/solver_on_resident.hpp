#pragma once

// Definitions of SolverOn: steps that share a launch.

#include <algorithm>

#include "kernels/fabric/solver_on.hpp"

namespace drogue::fabric {

template <class ExecutionSpace, Law law>
void SolverOn<ExecutionSpace, law>::make_resident(const Parameters& p, const RingSlots& rings,
                                                  const SpringSlots& springs) {
  if constexpr (device::ResidentGrid<ExecutionSpace>::available) {
    using Grid = device::ResidentGrid<ExecutionSpace>;
    const bool wanted = p.driver == Driver::persistent || p.driver == Driver::automatic;
    if (!wanted || _acts || _prescribed || _contact) return;
    const int teams = Grid::most_teams(_instance);
    if (teams == 0) return;
    const auto share = [&](int parts) { return (_vertices + parts - 1) / parts; };
    const int count = std::min(teams, share(p.patch > 0 ? p.patch : slice));
    if (share(count) > largest_resident_team) return;
    const Patches patches = cut_patches(p.mesh.rest, rings, springs, count, largest_resident_team);
    const PatchViews<ExecutionSpace> views = patch_views(_instance.space(), patches);
    const std::size_t scratch = ResidentStepsFunctor<ExecutionSpace, law>::scratch_bytes(views);
    if (scratch > Grid::most_scratch_bytes(_instance)) return;
    _resident.emplace(Resident<ExecutionSpace>{
        {_instance, count, patches.team, scratch, static_cast<std::size_t>(patches.places)}, views});
  }
}

/// In one launch. Copies that are put aside end a launch too, so that none has more than `keep_every` steps:
/// a few milliseconds.
template <class ExecutionSpace, Law law>
void SolverOn<ExecutionSpace, law>::take_resident(std::int64_t steps) {
  if constexpr (device::ResidentGrid<ExecutionSpace>::available) {
    const ResidentStepsFunctor<ExecutionSpace, law> functor{
        _resident->patches, _cloth, _x, _v, _watch, _clock.dt, _clock.step, steps, _resident->epoch};
    if (_resident->patches.team <= usual_resident_team)
      _resident->grid.template launch<usual_resident_team, 1>(functor);
    else
      _resident->grid.template launch<largest_resident_team, 1>(functor);
    _resident->epoch += 4 * static_cast<std::uint64_t>(steps);
  }
}

}  // namespace drogue::fabric
