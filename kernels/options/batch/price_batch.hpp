#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/options/pide/price.hpp"
#include "kernels/options/pide/solve.hpp"
#include "kernels/options/pricer.hpp"

namespace drogue::options {

/// The larger of two; not a number if one of them is none.
template <class R>
KOKKOS_INLINE_FUNCTION R larger(R a, R b) {
  return device::select(b >= b, device::select(b > a, b, a), b);
}

/// What is known of the puts of a group before the first step.
template <class R>
struct Prepared {
  PutPack<R> put;
  LevyMeasure<R> law;
  Grid<R> grid;  ///< the finer one
  Tails<R> tails;
  Jumps<R> jumps;  ///< on it
};

/// The number that a thread of `ExecutionSpace` computes with: one option's, or on hosts several options'.
template <class ExecutionSpace>
using Number = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;

/// Contracts order(0), order(1), ... of one model, priced on one mesh in one launch by a team for one or two
/// of them, or on hosts for each pack of them.
template <class ExecutionSpace>
struct PriceBatch {
  using Space = typename ExecutionSpace::memory_space;
  using R = Number<ExecutionSpace>;
  using Member = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;
  static constexpr int members = device::Access<R>::lanes;

  Kokkos::View<const Contract*, Space> contracts;  ///< (batch)
  Kokkos::View<Price*, Space> prices;              ///< (batch)
  Kokkos::View<const int*, Space> order;           ///< (count)
  Kokkos::View<const double*, Space> panels;       ///< (panels, HankelGrid::panel_size)
  Kokkos::View<const int*, Space> panel_slot;      ///< (HankelGrid::panels)
  FourierRoots roots{};                            ///< in the memory of the backend
  Record record{};                                 ///< of the only contract, if at all
  int count = 0, mesh = 0, steps = 0, level = 0;
  int lanes = most_lanes;  ///< of an option on hosts
  double tolerance = 0.0;
  Model model{};             ///< of all contracts
  bool split = false;        ///< exercise is, wherever it pays
  bool single_grid = false;  ///< no second solve: the price is not extrapolated and has no error

  /// Groups, of an option or of a pack of them, that a team prices side by side.
  static KOKKOS_INLINE_FUNCTION constexpr int groups(int fixed) {
    return device::is_host<ExecutionSpace> ? 1 : most_lanes / lanes_of(fixed);
  }

  /// Calls `functor.price` with the workers and the memory of a group. For `fixed` see `solve`.
  template <int fixed, class Functor>
  KOKKOS_FORCEINLINE_FUNCTION void price_group(const Functor& functor, const Member& team) const {
    using Scratch = Memory<R, fixed>;
    const std::size_t bytes = Scratch::bytes(mesh);
    void* place = team.team_scratch(level).get_shmem_aligned(groups(fixed) * bytes, 64);
    if constexpr (fixed > 0) place = device::in_shared_memory(place);
    if constexpr (members == 1 && !device::is_host<ExecutionSpace>) {
      constexpr int width = lanes_of(fixed);
      const int rank = static_cast<int>(team.team_rank()), own = rank / width;
      functor.price(WarpWorkers<width>(rank), Scratch(static_cast<std::byte*>(place) + own * bytes, mesh),
                    team.league_rank() * groups(fixed) + own);
    } else {
      functor.price(SerialWorkers<R>{lanes}, Scratch(place, mesh), team.league_rank());
    }
  }

  /// The contract of member k of a group; the last group repeats the last contract.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int place(int group, int k) const {
    const int at = group * members + k;
    return order(at < count ? at : count - 1);
  }

  /// Prices the contracts of a group. A call would keep all that it is told in memory.
  template <JumpClass jump_class, int fixed, class ThreadGroup>
  KOKKOS_FORCEINLINE_FUNCTION void price(const ThreadGroup& workers, const Memory<R, fixed>& memory,
                                         int group) const {
    const Prepared<R> prepared = prepare<jump_class>(workers, memory, group);
    const ErrorEstimate<R> doubt =
        doubt_of_solve(prepared.put, prepared.law, prepared.jumps, prepared.grid, steps);
    solve_fine(workers, prepared, memory);
    const R* coarse = single_grid ? memory.kept(prepared.grid.mesh) : solve_coarse(workers, prepared, memory);
    conclude(workers, prepared, doubt, memory, coarse, memory, group);
  }

