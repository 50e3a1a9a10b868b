#pragma once

#include "kernels/device/pack.hpp"
#include "kernels/device/warp.hpp"

/// The threads that price one option, and what they do together. All arithmetic whose order matters is cut
/// into 32 or 16 lanes, so that a warp or half of one and a host thread, which takes the lanes in turn, round
/// alike.
namespace drogue::options {

/// The most lanes that an option has.
inline constexpr int most_lanes = 32;

/// One host thread, which prices a pack of options, `R`.
template <class R>
struct SerialWorkers {
  static constexpr bool is_alone = false;

  int lanes = most_lanes;

  [[nodiscard]] KOKKOS_INLINE_FUNCTION int threads() const { return lanes; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION static constexpr bool writes() { return true; }
  template <class F>
  KOKKOS_INLINE_FUNCTION void each(const F& f) const {
    for (int lane = 0; lane < lanes; ++lane) f(lane);
  }
  KOKKOS_INLINE_FUNCTION void meet() const {}
  /// Joins the arrays f(lane) of all lanes, element by element and by halves.
  template <class F, class Join>
  KOKKOS_INLINE_FUNCTION auto reduce(const F& f, const Join& join) const {
    decltype(f(0)) part[most_lanes];
    for (int lane = 0; lane < lanes; ++lane) part[lane] = f(lane);
    for (int reach = lanes / 2; reach > 0; reach /= 2)
      for (int lane = 0; lane < reach; ++lane)
        for (std::size_t k = 0; k < part[0].size(); ++k)
          part[lane][k] = join(part[lane][k], part[lane + reach][k]);
    return part[0];
  }
  /// Whether a condition holds for all options of the pack.
  template <class Condition>
  KOKKOS_INLINE_FUNCTION bool all(const Condition& condition) const {
    return device::all(condition);
  }
};

/// A warp that prices as many options as groups of `count` lanes make it up, side by side: what all of them
/// ask of `all` they do together. Where the warp has one option `alone`, its other threads do as the lanes
/// do, and share what may be done in any order.
template <int count = most_lanes, bool alone = false>
struct WarpWorkers {
  static constexpr int lanes = count;
  static constexpr bool is_alone = alone;

  int lane;    ///< within its group
  int thread;  ///< of those that share what `each` does

  KOKKOS_INLINE_FUNCTION explicit WarpWorkers(int rank)
      : lane(rank % count), thread(alone ? rank % most_lanes : rank % count) {}

