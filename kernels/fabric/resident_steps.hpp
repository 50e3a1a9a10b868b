#pragma once

#include "kernels/device/resident_grid.hpp"
#include "kernels/fabric/patches.hpp"
#include "kernels/fabric/step.hpp"

namespace drogue::fabric {

/// `Patches` where kernels read them.
template <class ExecutionSpace>
struct PatchViews {
  ListView<ExecutionSpace, int> vertex, place, first_halo, halo_vertex, halo_place;
  SlotViews<ExecutionSpace, 3> triangles;
  SlotViews<ExecutionSpace, 2> springs;
  int team, most_halo;
  std::size_t most_triangle_slots, most_spring_slots;
};

template <class ExecutionSpace>
[[nodiscard]] PatchViews<ExecutionSpace> patch_views(const ExecutionSpace& space, const Patches& from) {
  return {list_view(space, "drogue::fabric::patch_vertices", from.vertex),
          list_view(space, "drogue::fabric::patch_places", from.place),
          list_view(space, "drogue::fabric::first_halo", from.first_halo),
          list_view(space, "drogue::fabric::halo_vertices", from.halo_vertex),
          list_view(space, "drogue::fabric::halo_places", from.halo_place),
          slot_views(space, from.triangles),
          slot_views(space, from.springs),
          from.team,
          from.most_halo,
          most_slots(from, from.triangles),
          most_slots(from, from.springs)};
}

/// Threads of a team that has a multiprocessor for itself: each has 168 registers in a usual one, 80 in the
/// largest.
inline constexpr int usual_resident_team = 384, largest_resident_team = 768;

/// What steps that share a launch need beside the cloth.
template <class ExecutionSpace>
struct Resident {
  device::ResidentGrid<ExecutionSpace> grid;
  PatchViews<ExecutionSpace> patches;
  std::uint64_t epoch = 0;  ///< of the last stage launched
};

/// A column of numbers in a team's memory.
template <class T>
struct TeamList {
  T* data;
  KOKKOS_FUNCTION T& operator()(int i) const { return data[i]; }
};

/// Columns of them.
struct TeamTable {
  double* data;
  int rows;
  KOKKOS_FUNCTION double& operator()(int row, int column) const { return data[column * rows + row]; }
};

/// The slots of a patch in its team's memory.
template <int values>
struct TeamSlots {
  TeamList<int> first, neighbour;
  TeamTable value;

  [[nodiscard]] static std::size_t bytes(int team, std::size_t slots) {
    return (static_cast<std::size_t>(team / slice) + 1 + slots) * sizeof(int) +
           values * slots * sizeof(double);
  }

  /// Copies those of the member's patch; the team must wait before it reads them.
  template <class Member, class Views>
  KOKKOS_FUNCTION TeamSlots(const Member& member, const Views& from) {
    const int slices = member.team_size() / slice, patch = member.league_rank() * slices;
    const int begin = from.first(patch), slots = (from.first(patch + slices) - begin) * slice;
    value = {doubles(member, values * slots), slots};
    first.data = integers(member, slices + 1);
    neighbour.data = integers(member, slots);
    for (int s = member.team_rank(); s <= slices; s += member.team_size())
      first(s) = from.first(patch + s) - begin;
    for (int slot = member.team_rank(); slot < slots; slot += member.team_size()) {
      neighbour(slot) = from.neighbour(begin * slice + slot);
      for (int a = 0; a < values; ++a) value(slot, a) = from.value(begin * slice + slot, a);
    }
  }

  template <class Take>
  KOKKOS_FUNCTION void each(int i, const Take& take) const {
    each_slot(first, i, take);
  }
  template <class Read, class Take>
  KOKKOS_FUNCTION void each_pair(int i, const Read& read, const Take& take) const {
    each_pair_of_slots(first, i, read, take);
  }

 private:
  template <class Member>
  KOKKOS_FUNCTION static double* doubles(const Member& member, int count) {
    return static_cast<double*>(member.team_scratch(0).get_shmem_aligned(
        static_cast<std::size_t>(count) * sizeof(double), alignof(double)));
  }
  template <class Member>
  KOKKOS_FUNCTION static int* integers(const Member& member, int count) {
    return static_cast<int*>(member.team_scratch(0).get_shmem_aligned(
        static_cast<std::size_t>(count) * sizeof(int), alignof(int)));
  }
};

/// What `elastic_force` asks of a Cloth, of a patch.
struct TeamCloth {
  TeamSlots<3> triangles;
  TeamSlots<2> springs;
  Moduli moduli;
  Vector3<double> gravity;
  double damping;

  template <class R>
  KOKKOS_FUNCTION R rest_edge(int /*i*/, int slot) const {
    return triangles.value(slot, 0);
  }
  template <class R>
  KOKKOS_FUNCTION RestTriangle<R> rest_triangle(R before, R next, int slot) const {
    return stored_triangle(triangles.value, before, next, slot);
  }
};

/// Many steps of Runge and Kutta's method in one launch: what `RungeKuttaFunctor` does in four launches a
/// step, with a vertex a thread whose state stays in registers, and no barrier across the grid. After every
/// stage a team posts the positions of those vertices that others read, with the number of the stage, and
/// waits for those of its halo.
///
/// Two boards, of even and of odd stages, are enough, though nobody hears from all: who posts stage e has
/// passed the barrier behind stage e-1, at which its team had read what all its neighbours posted for e-1.
/// They had posted it after their own barrier behind e-2, with all of e-2 read. So whoever reads the place
/// of e-2 that is now written anew, and only neighbours do (`Patches`), has read it. The first stage of a
/// launch reads memory, which the launch before has left, and nothing of an older launch is read any more.
template <class ExecutionSpace, Law law>
struct ResidentStepsFunctor {
  using Points = PointsView<ExecutionSpace>;
  PatchViews<ExecutionSpace> patches;
  Cloth<ExecutionSpace> cloth;
  Points x, v;
  Watch<ExecutionSpace> watch;
  double dt;
  std::int64_t begun;   ///< steps taken before
  std::int64_t steps;   ///< to take, at least 1
  std::uint64_t epoch;  ///< of the last stage of the launch before

