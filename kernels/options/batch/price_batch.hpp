#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/options/pide/price.hpp"
#include "kernels/options/pide/solve.hpp"
#include "kernels/options/pricer.hpp"

namespace drogue::options {

/// Maximum of two values; NaN if one of them is NaN.
template <class R>
KOKKOS_INLINE_FUNCTION R maximum_or_nan(R a, R b) {
  return device::select(b >= b, device::select(b > a, b, a), b);
}

/// Data of a pack before the first step.
template <class R>
struct PreparedPack {
  PutPack<R> put;
  LevyMeasure<R> measure;
  Grid<R> grid;  ///< finer grid
  Tails<R> tails;
  Jumps<R> jumps;  ///< on `grid`
};

/// Arithmetic type of a thread of `ExecutionSpace`: one option on devices, a pack of options on hosts.
template <class ExecutionSpace>
using Number = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;

/// Contracts order(0), order(1), ... of one model, priced on one mesh in one launch. On devices a team prices
/// one or two contracts, on hosts a pack.
template <class ExecutionSpace>
struct PriceBatch {
  using Space = typename ExecutionSpace::memory_space;
  using R = Number<ExecutionSpace>;
  using Member = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;
  static constexpr int members = device::Access<R>::lanes;

  Kokkos::View<const Contract*, Space> contracts;  ///< (batch): all contracts of the caller
  Kokkos::View<Price*, Space> prices;              ///< (batch)
  Kokkos::View<const int*, Space> order;           ///< (count): indices of the contracts to price
  Kokkos::View<const double*, Space> panels;       ///< (panels, HankelGrid::panel_size)
  Kokkos::View<const int*, Space> panel_slot;      ///< (HankelGrid::panels)
  FourierRoots roots{};                            ///< in the memory of the backend
  MarchRecord record{};                            ///< only for batches of one contract
  int count = 0, mesh = 0, steps = 0, level = 0;
  int lanes = max_lanes;  ///< per option on hosts
  double tolerance = 0.0;
  JumpModel model{};         ///< common model of the contracts
  bool split = false;        ///< use split exercise wherever exercise may pay
  bool single_grid = false;  ///< no second solve: no extrapolation and no error estimate

  /// Packs, or single options on devices, that a team prices side by side.
  static KOKKOS_INLINE_FUNCTION constexpr int packs_per_team(int fixed) {
    return device::is_host<ExecutionSpace> ? 1 : max_lanes / lanes_of(fixed);
  }

  /// Calls `functor.price` with a thread group, its memory and the index of its pack. For `fixed` see
  /// `solve`.
  template <int fixed, class Functor>
  KOKKOS_FORCEINLINE_FUNCTION void price_pack(const Functor& functor, const Member& team) const {
    using Scratch = SolveMemory<R, fixed>;
    const std::size_t bytes = Scratch::bytes(mesh);
    void* place = team.team_scratch(level).get_shmem_aligned(packs_per_team(fixed) * bytes, 64);
    if constexpr (fixed > 0) place = device::in_shared_memory(place);
    if constexpr (members == 1 && !device::is_host<ExecutionSpace>) {
      constexpr int width = lanes_of(fixed);
      const int rank = static_cast<int>(team.team_rank()), own = rank / width;
      functor.price(WarpThreadGroup<width>(rank), Scratch(static_cast<std::byte*>(place) + own * bytes, mesh),
                    team.league_rank() * packs_per_team(fixed) + own);
    } else {
      functor.price(SerialThreadGroup<R>{lanes}, Scratch(place, mesh), team.league_rank());
    }
  }

  /// Index of the contract of member k of a pack; the last pack is filled up with the last contract.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int contract_index(int pack, int k) const {
    const int at = pack * members + k;
    return order(at < count ? at : count - 1);
  }

  /// Prices the contracts of a pack. Force-inlined: a call would spill its arguments.
  template <JumpClass jump_class, int fixed, class ThreadGroup>
  KOKKOS_FORCEINLINE_FUNCTION void price(const ThreadGroup& group, const SolveMemory<R, fixed>& memory,
                                         int pack) const {
    const PreparedPack<R> prepared = prepare<jump_class>(group, memory, pack);
    const ErrorEstimate<R> estimate =
        estimate_solve_error(prepared.put, prepared.measure, prepared.jumps, prepared.grid, steps);
    solve_fine(group, prepared, memory);
    const R* coarse =
        single_grid ? memory.fine_values(prepared.grid.mesh) : solve_coarse(group, prepared, memory);
    write_prices(group, prepared, estimate, memory, coarse, memory, pack);
  }

