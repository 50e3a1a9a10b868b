#pragma once

#include "kernels/options/batch/price_batch.hpp"

namespace drogue::options {

/// Kernel that prices a batch; for `fixed` see `solve`.
template <class ExecutionSpace, int fixed, JumpClass jump_class>
struct PriceFunctor {
  using Batch = PriceBatch<ExecutionSpace>;

  Batch batch;

  KOKKOS_FORCEINLINE_FUNCTION void operator()(const typename Batch::Member& team) const {
    batch.template price_pack<fixed>(*this, team);
  }
  template <class ThreadGroup>
  KOKKOS_FORCEINLINE_FUNCTION void price(const ThreadGroup& group,
                                         const SolveMemory<typename Batch::R, fixed>& memory,
                                         int pack) const {
    batch.template price<jump_class>(group, memory, pack);
  }
};

/// Kernel for small batches, which would leave most of a GPU idle: a team of two warps per option. Both warps
/// prepare the data in separate memory. One warp then marches on the finer grid, the other one on the coarser
/// grid.
template <class ExecutionSpace, int fixed, JumpClass jump_class>
struct TwoWarpPriceFunctor {
  using Batch = PriceBatch<ExecutionSpace>;

  Batch batch;  ///< with two grids per price

  KOKKOS_FORCEINLINE_FUNCTION void operator()(const typename Batch::Member& team) const {
    const std::size_t bytes = SolveMemory<double, fixed>::bytes(batch.mesh);
    auto* const place = static_cast<std::byte*>(
        device::in_shared_memory(team.team_scratch(batch.level).get_shmem_aligned(2 * bytes, 64)));
    const int rank = static_cast<int>(team.team_rank()), option = team.league_rank();
    const bool finer = rank < max_lanes;
    const SolveMemory<double, fixed> memory(place + (finer ? 0 : bytes), batch.mesh),
        coarser_memory(place + bytes, batch.mesh);
    const WarpThreadGroup<lanes_of(fixed), true> group(rank);
    const PreparedPack<double> prepared = batch.template prepare<jump_class>(group, memory, option);
    if (finer) {
      batch.solve_fine(group, prepared, memory);
    } else {
      const ErrorEstimate<double> estimate =
          estimate_solve_error(prepared.put, prepared.measure, prepared.jumps, prepared.grid, batch.steps);
      batch.solve_coarse(group, prepared, memory);
      group.each([=](int thread) {
        if (thread == 0) *memory.estimate() = estimate;
      });
    }
    team.team_barrier();
    if (finer)
      batch.write_prices(group, prepared, *coarser_memory.estimate(), memory,
                         coarser_memory.row(0, fixed / 2), coarser_memory, option);
  }
};

/// Enqueues the launch; asynchronous.
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
      // Two warps per option if half a warp per option would leave half of the GPU's schedulers idle.
      if (batch.mesh == 128 && !batch.single_grid && batch.count <= space.concurrency() / (16 * max_lanes))
        return dispatch_jump_class(batch.model, [&]<JumpClass jump_class> {
          launch_batch<128, 2>(space, "drogue::options::price by two warps",
                               TwoWarpPriceFunctor<ExecutionSpace, 128, jump_class>{batch});
        });
      if (batch.mesh == 64) return launch.template operator()<64>();
      if (batch.mesh == 128) return launch.template operator()<128>();
      if (batch.mesh == 256) return launch.template operator()<256>();
    }
  }
  launch_batch<0>(space, "drogue::options::price", PriceFunctor<ExecutionSpace, 0, JumpClass::any>{batch});
}

}  // namespace drogue::options
