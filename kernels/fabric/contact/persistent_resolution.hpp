#pragma once

#include "kernels/device/block_size.hpp"
#include "kernels/device/persistent_kernel.hpp"
#include "kernels/device/relaxed_access.hpp"
#include "kernels/fabric/contact/broad_phase.hpp"
#include "kernels/fabric/contact/impulses.hpp"
#include "kernels/fabric/contact/rigid_zones.hpp"

namespace drogue::fabric {

/// Contact of an interval in one cooperative launch: the kernels of `ContactImpl::enqueue_end` one after
/// another, with a barrier of all teams between them, but for those without work. Lists are mostly valid,
/// impulses mostly enough, and a launch of a kernel in a graph takes as long as its work.
template <class ExecutionSpace>
struct PersistentResolutionFunctor {
  using Points3 = UnmanagedTable<ExecutionSpace, double, 3>;

  /// Default number of threads of a team, and the largest: detection needs some 100 registers of each.
  static constexpr int largest_team = device::largest_block;

  /// Compilers do not inline it: a copy of its views on the device would lie in local memory.
  DetectConstraintsFunctor<ExecutionSpace> detect;
  Points3 x, v;

  /// Phases of a launch, which barriers separate.
  template <class Member>
  class Phases {
   public:
    KOKKOS_FUNCTION explicit Phases(const Member& member) : _member(member), _epoch(member.epoch()) {}

    [[nodiscard]] KOKKOS_FUNCTION int threads() const { return _member.league_size() * _member.team_size(); }

    /// Calls `functor(k)` for k below `count`, and waits until all teams have. Warps of different teams take
    /// turns, so that few indices occupy many multiprocessors.
    template <class Functor>
    KOKKOS_FUNCTION void each(int count, const Functor& functor) {
      constexpr int warp = 32;
      const int rank = _member.team_rank(),
                first = (rank / warp * _member.league_size() + _member.league_rank()) * warp + rank % warp;
      for (int k = first; k < count; k += threads()) functor(k);
      wait();
    }

   private:
    KOKKOS_FUNCTION void wait() {
      ++_epoch;
      _member.team_barrier();
      if (_member.team_rank() == 0) _member.publish(_epoch);
      for (int other = _member.team_rank(); other < _member.league_size(); other += _member.team_size())
        _member.await(other, _epoch);
      _member.team_barrier();
    }

    const Member& _member;
    std::uint64_t _epoch;
  };

  template <class Member>
  KOKKOS_FUNCTION void operator()(const Member& member) const {
    Phases<Member> phases(member);
    find_constraints(phases);
    if (device::relaxed_load(&detect.views.progress(0).constraints) > 0) apply_impulses(phases);
    move_zones(phases);
  }

 private:
  template <class Member>
  KOKKOS_FUNCTION void find_constraints(Phases<Member>& phases) const {
    const ContactViews<ExecutionSpace>& views = detect.views;
    using Space = ExecutionSpace;
    phases.each(views.vertices, MeanMotionFunctor<Space>{views, x});
    phases.each(1, RebuildDecisionFunctor<Space>{views});
    if (views.self && device::relaxed_load(&views.progress(0).stale) != 0) {
      phases.each(grid_entries(), ClearGridFunctor<Space>{views});
      phases.each(views.edges > views.triangles ? views.edges : views.triangles,
                  FillGridFunctor<Space>{views});
      list_neighbours(phases);
    }
    phases.each(parts(), detect);
  }

  template <class Member>
  KOKKOS_FUNCTION void list_neighbours(Phases<Member>& phases) const {
    const ContactViews<ExecutionSpace>& views = detect.views;
    using Space = ExecutionSpace;
    for (const bool narrowed : {false, true}) {
      phases.each(views.vertices + views.edges, NeighbourListFunctor<Space>{views, narrowed});
      // No phase after the first one changes it.
      if (narrowed || device::relaxed_load(&views.progress(0).crowded) == 0) break;
      phases.each(1, NarrowSkinFunctor<Space>{views});
    }
  }

  template <class Member>
  KOKKOS_FUNCTION void apply_impulses(Phases<Member>& phases) const {
    const ContactViews<ExecutionSpace>& views = detect.views;
    for (int round = 0; round < impulse_rounds; ++round) {
      phases.each(phases.threads(), SolveImpulsesFunctor<ExecutionSpace>{views, phases.threads(), round});
      phases.each(views.vertices, ApplyImpulsesFunctor<ExecutionSpace>{views, x, v, round});
    }
  }

  template <class Member>
  KOKKOS_FUNCTION void move_zones(Phases<Member>& phases) const {
    const ContactViews<ExecutionSpace>& views = detect.views;
    using Space = ExecutionSpace;
    for (int round = 0;; ++round) {
      // At one place, since the code of detection is long.
      phases.each(parts(), CcdFunctor<Space>{views, round == 0 ? x : views.end_x, round});
      if (round == zone_rounds || device::relaxed_load(&views.progress(0).crossing[round]) == 0) break;
      phases.each(views.vertices, LabelZonesFunctor<Space>{views, round});
      phases.each(views.vertices, ZoneMotionFunctor<Space>{views, x, v, round});
      phases.each(views.vertices, MoveZonesFunctor<Space>{views, x, v, round});
    }
    if (device::relaxed_load(&views.progress(0).crossing[0]) != 0)
      phases.each(views.vertices, CommitZonesFunctor<Space>{views, x, v});
  }

  [[nodiscard]] KOKKOS_FUNCTION int parts() const {
    return detect.views.vertices + detect.views.edges + detect.views.triangles;
  }
  /// Entries that `ClearGridFunctor` visits.
  [[nodiscard]] KOKKOS_FUNCTION int grid_entries() const {
    const int buckets = static_cast<int>(detect.views.triangle_heads.extent(0));
    const int edges = detect.views.edges, vertices = detect.views.vertices;
    const int most = edges > vertices ? edges : vertices;
    return buckets > most ? buckets : most;
  }
};

}  // namespace drogue::fabric
