#pragma once

#include "kernels/options/batch/price_batch.hpp"

/// Prices for all strikes of one process and maturity, a strike group, from one solve. V(c spot, c strike) =
/// c V, so a solve for strike 1 contains them at x = ln(spot/strike).
namespace drogue::options {

/// Data of a solved strike group without its node values.
struct StrikeGroup {
  MemberGrid fine, coarse;
  ErrorEstimate<double> estimate;
  double window;  ///< half width in x of the interval around a strike whose largest difference of the two
                  ///< solves estimates the error
};

/// Node values of a strike group: V and dV/dtau on the finer grid, then on the coarser one.
struct StrikeGroupNodes {
  double* first;
  int mesh;  ///< of the finer grid

  [[nodiscard]] KOKKOS_INLINE_FUNCTION static std::size_t size(int mesh) {
    return static_cast<std::size_t>(2 * (mesh + 1) + 2 * (mesh / 2 + 1));
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double* fine() const { return first; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double* coarse() const { return first + 2 * (mesh + 1); }
};

/// Solves strike groups of one model on one mesh in one launch: one per team on devices, a pack on hosts.
/// Strike group k has the parameters of contract k of the batch, whose strike is not used. For `fixed` see
/// `march_nodes`.
template <class ExecutionSpace, int fixed, JumpClass jump_class>
struct StrikeGroupFunctor {
  using Batch = PriceBatch<ExecutionSpace>;
  using R = typename Batch::R;
  using Space = typename Batch::Space;
  using Scratch = SolveMemory<R, fixed>;
  static constexpr int members = Batch::members;

  Batch batch;                                       ///< its prices are not used
  Kokkos::View<const double*, Space> strike_ranges;  ///< (strike groups): half widths in ln(spot/strike)
  Kokkos::View<StrikeGroup*, Space> strike_groups;   ///< (strike groups)
  Kokkos::View<double*, Space> values;               ///< (strike groups, StrikeGroupNodes::size)

  KOKKOS_FORCEINLINE_FUNCTION void operator()(const typename Batch::Member& team) const {
    batch.template price_pack<fixed>(*this, team);
  }

  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION void price(const ThreadGroup& group, const Scratch& memory, int pack) const {
    const int mesh = mesh_for<fixed>(batch.mesh);
    group.each([=, this](int thread) {
      for (int k = thread; k < members; k += group.threads()) {
        const int at = batch.contract_index(pack, k);
        memory.puts[k] = normalize(batch.contracts(at));
        memory.puts[k].log_spot = strike_ranges(at);
      }
    });
    PutPack<R> put = pack_puts<R, jump_class>(memory.puts);
    put.any_split = !group.all(!put.any_split);
    const LevyMeasure<R> measure = make_levy_measure(group, put, memory.puts, batch.panels.data(),
                                                     batch.panel_slot.data(), memory.measure_memory());
    const R deviation = device::square_root((put.variance + measure.variance) * put.maturity);
    const R above = domain_of(group, put, measure, truncation_target(mesh), memory.scratch).above;
    put.log_spot = -put.log_spot;
    const R below = domain_of(group, put, measure, truncation_target(mesh), memory.scratch).below;
    const Grid<R> grid = grid_of(Domain<R>{below, above}, mesh);
    const Tails<R> tails = make_tails(group, put, measure, grid.h * double(mesh));
    const Jumps<R> jumps = jumps_on_grid<fixed>(group, put, measure, tails, grid, memory, memory.w);
    const Grid<R> coarse_grid = coarser(grid);
    write_estimates(group, memory, pack, estimate_solve_error(put, measure, jumps, grid, batch.steps),
                    device::maximum(coarse_grid.h, deviation));
    copy_solution<fixed, false>(
        group, memory, pack, grid,
        march_nodes<fixed>(group, put, jumps, grid, batch.steps, memory, batch.roots));
    const Jumps<R> coarse_jumps = jumps_on_grid<fixed / 2>(group, put, measure, tails, coarse_grid, memory,
                                                           memory.coarse_weights(mesh), memory.w);
    copy_solution<fixed / 2, true>(
        group, memory, pack, coarse_grid,
        march_nodes<fixed / 2>(group, put, coarse_jumps, coarse_grid, batch.steps / 2, memory, batch.roots));
  }

 private:
  /// Writes the error estimates of the pack's members.
  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION void write_estimates(const ThreadGroup& group, const Scratch& memory, int pack,
                                              const ErrorEstimate<R>& estimate, const R& window) const {
    group.each([=, this](int thread) {
      for (int k = thread; k < members; k += group.threads()) {
        if (pack * members + k >= batch.count) continue;
        StrikeGroup& strike_group = strike_groups(batch.contract_index(pack, k));
        strike_group.estimate = estimate_without_premium(estimate, memory.puts[k], k);
        strike_group.window = device::Access<R>::lane(window, k);
      }
    });
  }

  /// Copies the node values and the grid of a march to the strike groups of the pack's members.
  template <int solved, bool coarse, class ThreadGroup>
  KOKKOS_INLINE_FUNCTION void copy_solution(const ThreadGroup& group, const Scratch& memory, int pack,
                                            const Grid<R>& grid, const MarchResult<R>& solution) const {
    const int mesh = grid.mesh;
    group.each([=, this](int thread) {
      for (int k = 0; k < members; ++k) {
        if (pack * members + k >= batch.count) continue;
        const int at = batch.contract_index(pack, k);
        const StrikeGroupNodes nodes = nodes_at(at);
        double* const to = coarse ? nodes.coarse() : nodes.fine();
        for (int i = thread; i <= mesh; i += group.threads()) {
          to[i] = device::Access<R>::lane(solution.value[i], k);
          to[mesh + 1 + i] = device::Access<R>::lane(solution.time_derivative[i], k);
        }
        if (thread == 0)
          (coarse ? strike_groups(at).coarse : strike_groups(at).fine) =
              member_grid<solved>(solution, memory.puts[k], grid, k);
      }
    });
  }

  [[nodiscard]] KOKKOS_INLINE_FUNCTION StrikeGroupNodes nodes_at(int strike_group) const {
    const int mesh = mesh_for<fixed>(batch.mesh);
    return {values.data() + static_cast<std::size_t>(strike_group) * StrikeGroupNodes::size(mesh), mesh};
  }
};

/// Enqueues the solves of strike groups of one model; asynchronous.
template <class ExecutionSpace>
void solve_strike_groups(const ExecutionSpace& space,
                         StrikeGroupFunctor<ExecutionSpace, 0, JumpClass::any> work) {
  static_assert(
      Kokkos::SpaceAccessibility<ExecutionSpace, typename decltype(work.values)::memory_space>::accessible);
  // On devices other meshes are solved in memory by whole warps.
  if (work.batch.mesh == 128) work.batch.lanes = lanes_of(work.batch.mesh);
  if constexpr (!device::is_host<ExecutionSpace>) {
    const auto launch = [&]<int fixed> {
      return dispatch_jump_class(work.batch.model, [&]<JumpClass jump_class> {
        launch_batch<fixed>(space, "drogue::options::solve strike groups in registers",
                            StrikeGroupFunctor<ExecutionSpace, fixed, jump_class>{
                                work.batch, work.strike_ranges, work.strike_groups, work.values});
      });
    };
    if (work.batch.mesh == 128) return launch.template operator()<128>();
    if (work.batch.mesh == 256) return launch.template operator()<256>();
  }
  launch_batch<0>(space, "drogue::options::solve strike groups", work);
}

/// Request for the price of a strike of a solved strike group.
struct StrikeQuery {
  int strike_group;
  double spot, strike;
};

/// Interpolates the prices of strikes from solved strike groups, one thread per price.
template <class ExecutionSpace>
struct InterpolationFunctor {
  using Space = typename ExecutionSpace::memory_space;

  Kokkos::View<const Contract*, Space> contracts;         ///< (strike groups)
  Kokkos::View<const StrikeGroup*, Space> strike_groups;  ///< (strike groups)
  Kokkos::View<double*, Space> values;                    ///< (strike groups, StrikeGroupNodes::size)
  Kokkos::View<const StrikeQuery*, Space> queries;        ///< (queries)
  Kokkos::View<Price*, Space> prices;                     ///< (queries)
  int mesh, steps;
  double tolerance;

  KOKKOS_FUNCTION void operator()(int k) const {
    const StrikeQuery& query = queries(k);
    Contract contract = contracts(query.strike_group);
    contract.spot = query.spot;
    contract.strike = query.strike;
    const NormalizedPut put = normalize(contract);
    const StrikeGroup& strike_group = strike_groups(query.strike_group);
    const StrikeGroupNodes nodes{
        values.data() + static_cast<std::size_t>(query.strike_group) * StrikeGroupNodes::size(mesh), mesh};
    const MemberValues fine{nodes.fine(), 1}, coarse{nodes.coarse(), 1};
    const SolutionAtSpot solution =
        solution_at_spot(put, fine, {nodes.fine() + mesh + 1, 1}, strike_group.fine);
    const SolutionAtSpot rough_solution =
        solution_at_spot(put, coarse, {nodes.coarse() + mesh / 2 + 1, 1}, strike_group.coarse);
    const double largest = largest_difference(put, fine, coarse, strike_group);
    prices(k) = price_of(contract, put, solution, rough_solution, strike_group.estimate, largest,
                         strike_group.coarse.h, mesh, steps, tolerance);
  }

 private:
  /// Largest difference of the two solves at their common nodes near x, as for a separate price.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double largest_difference(const NormalizedPut& put,
                                                                 const MemberValues& fine,
                                                                 const MemberValues& coarse,
                                                                 const StrikeGroup& strike_group) const {
    const double h = strike_group.coarse.h, place = put.log_spot / h + strike_group.coarse.strike,
                 wide = strike_group.window / h;
    const double last = mesh / 2 - 1.0;
    if (!(wide < 1e9)) return device::portable::not_a_number();
    const int begin =
                  static_cast<int>(device::maximum(0.0, device::minimum(last, Kokkos::ceil(place - wide)))),
              end =
                  static_cast<int>(device::maximum(0.0, device::minimum(last, Kokkos::floor(place + wide))));
    double largest = 0.0;
    for (int i = begin; i <= end; ++i) {
      const double one = device::absolute(fine(2 * i) - coarse(i));
      largest = one > largest || one != one ? one : largest;
    }
    return largest;
  }
};

/// Enqueues the interpolation of `count` prices; asynchronous.
template <class ExecutionSpace>
void interpolate_prices(const ExecutionSpace& space, const InterpolationFunctor<ExecutionSpace>& work,
                        int count) {
  static_assert(
      Kokkos::SpaceAccessibility<ExecutionSpace, typename decltype(work.prices)::memory_space>::accessible);
  if (count == 0) return;
  Kokkos::parallel_for("drogue::options::interpolate prices",
                       Kokkos::RangePolicy<ExecutionSpace>(space, 0, count), work);
}

}  // namespace drogue::options