  [[nodiscard]] static std::size_t scratch_bytes(const PatchViews<ExecutionSpace>& patches) {
    const auto points = static_cast<std::size_t>(patches.team + patches.most_halo);
    return 2 * 3 * points * sizeof(double) + TeamSlots<3>::bytes(patches.team, patches.most_triangle_slots) +
           TeamSlots<2>::bytes(patches.team, patches.most_spring_slots) + 4 * alignof(double);
  }

  /// A thread's vertex, in registers.
  struct Own {
    int vertex, place;
    Vector3<double> x, v, load;
    double inverse_mass;
    std::uint8_t held;
  };

  template <class Member>
  KOKKOS_FUNCTION Own own(const Member& member) const {
    const int at = member.league_rank() * member.team_size() + member.team_rank();
    const Vector3<double> zero{0.0, 0.0, 0.0};
    Own own{patches.vertex(at), patches.place(at), zero, zero, zero, 0.0, 0};
    if (own.vertex < 0) return own;
    own.x = load_points<double>(x, own.vertex), own.v = load_points<double>(v, own.vertex);
    if (cloth.load.extent(0) > 0) own.load = load_points<double>(cloth.load, own.vertex);
    own.held = cloth.held(own.vertex);
    own.inverse_mass = cloth.inverse_mass(own.vertex);
    return own;
  }

  template <class Member>
  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const int rank = member.team_rank(), team = member.team_size();
    const int first = patches.first_halo(member.league_rank()),
              halo = patches.first_halo(member.league_rank() + 1) - first, held = team + halo;
    auto* const memory = static_cast<double*>(member.team_scratch(0).get_shmem_aligned(
        2 * 3 * static_cast<std::size_t>(held) * sizeof(double), alignof(double)));
    const auto points = [&](std::int64_t turn) { return TeamTable{memory + turn % 2 * 3 * held, held}; };
    const TeamCloth local{TeamSlots<3>(member, patches.triangles), TeamSlots<2>(member, patches.springs),
                          cloth.moduli, cloth.gravity, cloth.damping};
    Own mine = own(member);
    store_points(points(0), rank, mine.x);
    for (int k = rank; k < halo; k += team)
      store_points(points(0), team + k, load_points<double>(x, patches.halo_vertex(first + k)));
    member.team_barrier();

    // Of the stages after the first.
    Vector3<double> v2 = mine.v, v3 = mine.v, v_now = mine.v;
    const std::int64_t stages = 4 * steps;
    for (std::int64_t done = 0; done < stages; ++done) {
      const int stage = static_cast<int>(done % 4);
      Vector3<double> position = mine.x;
      if (mine.vertex >= 0) {
        const Vector3<double> force = elastic_force<law, double>(local, points(done), rank) + mine.load;
        const Vector3<double> a =
            acceleration(local, force, mine.inverse_mass, v_now, free_axes<double>(&mine.held));
        if (stage == 3) {
          const StepEnd<double> end = step_end(dt, mine.x, mine.v, v2, v3, v_now, a);
          mine.x = position = end.x;
          mine.v = v_now = end.v;
          watch.look(begun + done / 4 + 1, mine.vertex, end.x, end.v);
        } else {
          const double part = share_after(stage) * dt;
          position = mine.x + part * v_now;
          v_now = mine.v + part * a;
          if (stage == 0) v2 = v_now;
          if (stage == 1) v3 = v_now;
        }
      }
      if (done + 1 == stages) break;
      exchange(member, mine, position, points(done + 1), epoch + 1 + static_cast<std::uint64_t>(done), first,
               halo);
    }
    if (mine.vertex < 0) return;
    store_points(x, mine.vertex, mine.x);
    store_points(v, mine.vertex, mine.v);
    if (mine.vertex == 0) watch.steps(0) = begun + steps;
  }

  /// Brings the positions of the next stage into the team's memory.
  template <class Member>
  KOKKOS_FUNCTION void exchange(const Member& member, const Own& mine, const Vector3<double>& position,
                                const TeamTable& next, std::uint64_t posted, int first, int halo) const {
    const int rank = member.team_rank(), team = member.team_size();
    if (mine.place >= 0)
      member.post(posted, static_cast<std::size_t>(mine.place), {{position.x, position.y, position.z}});
    store_points(next, rank, position);
    for (int k = rank; k < halo; k += team) {
      const device::Posted other =
          member.collect(posted, static_cast<std::size_t>(patches.halo_place(first + k)));
      store_points(next, team + k, Vector3<double>{other.value[0], other.value[1], other.value[2]});
    }
    // The next stage writes the other table, which all have read when they are here.
    member.team_barrier();
  }
};

}  // namespace drogue::fabric