  /// Computes the data of both solves and the weights of the finer grid.
  template <JumpClass jump_class, int fixed, class ThreadGroup>
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION PreparedPack<R> prepare(const ThreadGroup& group,
                                                                    const SolveMemory<R, fixed>& memory,
                                                                    int pack) const {
    const int intervals = mesh_for<fixed>(mesh);
    group.each([=, this](int thread) {
      for (int k = thread; k < members; k += group.threads()) {
        memory.puts[k] = normalize(contracts(contract_index(pack, k)));
        if (split) memory.puts[k].split = memory.puts[k].early;
      }
    });
    PreparedPack<R> prepared;
    prepared.put = pack_puts<R, jump_class>(memory.puts);
    PutPack<R>& put = prepared.put;
    put.any_split = !group.all(!put.any_split);
    prepared.measure =
        make_levy_measure(group, put, memory.puts, panels.data(), panel_slot.data(), memory.measure_memory());
    const LevyMeasure<R>& measure = prepared.measure;
    prepared.grid =
        grid_of(domain_of(group, put, measure, truncation_target(intervals), memory.scratch), intervals);
    prepared.tails = make_tails(group, put, measure, prepared.grid.h * double(intervals));
    prepared.jumps =
        jumps_on_grid<fixed>(group, put, measure, prepared.tails, prepared.grid, memory, memory.w);
    return prepared;
  }

  /// Solves on the finer grid; leaves the solutions at the spots and every second value in the memory.
  template <int fixed, class ThreadGroup>
  KOKKOS_FORCEINLINE_FUNCTION void solve_fine(const ThreadGroup& group, const PreparedPack<R>& prepared,
                                              const SolveMemory<R, fixed>& memory) const {
    const int intervals = mesh_for<fixed>(prepared.grid.mesh);
    const MarchResult<R> fine = solve<fixed>(group, prepared.put, prepared.jumps, prepared.grid, steps,
                                             memory, roots, memory.solutions, record);
    R* const fine_values = memory.fine_values(intervals);
    group.each([=](int thread) {
      for (int i = thread; i < intervals / 2; i += group.threads()) fine_values[i] = fine.value[2 * i];
    });
  }

  /// Solves on the coarser grid; leaves the solutions at the spots in the memory. Returns the values at the
  /// nodes.
  template <int fixed, class ThreadGroup>
  KOKKOS_FORCEINLINE_FUNCTION const R* solve_coarse(const ThreadGroup& group, const PreparedPack<R>& prepared,
                                                    const SolveMemory<R, fixed>& memory) const {
    const Grid<R> grid = coarser(prepared.grid);
    const R* value = nullptr;
    // For split exercise the coarser grid is first solved without exercise, since the premium bounds the
    // splitting error.
    for (int exercise = prepared.put.any_split && has_premium() ? 0 : 1; exercise < 2; ++exercise) {
      const PutPack<R> put = with_exercise(prepared.put, exercise != 0);
      const Jumps<R> jumps =
          jumps_on_grid<fixed / 2>(group, put, prepared.measure, prepared.tails, grid, memory,
                                   memory.coarse_weights(mesh_for<fixed>(prepared.grid.mesh)), memory.w);
      value = solve<fixed / 2>(group, put, jumps, grid, steps / 2, memory, roots, memory.solutions + members)
                  .value;
      if (exercise == 0)
        group.each([=, &memory](int thread) {
          for (int k = thread; k < members; k += group.threads())
            memory.european_values[k] = value_near_spot(memory.puts[k], grid, value, k);
        });
    }
    return value;
  }

