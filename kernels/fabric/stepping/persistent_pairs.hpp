#pragma once

#include "kernels/fabric/stepping/persistent_steps.hpp"

namespace drogue::fabric {

/// Maximum number of vertices of a patch, and of threads of its team, with 128 registers each.
inline constexpr int max_pair_vertices = 384, max_pair_threads = 512;

/// `PersistentSteps` of patches of few vertices, which would leave a multiprocessor idle if a thread
/// traversed the ring of its vertex. A warp computes the forces of a row of pairs of triangles and stores
/// them in the team's scratch memory, where the thread of the vertex adds them in the order of the ring. The
/// triangles at rest of a warp's first row stay in registers.
template <class ExecutionSpace, ConstitutiveModel model, class VertexForce = NoVertexForce>
struct PersistentPairsFunctor {
  PersistentSteps<ExecutionSpace, VertexForce> of;

  [[nodiscard]] static std::size_t scratch_bytes(const PatchViews<ExecutionSpace>& patches) {
    return PersistentSteps<ExecutionSpace>::tables_bytes(patches, 3) +
           2 * 3 * patches.max_triangle_slots * sizeof(double) +
           TeamSlicedEll<2>::bytes(patches.team, patches.max_spring_slots) + 3 * alignof(double);
  }

  /// Pair of triangles of a lane.
  struct Pair {
    int vertex, first_force, triangles;  ///< `first_force`: row of the first force in the table of forces
    int neighbour[3];
    RestTriangle<double> rest[2];
  };

  KOKKOS_FUNCTION Pair pair(int row, int lane, int first_slot) const {
    const auto& slots = of.patches.triangles;
    const PairRow at = of.patches.row(row);
    const int next = at.slot + lane, before = next - slice, last = at.triangles == 2 ? next + slice : next;
    const double squared = slots.value(next, 0);
    return {.vertex = at.vertex + lane,
            .first_force = next - first_slot,
            .triangles = at.triangles,
            .neighbour = {slots.neighbour(before), slots.neighbour(next), slots.neighbour(last)},
            .rest = {stored_triangle(slots.value, slots.value(before, 0), squared, next),
                     stored_triangle(slots.value, squared, slots.value(last, 0), last)}};
  }

  KOKKOS_FUNCTION void store_forces(const Pair& pair, const TeamTable& points,
                                    const TeamTable& forces) const {
    if constexpr (whole_triangles<model>) {
      const Vector3<double> own = load_points<double>(points, pair.vertex);
      const auto to = [&](int k) { return edge_to<double>(points, own, pair.neighbour[k]); };
      const auto store = [&](int slot, const EdgeVector<double>& j, const EdgeVector<double>& k,
                             const RestTriangle<double>& rest) {
        // One neutral slot would send all lanes through the branches of a root and a division of zero.
        Vector3<double> force{0.0, 0.0, 0.0};
        if (rest.inverse_area > 0.0) force = triangle_force<model>(of.fabric.moduli, j, k, rest);
        store_points(forces, slot, force);
      };
      const EdgeVector<double> middle = to(1);
      store(pair.first_force, to(0), middle, pair.rest[0]);
      if (pair.triangles == 2) store(pair.first_force + slice, middle, to(2), pair.rest[1]);
    }
  }

  /// `sum` plus the forces from `begin` to `end`, one per slice, in their order, N. Four loads are in flight
  /// at once.
  KOKKOS_FUNCTION static Vector3<double> with_forces(Vector3<double> sum, const TeamTable& forces, int begin,
                                                     int end) {
    const Vector3<double> zero{0.0, 0.0, 0.0};
    for (int k = begin; k < end; k += 4 * slice) {
      Vector3<double> four[4];
      for (int n = 0; n < 4; ++n)
        four[n] = k + n * slice < end ? load_points<double>(forces, k + n * slice) : zero;
      for (const Vector3<double>& force : four) sum = sum + force;
    }
    return sum;
  }

  template <class Member>
  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const auto halo = of.halo(member);
    const auto points = of.tables(member, halo, 3);
    const int rank = member.team_rank(), lane = rank % slice, team = of.patches.team, slices = team / slice,
              slots = static_cast<int>(of.patches.max_triangle_slots);
    auto* const memory = team_numbers<double>(member, 2 * 3 * of.patches.max_triangle_slots);
    const struct { TeamSlicedEll<2> springs; } local{TeamSlicedEll<2>(member, slices, of.patches.springs)};
    OwnVertex own = of.begin(member, halo, points);

    const int patch = member.league_rank(), first = patch * slices,
              first_slot = of.patches.triangles.first(first) * slice, begin = of.patches.first_row(patch),
              end = of.patches.first_row(patch + 1), stride = member.team_size() / slice,
              row = begin + rank / slice;
    Pair mine{};
    if (row < end) mine = pair(row, lane, first_slot);
    int first_force = 0, forces_end = 0;
    if (own.vertex >= 0) {
      first_force = (of.patches.triangles.first(first + rank / slice) + 1) * slice + lane - first_slot;
      forces_end = of.patches.triangles.first(first + rank / slice + 1) * slice - first_slot;
    }
    member.team_barrier();
    of.run(member, halo, points, own, of.patches.triangles,
           [&](const TeamTable& now, std::int64_t done, const auto& arrive) {
             // Two tables: some threads still sum the forces of the previous stage.
             const TeamTable forces{memory + done % 2 * 3 * slots, slots};
             if (row < end) store_forces(mine, now, forces);
             for (int more = row + stride; more < end; more += stride)
               store_forces(pair(more, lane, first_slot), now, forces);
             arrive();
             const Vector3<double> zero{0.0, 0.0, 0.0};
             if (own.vertex < 0) return zero;
             return with_springs<model>(local, now, rank, with_forces(zero, forces, first_force, forces_end));
           });
  }
};

}  // namespace drogue::fabric
