#pragma once

#include "kernels/fabric/stepping/kick.hpp"
#include "kernels/fabric/stepping/persistent_pairs.hpp"

namespace drogue::fabric {

/// Many steps of the symplectic Euler method in one launch: `SymplecticEulerFunctor` with the state of a
/// vertex in the registers of a thread, forces by pairs of triangles (`PersistentPairsFunctor`) and by single
/// springs, and without a barrier across the grid. The positions at the end of a step follow from the forces
/// at its beginning, so that a team waits for its halo in every step.
///
/// Two halo buffers suffice, as in `PersistentSteps`. A team that ends step n + 2 has read the messages of
/// all its neighbours for n + 1, which these put after the barrier at which they had read all of n. A team
/// needs one table of positions and one of forces: threads read positions before the barrier in the middle of
/// a step, and add forces and store positions after it.
///
/// A launch takes two steps at least: no team then stores its last state before its neighbours, whose
/// messages it needs, have read the first one.
template <class ExecutionSpace, ConstitutiveModel model, class VertexForce = NoVertexForce>
struct PersistentEulerFunctor {
  PersistentPairsFunctor<ExecutionSpace, model, VertexForce> pairs;
  double damping;  ///< 1/s, as in `kicked`

  [[nodiscard]] static std::size_t scratch_bytes(const PatchViews<ExecutionSpace>& patches) {
    return PersistentSteps<ExecutionSpace>::tables_bytes(patches, 1) +
           3 * (patches.max_triangle_slots + patches.max_spring_slots) * sizeof(double) +
           TeamSlicedEll<2>::bytes(patches.team, patches.max_spring_slots) + 4 * alignof(double);
  }

  /// Loads the vertex of the thread, if any, and stores the positions of the team and its halo.
  template <class Member, class Halo>
  KOKKOS_FUNCTION OwnVertex begin(const Member& member, const Halo& halo, const TeamTable& points) const {
    const auto& of = pairs.of;
    OwnVertex own;
    if (const int rank = member.team_rank(); rank < of.patches.team) {
      const int at = member.league_rank() * of.patches.team + rank;
      own.vertex = of.patches.vertex(at), own.message = of.patches.message(at);
      if (own.vertex >= 0) {
        own.x = load_points<double>(of.x, own.vertex), own.v = load_points<double>(of.v, own.vertex);
        if (of.fabric.load.extent(0) > 0) own.load = load_points<double>(of.fabric.load, own.vertex);
        own.free = free_axes<double>(of.fabric, own.vertex);
        own.inverse_mass = of.fabric.inverse_mass(own.vertex);
      }
      store_points(points, rank, own.x);  // neutral slots of a lane without a vertex read it, too
    }
    for (int k = halo.rank; k < halo.count; k += member.team_size())
      store_points(points, of.patches.team + k,
                   load_points<double>(of.x, of.patches.halo_vertex(halo.first + k)));
    return own;
  }

  /// Ends step `done` of this launch under the elastic force, N: puts the new position, m, and stores it in
  /// `points`.
  template <class Member>
  KOKKOS_FUNCTION void end_step(const Member& member, OwnVertex& own, std::int64_t done,
                                const Vector3<double>& elastic, const TeamTable& points) const {
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
    store_points(points, member.team_rank(), own.x);
    // After the message, which other teams wait for.
    record_divergence(of.monitor, step + 1, own.vertex, own.x, own.v);
  }

  /// Stores the forces of row `k` of the springs of a patch, N. Neutral slots have none.
  KOKKOS_FUNCTION static void store_spring_forces(const TeamSlicedEll<2>& springs, int k, int lane,
                                                  const TeamTable& points, const TeamTable& forces) {
    int of_slice = 0;
    while (springs.first(of_slice + 1) <= k) ++of_slice;
    const int slot = k * slice + lane, rank = of_slice * slice + lane;
    Vector3<double> force{0.0, 0.0, 0.0};
    if (springs.neighbour(slot) != rank)
      force = spring_force<model>(spring_reader<double>(springs, points, rank)(slot));
    store_points(forces, slot, force);
  }

  template <class Member>
  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const auto& of = pairs.of;
    const auto halo = of.halo(member);
    const TeamTable points = of.tables(member, halo, 1)(0),
                    triangle_forces = team_table(member, of.patches.max_triangle_slots),
                    spring_forces = team_table(member, of.patches.max_spring_slots);
    const int rank = member.team_rank(), lane = rank % slice, warp = rank / slice,
              warps = member.team_size() / slice, slices = of.patches.team / slice;
    const TeamSlicedEll<2> springs(member, slices, of.patches.springs);
    OwnVertex own = begin(member, halo, points);

    const int patch = member.league_rank(), first = patch * slices,
              first_slot = of.patches.triangles.first(first) * slice,
              row = of.patches.first_row(patch) + warp, end = of.patches.first_row(patch + 1);
    typename decltype(pairs)::Pair mine{};
    if (row < end) mine = pairs.pair(row, lane, first_slot);
    int first_force = 0, forces_end = 0, first_spring = 0, springs_end = 0;
    member.team_barrier();
    const int spring_rows = springs.first(slices);
    if (own.vertex >= 0) {
      first_force = (of.patches.triangles.first(first + warp) + 1) * slice + lane - first_slot;
      forces_end = of.patches.triangles.first(first + warp + 1) * slice - first_slot;
      first_spring = springs.first(warp) * slice + lane;
      springs_end = springs.first(warp + 1) * slice;
    }
    for (std::int64_t done = 0; done < of.steps; ++done) {
      if (row < end) pairs.store_forces(mine, points, triangle_forces);
      for (int more = row + warps; more < end; more += warps)
        pairs.store_forces(pairs.pair(more, lane, first_slot), points, triangle_forces);
      // From the last warps on, which have the fewest triangles.
      for (int k = warps - 1 - warp; k < spring_rows; k += warps)
        store_spring_forces(springs, k, lane, points, spring_forces);
      member.team_barrier();
      if (own.vertex >= 0) {
        const Vector3<double> zero{0.0, 0.0, 0.0},
            of_triangles = pairs.with_forces(zero, triangle_forces, first_force, forces_end);
        end_step(member, own, done, pairs.with_forces(of_triangles, spring_forces, first_spring, springs_end),
                 points);
      }
      if (done + 1 == of.steps) break;
      of.get_halo(member, halo, done, points);
      member.team_barrier();
    }
    if (own.vertex < 0) return;
    store_points(of.x, own.vertex, own.x);
    store_points(of.v, own.vertex, own.v);
    if (own.vertex == 0) of.monitor.steps(0) = of.steps_before() + of.steps;
  }
};

}  // namespace drogue::fabric
