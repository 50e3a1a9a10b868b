#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/options/pide/register_march.hpp"

namespace drogue::perf::tridiagonal {

/// Coefficients of the two recurrences of a group of systems, all divided by the pivot but the last.
template <class R>
struct RecurrenceFactors {
  R inverse, from_left, from_right, boundary_value;  ///< 1/pivot, lower/pivot, upper/pivot, x_0
};

/// Solves one group of systems per team. A group holds one system for each SIMD lane, `members` in all, and
/// the numbers of its member k are every `members`-th from the k-th on.
template <class ExecutionSpace, int block>
struct ToeplitzFunctor {
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;
  using Member = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;
  using View = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  using ConstView = Kokkos::View<const double*, typename ExecutionSpace::memory_space>;
  static constexpr int members = device::Access<R>::lanes, rows = 3;

  int nodes;
  ConstView factors;  ///< (groups, 4, members): RecurrenceFactors
  ConstView right;    ///< (groups, nodes, members)
  View solution;      ///< (groups, nodes, members)

  [[nodiscard]] KOKKOS_INLINE_FUNCTION static std::size_t scratch_bytes(int nodes) {
    const auto count =
        static_cast<std::size_t>(options::block_of(nodes, options::max_lanes) * options::max_lanes);
    return block > 0 ? 0 : sizeof(R) * (rows * count + 9 * options::max_lanes) + 64;
  }

  KOKKOS_FUNCTION void operator()(const Member& team) const {
    const int group = team.league_rank();
    const double* at = factors.data() + group * 4 * members;
    const auto load = [at](int k) { return device::Access<R>::load(at + k * members); };
    const RecurrenceFactors<R> f{load(0), load(1), load(2), load(3)};
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(group) * nodes * members;
    if constexpr (block > 0) {
      in_registers(team.team_rank(), f, right.data() + first, solution.data() + first);
    } else if constexpr (device::is_host<ExecutionSpace>) {
      in_scratch(options::SerialThreadGroup<R>{}, team, f, right.data() + first, solution.data() + first);
    } else {
      in_scratch(options::WarpThreadGroup<>{static_cast<int>(team.team_rank())}, team, f,
                 right.data() + first, solution.data() + first);
    }
  }

  KOKKOS_INLINE_FUNCTION void in_registers(int lane, const RecurrenceFactors<R>& f, const double* from,
                                           double* to) const {
    options::LaneNodes<block> y = options::LaneNodes<block>::load(lane, from), floor;
    for (int m = 0; m < block; ++m) {
      y.node[m] = f.inverse * y.node[m];
      floor.node[m] = -options::unbounded;
    }
    constexpr int lanes = options::max_lanes;
    options::recur_backward<lanes>(lane, y, f.from_right);
    const options::LaneNodes<block> x = f.from_left >= 0.0
                                            ? options::recur_by_maps<lanes, options::MaxAffineMap<double>>(
                                                  lane, y, floor, f.from_left, f.boundary_value)
                                            : options::recur_by_maps<lanes, options::ClampedMap<double>>(
                                                  lane, y, floor, f.from_left, f.boundary_value);
    x.store(lane, to);
  }

  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION void in_scratch(const ThreadGroup& group, const Member& team,
                                         const RecurrenceFactors<R>& f, const double* from,
                                         double* to) const {
    const int block_nodes = options::block_of(nodes, group.lanes), count = block_nodes * group.lanes,
              last = nodes;
    R* const y = static_cast<R*>(team.team_scratch(1).get_shmem_aligned(scratch_bytes(nodes) - 64, 64));
    R *const x = y + count, *const floor = x + count, *const slot = floor + count;
    group.each([=](int thread) {
      for (int i = thread; i < count; i += group.threads()) {
        y[i] = i < last ? f.inverse * device::Access<R>::load(from + i * members) : R(0.0);
        floor[i] = -options::unbounded;
      }
    });
    options::recur_backward(group, {y}, block_nodes, f.from_right, slot);
    options::recur_forward(group, x, y, floor, block_nodes, last, f.from_left, f.boundary_value, slot);
    group.each([=](int thread) {
      for (int i = thread; i < last; i += group.threads()) device::Access<R>::store(to + i * members, x[i]);
    });
  }
};

/// Solves `groups` groups of systems on `nodes` nodes; the Views are shaped as in ToeplitzFunctor.
/// Asynchronous, does not throw.
template <class ExecutionSpace, class Factors, class Right, class Solution>
void solve_toeplitz(const ExecutionSpace& space, int groups, int nodes, const Factors& factors,
                    const Right& right, const Solution& solution) {
  static_assert(Kokkos::SpaceAccessibility<ExecutionSpace, typename Solution::memory_space>::accessible);
  const auto launch = [&]<int block>() {
    using Functor = ToeplitzFunctor<ExecutionSpace, block>;
    Kokkos::TeamPolicy<ExecutionSpace> policy(space, groups,
                                              device::is_host<ExecutionSpace> ? 1 : options::max_lanes);
    policy.set_scratch_size(1, Kokkos::PerTeam(Functor::scratch_bytes(nodes)));
    Kokkos::parallel_for("drogue::perf::solve_toeplitz", policy, Functor{nodes, factors, right, solution});
  };
  if constexpr (!device::is_host<ExecutionSpace>) {
    if (nodes == 128) return launch.template operator()<4>();
    if (nodes == 256) return launch.template operator()<8>();
  }
  launch.template operator()<0>();
}

}  // namespace drogue::perf::tridiagonal
