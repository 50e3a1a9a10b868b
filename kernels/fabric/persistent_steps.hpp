#pragma once

#include "kernels/device/persistent_kernel.hpp"
#include "kernels/fabric/step.hpp"
#include "kernels/fabric/stepping/patches.hpp"
#include "kernels/fabric/team_slots.hpp"

namespace drogue::fabric {

/// `Patches` where kernels read them.
template <class ExecutionSpace>
struct PatchViews {
  ListView<ExecutionSpace, int> vertex, place, first_halo, halo_vertex, halo_place;
  SlicedEllViews<ExecutionSpace, 3> triangles;
  SlicedEllViews<ExecutionSpace, 2> springs;
  ListView<ExecutionSpace, PairRow> row;
  ListView<ExecutionSpace, int> first_row;
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
          sliced_ell_views(space, from.triangles),
          sliced_ell_views(space, from.springs),
          list_view(space, "drogue::fabric::pair_rows", from.row),
          list_view(space, "drogue::fabric::first_row", from.first_row),
          from.team,
          from.most_halo,
          most_slots(from, from.triangles),
          most_slots(from, from.springs)};
}

/// What steps that share a launch need beside the cloth.
template <class ExecutionSpace>
struct Persistent {
  device::PersistentKernel<ExecutionSpace> grid;
  PatchViews<ExecutionSpace> patches;
  std::uint64_t epoch = 0;  ///< of the last stage launched
};

/// A thread's vertex, in registers.
struct OwnVertex {
  int vertex, place;
  Vector3<double> x, v, load;
  Vector3<double> v2, v3, v_now;  ///< velocities of the stages after the first; of this one
  double inverse_mass;
  Vector3<double> free;  ///< axes: 1, or 0 of those that are pinned
};

/// Many steps of Runge and Kutta's method in one launch: what `RungeKuttaFunctor` does in four launches a
/// step, with the state of a vertex in the registers of a thread, and no barrier across the grid. The
/// positions of a stage follow from the velocities of the one before, and these from the forces of the one
/// before that: at the end of stage e a team posts the positions of stage e+2, of those vertices that others
/// read, and while it computes stage e+1 those of its halo arrive.
///
/// Two boards, of even and of odd stages, are enough, though nobody hears from all: who ends stage e has read
/// what all its neighbours posted for e+1. They had posted it after their barrier in stage e-1, with all of
/// stage e read. So whoever reads the place of e that is now written anew for e+2, and only neighbours do
/// (`Patches`), has read it. The first two stages of a launch read memory, which the launch before has left,
/// and nothing of an older launch is read any more. A team needs three tables of positions, or two if it
/// reads none behind the barrier of a stage.
template <class ExecutionSpace>
struct PersistentSteps {
  using Points = PointsView<ExecutionSpace>;
  PatchViews<ExecutionSpace> patches;
  Cloth<ExecutionSpace> cloth;
  Points x, v;
  Watch<ExecutionSpace> watch;
  double dt;
  std::int64_t begun;   ///< steps taken before
  std::int64_t steps;   ///< to take, at least 1
  std::uint64_t epoch;  ///< of the last stage of the launch before

  /// Positions that a team holds, of `count` stages.
  struct Tables {
    double* memory;
    int held, count;
    KOKKOS_FUNCTION TeamTable operator()(int turn) const { return {memory + turn * 3 * held, held}; }
  };
  [[nodiscard]] static std::size_t tables_bytes(const PatchViews<ExecutionSpace>& patches, int count) {
    return 3 * static_cast<std::size_t>(count * (patches.team + patches.most_halo)) * sizeof(double);
  }

  /// What a thread collects: its first vertex of the halo and where others post it, and how many there are.
  struct Halo {
    int first, count, rank, place;
  };

  template <class Member>
  KOKKOS_FUNCTION Halo halo(const Member& member) const {
    const int first = patches.first_halo(member.league_rank()),
              count = patches.first_halo(member.league_rank() + 1) - first,
              rank = member.team_size() - 1 - member.team_rank();  // the last threads have the least to do
    return {first, count, rank, rank < count ? patches.halo_place(first + rank) : -1};
  }

  template <class Member>
  KOKKOS_FUNCTION Tables tables(const Member& member, const Halo& halo, int count) const {
    const int held = patches.team + halo.count;
    return {static_cast<double*>(member.team_scratch(0).get_shmem_aligned(
                3 * static_cast<std::size_t>(count * held) * sizeof(double), alignof(double))),
            held, count};
  }

