#pragma once

#include "kernels/device/persistent_kernel.hpp"
#include "kernels/fabric/loads/external.hpp"
#include "kernels/fabric/results.hpp"
#include "kernels/fabric/stepping/patches.hpp"
#include "kernels/fabric/stepping/rk4.hpp"
#include "kernels/fabric/stepping/team_sliced_ell.hpp"

namespace drogue::fabric {

/// `Patches` in the memory of an execution space.
template <class ExecutionSpace>
struct PatchViews {
  ListView<ExecutionSpace, int> vertex, message, first_halo, halo_vertex, halo_message;
  SlicedEllViews<ExecutionSpace, 3> triangles;
  SlicedEllViews<ExecutionSpace, 2> springs;
  ListView<ExecutionSpace, PairRow> row;
  ListView<ExecutionSpace, int> first_row;
  int team, max_halo;
  std::size_t max_triangle_slots, max_spring_slots;
};

template <class ExecutionSpace>
[[nodiscard]] PatchViews<ExecutionSpace> patch_views(const ExecutionSpace& space, const Patches& from) {
  return {.vertex = list_view(space, "drogue::fabric::patch_vertices", from.vertex),
          .message = list_view(space, "drogue::fabric::patch_messages", from.message),
          .first_halo = list_view(space, "drogue::fabric::first_halo", from.first_halo),
          .halo_vertex = list_view(space, "drogue::fabric::halo_vertices", from.halo_vertex),
          .halo_message = list_view(space, "drogue::fabric::halo_messages", from.halo_message),
          .triangles = sliced_ell_views(space, from.triangles),
          .springs = sliced_ell_views(space, from.springs),
          .row = list_view(space, "drogue::fabric::pair_rows", from.row),
          .first_row = list_view(space, "drogue::fabric::first_row", from.first_row),
          .team = from.team,
          .max_halo = from.max_halo,
          .max_triangle_slots = max_slots(from, from.triangles),
          .max_spring_slots = max_slots(from, from.springs)};
}

/// State of a thread's vertex, in registers.
struct OwnVertex {
  int vertex = -1, message = -1;
  Vector3<double> x{}, v{}, load{};
  Vector3<double> v2{}, v3{}, v_now{};  ///< velocities of stages 2 and 3, and of the present stage
  double inverse_mass = 0.0;
  Vector3<double> free{};  ///< 1 for free axes, 0 for pinned ones
};

/// Loads that `PersistentSteps` evaluates in every stage; empty without.
template <class ExecutionSpace, bool loads>
struct PersistentLoads {
  External<ExecutionSpace> external;  ///< only timed loads and pressures are evaluated
  TimeState origin;                   ///< `step` is ignored
};
template <class ExecutionSpace>
struct PersistentLoads<ExecutionSpace, false> {};

/// Many steps of Runge and Kutta's method in one launch: `RungeKuttaFunctor` with the state of a vertex in
/// the registers of a thread and without a barrier across the grid. The positions of a stage follow from the
/// velocities of the stage before, and these from the forces of the stage before that. At the end of stage e
/// a team puts the positions of stage e+2 of vertices that other teams read. It gets those of its halo while
/// it computes stage e+1.
///
/// Two halo buffers, for even and odd stages, suffice without global synchronization. A team that ends stage
/// e has read the messages of all its neighbours for e+1. The neighbours put them after their barrier in
/// stage e-1, when they had read all of stage e. Only neighbours read a message (`Patches`), so the buffer of
/// e is free for e+2. The first two stages of a launch read the state in memory, and none of the messages of
/// an earlier launch are read. A team needs three tables of positions, or two if no thread reads a table
/// after the barrier of its stage.
///
/// `loads`: timed loads and follower pressures are evaluated in every stage.
template <class ExecutionSpace, class VertexForce = NoVertexForce, bool loads = false>
struct PersistentSteps {
  using Points = PointsView<ExecutionSpace>;
  PatchViews<ExecutionSpace> patches;
  FabricViews<ExecutionSpace> fabric;
  Points x, v;
  StepMonitor<ExecutionSpace> monitor;
  double dt;
  std::int64_t previous_steps;  ///< completed before this launch; negative: read `monitor.steps(1)`
  std::int64_t steps;           ///< of this launch, at least 1
  std::uint64_t epoch;          ///< last stage of the previous launch
  VertexForceTerm<VertexForce> vertex_force;
  PersistentLoads<ExecutionSpace, loads> load;

