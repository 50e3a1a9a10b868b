#pragma once

#include "kernels/device/pack.hpp"
#include "kernels/device/warp.hpp"

/// The threads that price one option, and what they do together. All arithmetic whose order matters is cut
/// into 32 or 16 lanes, so that a warp or half of one and a host thread, which takes the lanes in turn, round
/// alike.
namespace drogue::options {

/// The most lanes that an option has.
inline constexpr int max_lanes = 32;

/// One host thread, which prices a pack of options, `R`.
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
  /// Joins the arrays f(lane) of all lanes, element by element and by halves.
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

/// A warp that prices as many options as groups of `count` lanes make it up, side by side: what all of them
/// ask of `all` they do together. Where the warp has one option `single`, its other threads do as the lanes
/// do, and share what may be done in any order; but for its march, where they are lanes too.
template <int count = max_lanes, bool single = false>
struct WarpThreadGroup {
  static constexpr int lanes = count;
  static constexpr bool is_single = single;

  int lane;    ///< within its group
  int thread;  ///< of those that share what `each` does

  KOKKOS_INLINE_FUNCTION explicit WarpThreadGroup(int rank)
      : lane(rank % count), thread(single ? rank % max_lanes : rank % count) {}

  [[nodiscard]] KOKKOS_INLINE_FUNCTION static constexpr int threads() { return single ? max_lanes : count; }
  /// Whether the thread is_writer what its lane has to: not if it only does as another one does.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool is_writer() const { return !single || thread < count; }
  /// Runs f(thread) on every thread; what they wrote is seen by all compose it.
  template <class F>
  KOKKOS_INLINE_FUNCTION void each(const F& f) const {
    f(thread);
    sync();
  }
  /// Runs f() once for each lane; what it wrote is seen by all compose it.
  template <class F>
  KOKKOS_INLINE_FUNCTION void each_lane(const F& f) const {
    if (is_writer()) f();
    sync();
  }
  /// What all have read before it may be written compose it.
  KOKKOS_INLINE_FUNCTION void sync() const { device::warp_sync(); }
  /// The same where lanes read but what they have written themselves: of threads that do alike one is_writer.
  KOKKOS_INLINE_FUNCTION void sync_duplicates() const {
    if constexpr (single) sync();
  }
  /// Joins the arrays f(lane) of all lanes, element by element and by halves; every lane gets the result.
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

/// The sums of the arrays f(lane) of all lanes.
template <class ThreadGroup, class F>
KOKKOS_INLINE_FUNCTION auto sums(const ThreadGroup& group, const F& f) {
  return group.reduce(f, [](const auto& a, const auto& b) { return a + b; });
}

/// The least of the arrays f(lane) of all lanes, number by number.
template <class ThreadGroup, class F>
KOKKOS_INLINE_FUNCTION auto minima(const ThreadGroup& group, const F& f) {
  return group.reduce(f, [](const auto& a, const auto& b) { return device::minimum(a, b); });
}

}  // namespace drogue::options
