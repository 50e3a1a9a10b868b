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
/// do, and share what may be done in any order; but for its march, where they are lanes too.
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
  KOKKOS_INLINE_FUNCTION void meet() const { device::warp_sync(); }
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
        part[k] = join(part[k], device::shuffle_xor(part[k], reach));
    return part;
  }
  /// Whether a condition holds for all options of the warp.
  KOKKOS_INLINE_FUNCTION bool all(bool condition) const {
    return lanes == most_lanes ? condition : device::warp_all(condition);
  }
};

/// The sums of the arrays f(lane) of all lanes.
template <class ThreadGroup, class F>
KOKKOS_INLINE_FUNCTION auto sums(const ThreadGroup& workers, const F& f) {
  return workers.reduce(f, [](const auto& a, const auto& b) { return a + b; });
}

/// The least of the arrays f(lane) of all lanes, number by number.
template <class ThreadGroup, class F>
KOKKOS_INLINE_FUNCTION auto minima(const ThreadGroup& workers, const F& f) {
  return workers.reduce(f, [](const auto& a, const auto& b) { return device::minimum(a, b); });
}

/// The nodes of each of two parts that a lane's block of nodes is cut into, so that no chain of operations is
/// longer than need be; of a short block the only part.
KOKKOS_INLINE_FUNCTION constexpr int part_of(int block) {
  return block >= 8 && block % 2 == 0 ? block / 2 : block;
}

/// The slope of what `count` nodes with this one compose to.
template <class R>
KOKKOS_INLINE_FUNCTION R slope_of(R slope, int count) {
  R joined = slope;
  for (int m = 1; m < count; ++m) joined = joined * slope;
  return joined;
}

/// y_i = a_i + g y_{i+1} of some nodes in place, from 0 beyond; returns the first.
template <class R>
KOKKOS_INLINE_FUNCTION R run_backward(R* y, int count, R g) {
  R value = y[count - 1];
  for (int m = count - 2; m >= 0; --m) {
    value = y[m] + g * value;
    y[m] = value;
  }
  return value;
}

/// Adds what flows into them from above.
template <class R>
KOKKOS_INLINE_FUNCTION void flow_backward(R* y, int count, R g, R inflow) {
  for (int m = count - 1; m >= 0; --m) {
    inflow = g * inflow;
    y[m] = y[m] + inflow;
  }
}

/// What a lane's block begins with, from 0 beyond it: each part by itself, then both joined.
template <class R>
KOKKOS_INLINE_FUNCTION R begin_backward(R* own, int block, R g, R slope) {
  const int part = part_of(block);
  const R low = run_backward(own, part, g);
  return part == block ? low : low + slope * run_backward(own + part, part, g);
}

/// The same once what flows into the block is known.
template <class R>
KOKKOS_INLINE_FUNCTION void end_backward(R* own, int block, R g, R slope, R inflow) {
  const int part = part_of(block);
  if (part < block) {
    const R high = own[part] + slope * inflow;
    flow_backward(own + part, part, g, inflow);
    inflow = high;
  }
  flow_backward(own, part, g, inflow);
}

/// y_i = a_i + g y_{i+1} for i = 0 .. lanes block - 1 in place, from 0 beyond, on n arrays: each lane runs
/// through the parts of its block, then blocks are joined by doubling (Kogge and Stone). `slot` holds 2 lanes
/// values.
template <int n, class R>
KOKKOS_INLINE_FUNCTION void recur_backward(const SerialWorkers<R>& workers, R* const (&rows)[n], int block,
                                           R g, R* slot) {
  const int part = part_of(block);
  const R slope = slope_of(g, part);
  for (R* const y : rows) {
    R joined = part < block ? slope * slope : slope;
    workers.each([=](int lane) { slot[lane] = begin_backward(y + lane * block, block, g, slope); });
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
      end_backward(y + lane * block, block, g, slope, lane + 1 < workers.lanes ? from[lane + 1] : R(0.0));
    });
  }
}