  /// Steps completed before this launch. A captured launch reads them on the device.
  KOKKOS_FUNCTION std::int64_t steps_before() const {
    return previous_steps >= 0 ? previous_steps : monitor.steps(1);
  }

  /// Tables of a team's positions in `count` stages.
  struct Tables {
    double* memory;
    int rows, count;
    KOKKOS_FUNCTION TeamTable operator()(int turn) const { return {memory + turn * 3 * rows, rows}; }
  };
  [[nodiscard]] static std::size_t tables_bytes(const PatchViews<ExecutionSpace>& patches, int count) {
    return 3 * static_cast<std::size_t>(count * (patches.team + patches.max_halo)) * sizeof(double);
  }

  /// Halo of a team and the share of a thread: its first halo vertex and the message of that vertex.
  struct Halo {
    int first, count, rank, message;
  };

  template <class Member>
  KOKKOS_FUNCTION Halo halo(const Member& member) const {
    const int first = patches.first_halo(member.league_rank()),
              count = patches.first_halo(member.league_rank() + 1) - first,
              rank = member.team_size() - 1 - member.team_rank();  // the last threads have the least work
    return {first, count, rank, rank < count ? patches.halo_message(first + rank) : -1};
  }

  template <class Member>
  KOKKOS_FUNCTION Tables tables(const Member& member, const Halo& halo, int count) const {
    const int rows = patches.team + halo.count;
    return {team_numbers<double>(member, 3 * static_cast<std::size_t>(count * rows)), rows, count};
  }

