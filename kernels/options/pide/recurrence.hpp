#pragma once

#include "kernels/device/warp.hpp"
#include "kernels/options/pide/thread_group.hpp"
#include "kernels/options/transforms/lane_nodes.hpp"

/// First-order recurrences along the nodes of an option, cut into blocks for lanes.
namespace drogue::options {

/// Nodes per part of a lane's block. Blocks of eight nodes or more have two parts, which shortens the chain
/// of dependent operations.
KOKKOS_INLINE_FUNCTION constexpr int part_length(int block) {
  return block >= 8 && block % 2 == 0 ? block / 2 : block;
}

/// Slope of the composition of `count` maps of equal slope: slope^count.
template <class R>
KOKKOS_INLINE_FUNCTION R composed_slope(R slope, int count) {
  R product = slope;
  for (int m = 1; m < count; ++m) product = product * slope;
  return product;
}

/// Solves y_i = a_i + g y_{i+1} in place for `count` nodes, with 0 beyond the last one. Returns the first
/// value.
template <class R>
KOKKOS_INLINE_FUNCTION R sweep_backward(R* y, int count, R g) {
  R value = y[count - 1];
  for (int m = count - 2; m >= 0; --m) {
    value = y[m] + g * value;
    y[m] = value;
  }
  return value;
}

/// Adds to a solution of `sweep_backward` the contribution of `inflow`, the value beyond the last node.
template <class R>
KOKKOS_INLINE_FUNCTION void add_inflow_backward(R* y, int count, R g, R inflow) {
  for (int m = count - 1; m >= 0; --m) {
    inflow = g * inflow;
    y[m] = y[m] + inflow;
  }
}

/// Solves the recurrence within a lane's block, part by part, with 0 beyond it. Returns the first value of
/// the block.
template <class R>
KOKKOS_INLINE_FUNCTION R sweep_block_backward(R* own, int block, R g, R slope) {
  const int part = part_length(block);
  const R low = sweep_backward(own, part, g);
  return part == block ? low : low + slope * sweep_backward(own + part, part, g);
}

/// Adds to a result of `sweep_block_backward` the contribution of `inflow`, the value beyond the block.
template <class R>
KOKKOS_INLINE_FUNCTION void add_inflow_to_block(R* own, int block, R g, R slope, R inflow) {
  const int part = part_length(block);
  if (part < block) {
    const R high = own[part] + slope * inflow;
    add_inflow_backward(own + part, part, g, inflow);
    inflow = high;
  }
  add_inflow_backward(own, part, g, inflow);
}

/// Solves y_i = a_i + g y_{i+1}, i = 0 .. lanes block - 1, in place on n arrays, with 0 beyond the end. Each
/// lane solves its block, then the blocks are combined by a parallel scan (Kogge and Stone 1973). `scratch`
/// holds 2 lanes values.
template <int n, class R>
KOKKOS_INLINE_FUNCTION void recur_backward(const SerialThreadGroup<R>& group, R* const (&rows)[n], int block,
                                           R g, R* scratch) {
  const int part = part_length(block);
  const R slope = composed_slope(g, part);
  for (R* const y : rows) {
    R block_slope = part < block ? slope * slope : slope;
    group.each([=](int lane) { scratch[lane] = sweep_block_backward(y + lane * block, block, g, slope); });
    R *from = scratch, *to = scratch + group.lanes;
    for (int lane_offset = 1; lane_offset < group.lanes; lane_offset *= 2) {
      group.each([=](int lane) {
        to[lane] = lane + lane_offset < group.lanes ? from[lane] + block_slope * from[lane + lane_offset]
                                                    : from[lane];
      });
      block_slope = block_slope * block_slope;
      R* const other = from;
      from = to;
      to = other;
    }
    group.each([=](int lane) {
      add_inflow_to_block(y + lane * block, block, g, slope,
                          lane + 1 < group.lanes ? from[lane + 1] : R(0.0));
    });
  }
}

/// Inclusive scan of the first values of all blocks, n per lane, from above. `block_slope` is the slope of
/// one block. Only the first of each `stride` threads holds a valid carry.
template <int lanes, int stride = 1, int n>
KOKKOS_INLINE_FUNCTION void scan_backward(int lane, double (&carry)[n], double block_slope) {
  for (int lane_offset = stride; lane_offset < lanes; lane_offset *= 2) {
    for (double& own : carry) {
      const double next = device::shuffle_down<lanes>(own, lane_offset);
      if (lane + lane_offset < lanes) own = own + block_slope * next;
    }
    block_slope = block_slope * block_slope;
  }
}

/// Version for a warp, whose lanes exchange the carries by shuffles.
template <int n, int lanes, bool single>
KOKKOS_INLINE_FUNCTION void recur_backward(const WarpThreadGroup<lanes, single>& group,
                                           double* const (&rows)[n], int block, double g,
                                           double* /*scratch*/) {
  const int lane = group.lane;
  if constexpr (single && lanes < max_lanes) {  // each group of lanes solves one row
    static_assert(n == max_lanes / lanes);
    recur_backward(WarpThreadGroup<lanes>(lane), {rows[group.thread / lanes]}, block, g,
                   static_cast<double*>(nullptr));
  } else {
    const int part = part_length(block);
    const double slope = composed_slope(g, part);
    double carry[n];
    for (int k = 0; k < n; ++k) carry[k] = sweep_block_backward(rows[k] + lane * block, block, g, slope);
    scan_backward<lanes>(lane, carry, part < block ? slope * slope : slope);
    for (int k = 0; k < n; ++k) {
      const double inflow = device::shuffle_down<lanes>(carry[k], 1);
      add_inflow_to_block(rows[k] + lane * block, block, g, slope, lane + 1 < lanes ? inflow : 0.0);
    }
    group.sync();
  }
}

/// Map x -> max(lo, a x + b), a >= 0 common to all maps. The set is closed under composition, so the maps are
/// elements of a parallel scan.
template <class R>
struct MaxAffineMap {
  R b, lo;
  KOKKOS_INLINE_FUNCTION static MaxAffineMap at_least(R lo, R b) { return {b, lo}; }
  KOKKOS_INLINE_FUNCTION static MaxAffineMap constant(R x) { return {x, x}; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R apply(R x, R a) const { return device::maximum(lo, a * x + b); }
};

/// Composition of `second` after `first`; a2 is the slope of `second`.
template <class R>
KOKKOS_INLINE_FUNCTION MaxAffineMap<R> compose(const MaxAffineMap<R>& second, R a2,
                                               const MaxAffineMap<R>& first) {
  return {a2 * first.b + second.b, device::maximum(second.lo, a2 * first.lo + second.b)};
}

/// Replaces infinity in bounds: products with a slope stay finite.
inline constexpr double unbounded = 1e200;

/// Map x -> min(hi, max(lo, a x + b)), a of either sign and common to all maps. The set is closed under
/// composition. Without negative slopes `hi` has no effect, and b and lo equal those of a MaxAffineMap bit
/// for bit.
template <class R>
struct ClampedMap {
  R b, lo, hi;
  KOKKOS_INLINE_FUNCTION static ClampedMap at_least(R lo, R b) { return {b, lo, R(unbounded)}; }
  KOKKOS_INLINE_FUNCTION static ClampedMap constant(R x) { return {x, x, x}; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION R apply(R x, R a) const {
    return device::maximum(lo, device::minimum(hi, a * x + b));
  }
};

template <class R>
KOKKOS_INLINE_FUNCTION ClampedMap<R> compose(const ClampedMap<R>& second, R a2, const ClampedMap<R>& first) {
  const R low = device::maximum(second.lo, device::minimum(second.hi, a2 * first.lo + second.b));
  const R high = device::maximum(second.lo, device::minimum(second.hi, a2 * first.hi + second.b));
  return {a2 * first.b + second.b, device::minimum(low, high), device::maximum(low, high)};
}

/// Composition of the maps of a part; `map` is that of its first node.
template <class Map, class R>
KOKKOS_INLINE_FUNCTION Map compose_part(Map map, const R* y, const R* floor, int count, R a) {
  for (int m = 1; m < count; ++m) map = compose(Map::at_least(floor[m], y[m]), a, map);
  return map;
}

/// Solves x_i = max(floor_i, a x_{i-1} + y_i) for the nodes 1, 2, ... of all blocks; x_0 is given, and nodes
/// from `end` on are set to 0. The map of the first block is constant, so the bounds of the scanned maps are
/// the values. `scratch` holds 3 lanes maps.
template <class Map, class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void recur_by_maps(const ThreadGroup& group, R* x, const R* y, const R* floor,
                                          int block, int end, R a, R x0, Map* scratch) {
  static_assert(!ThreadGroup::is_single);  // `each` must run over lanes
  const int part = part_length(block);
  const R slope = composed_slope(a, part);
  R block_slope = part < block ? slope * slope : slope;
  Map* const low = scratch + 2 * group.lanes;
  group.each([=](int lane) {
    const int begin = lane * block, middle = begin + part;
    const Map first = lane == 0 ? Map::constant(x0) : Map::at_least(floor[begin], y[begin]);
    low[lane] = compose_part(first, y + begin, floor + begin, part, a);
    scratch[lane] = part == block ? low[lane]
                                  : compose(compose_part(Map::at_least(floor[middle], y[middle]), y + middle,
                                                         floor + middle, part, a),
                                            slope, low[lane]);
  });
  Map *from = scratch, *to = scratch + group.lanes;
  for (int lane_offset = 1; lane_offset < group.lanes; lane_offset *= 2) {
    group.each([=](int lane) {
      to[lane] =
          lane >= lane_offset ? compose(from[lane], block_slope, from[lane - lane_offset]) : from[lane];
    });
    block_slope = block_slope * block_slope;
    Map* const other = from;
    from = to;
    to = other;
  }
  group.each([=](int lane) {
    const R inflow = lane > 0 ? from[lane - 1].lo : x0;
    R value = inflow;
    for (int m = 0; m < block; ++m) {
      const int i = lane * block + m;
      if (m == part) value = lane == 0 ? low[lane].lo : low[lane].apply(inflow, slope);
      value = i == 0 ? x0 : device::maximum(floor[i], a * value + y[i]);
      x[i] = i < end ? value : R(0.0);
    }
  });
}

/// Version for a of either sign; `scratch` holds 3 lanes ClampedMaps.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void recur_forward(const ThreadGroup& group, R* x, const R* y, const R* floor,
                                          int block, int end, R a, R x0, R* scratch) {
  if (group.all(a >= R(0.0))) {
    recur_by_maps(group, x, y, floor, block, end, a, x0, reinterpret_cast<MaxAffineMap<R>*>(scratch));
  } else {
    recur_by_maps(group, x, y, floor, block, end, a, x0, reinterpret_cast<ClampedMap<R>*>(scratch));
  }
}

/// `recur_backward` on nodes in registers. With `halved` two adjacent threads hold the two halves of a lane's
/// block.
template <int lanes, bool halved = false, int block>
KOKKOS_INLINE_FUNCTION void recur_backward(int lane, LaneNodes<block>& nodes, double g) {
  if constexpr (halved) {
    const double slope = composed_slope(g, block), low = sweep_backward(nodes.node, block, g),
                 high = device::shuffle_down<lanes>(low, 1);
    double carry[] = {low + slope * high};
    scan_backward<lanes, 2>(lane, carry, slope * slope);
    const int next = lane / 2 * 2 + 2;
    double inflow = device::shuffle(carry[0], next);
    if (next == lanes) inflow = 0.0;  // discards the value that wraps around
    add_inflow_backward(nodes.node, block, g, lane % 2 == 0 ? high + slope * inflow : inflow);
  } else {
    constexpr int part = part_length(block);
    const double slope = composed_slope(g, part);
    double carry[] = {sweep_block_backward(nodes.node, block, g, slope)};
    scan_backward<lanes>(lane, carry, part < block ? slope * slope : slope);
    const double inflow = device::shuffle_down<lanes>(carry[0], 1);
    add_inflow_to_block(nodes.node, block, g, slope, lane + 1 < lanes ? inflow : 0.0);
  }
}

/// Map of the thread `lane_offset` lanes below.
template <int lanes>
KOKKOS_INLINE_FUNCTION MaxAffineMap<double> shuffle_up(const MaxAffineMap<double>& map, int lane_offset) {
  return {device::shuffle_up<lanes>(map.b, lane_offset), device::shuffle_up<lanes>(map.lo, lane_offset)};
}
template <int lanes>
KOKKOS_INLINE_FUNCTION ClampedMap<double> shuffle_up(const ClampedMap<double>& map, int lane_offset) {
  return {device::shuffle_up<lanes>(map.b, lane_offset), device::shuffle_up<lanes>(map.lo, lane_offset),
          device::shuffle_up<lanes>(map.hi, lane_offset)};
}

/// Inclusive scan of the maps of all lanes from below; `block_slope` is the slope of one block. Only the last
/// of each `stride` threads holds a valid map.
template <int lanes, int stride = 1, class Map>
KOKKOS_INLINE_FUNCTION void scan_forward(int lane, Map& map, double block_slope) {
  for (int lane_offset = stride; lane_offset < lanes; lane_offset *= 2) {
    const Map whole = compose(map, block_slope, shuffle_up<lanes>(map, lane_offset));
    if (lane >= lane_offset) map = whole;
    block_slope *= block_slope;
  }
}

/// `recur_by_maps` on nodes in registers.
template <int lanes, class Map, bool halved = false, int block>
KOKKOS_INLINE_FUNCTION LaneNodes<block> recur_by_maps(int lane, const LaneNodes<block>& y,
                                                      const LaneNodes<block>& floor, double a, double x0) {
  constexpr int part = halved ? block : part_length(block);
  double slope = a;  // not by `composed_slope`: NVIDIA's compiler would spill twice as many registers in the
                     // kernel of 64 nodes
  for (int m = 1; m < part; ++m) slope *= a;
  const auto map_of = [&](int m) {
    const Map node = lane == 0 && m == 0 ? Map::constant(x0) : Map::at_least(floor.node[m], y.node[m]);
    return compose_part(node, y.node + m, floor.node + m, part, a);
  };
  const Map first = map_of(0);
  double begin[2];  // values that flow into the parts
  if constexpr (halved) {
    const Map low = shuffle_up<lanes>(first, 1);
    Map map = compose(first, slope, low);
    scan_forward<lanes, 2>(lane, map, slope * slope);
    const double inflow = device::shuffle(map.lo, lane / 2 * 2 - 1);  // not used by the first two threads
    begin[0] = lane % 2 == 0 ? inflow : lane == 1 ? low.lo : low.apply(inflow, slope);
  } else {
    Map map = first;
    if constexpr (part < block) map = compose(map_of(part), slope, first);
    scan_forward<lanes>(lane, map, part < block ? slope * slope : slope);
    begin[0] = device::shuffle_up<lanes>(map.lo, 1);
    begin[1] = lane == 0 ? first.lo : first.apply(begin[0], slope);
  }
  LaneNodes<block> x;
  for (int k = 0; k < block; k += part) {
    double value = begin[k / part];
    for (int m = k; m < k + part; ++m) {
      value = lane == 0 && m == 0 ? x0 : device::maximum(floor.node[m], a * value + y.node[m]);
      x.node[m] = value;
    }
  }
  return x;
}

}  // namespace drogue::options