  /// What both solves need, and the weights of the finer one.
  template <JumpClass jump_class, int fixed, class ThreadGroup>
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION Prepared<R> prepare(const ThreadGroup& workers,
                                                                const Memory<R, fixed>& memory,
                                                                int group) const {
    const int cells = mesh_for<fixed>(mesh);
    workers.each([=, this](int thread) {
      for (int k = thread; k < members; k += workers.threads()) {
        memory.puts[k] = normalize(contracts(place(group, k)));
        if (split) memory.puts[k].split = memory.puts[k].early;
      }
    });
    Prepared<R> prepared;
    prepared.put = pack_puts<R, jump_class>(memory.puts);
    PutPack<R>& put = prepared.put;
    put.any_split = !workers.all(!put.any_split);
    prepared.law =
        make_levy_measure(workers, put, memory.puts, panels.data(), panel_slot.data(), memory.law_memory());
    const LevyMeasure<R>& law = prepared.law;
    prepared.grid = grid_of(domain_of(workers, put, law, cut_error(cells), memory.slot), cells);
    prepared.tails = make_tails(workers, put, law, prepared.grid.h * double(cells));
    prepared.jumps = jumps_on<fixed>(workers, put, law, prepared.tails, prepared.grid, memory, memory.w);
    return prepared;
  }

  /// Leaves answers and every other value in the memory.
  template <int fixed, class ThreadGroup>
  KOKKOS_FORCEINLINE_FUNCTION void solve_fine(const ThreadGroup& workers, const Prepared<R>& prepared,
                                              const Memory<R, fixed>& memory) const {
    const int cells = mesh_for<fixed>(prepared.grid.mesh);
    const Solution<R> fine = solve<fixed>(workers, prepared.put, prepared.jumps, prepared.grid, steps, memory,
                                          roots, memory.answers, record);
    R* const kept = memory.kept(cells);
    workers.each([=](int thread) {
      for (int i = thread; i < cells / 2; i += workers.threads()) kept[i] = fine.value[2 * i];
    });
  }

  /// Returns the values; leaves answers in the memory.
  template <int fixed, class ThreadGroup>
  KOKKOS_FORCEINLINE_FUNCTION const R* solve_coarse(const ThreadGroup& workers, const Prepared<R>& prepared,
                                                    const Memory<R, fixed>& memory) const {
    const Grid<R> grid = coarser(prepared.grid);
    const R* value = nullptr;
    // Where exercise has to be split off, once more without it before: the premium tells what that misses.
    for (int exercise = prepared.put.any_split && knows_premium() ? 0 : 1; exercise < 2; ++exercise) {
      const PutPack<R> put = with_exercise(prepared.put, exercise != 0);
      const Jumps<R> jumps =
          jumps_on<fixed / 2>(workers, put, prepared.law, prepared.tails, grid, memory,
                              memory.coarse_weights(mesh_for<fixed>(prepared.grid.mesh)), memory.w);
      value = solve<fixed / 2>(workers, put, jumps, grid, steps / 2, memory, roots, memory.answers + members)
                  .value;
      if (exercise == 0)
        workers.each([=, &memory](int thread) {
          for (int k = thread; k < members; k += workers.threads())
            memory.unexercised[k] = beside_spot(memory.puts[k], grid, value, k);
        });
    }
    return value;
  }

