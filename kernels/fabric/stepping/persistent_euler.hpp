#pragma once

#include "kernels/fabric/stepping/kick.hpp"
#include "kernels/fabric/stepping/persistent_pairs.hpp"

namespace drogue::fabric {

/// `sum` plus the forces of the springs on vertex `rank` of a team, N. All threads of a warp call it.
template <ConstitutiveModel model, class Local>
KOKKOS_INLINE_FUNCTION Vector3<double> with_team_springs(const Local& local, const TeamTable& positions,
                                                         int rank, const Vector3<double>& sum) {
  KOKKOS_IF_ON_DEVICE((return with_springs_of_warp<model>(local.springs, positions, rank, sum);))
  KOKKOS_IF_ON_HOST((return with_springs<model>(local, positions, rank, sum);))
}

/// Many steps of the symplectic Euler method in one launch: `SymplecticEulerFunctor` with the state of a
/// vertex in the registers of a thread, forces by pairs of triangles (`PersistentPairsFunctor`) and without a
/// barrier across the grid. The positions at the end of a step follow from the forces at its beginning, so
/// that a team waits for its halo in every step.
///
/// Two halo buffers suffice, as in `PersistentSteps`. A team that ends step n + 2 has read the messages of
/// all its neighbours for n + 1, which these put after the barrier at which they had read all of n. A team
/// needs two tables of positions, since some threads add springs while others store new positions, and one of
/// forces: all are added before the barrier at the end of a step.
///
/// A launch takes two steps at least: no team then stores its last state before its neighbours, whose
/// messages it needs, have read the first one.
template <class ExecutionSpace, ConstitutiveModel model, class VertexForce = NoVertexForce>
struct PersistentEulerFunctor {
  PersistentPairsFunctor<ExecutionSpace, model, VertexForce> pairs;
  double damping;  ///< 1/s, as in `kicked`

  [[nodiscard]] static std::size_t scratch_bytes(const PatchViews<ExecutionSpace>& patches) {
    return PersistentSteps<ExecutionSpace>::tables_bytes(patches, 2) +
           3 * patches.max_triangle_slots * sizeof(double) +
           TeamSlicedEll<2>::bytes(patches.team, patches.max_spring_slots) + 3 * alignof(double);
  }

  /// Loads the vertex of the thread, if any, and stores the positions of the team and its halo.
  template <class Member, class Halo>
  KOKKOS_FUNCTION OwnVertex begin(const Member& member, const Halo& halo, const TeamTable& now,
                                  const TeamTable& next) const {
    const auto& of = pairs.of;
    const Vector3<double> zero{0.0, 0.0, 0.0};
    OwnVertex own;
    if (const int rank = member.team_rank(); rank < of.patches.team) {
      const int at = member.league_rank() * of.patches.team + rank;
      own.vertex = of.patches.vertex(at), own.message = of.patches.message(at);
      if (own.vertex >= 0) {
        own.x = load_points<double>(of.x, own.vertex), own.v = load_points<double>(of.v, own.vertex);
        if (of.fabric.load.extent(0) > 0) own.load = load_points<double>(of.fabric.load, own.vertex);
        own.free = free_axes<double>(of.fabric, own.vertex);
        own.inverse_mass = of.fabric.inverse_mass(own.vertex);
      } else {
        store_points(next, rank, zero);  // neutral slots of its lane read it
      }
      store_points(now, rank, own.x);
    }
    for (int k = halo.rank; k < halo.count; k += member.team_size())
      store_points(now, of.patches.team + k,
                   load_points<double>(of.x, of.patches.halo_vertex(halo.first + k)));
    return own;
  }

  /// Ends step `done` of this launch under the elastic force, N: puts the new position, m, and stores it in
  /// `next`.
  template <class Member>
  KOKKOS_FUNCTION void end_step(const Member& member, OwnVertex& own, std::int64_t done,
                                const Vector3<double>& elastic, const TeamTable& next) const {
    const auto& of = pairs.of;
    const std::int64_t step = of.steps_before() + done;
    Vector3<double> total_force = of.fabric.load.extent(0) > 0 ? elastic + own.load : elastic;
    if constexpr (has_vertex_force<VertexForce>)
      total_force =
          of.vertex_force.add_to(total_force, own.x, own.v, &own.inverse_mass, own.vertex, step, 0.0);
    own.v = kicked(own.v, acceleration(of.fabric, total_force, own.inverse_mass, own.v, own.free), own.free,
                   damping, of.dt);
    if constexpr (has_vertex_force<VertexForce>)
      own.v = of.vertex_force.relaxed(own.x, own.v, own.free, &own.inverse_mass, own.vertex, step);
    own.x = own.x + of.dt * own.v;
    // A message without readers would replace one that a neighbour may still have to read.
    if (own.message >= 0 && done + 1 < of.steps)
      member.put(of.epoch_after(done), static_cast<std::size_t>(own.message), {{own.x.x, own.x.y, own.x.z}});
    store_points(next, member.team_rank(), own.x);
    // After the message, which other teams wait for.
    record_divergence(of.monitor, step + 1, own.vertex, own.x, own.v);
  }

  template <class Member>
  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const auto& of = pairs.of;
    const auto halo = of.halo(member);
    const auto points = of.tables(member, halo, 2);
    const int rank = member.team_rank(), lane = rank % slice, team = of.patches.team, slices = team / slice,
              slots = static_cast<int>(of.patches.max_triangle_slots);
    const TeamTable forces{static_cast<double*>(member.team_scratch(0).get_shmem_aligned(
                               3 * of.patches.max_triangle_slots * sizeof(double), alignof(double))),
                           slots};
    const struct { TeamSlicedEll<2> springs; } local{TeamSlicedEll<2>(member, slices, of.patches.springs)};
    OwnVertex own = begin(member, halo, points(0), points(1));

    const int patch = member.league_rank(), first = patch * slices,
              first_slot = of.patches.triangles.first(first) * slice, first_row = of.patches.first_row(patch),
              end = of.patches.first_row(patch + 1), stride = member.team_size() / slice,
              row = first_row + rank / slice;
    typename decltype(pairs)::Pair mine{};
    if (row < end) mine = pairs.pair(row, lane, first_slot);
    int first_force = 0, forces_end = 0;
    if (own.vertex >= 0) {
      first_force = (of.patches.triangles.first(first + rank / slice) + 1) * slice + lane - first_slot;
      forces_end = of.patches.triangles.first(first + rank / slice + 1) * slice - first_slot;
    }
    member.team_barrier();
    for (std::int64_t done = 0; done < of.steps; ++done) {
      const TeamTable now = points(static_cast<int>(done % 2)), next = points(static_cast<int>(1 - done % 2));
      if (row < end) pairs.store_forces(mine, now, forces);
      for (int more = row + stride; more < end; more += stride)
        pairs.store_forces(pairs.pair(more, lane, first_slot), now, forces);
      member.team_barrier();
      if (rank < team) {
        const Vector3<double> elastic = with_team_springs<model>(
            local, now, rank, decltype(pairs)::sum_of(forces, first_force, forces_end));
        if (own.vertex >= 0) end_step(member, own, done, elastic, next);
      }
      if (done + 1 == of.steps) break;
      of.get_halo(member, halo, done, next);
      member.team_barrier();
    }
    if (own.vertex < 0) return;
    store_points(of.x, own.vertex, own.x);
    store_points(of.v, own.vertex, own.v);
    if (own.vertex == 0) of.monitor.steps(0) = of.steps_before() + of.steps;
  }
};

}  // namespace drogue::fabric
