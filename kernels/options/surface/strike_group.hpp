#pragma once

#include "kernels/options/batch/price_batch.hpp"

/// Prices of all strikes of one law and maturity, a smile, from one solve: V(c spot, c strike) = c V, so a
/// solve for the strike 1 has them at x = ln(spot/strike).
namespace drogue::options {

/// What a solve of a smile leaves beside the values of its nodes.
struct Smile {
  Nodes fine, coarse;
  ErrorEstimate<double> doubt;
  double window;  ///< about a strike in which the largest difference of both solves tells of its error
};

/// The values of a smile's nodes: V and dV/dtau on the fine grid and on the coarse one, one after another.
struct SmileNodes {
  double* first;
  int mesh;  ///< of the fine grid

  [[nodiscard]] KOKKOS_INLINE_FUNCTION static std::size_t size(int mesh) {
    return static_cast<std::size_t>(2 * (mesh + 1) + 2 * (mesh / 2 + 1));
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double* fine() const { return first; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double* coarse() const { return first + 2 * (mesh + 1); }
};

/// Smiles of one model, solved on one mesh in one launch by a team for each, or on hosts for each pack of
/// them: smile k is that of contract k of the batch, whose strike does not matter. For `fixed` see
/// `march_nodes`.
template <class ExecutionSpace, int fixed, JumpClass jump_class>
struct SmileFunctor {
  using Batch = PriceBatch<ExecutionSpace>;
  using R = typename Batch::R;
  using Space = typename Batch::Space;
  using Scratch = Memory<R, fixed>;
  static constexpr int members = Batch::members;

  Batch batch;                                 ///< without prices
  Kokkos::View<const double*, Space> reaches;  ///< (smiles)
  Kokkos::View<Smile*, Space> smiles;          ///< (smiles)
  Kokkos::View<double*, Space> values;         ///< (smiles, SmileNodes::size)

  KOKKOS_FORCEINLINE_FUNCTION void operator()(const typename Batch::Member& team) const {
    batch.template price_group<fixed>(*this, team);
  }

  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION void price(const ThreadGroup& workers, const Scratch& memory, int group) const {
    const int mesh = mesh_for<fixed>(batch.mesh);
    workers.each([=, this](int thread) {
      for (int k = thread; k < members; k += workers.threads()) {
        const int at = batch.place(group, k);
        memory.puts[k] = normalize(batch.contracts(at));
        memory.puts[k].log_spot = reaches(at);
      }
    });
    PutPack<R> put = pack_puts<R, jump_class>(memory.puts);
    put.any_split = !workers.all(!put.any_split);
    const LevyMeasure<R> law = make_levy_measure(workers, put, memory.puts, batch.panels.data(),
                                                 batch.panel_slot.data(), memory.law_memory());
    const R deviation = device::square_root((put.variance + law.variance) * put.maturity);
    const R above = domain_of(workers, put, law, cut_error(mesh), memory.slot).above;
    put.log_spot = -put.log_spot;
    const R below = domain_of(workers, put, law, cut_error(mesh), memory.slot).below;
    const Grid<R> grid = grid_of(Domain<R>{below, above}, mesh);
    const Tails<R> tails = make_tails(workers, put, law, grid.h * double(mesh));
    const Jumps<R> jumps = jumps_on<fixed>(workers, put, law, tails, grid, memory, memory.w);
    const Grid<R> half = coarser(grid);
    note(workers, memory, group, doubt_of_solve(put, law, jumps, grid, batch.steps),
         device::maximum(half.h, deviation));
    keep<fixed, false>(workers, memory, group, grid,
                       march_nodes<fixed>(workers, put, jumps, grid, batch.steps, memory, batch.roots));
    const Jumps<R> wider =
        jumps_on<fixed / 2>(workers, put, law, tails, half, memory, memory.coarse_weights(mesh), memory.w);
    keep<fixed / 2, true>(
        workers, memory, group, half,
        march_nodes<fixed / 2>(workers, put, wider, half, batch.steps / 2, memory, batch.roots));
  }

 private:
  /// Tells the smiles of the pack's members what readings need beside values.
  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION void note(const ThreadGroup& workers, const Scratch& memory, int group,
                                   const ErrorEstimate<R>& doubt, const R& window) const {
    workers.each([=, this](int thread) {
      for (int k = thread; k < members; k += workers.threads()) {
        if (group * members + k >= batch.count) continue;
        Smile& smile = smiles(batch.place(group, k));
        smile.doubt = doubt_without_premium(doubt, memory.puts[k], k);
        smile.window = device::Access<R>::lane(window, k);
      }
    });
  }

  /// Copies what a solve has left to the smiles of the pack's members.
  template <int solved, bool coarse, class ThreadGroup>
  KOKKOS_INLINE_FUNCTION void keep(const ThreadGroup& workers, const Scratch& memory, int group,
                                   const Grid<R>& grid, const Solution<R>& solution) const {
    const int mesh = grid.mesh;
    workers.each([=, this](int thread) {
      for (int k = 0; k < members; ++k) {
        if (group * members + k >= batch.count) continue;
        const int at = batch.place(group, k);
        const SmileNodes nodes = nodes_at(at);
        double* const to = coarse ? nodes.coarse() : nodes.fine();
        for (int i = thread; i <= mesh; i += workers.threads()) {
          to[i] = device::Access<R>::lane(solution.value[i], k);
          to[mesh + 1 + i] = device::Access<R>::lane(solution.change[i], k);
        }
        if (thread == 0)
          (coarse ? smiles(at).coarse : smiles(at).fine) =
              nodes_of<solved>(solution, memory.puts[k], grid, k);
      }
    });
  }

  [[nodiscard]] KOKKOS_INLINE_FUNCTION SmileNodes nodes_at(int smile) const {
    const int mesh = mesh_for<fixed>(batch.mesh);
    return {values.data() + static_cast<std::size_t>(smile) * SmileNodes::size(mesh), mesh};
  }
};

/// Enqueues the solves of smiles of one model.
template <class ExecutionSpace>
void solve_smiles(const ExecutionSpace& space, SmileFunctor<ExecutionSpace, 0, JumpClass::any> work) {
  static_assert(
      Kokkos::SpaceAccessibility<ExecutionSpace, typename decltype(work.values)::memory_space>::accessible);
  // On a device the other meshes are solved in memory, by whole warps.
  if (work.batch.mesh == 128) work.batch.lanes = lanes_of(work.batch.mesh);
  if constexpr (!device::is_host<ExecutionSpace>) {
    const auto launch = [&]<int fixed> {
      return dispatch_jump_class(work.batch.model, [&]<JumpClass jump_class> {
        launch_batch<fixed>(space, "drogue::options::solve smiles in registers",
                            SmileFunctor<ExecutionSpace, fixed, jump_class>{work.batch, work.reaches,
                                                                            work.smiles, work.values});
      });
    };
    if (work.batch.mesh == 128) return launch.template operator()<128>();
    if (work.batch.mesh == 256) return launch.template operator()<256>();
  }
  launch_batch<0>(space, "drogue::options::solve smiles", work);
}

/// A price that is read from a smile.
struct Reading {
  int smile;
  double spot, strike;
};

/// Reads prices of strikes from solved smiles, a thread for each.
template <class ExecutionSpace>
struct ReadSmiles {
  using Space = typename ExecutionSpace::memory_space;

  Kokkos::View<const Contract*, Space> contracts;  ///< (smiles)
  Kokkos::View<const Smile*, Space> smiles;        ///< (smiles)
  Kokkos::View<double*, Space> values;             ///< (smiles, SmileNodes::size)
  Kokkos::View<const Reading*, Space> readings;    ///< (readings)
  Kokkos::View<Price*, Space> prices;              ///< (readings)
  int mesh, steps;
  double tolerance;

  KOKKOS_FUNCTION void operator()(int k) const {
    const Reading& reading = readings(k);
    Contract contract = contracts(reading.smile);
    contract.spot = reading.spot;
    contract.strike = reading.strike;
    const NormalizedPut put = normalize(contract);
    const Smile& smile = smiles(reading.smile);
    const SmileNodes nodes{values.data() + static_cast<std::size_t>(reading.smile) * SmileNodes::size(mesh),
                           mesh};
    const Column fine{nodes.fine(), 1}, coarse{nodes.coarse(), 1};
    const SolutionAtSpot answer = answer_of(put, fine, {nodes.fine() + mesh + 1, 1}, smile.fine);
    const SolutionAtSpot rough = answer_of(put, coarse, {nodes.coarse() + mesh / 2 + 1, 1}, smile.coarse);
    const double largest = largest_change(put, fine, coarse, smile);
    prices(k) =
        price_of(contract, put, answer, rough, smile.doubt, largest, smile.coarse.h, mesh, steps, tolerance);
  }

 private:
  /// The largest difference of both solves at their common nodes near x, as for a price of its own.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double largest_change(const NormalizedPut& put, const Column& fine,
                                                             const Column& coarse, const Smile& smile) const {
    const double h = smile.coarse.h, place = put.log_spot / h + smile.coarse.strike, wide = smile.window / h;
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

/// Enqueues the readings.
template <class ExecutionSpace>
void read_smiles(const ExecutionSpace& space, const ReadSmiles<ExecutionSpace>& work, int count) {
  static_assert(
      Kokkos::SpaceAccessibility<ExecutionSpace, typename decltype(work.prices)::memory_space>::accessible);
  if (count == 0) return;
  Kokkos::parallel_for("drogue::options::read smiles", Kokkos::RangePolicy<ExecutionSpace>(space, 0, count),
                       work);
}

}  // namespace drogue::options