  [[nodiscard]] KOKKOS_INLINE_FUNCTION static constexpr int threads() { return alone ? most_lanes : count; }
  /// Whether the thread writes what its lane has to: not if it only does as another one does.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool writes() const { return !alone || thread < count; }
  /// Runs f(thread) on every thread; what they wrote is seen by all after it.
  template <class F>
  KOKKOS_INLINE_FUNCTION void each(const F& f) const {
    f(thread);
    meet();
  }
  /// Runs f() once for each lane; what it wrote is seen by all after it.
  template <class F>
  KOKKOS_INLINE_FUNCTION void each_lane(const F& f) const {
    if (writes()) f();
    meet();
  }
  /// What all have read before it may be written after it.
  KOKKOS_INLINE_FUNCTION void meet() const { device::meet_warp(); }
  /// The same where lanes read but what they have written themselves: of threads that do alike one writes.
  KOKKOS_INLINE_FUNCTION void meet_alike() const {
    if constexpr (alone) meet();
  }
  /// Joins the arrays f(lane) of all lanes, element by element and by halves; every lane gets the result.
  template <class F, class Join>
  KOKKOS_INLINE_FUNCTION auto reduce(const F& f, const Join& join) const {
    auto part = f(lane);
    for (int reach = lanes / 2; reach > 0; reach /= 2)
      for (std::size_t k = 0; k < part.size(); ++k)
        part[k] = join(part[k], device::from_across(part[k], reach));
    return part;
  }
  /// Whether a condition holds for all options of the warp.
  KOKKOS_INLINE_FUNCTION bool all(bool condition) const {
    return lanes == most_lanes ? condition : device::all_of_warp(condition);
  }
};

/// The sums of the arrays f(lane) of all lanes.
template <class Workers, class F>
KOKKOS_INLINE_FUNCTION auto sums(const Workers& workers, const F& f) {
  return workers.reduce(f, [](const auto& a, const auto& b) { return a + b; });
}

/// The least of the arrays f(lane) of all lanes, number by number.
template <class Workers, class F>
KOKKOS_INLINE_FUNCTION auto minima(const Workers& workers, const F& f) {
  return workers.reduce(f, [](const auto& a, const auto& b) { return device::minimum(a, b); });
}

/// y_i = a_i + g y_{i+1} for i = 0 .. lanes block - 1 in place, from 0 beyond, on n arrays: each lane runs
/// through its block, then blocks are joined by doubling (Kogge and Stone). `slot` holds 2 lanes values.
template <int n, class R>
KOKKOS_INLINE_FUNCTION void recur_backward(const SerialWorkers<R>& workers, R* const (&rows)[n], int block,
                                           R g, R* slot) {
  for (R* const y : rows) {
    R joined = 1.0;
    for (int m = 0; m < block; ++m) joined = joined * g;
    workers.each([=](int lane) {
      R* own = y + lane * block;
      R value = 0.0;
      for (int m = block - 1; m >= 0; --m) {
        value = own[m] + g * value;
        own[m] = value;
      }
      slot[lane] = value;
    });
    R *from = slot, *to = slot + workers.lanes;
    for (int reach = 1; reach < workers.lanes; reach *= 2) {
      workers.each([=](int lane) {
        to[lane] = lane + reach < workers.lanes ? from[lane] + joined * from[lane + reach] : from[lane];
      });
      joined = joined * joined;
      R* const other = from;
      from = to;
      to = other;
    }
    workers.each([=](int lane) {
      if (lane + 1 == workers.lanes) return;
      R* own = y + lane * block;
      R inflow = from[lane + 1];
      for (int m = block - 1; m >= 0; --m) {
        inflow = g * inflow;
        own[m] = own[m] + inflow;
      }
    });
  }
}

/// Joins what the lanes' blocks begin with, n numbers each, to those of all blocks above; `joined` is the
/// slope of a block.
template <int lanes, int n>
KOKKOS_INLINE_FUNCTION void join_backward(int lane, double (&carry)[n], double joined) {
  for (int reach = 1; reach < lanes; reach *= 2) {
    for (double& own : carry) {
      const double next = device::from_above<lanes>(own, reach);
      if (lane + reach < lanes) own = own + joined * next;
    }
    joined = joined * joined;
  }
}

/// The same by a warp, whose lanes ask one another for what joins their blocks.
template <int n, int lanes, bool alone>
KOKKOS_INLINE_FUNCTION void recur_backward(const WarpWorkers<lanes, alone>& workers, double* const (&rows)[n],
                                           int block, double g, double* /*slot*/) {
  const int lane = workers.lane;
  if constexpr (alone && lanes < most_lanes) {  // rows are dealt out to groups of lanes
    static_assert(n == most_lanes / lanes);
    recur_backward(WarpWorkers<lanes>(lane), {rows[workers.thread / lanes]}, block, g,
                   static_cast<double*>(nullptr));
  } else {
    double joined = 1.0, carry[n];
    for (int m = 0; m < block; ++m) joined = joined * g;
    for (int k = 0; k < n; ++k) {
      double* own = rows[k] + lane * block;
      carry[k] = 0.0;
      for (int m = block - 1; m >= 0; --m) {
        carry[k] = own[m] + g * carry[k];
        own[m] = carry[k];
      }
    }
    join_backward<lanes>(lane, carry, joined);
    for (int k = 0; k < n; ++k) {
      double* own = rows[k] + lane * block;
      double inflow = device::from_above<lanes>(carry[k], 1);
      if (lane + 1 == lanes) continue;
      for (int m = block - 1; m >= 0; --m) {
        inflow = g * inflow;
        own[m] = own[m] + inflow;
      }
    }
    workers.meet();
  }
}

/// x -> max(lo, a x + b), a >= 0 known to all. Such maps compose to maps of their kind.
template <class R>
struct RisingMap {
  R b, lo;
  KOKKOS_INLINE_FUNCTION static RisingMap at_least(R lo, R b) { return {b, lo}; }
  KOKKOS_INLINE_FUNCTION static RisingMap constant(R x) { return {x, x}; }
};

/// `second` after `first`; a2 is the slope of `second`.
template <class R>
KOKKOS_INLINE_FUNCTION RisingMap<R> after(const RisingMap<R>& second, R a2, const RisingMap<R>& first) {
  return {a2 * first.b + second.b, device::maximum(second.lo, a2 * first.lo + second.b)};
}

/// Stands for no bound; its products with a slope stay finite.
inline constexpr double unbounded = 1e200;

/// x -> min(hi, max(lo, a x + b)), a of any sign known to all. Such maps compose to maps of their kind. Where
/// no a is negative `hi` stays without effect, and b and lo have the bits of a RisingMap.
template <class R>
struct ClampedMap {
  R b, lo, hi;
  KOKKOS_INLINE_FUNCTION static ClampedMap at_least(R lo, R b) { return {b, lo, R(unbounded)}; }
  KOKKOS_INLINE_FUNCTION static ClampedMap constant(R x) { return {x, x, x}; }
};

template <class R>
KOKKOS_INLINE_FUNCTION ClampedMap<R> after(const ClampedMap<R>& second, R a2, const ClampedMap<R>& first) {
  const R low = device::maximum(second.lo, device::minimum(second.hi, a2 * first.lo + second.b));
  const R high = device::maximum(second.lo, device::minimum(second.hi, a2 * first.hi + second.b));
  return {a2 * first.b + second.b, device::minimum(low, high), device::maximum(low, high)};
}

/// x_i = max(floor_i, a x_{i-1} + y_i) for the nodes 1, 2, ... of all blocks, x_0 given; 0 from node `end`
/// on. The first block's map is a constant, so the bounds of what blocks compose to are the values. `slot`
/// holds 2 lanes maps.
template <class Map, class Workers, class R>
KOKKOS_INLINE_FUNCTION void recur_by_maps(const Workers& workers, R* x, const R* y, const R* floor, int block,
                                          int end, R a, R x0, Map* slot) {
  static_assert(!Workers::is_alone);  // `each` runs lanes here
  R joined = 1.0;
  for (int m = 0; m < block; ++m) joined = joined * a;
  workers.each([=](int lane) {
    const int begin = lane * block;
    Map map = lane == 0 ? Map::constant(x0) : Map::at_least(floor[begin], y[begin]);
    for (int m = 1; m < block; ++m) map = after(Map::at_least(floor[begin + m], y[begin + m]), a, map);
    slot[lane] = map;
  });
  Map *from = slot, *to = slot + workers.lanes;
  for (int reach = 1; reach < workers.lanes; reach *= 2) {
    workers.each([=](int lane) {
      to[lane] = lane >= reach ? after(from[lane], joined, from[lane - reach]) : from[lane];
    });
    joined = joined * joined;
    Map* const other = from;
    from = to;
    to = other;
  }
  workers.each([=](int lane) {
    const int begin = lane * block;
    R value = x0;
    if (lane > 0) value = device::maximum(floor[begin], a * from[lane - 1].lo + y[begin]);
    x[begin] = begin < end ? value : R(0.0);
    for (int m = 1; m < block; ++m) {
      value = device::maximum(floor[begin + m], a * value + y[begin + m]);
      x[begin + m] = begin + m < end ? value : R(0.0);
    }
  });
}

/// The same for a of any sign; `slot` holds 2 lanes ClampedMaps.
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION void recur_forward(const Workers& workers, R* x, const R* y, const R* floor, int block,
                                          int end, R a, R x0, R* slot) {
  if (workers.all(a >= R(0.0))) {
    recur_by_maps(workers, x, y, floor, block, end, a, x0, reinterpret_cast<RisingMap<R>*>(slot));
  } else {
    recur_by_maps(workers, x, y, floor, block, end, a, x0, reinterpret_cast<ClampedMap<R>*>(slot));
  }
}

}  // namespace drogue::options