  /// The thread's vertex, if it has one, with the positions of the first two stages.
  template <class Member>
  KOKKOS_FUNCTION OwnVertex begin(const Member& member, const Halo& halo, const Tables& points) const {
    const Vector3<double> zero{0.0, 0.0, 0.0};
    OwnVertex own{-1, -1, zero, zero, zero, zero, zero, zero, 0.0, zero};
    const auto store = [&](int number, const Vector3<double>& at, const Vector3<double>& velocity) {
      store_points(points(0), number, at);
      const double part = share_after(0) * dt;
      store_points(points(1), number, at + part * velocity);
    };
    if (const int rank = member.team_rank(); rank < patches.team) {
      const int at = member.league_rank() * patches.team + rank;
      own.vertex = patches.vertex(at), own.place = patches.place(at);
      if (own.vertex >= 0) {
        own.x = load_points<double>(x, own.vertex), own.v_now = own.v = load_points<double>(v, own.vertex);
        if (cloth.load.extent(0) > 0) own.load = load_points<double>(cloth.load, own.vertex);
        own.free = free_axes<double>(cloth, own.vertex);
        own.inverse_mass = cloth.inverse_mass(own.vertex);
      } else {
        store_points(points(points.count - 1), rank, zero);  // neutral slots of its lane read it
      }
      store(rank, own.x, own.v);
    }
    for (int k = halo.rank; k < halo.count; k += member.team_size()) {
      const int vertex = patches.halo_vertex(halo.first + k);
      store(patches.team + k, load_points<double>(x, vertex), load_points<double>(v, vertex));
    }
    return own;
  }

  /// Ends stage `done` of this launch under an elastic force, N: posts the position of the next stage but one
  /// and leaves it in `points`.
  template <class Member>
  KOKKOS_FUNCTION void end_stage(const Member& member, OwnVertex& own, std::int64_t done,
                                 const Vector3<double>& elastic, const TeamTable& points) const {
    const Vector3<double> a = acceleration(cloth, elastic + own.load, own.inverse_mass, own.v_now, own.free);
    const int stage = static_cast<int>(done % 4);
    Vector3<double> position;
    if (stage == 3) {
      own.v = own.v_now = end_velocity(dt, own.v, own.v2, own.v3, own.v_now, a);
      position = own.x + (share_after(0) * dt) * own.v;
    } else {
      const Vector3<double> velocity = own.v + (share_after(stage) * dt) * a;
      if (stage == 2)
        position = own.x = end_position(dt, own.x, own.v, own.v2, own.v3, velocity);
      else
        position = own.x + (share_after(stage + 1) * dt) * velocity;
      if (stage == 0) own.v2 = velocity;
      if (stage == 1) own.v3 = velocity;
      own.v_now = velocity;
    }
    // What nobody reads would replace what somebody may still have to read.
    if (own.place >= 0 && done + 2 < 4 * steps)
      member.put(epoch_after(done), static_cast<std::size_t>(own.place),
                 {{position.x, position.y, position.z}});
    store_points(points, member.team_rank(), position);
    // Others wait for the post and not for this.
    if (stage == 3) watch.look(begun + done / 4 + 1, own.vertex, own.x, own.v);
  }

  /// Brings what the halo posted at the end of stage `done` into `points`.
  template <class Member>
  KOKKOS_FUNCTION void collect(const Member& member, const Halo& halo, std::int64_t done,
                               const TeamTable& points) const {
    int place = halo.place;
    for (int k = halo.rank; k < halo.count; k += member.team_size()) {
      if (k > halo.rank) place = patches.halo_place(halo.first + k);
      const device::HaloValue other = member.get(epoch_after(done), static_cast<std::size_t>(place));
      store_points(points, patches.team + k, Vector3<double>{other.value[0], other.value[1], other.value[2]});
    }
  }
  KOKKOS_FUNCTION std::uint64_t epoch_after(std::int64_t done) const {
    return epoch + 1 + static_cast<std::uint64_t>(done);
  }

  /// Calls `force(points, done)` for each stage: what is the elastic force on the thread's vertex, N, when
  /// `arrive` has been called in it, which waits for the team and the positions of the next stage.
  template <class Member, class Force>
  KOKKOS_FUNCTION void run(const Member& member, const Halo& halo, const Tables& points, OwnVertex& own,
                           const Force& force) const {
    const std::int64_t stages = 4 * steps;
    int now = 0;  // of the tables
    for (std::int64_t done = 0; done < stages; ++done) {
      const int last = points.count - 1, next = now == last ? 0 : now + 1, then = next == last ? 0 : next + 1;
      const Vector3<double> elastic = force(points(now), done, [&] {
        if (done > 0 && done + 1 < stages) collect(member, halo, done - 1, points(next));
        member.team_barrier();
      });
      if (own.vertex >= 0) end_stage(member, own, done, elastic, points(then));
      now = next;
    }
    if (own.vertex < 0) return;
    store_points(x, own.vertex, own.x);
    store_points(v, own.vertex, own.v);
    if (own.vertex == 0) watch.steps(0) = begun + steps;
  }
};

}  // namespace drogue::fabric