/// Joins what the lanes' blocks begin with, n numbers each, to those of all blocks above; `joined` is the
/// slope of a block. Of each `stride` threads the first counts.
template <int lanes, int stride = 1, int n>
KOKKOS_INLINE_FUNCTION void join_backward(int lane, double (&carry)[n], double joined) {
  for (int reach = stride; reach < lanes; reach *= 2) {
    for (double& own : carry) {
      const double next = device::shuffle_down<lanes>(own, reach);
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
    const int part = part_of(block);
    const double slope = slope_of(g, part);
    double carry[n];
    for (int k = 0; k < n; ++k) carry[k] = begin_backward(rows[k] + lane * block, block, g, slope);
    join_backward<lanes>(lane, carry, part < block ? slope * slope : slope);
    for (int k = 0; k < n; ++k) {
      const double inflow = device::shuffle_down<lanes>(carry[k], 1);
      end_backward(rows[k] + lane * block, block, g, slope, lane + 1 < lanes ? inflow : 0.0);
    }
    workers.meet();
  }
}

/// x -> max(lo, a x + b), a >= 0 known to all. Such maps compose to maps of their kind.
template <class R>
struct MaxAffineMap {
  R b, lo;
  KOKKOS_INLINE_FUNCTION static MaxAffineMap at_least(R lo, R b) { return {b, lo}; }
  KOKKOS_INLINE_FUNCTION static MaxAffineMap constant(R x) { return {x, x}; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R at(R x, R a) const { return device::maximum(lo, a * x + b); }
};

/// `second` after `first`; a2 is the slope of `second`.
template <class R>
KOKKOS_INLINE_FUNCTION MaxAffineMap<R> after(const MaxAffineMap<R>& second, R a2,
                                             const MaxAffineMap<R>& first) {
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
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R at(R x, R a) const {
    return device::maximum(lo, device::minimum(hi, a * x + b));
  }
};

template <class R>
KOKKOS_INLINE_FUNCTION ClampedMap<R> after(const ClampedMap<R>& second, R a2, const ClampedMap<R>& first) {
  const R low = device::maximum(second.lo, device::minimum(second.hi, a2 * first.lo + second.b));
  const R high = device::maximum(second.lo, device::minimum(second.hi, a2 * first.hi + second.b));
  return {a2 * first.b + second.b, device::minimum(low, high), device::maximum(low, high)};
}

/// What the nodes of a part compose to, `map` being the first node's.
template <class Map, class R>
KOKKOS_INLINE_FUNCTION Map compose(Map map, const R* y, const R* floor, int count, R a) {
  for (int m = 1; m < count; ++m) map = after(Map::at_least(floor[m], y[m]), a, map);
  return map;
}

/// x_i = max(floor_i, a x_{i-1} + y_i) for the nodes 1, 2, ... of all blocks, x_0 given; 0 from node `end`
/// on. The first block's map is a constant, so the bounds of what blocks compose to are the values. `slot`
/// holds 3 lanes maps.
template <class Map, class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void recur_by_maps(const ThreadGroup& workers, R* x, const R* y, const R* floor,
                                          int block, int end, R a, R x0, Map* slot) {
  static_assert(!ThreadGroup::is_alone);  // `each` runs lanes here
  const int part = part_of(block);
  const R slope = slope_of(a, part);
  R joined = part < block ? slope * slope : slope;
  Map* const low = slot + 2 * workers.lanes;
  workers.each([=](int lane) {
    const int begin = lane * block, middle = begin + part;
    const Map first = lane == 0 ? Map::constant(x0) : Map::at_least(floor[begin], y[begin]);
    low[lane] = compose(first, y + begin, floor + begin, part, a);
    slot[lane] =
        part == block
            ? low[lane]
            : after(compose(Map::at_least(floor[middle], y[middle]), y + middle, floor + middle, part, a),
                    slope, low[lane]);
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
    const R inflow = lane > 0 ? from[lane - 1].lo : x0;
    R value = inflow;
    for (int m = 0; m < block; ++m) {
      const int i = lane * block + m;
      if (m == part) value = lane == 0 ? low[lane].lo : low[lane].at(inflow, slope);
      value = i == 0 ? x0 : device::maximum(floor[i], a * value + y[i]);
      x[i] = i < end ? value : R(0.0);
    }
  });
}

/// The same for a of any sign; `slot` holds 3 lanes ClampedMaps.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void recur_forward(const ThreadGroup& workers, R* x, const R* y, const R* floor,
                                          int block, int end, R a, R x0, R* slot) {
  if (workers.all(a >= R(0.0))) {
    recur_by_maps(workers, x, y, floor, block, end, a, x0, reinterpret_cast<MaxAffineMap<R>*>(slot));
  } else {
    recur_by_maps(workers, x, y, floor, block, end, a, x0, reinterpret_cast<ClampedMap<R>*>(slot));
  }
}

}  // namespace drogue::options
