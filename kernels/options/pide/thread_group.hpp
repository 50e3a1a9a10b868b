#pragma once

#include "kernels/device/pack.hpp"
#include "kernels/device/warp.hpp"

/// Threads that price one option, with reductions and synchronization. Arithmetic that depends on the order
/// of operations is divided among 32 or 16 lanes. A warp, half a warp, and a host thread that processes the
/// lanes in turn therefore round identically.
namespace drogue::options {

/// Maximum number of lanes per option.
inline constexpr int max_lanes = 32;

/// One host thread, which prices a pack `R` of options.
template <class R>
struct SerialThreadGroup {
  static constexpr bool is_single = false;

  int lanes = max_lanes;

  [[nodiscard]] KOKKOS_INLINE_FUNCTION int threads() const { return lanes; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION static constexpr bool is_writer() { return true; }
  template <class F>
  KOKKOS_INLINE_FUNCTION void each(const F& f) const {
    for (int lane = 0; lane < lanes; ++lane) f(lane);
  }
  KOKKOS_INLINE_FUNCTION void sync() const {}
  /// Reduces the arrays f(lane) of all lanes element by element in a binary tree.
  template <class F, class Join>
  KOKKOS_INLINE_FUNCTION auto reduce(const F& f, const Join& join) const {
    decltype(f(0)) part[max_lanes];
    for (int lane = 0; lane < lanes; ++lane) part[lane] = f(lane);
    for (int lane_offset = lanes / 2; lane_offset > 0; lane_offset /= 2)
      for (int lane = 0; lane < lane_offset; ++lane)
        for (std::size_t k = 0; k < part[0].size(); ++k)
          part[lane][k] = join(part[lane][k], part[lane + lane_offset][k]);
    return part[0];
  }
  /// Whether a condition holds for all options of the pack.
  template <class Condition>
  KOKKOS_INLINE_FUNCTION bool all(const Condition& condition) const {
    return device::all(condition);
  }
};

/// A warp that prices 32/`count` options side by side, `count` lanes each; `all` covers the options of the
/// warp. With `single` the warp has one option: the remaining threads repeat the arithmetic of the lanes and
/// share order-independent work. In the march all 32 threads are lanes.
template <int count = max_lanes, bool single = false>
struct WarpThreadGroup {
  static constexpr int lanes = count;
  static constexpr bool is_single = single;

  int lane;    ///< index within the option
  int thread;  ///< index among the threads that share the work of `each`

  KOKKOS_INLINE_FUNCTION explicit WarpThreadGroup(int rank)
      : lane(rank % count), thread(single ? rank % max_lanes : rank % count) {}

  [[nodiscard]] KOKKOS_INLINE_FUNCTION static constexpr int threads() { return single ? max_lanes : count; }
  /// Whether the thread writes the results of its lane; false for threads that only repeat a lane.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool is_writer() const { return !single || thread < count; }
  /// Runs f(thread) on every thread, then synchronizes.
  template <class F>
  KOKKOS_INLINE_FUNCTION void each(const F& f) const {
    f(thread);
    sync();
  }
  /// Runs f() once per lane, then synchronizes.
  template <class F>
  KOKKOS_INLINE_FUNCTION void each_lane(const F& f) const {
    if (is_writer()) f();
    sync();
  }
  /// Warp barrier: orders memory accesses before and after it.
  KOKKOS_INLINE_FUNCTION void sync() const { device::warp_sync(); }
  /// Barrier that is only needed if two threads repeat one lane: lanes read only their own writes, and one of
  /// the two threads writes.
  KOKKOS_INLINE_FUNCTION void sync_duplicates() const {
    if constexpr (single) sync();
  }
  /// Reduces the arrays f(lane) of all lanes element by element in a binary tree; every lane gets the result.
  template <class F, class Join>
  KOKKOS_INLINE_FUNCTION auto reduce(const F& f, const Join& join) const {
    auto part = f(lane);
    for (int lane_offset = lanes / 2; lane_offset > 0; lane_offset /= 2)
      for (std::size_t k = 0; k < part.size(); ++k)
        part[k] = join(part[k], device::shuffle_xor(part[k], lane_offset));
    return part;
  }
  /// Whether a condition holds for all options of the warp.
  KOKKOS_INLINE_FUNCTION bool all(bool condition) const {
    return lanes == max_lanes ? condition : device::warp_all(condition);
  }
};

/// Sums of the arrays f(lane) of all lanes, element by element.
template <class ThreadGroup, class F>
KOKKOS_INLINE_FUNCTION auto sums(const ThreadGroup& group, const F& f) {
  return group.reduce(f, [](const auto& a, const auto& b) { return a + b; });
}

/// Minima of the arrays f(lane) of all lanes, element by element.
template <class ThreadGroup, class F>
KOKKOS_INLINE_FUNCTION auto minima(const ThreadGroup& group, const F& f) {
  return group.reduce(f, [](const auto& a, const auto& b) { return device::minimum(a, b); });
}

}  // namespace drogue::options
