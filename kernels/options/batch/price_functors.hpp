#pragma once

#include "kernels/options/batch/price_batch.hpp"

namespace drogue::options {

/// Prices a batch; for `fixed` see `solve`.
template <class ExecutionSpace, int fixed, JumpClass jump_class>
struct PriceFunctor {
  using Batch = PriceBatch<ExecutionSpace>;

  Batch batch;

  KOKKOS_FORCEINLINE_FUNCTION void operator()(const typename Batch::Member& team) const {
    batch.template price_group<fixed>(*this, team);
  }
  template <class ThreadGroup>
  KOKKOS_FORCEINLINE_FUNCTION void price(const ThreadGroup& workers,
                                         const Memory<typename Batch::R, fixed>& memory, int group) const {
    batch.template price<jump_class>(workers, memory, group);
  }
};

/// The same for a batch that leaves most of a GPU idle: a team of two warps for each option. Both prepare it,
/// in memory of their own; then one marches on the finer grid and the other on the coarser one.
template <class ExecutionSpace, int fixed, JumpClass jump_class>
struct PriceByTwoFunctor {
  using Batch = PriceBatch<ExecutionSpace>;

  Batch batch;  ///< on two grids

  KOKKOS_FORCEINLINE_FUNCTION void operator()(const typename Batch::Member& team) const {
    const std::size_t bytes = Memory<double, fixed>::bytes(batch.mesh);
    auto* const place = static_cast<std::byte*>(
        device::in_shared_memory(team.team_scratch(batch.level).get_shmem_aligned(2 * bytes, 64)));
    const int rank = static_cast<int>(team.team_rank()), option = team.league_rank();
    const bool finer = rank < most_lanes;
    const Memory<double, fixed> memory(place + (finer ? 0 : bytes), batch.mesh),
        coarser_memory(place + bytes, batch.mesh);
    const WarpWorkers<lanes_of(fixed), true> workers(rank);
    const Prepared<double> prepared = batch.template prepare<jump_class>(workers, memory, option);
    if (finer) {
      batch.solve_fine(workers, prepared, memory);
    } else {
      const ErrorEstimate<double> doubt =
          doubt_of_solve(prepared.put, prepared.law, prepared.jumps, prepared.grid, batch.steps);
      batch.solve_coarse(workers, prepared, memory);
      workers.each([=](int thread) {
        if (thread == 0) *memory.doubt() = doubt;
      });
    }
    team.team_barrier();
    if (finer)
      batch.conclude(workers, prepared, *coarser_memory.doubt(), memory, coarser_memory.row(0, fixed / 2),
                     coarser_memory, option);
  }
};

/// Enqueues the launch.
template <class ExecutionSpace>
void price_batch(const ExecutionSpace& space, PriceBatch<ExecutionSpace> batch) {
  static_assert(
      Kokkos::SpaceAccessibility<ExecutionSpace, typename decltype(batch.prices)::memory_space>::accessible);
  if (batch.record.time == nullptr) batch.lanes = lanes_of(batch.mesh);
  if constexpr (!device::is_host<ExecutionSpace>) {
    const auto launch = [&]<int fixed> {
      return dispatch_jump_class(batch.model, [&]<JumpClass jump_class> {
        launch_batch<fixed>(space, "drogue::options::price in registers",
                            PriceFunctor<ExecutionSpace, fixed, jump_class>{batch});
      });
    };
    if (batch.record.time == nullptr) {
      // Two warps an option where half of one each would leave half of a GPU's schedulers idle.
      if (batch.mesh == 128 && !batch.single_grid && batch.count <= space.concurrency() / (16 * most_lanes))
        return dispatch_jump_class(batch.model, [&]<JumpClass jump_class> {
          launch_batch<128, 2>(space, "drogue::options::price by two",
                               PriceByTwoFunctor<ExecutionSpace, 128, jump_class>{batch});
        });
      if (batch.mesh == 64) return launch.template operator()<64>();
      if (batch.mesh == 128) return launch.template operator()<128>();
      if (batch.mesh == 256) return launch.template operator()<256>();
    }
  }
  launch_batch<0>(space, "drogue::options::price", PriceFunctor<ExecutionSpace, 0, JumpClass::any>{batch});
}

}  // namespace drogue::options
