#pragma once

#include <cstdint>

#include "kernels/fabric/fabric_views.hpp"

namespace drogue::fabric {

/// Positions, m, and velocities, m/s, count as lost from this sum of magnitudes on.
inline constexpr double divergence_limit = 1e100;

inline constexpr std::uint64_t no_failure = ~std::uint64_t{0};

/// Steps between checkpoints. A checkpoint moves 96 bytes per vertex, a step 1.5 kB.
inline constexpr std::int64_t checkpoint_interval = 256;

/// Step counter and failure record that the kernels of a step share. The host reads `raised` in its own
/// memory without synchronization.
template <class ExecutionSpace>
struct StepMonitor {
  using Memory = typename ExecutionSpace::memory_space;
  /// Double-buffered step counter: a kernel may write one entry while others read the other.
  Kokkos::View<std::int64_t[2], Memory> steps;
  Kokkos::View<std::uint64_t, Memory> lost;  ///< first failed step times 2^31, plus its first vertex
  Kokkos::View<int, device::HostPinnedSpace<ExecutionSpace>> raised;  ///< 1 after a failure

  /// Records a failure where vertex i, or a lane after it, has no finite state at the end of `step`.
  template <class R>
  KOKKOS_INLINE_FUNCTION void look(std::int64_t step, int i, const Vector3<R>& x, const Vector3<R>& v) const {
    using device::absolute;
    const R size =
        absolute(x.x) + absolute(x.y) + absolute(x.z) + absolute(v.x) + absolute(v.y) + absolute(v.z);
    for (int lane = 0; lane < device::Access<R>::lanes; ++lane)
      if (!(device::Access<R>::lane(size, lane) < divergence_limit)) raise(step, i + lane);
  }

  /// Records a failure of `vertex` in `step`.
  KOKKOS_FUNCTION void raise(std::int64_t step, int vertex) const {
    // The minimum of integers does not depend on the order.
    Kokkos::atomic_min(&lost(), static_cast<std::uint64_t>(step) << 31U | static_cast<std::uint64_t>(vertex));
    raised() = 1;
  }
};

/// Copies the state to the checkpoint unless an earlier state was lost.
template <class ExecutionSpace>
struct CheckpointFunctor {
  StepMonitor<ExecutionSpace> monitor;
  PointsView<ExecutionSpace> x, v, kept_x, kept_v;
  Kokkos::View<std::int64_t, typename ExecutionSpace::memory_space> kept_step;
  int parity;  ///< of `monitor.steps`

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (monitor.lost() != no_failure) return;
    store_points(kept_x, i, load_points<double>(x, i));
    store_points(kept_v, i, load_points<double>(v, i));
    if (i == 0) kept_step() = monitor.steps(parity);
  }
};

/// Moves the state of an odd number of Verlet's steps back to the Views that a solver shows.
template <class ExecutionSpace>
struct RestoreAddressesFunctor {
  StepMonitor<ExecutionSpace> monitor;
  PointsView<ExecutionSpace> from_x, from_v, x, v;  ///< `from_v` may be `v`

  KOKKOS_FUNCTION void operator()(const int i) const {
    store_points(x, i, load_points<double>(from_x, i));
    store_points(v, i, load_points<double>(from_v, i));
    if (i == 0) monitor.steps(0) = monitor.steps(1);
  }
};

}  // namespace drogue::fabric