  /// Loads the thread's vertex, if any, and stores the positions of the first two stages.
  template <class Member>
  KOKKOS_FUNCTION OwnVertex begin(const Member& member, const Halo& halo, const Tables& points) const {
    const Vector3<double> zero{0.0, 0.0, 0.0};
    OwnVertex own;
    const auto store = [&](int number, const Vector3<double>& at, const Vector3<double>& velocity) {
      store_points(points(0), number, at);
      const double part = fraction_after_stage(0) * dt;
      store_points(points(1), number, at + part * velocity);
    };
    if (const int rank = member.team_rank(); rank < patches.team) {
      const int at = member.league_rank() * patches.team + rank;
      own.vertex = patches.vertex(at), own.message = patches.message(at);
      if (own.vertex >= 0) {
        own.x = load_points<double>(x, own.vertex), own.v_now = own.v = load_points<double>(v, own.vertex);
        if (fabric.load.extent(0) > 0) own.load = load_points<double>(fabric.load, own.vertex);
        own.free = free_axes<double>(fabric, own.vertex);
        own.inverse_mass = fabric.inverse_mass(own.vertex);
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

  /// All loads on the thread's vertex in stage `done` at the positions `now` of its team, N.
  template <class Rings>
  KOKKOS_FUNCTION Vector3<double> loads_on(const OwnVertex& own, std::int64_t done, const Rings& rings,
                                           const TeamTable& now, int rank) const {
    Vector3<double> sum = own.load;
    if constexpr (loads) {
      const Vector3<double> rest = load_points<double>(load.external.rest, own.vertex);
      const double t = stepping::stage_time(load.origin, steps_before() + done / 4,
                                            fraction_before_stage(static_cast<int>(done % 4)));
      sum = load.external.with_timed_loads(sum, own.vertex, rest, t);
      if (load.external.has_pressure())
        sum = sum +
              (load.external.pressure_at(own.vertex, rest, t) / 6.0) * twice_area_vector(rings, now, rank);
    }
    return sum;
  }

  /// Ends stage `done` of this launch at position `at`, m, under `elastic` and `loaded` forces, N: puts the
  /// position of the next stage but one and stores it in `points`.
  template <class Member>
  KOKKOS_FUNCTION void end_stage(const Member& member, OwnVertex& own, std::int64_t done,
                                 const Vector3<double>& elastic, const Vector3<double>& loaded,
                                 const Vector3<double>& at, const TeamTable& points) const {
    const int stage = static_cast<int>(done % 4);
    Vector3<double> force = elastic + loaded;
    if constexpr (has_vertex_force<VertexForce>)
      force = vertex_force.add_to(force, at, own.v_now, &own.inverse_mass, own.vertex,
                                  steps_before() + done / 4, fraction_before_stage(stage));
    const Vector3<double> a = acceleration(fabric, force, own.inverse_mass, own.v_now, own.free);
    Vector3<double> position;
    if (stage == 3) {
      own.v = own.v_now = end_velocity(dt, own.v, own.v2, own.v3, own.v_now, a);
      position = own.x + (fraction_after_stage(0) * dt) * own.v;
    } else {
      const Vector3<double> velocity = own.v + (fraction_after_stage(stage) * dt) * a;
      if (stage == 2)
        position = own.x = end_position(dt, own.x, own.v, own.v2, own.v3, velocity);
      else
        position = own.x + (fraction_after_stage(stage + 1) * dt) * velocity;
      if (stage == 0) own.v2 = velocity;
      if (stage == 1) own.v3 = velocity;
      own.v_now = velocity;
    }
    // A message without readers would replace one that a neighbour may still have to read.
    if (own.message >= 0 && done + 2 < 4 * steps)
      member.put(epoch_after(done), static_cast<std::size_t>(own.message),
                 {{position.x, position.y, position.z}});
    store_points(points, member.team_rank(), position);
    // After the message, which other teams wait for.
    if (stage == 3) record_divergence(monitor, steps_before() + done / 4 + 1, own.vertex, own.x, own.v);
  }

  /// Gets the positions of the halo that its teams put at the end of stage `done` and stores them in
  /// `points`.
  template <class Member>
  KOKKOS_FUNCTION void get_halo(const Member& member, const Halo& halo, std::int64_t done,
                                const TeamTable& points) const {
    int message = halo.message;
    for (int k = halo.rank; k < halo.count; k += member.team_size()) {
      if (k > halo.rank) message = patches.halo_message(halo.first + k);
      const device::HaloValue other = member.get(epoch_after(done), static_cast<std::size_t>(message));
      store_points(points, patches.team + k, Vector3<double>{other.value[0], other.value[1], other.value[2]});
    }
  }
  KOKKOS_FUNCTION std::uint64_t epoch_after(std::int64_t done) const {
    return epoch + 1 + static_cast<std::uint64_t>(done);
  }

  /// Takes all steps. `force(points, done, arrive)` returns the elastic force on the thread's vertex in stage
  /// `done`, N, and calls `arrive`, which gets the positions of the next stage and is a team barrier. `rings`
  /// are the slots of the team's triangles, which loads read.
  template <class Member, class Rings, class Force>
  KOKKOS_FUNCTION void run(const Member& member, const Halo& halo, const Tables& points, OwnVertex& own,
                           const Rings& rings, const Force& force) const {
    const std::int64_t stages = 4 * steps;
    int now = 0;  // table
    for (std::int64_t done = 0; done < stages; ++done) {
      const int last = points.count - 1, next = now == last ? 0 : now + 1, then = next == last ? 0 : next + 1;
      Vector3<double> loaded = own.load, at = own.x;
      if constexpr (loads || has_vertex_force<VertexForce>) {
        // Before the barrier of the stage, after which a table may be overwritten.
        if (own.vertex >= 0) {
          loaded = loads_on(own, done, rings, points(now), member.team_rank());
          at = load_points<double>(points(now), member.team_rank());
        }
      }
      const Vector3<double> elastic = force(points(now), done, [&] {
        if (done > 0 && done + 1 < stages) get_halo(member, halo, done - 1, points(next));
        member.team_barrier();
      });
      if (own.vertex >= 0) end_stage(member, own, done, elastic, loaded, at, points(then));
      now = next;
    }
    if (own.vertex < 0) return;
    store_points(x, own.vertex, own.x);
    store_points(v, own.vertex, own.v);
    if (own.vertex == 0) monitor.steps(0) = steps_before() + steps;
  }
};

}  // namespace drogue::fabric