  /// Writes the prices. `coarse` is the result of `solve_coarse`, and `other` its memory.
  template <int fixed, class ThreadGroup>
  KOKKOS_FORCEINLINE_FUNCTION void write_prices(const ThreadGroup& group, const PreparedPack<R>& prepared,
                                                const ErrorEstimate<R>& estimate,
                                                const SolveMemory<R, fixed>& memory, const R* coarse,
                                                const SolveMemory<R, fixed>& other, int pack) const {
    const PutPack<R>& put = prepared.put;
    const int intervals = mesh_for<fixed>(prepared.grid.mesh);
    const Grid<R> grid = coarser(prepared.grid);
    const R* const fine_values = memory.fine_values(intervals);
    const SolutionAtSpot* const coarse_solutions = single_grid ? memory.solutions : other.solutions + members;
    const R deviation = device::square_root((put.variance + prepared.measure.variance) * put.maturity);
    const R window = device::maximum(grid.h, deviation);
    const auto largest_difference = [=, &put](int lane) {
      Kokkos::Array<R, 1> largest = {R(0.0)};
      for (int i = lane; i < intervals / 2; i += group.lanes) {
        const auto near = device::absolute((double(i) - grid.strike) * grid.h - put.log_spot) <= window;
        largest[0] = maximum_or_nan(
            largest[0], device::select(near, device::absolute(fine_values[i] - coarse[i]), R(0.0)));
      }
      return largest;
    };
    const R largest =
        group.reduce(largest_difference, [](const R& a, const R& b) { return maximum_or_nan(a, b); })[0];
    group.each([=, this, &memory, &other](int thread) {
      for (int k = thread; k < members; k += group.threads()) {
        if (pack * members + k >= count) continue;
        const int at = contract_index(pack, k);
        const auto own = [k](const R& number) { return device::Access<R>::lane(number, k); };
        const NormalizedPut& one = memory.puts[k];
        ErrorEstimate<double> applied = estimate_without_premium(estimate, one, k);
        if (has_premium() && one.split) {
          const double premium = value_near_spot(one, grid, coarse, k) - other.european_values[k];
          applied = {own(estimate.factor),
                     own(estimate.offset) + splitting_error(premium, intervals, steps, own(largest)),
                     own(estimate.variance)};
        }
        prices(at) = price_of(contracts(at), one, memory.solutions[k], coarse_solutions[k], applied,
                              own(largest), own(grid.h), intervals, steps, tolerance);
        if (single_grid) prices(at).error = device::portable::not_a_number();
      }
    });
  }

 private:
  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool has_premium() const { return !split && !single_grid; }

  /// Value of member k at the node next to its spot.
  [[nodiscard]] static KOKKOS_INLINE_FUNCTION double value_near_spot(const NormalizedPut& put,
                                                                     const Grid<R>& grid, const R* nodes,
                                                                     int k) {
    const auto own = [k](const R& number) { return device::Access<R>::lane(number, k); };
    return member_values(nodes, k)(nearest_node(put, own(grid.strike), own(grid.h), grid.mesh));
  }
};

/// Kokkos scratch level of a team's memory: 0, shared memory, on devices if it is large enough, else 1.
template <class ExecutionSpace>
[[nodiscard]] int scratch_level(int mesh) {
  const auto shared_limit = static_cast<std::size_t>(Kokkos::TeamPolicy<ExecutionSpace>::scratch_size_max(0));
  const bool shared = !device::is_host<ExecutionSpace> &&
                      SolveMemory<Number<ExecutionSpace>, 0>::bytes(mesh) + 64 <= shared_limit;
  return shared ? 0 : 1;
}

/// Enqueues `functor` for its batch, with teams of a warp, or of `warps` warps per option.
template <int fixed, int warps = 1, class ExecutionSpace, class Functor>
void launch_batch(const ExecutionSpace& space, const char* label, const Functor& functor) {
  using Batch = PriceBatch<ExecutionSpace>;
  const Batch& batch = functor.batch;
  if (batch.count == 0) return;
  // Teams per multiprocessor: as many warps as fit into the registers without spilling. Clang 15 gives up the
  // kernels of all meshes with the registers of a larger team ("unhandled SGPR spill to memory").
  constexpr unsigned teams = fixed == 0 ? 1 : (fixed < 128 ? 12 : 8) / warps;
  using Bounds = Kokkos::LaunchBounds<warps * max_lanes, teams>;
  constexpr int packs = warps > 1 ? 1 : Batch::packs_per_team(fixed), options = Batch::members * packs;
  const int league = (batch.count + options - 1) / options;
  Kokkos::TeamPolicy<ExecutionSpace, Bounds> policy(space, league,
                                                    device::is_host<ExecutionSpace> ? 1 : warps * max_lanes);
  policy.set_scratch_size(
      batch.level,
      Kokkos::PerTeam(warps * packs * SolveMemory<typename Batch::R, fixed>::bytes(batch.mesh) + 64));
  Kokkos::parallel_for(label, policy, functor);
}

}  // namespace drogue::options