  /// Puts the prices together. `coarse` are the values that `solve_coarse` has returned, whose memory was
  /// `other`.
  template <int fixed, class ThreadGroup>
  KOKKOS_FORCEINLINE_FUNCTION void conclude(const ThreadGroup& workers, const Prepared<R>& prepared,
                                            const ErrorEstimate<R>& doubt, const Memory<R, fixed>& memory,
                                            const R* coarse, const Memory<R, fixed>& other, int group) const {
    const PutPack<R>& put = prepared.put;
    const int cells = mesh_for<fixed>(prepared.grid.mesh);
    const Grid<R> grid = coarser(prepared.grid);
    const R* const kept = memory.kept(cells);
    const SolutionAtSpot* const coarse_answers = single_grid ? memory.answers : other.answers + members;
    const R deviation = device::square_root((put.variance + prepared.law.variance) * put.maturity);
    const R window = device::maximum(grid.h, deviation);
    const auto largest_change = [=, &put](int lane) {
      Kokkos::Array<R, 1> largest = {R(0.0)};
      for (int i = lane; i < cells / 2; i += workers.lanes) {
        const auto near = device::absolute((double(i) - grid.strike) * grid.h - put.log_spot) <= window;
        largest[0] = larger(largest[0], device::select(near, device::absolute(kept[i] - coarse[i]), R(0.0)));
      }
      return largest;
    };
    const R largest = workers.reduce(largest_change, [](const R& a, const R& b) { return larger(a, b); })[0];
    workers.each([=, this, &memory, &other](int thread) {
      for (int k = thread; k < members; k += workers.threads()) {
        if (group * members + k >= count) continue;
        const int at = place(group, k);
        const auto own = [k](const R& number) { return device::Access<R>::lane(number, k); };
        const NormalizedPut& one = memory.puts[k];
        ErrorEstimate<double> known = doubt_without_premium(doubt, one, k);
        if (knows_premium() && one.split) {
          const double premium = beside_spot(one, grid, coarse, k) - other.unexercised[k];
          known = {own(doubt.factor),
                   own(doubt.gap) + doubt_of_splitting(premium, cells, steps, own(largest)),
                   own(doubt.variance)};
        }
        prices(at) = price_of(contracts(at), one, memory.answers[k], coarse_answers[k], known, own(largest),
                              own(grid.h), cells, steps, tolerance);
        if (single_grid) prices(at).error = device::portable::not_a_number();
      }
    });
  }

 private:
  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool knows_premium() const { return !split && !single_grid; }

  /// The value of member k at the node next to its spot.
  [[nodiscard]] static KOKKOS_INLINE_FUNCTION double beside_spot(const NormalizedPut& put,
                                                                 const Grid<R>& grid, const R* nodes, int k) {
    const auto own = [k](const R& number) { return device::Access<R>::lane(number, k); };
    return column_of(nodes, k)(node_beside(put, own(grid.strike), own(grid.h), grid.mesh));
  }
};

/// Where a team's memory is: in that of its multiprocessor, if Kokkos has so much for a team, else (and on
/// hosts) beside.
template <class ExecutionSpace>
[[nodiscard]] int scratch_level(int mesh) {
  const auto most_shared = static_cast<std::size_t>(Kokkos::TeamPolicy<ExecutionSpace>::scratch_size_max(0));
  const bool shared =
      !device::is_host<ExecutionSpace> && Memory<Number<ExecutionSpace>, 0>::bytes(mesh) + 64 <= most_shared;
  return shared ? 0 : 1;
}

/// Enqueues `functor`, which prices its batch by teams of a warp each, or of several for an option.
template <int fixed, int warps = 1, class ExecutionSpace, class Functor>
void launch_batch(const ExecutionSpace& space, const char* label, const Functor& functor) {
  using Batch = PriceBatch<ExecutionSpace>;
  const Batch& batch = functor.batch;
  if (batch.count == 0) return;
  // Teams that share a multiprocessor: of their warps as many as registers for the nodes allow without
  // spilling.
  constexpr unsigned teams = fixed == 0 ? 1 : (fixed < 128 ? 12 : 8) / warps;
  using Bounds =
      std::conditional_t<fixed == 0, Kokkos::LaunchBounds<>, Kokkos::LaunchBounds<warps * most_lanes, teams>>;
  constexpr int groups = warps > 1 ? 1 : Batch::groups(fixed), options = Batch::members * groups;
  const int league = (batch.count + options - 1) / options;
  Kokkos::TeamPolicy<ExecutionSpace, Bounds> policy(space, league,
                                                    device::is_host<ExecutionSpace> ? 1 : warps * most_lanes);
  policy.set_scratch_size(
      batch.level,
      Kokkos::PerTeam(warps * groups * Memory<typename Batch::R, fixed>::bytes(batch.mesh) + 64));
  Kokkos::parallel_for(label, policy, functor);
}

}  // namespace drogue::options
