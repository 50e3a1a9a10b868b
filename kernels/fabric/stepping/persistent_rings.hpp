#pragma once

#include "kernels/fabric/stepping/persistent_steps.hpp"

namespace drogue::fabric {

/// Maximum number of threads of a team, with 80 registers each.
inline constexpr int max_ring_threads = 768;

/// Tables of a patch with the interface of FabricViews that `elastic_force` uses.
struct TeamFabric {
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

/// `PersistentSteps` of patches of many vertices: a thread traverses the ring of its vertex. Triangles and
/// springs at rest are in the team's scratch memory.
template <class ExecutionSpace, ConstitutiveModel model, class VertexForce = NoVertexForce,
          bool loads = false>
struct PersistentRingsFunctor {
  PersistentSteps<ExecutionSpace, VertexForce, loads> of;

  [[nodiscard]] static std::size_t scratch_bytes(const PatchViews<ExecutionSpace>& patches) {
    return PersistentSteps<ExecutionSpace>::tables_bytes(patches, 2) +
           TeamSlicedEll<3>::bytes(patches.team, patches.max_triangle_slots) +
           TeamSlicedEll<2>::bytes(patches.team, patches.max_spring_slots) + 4 * alignof(double);
  }

  template <class Member>
  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const auto halo = of.halo(member);
    const auto points = of.tables(member, halo, 2);
    const int slices = of.patches.team / slice;
    const TeamFabric local{TeamSlicedEll<3>(member, slices, of.patches.triangles),
                           TeamSlicedEll<2>(member, slices, of.patches.springs), of.fabric.moduli};
    OwnVertex own = of.begin(member, halo, points);
    member.team_barrier();
    of.run(member, halo, points, own, local.triangles,
           [&](const TeamTable& now, std::int64_t, const auto& arrive) {
             Vector3<double> elastic{0.0, 0.0, 0.0};
             if (own.vertex >= 0) elastic = elastic_force<model, double>(local, now, member.team_rank());
             arrive();
             return elastic;
           });
  }
};

}  // namespace drogue::fabric
