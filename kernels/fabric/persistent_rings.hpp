#pragma once

#include "kernels/fabric/persistent_steps.hpp"

namespace drogue::fabric {

/// Threads of the largest team, with 80 registers each.
inline constexpr int most_ring_threads = 768;

/// What `elastic_force` asks of a Cloth, of a patch.
struct TeamCloth {
  TeamSlicedEll<3> triangles;
  TeamSlicedEll<2> springs;
  Moduli moduli;

  template <class R>
  KOKKOS_FUNCTION R rest_edge(int /*i*/, int slot, int /*neighbour*/) const {
    return triangles.value(slot, 0);
  }
  template <class R>
  KOKKOS_FUNCTION RestTriangle<R> rest_triangle(R before, R next, int slot) const {
    return stored_triangle(triangles.value, before, next, slot);
  }
};

/// `PersistentSteps` of patches of many vertices: a thread goes round the ring of its vertex, and what
/// triangles and springs are at rest lies in the team's memory.
template <class ExecutionSpace, ConstitutiveModel law>
struct PersistentRingsFunctor {
  PersistentSteps<ExecutionSpace> of;

  [[nodiscard]] static std::size_t scratch_bytes(const PatchViews<ExecutionSpace>& patches) {
    return PersistentSteps<ExecutionSpace>::tables_bytes(patches, 2) +
           TeamSlicedEll<3>::bytes(patches.team, patches.most_triangle_slots) +
           TeamSlicedEll<2>::bytes(patches.team, patches.most_spring_slots) + 4 * alignof(double);
  }

  template <class Member>
  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const auto halo = of.halo(member);
    const auto points = of.tables(member, halo, 2);
    const int slices = of.patches.team / slice;
    const TeamCloth local{TeamSlicedEll<3>(member, slices, of.patches.triangles),
                          TeamSlicedEll<2>(member, slices, of.patches.springs), of.cloth.moduli};
    OwnVertex own = of.begin(member, halo, points);
    member.team_barrier();
    of.run(member, halo, points, own, [&](const TeamTable& now, std::int64_t, const auto& arrive) {
      Vector3<double> elastic{0.0, 0.0, 0.0};
      if (own.vertex >= 0) elastic = elastic_force<law, double>(local, now, member.team_rank());
      arrive();
      return elastic;
    });
  }
};

}  // namespace drogue::fabric
