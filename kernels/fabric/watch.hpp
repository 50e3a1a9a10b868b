#pragma once

#include <cstdint>

#include "kernels/fabric/cloth.hpp"

namespace drogue::fabric {

/// Positions, m, and velocities, m/s, beyond it count as lost.
inline constexpr double lost_beyond = 1e100;

inline constexpr std::uint64_t none_lost = ~std::uint64_t{0};

/// Steps between copies of the state that are put aside: they move 96 bytes a vertex, steps 1.5 kB each.
inline constexpr std::int64_t keep_every = 256;

/// What the kernels of a step share beside the state: how many steps were taken, and what went wrong. It
/// lives on the device; the host reads a word of its own memory and waits for nothing.
template <class ExecutionSpace>
struct Watch {
  using Memory = typename ExecutionSpace::memory_space;
  /// Steps taken, told twice: while kernels read one, a later one may set the other.
  Kokkos::View<std::int64_t[2], Memory> steps;
  Kokkos::View<std::uint64_t, Memory> lost;  ///< the least step, and of it the least vertex
  Kokkos::View<int, device::HostPinnedSpace<ExecutionSpace>> raised;

  /// Raises the flag where vertex i, or a lane after it, is nowhere at the end of `step`.
  template <class R>
  KOKKOS_INLINE_FUNCTION void look(std::int64_t step, int i, const Vector3<R>& x, const Vector3<R>& v) const {
    using device::absolute;
    const R size =
        absolute(x.x) + absolute(x.y) + absolute(x.z) + absolute(v.x) + absolute(v.y) + absolute(v.z);
    for (int lane = 0; lane < device::Access<R>::lanes; ++lane)
      if (!(device::Access<R>::lane(size, lane) < lost_beyond)) raise(step, i + lane);
  }

  KOKKOS_FUNCTION void raise(std::int64_t step, int vertex) const {
    // The least of whole numbers is the same in any order.
    Kokkos::atomic_min(&lost(), static_cast<std::uint64_t>(step) << 31U | static_cast<std::uint64_t>(vertex));
    raised() = 1;
  }
};

/// Puts a state aside unless one before it was lost.
template <class ExecutionSpace>
struct KeepFunctor {
  Watch<ExecutionSpace> watch;
  PointsView<ExecutionSpace> x, v, kept_x, kept_v;
  Kokkos::View<std::int64_t, typename ExecutionSpace::memory_space> kept_step;
  int hand;  ///< of `steps`

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (watch.lost() != none_lost) return;
    store_points(kept_x, i, load_points<double>(x, i));
    store_points(kept_v, i, load_points<double>(v, i));
    if (i == 0) kept_step() = watch.steps(hand);
  }
};

}  // namespace drogue::fabric
