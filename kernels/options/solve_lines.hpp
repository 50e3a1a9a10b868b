#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/options/pide/register_march.hpp"

namespace drogue::options {

/// What solves a group of lines multiplies with.
template <class R>
struct LineFactors {
  R inverse, from_left, from_right, edge;  ///< 1/pivot, l/pivot, u/pivot, x_0
};

/// The lines of a batch in groups of as many as a thread takes at once; numbers of a group's member k are
/// every `members`-th from the k-th on.
template <class ExecutionSpace, int block>
struct LineFunctor {
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;
  using Member = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;
  using View = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  using ConstView = Kokkos::View<const double*, typename ExecutionSpace::memory_space>;
  static constexpr int members = device::Access<R>::lanes, rows = 3;

  int nodes;
  ConstView factors;  ///< (groups, 4, members): LineFactors
  ConstView right;    ///< (groups, nodes, members)
  View solution;      ///< (groups, nodes, members)

  [[nodiscard]] KOKKOS_INLINE_FUNCTION static std::size_t scratch_bytes(int nodes) {
    const auto count = static_cast<std::size_t>(block_of(nodes, max_lanes) * max_lanes);
    return block > 0 ? 0 : sizeof(R) * (rows * count + 9 * max_lanes) + 64;
  }

  KOKKOS_FUNCTION void operator()(const Member& team) const {
    const int group = team.league_rank();
    const double* at = factors.data() + group * 4 * members;
    const auto load = [at](int k) { return device::Access<R>::load(at + k * members); };
    const LineFactors<R> f{load(0), load(1), load(2), load(3)};
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(group) * nodes * members;
    if constexpr (block > 0) {
      in_registers(team.team_rank(), f, right.data() + first, solution.data() + first);
    } else if constexpr (device::is_host<ExecutionSpace>) {
      in_scratch(SerialThreadGroup<R>{}, team, f, right.data() + first, solution.data() + first);
    } else {
      in_scratch(WarpThreadGroup<>{static_cast<int>(team.team_rank())}, team, f, right.data() + first,
                 solution.data() + first);
    }
  }

  KOKKOS_INLINE_FUNCTION void in_registers(int lane, const LineFactors<R>& f, const double* from,
                                           double* to) const {
    LaneNodes<block> y = LaneNodes<block>::load(lane, from), floor;
    for (int m = 0; m < block; ++m) {
      y.node[m] = f.inverse * y.node[m];
      floor.node[m] = -unbounded;
    }
    recur_backward<max_lanes>(lane, y, f.from_right);
    const LaneNodes<block> x =
        f.from_left >= 0.0
            ? recur_by_maps<max_lanes, MaxAffineMap<double>>(lane, y, floor, f.from_left, f.edge)
            : recur_by_maps<max_lanes, ClampedMap<double>>(lane, y, floor, f.from_left, f.edge);
    x.store(lane, to);
  }

  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION void in_scratch(const ThreadGroup& workers, const Member& team,
                                         const LineFactors<R>& f, const double* from, double* to) const {
    const int block_nodes = block_of(nodes, workers.lanes), count = block_nodes * workers.lanes, last = nodes;
    R* const y = static_cast<R*>(team.team_scratch(1).get_shmem_aligned(scratch_bytes(nodes) - 64, 64));
    R *const x = y + count, *const floor = x + count, *const slot = floor + count;
    workers.each([=](int thread) {
      for (int i = thread; i < count; i += workers.threads()) {
        y[i] = i < last ? f.inverse * device::Access<R>::load(from + i * members) : R(0.0);
        floor[i] = -unbounded;
      }
    });
    recur_backward(workers, {y}, block_nodes, f.from_right, slot);
    recur_forward(workers, x, y, floor, block_nodes, last, f.from_left, f.edge, slot);
    workers.each([=](int thread) {
      for (int i = thread; i < last; i += workers.threads()) device::Access<R>::store(to + i * members, x[i]);
    });
  }
};

/// Enqueues the solution of `groups` groups of lines of `nodes` nodes: factors, right and solution as in
/// LineFunctor.
template <class ExecutionSpace, class Factors, class Right, class Solution>
void solve_lines(const ExecutionSpace& space, int groups, int nodes, const Factors& factors,
                 const Right& right, const Solution& solution) {
  static_assert(Kokkos::SpaceAccessibility<ExecutionSpace, typename Solution::memory_space>::accessible);
  const auto launch = [&]<int block>() {
    using Functor = LineFunctor<ExecutionSpace, block>;
    Kokkos::TeamPolicy<ExecutionSpace> policy(space, groups, device::is_host<ExecutionSpace> ? 1 : max_lanes);
    policy.set_scratch_size(1, Kokkos::PerTeam(Functor::scratch_bytes(nodes)));
    Kokkos::parallel_for("drogue::options::solve lines", policy, Functor{nodes, factors, right, solution});
  };
  if constexpr (!device::is_host<ExecutionSpace>) {
    if (nodes == 128) return launch.template operator()<4>();
    if (nodes == 256) return launch.template operator()<8>();
  }
  launch.template operator()<0>();
}

}  // namespace drogue::options
