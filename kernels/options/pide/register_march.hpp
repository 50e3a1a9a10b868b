#pragma once

#include "kernels/device/warp.hpp"
#include "kernels/options/pide/march.hpp"
#include "kernels/options/transforms/register_fourier.hpp"
#include "kernels/options/transforms/shared_fourier.hpp"

/// A march with the nodes of one option in the registers of a group of lanes, each of which has `block` nodes
/// side by side; or `halved`: of two threads for each lane, which `lane` and `lanes` count then. It does what
/// `step` does, number by number and in the same order. Shared memory holds what lanes read of one another in
/// the sum over jumps.
namespace drogue::options {

/// `convolve` for lanes x block intervals: a task of 2 block nodes and half of the values for every lane. The
/// weights that a task needs are a window that slides through registers. Results lie `swizzled`. What does
/// not change from step to step is found once.
template <int block, int lanes>
class Convolution {
 public:
  KOKKOS_INLINE_FUNCTION Convolution(int lane, const double* w, const double* v, double* out, double* other) {
    const WeightLayout<double> layout(mesh);
    const int part = lane / chunks, chunk = lane % chunks;
    const int jump = 8 * half * part - outs * chunk;
    for (int k = 0; k < 8 / outs; ++k) _weights[k] = w + layout.place(jump + k * outs);
    _values = reinterpret_cast<const NodePair*>(v) + 4 * half * part;
    for (int m = 0; m < outs; m += 2)
      _sums[m / 2] = reinterpret_cast<NodePair*>(part == 0 ? out : other) + swizzled((outs * chunk + m) / 2);
  }

  KOKKOS_INLINE_FUNCTION void operator()() const {
    constexpr int last = 8 / outs - 1;  // the row of the weights before the first lies under the last
    double sum[outs], window[outs + 7];
    for (int m = 0; m < outs; ++m) sum[m] = 0.0;
    for (int m = 0; m < outs - 1; ++m) window[m] = _weights[last][(m + 1) * stride - 1];
    for (int u = 0; u < half; ++u) {
      for (int k = 0; k < 8; ++k) window[outs - 1 + k] = _weights[k / outs][k % outs * stride + u];
      for (int k = 0; k < 8; k += 2) {
        const NodePair value = _values[4 * u + k / 2];
        for (int m = 0; m < outs; ++m) sum[m] += window[outs - 1 + k - m] * value.first;
        for (int m = 0; m < outs; ++m) sum[m] += window[outs + k - m] * value.second;
      }
      for (int m = 0; m < outs - 1; ++m) window[m] = window[8 + m];
    }
    for (int m = 0; m < outs; m += 2) *_sums[m / 2] = {sum[m], sum[m + 1]};
  }

 private:
  static constexpr int mesh = lanes * block, outs = 2 * block, chunks = lanes / 2, half = mesh / 8 / 2;
  static constexpr int stride = WeightLayout<double>(mesh).stride;
  static_assert(outs <= 8);

  const double* _weights[8 / outs];
  const NodePair* _values;
  NodePair* _sums[(outs + 1) / 2];
};

/// `recur_backward` on registers.
template <int lanes, bool halved = false, int block>
KOKKOS_INLINE_FUNCTION void recur_backward(int lane, LaneNodes<block>& nodes, double g) {
  if constexpr (halved) {
    const double slope = slope_of(g, block), low = run_backward(nodes.node, block, g),
                 high = device::shuffle_down<lanes>(low, 1);
    double carry[] = {low + slope * high};
    join_backward<lanes, 2>(lane, carry, slope * slope);
    const int next = lane / 2 * 2 + 2;
    double inflow = device::shuffle(carry[0], next);
    if (next == lanes) inflow = 0.0;  // not what the first one has
    flow_backward(nodes.node, block, g, lane % 2 == 0 ? high + slope * inflow : inflow);
  } else {
    constexpr int part = part_of(block);
    const double slope = slope_of(g, part);
    double carry[] = {begin_backward(nodes.node, block, g, slope)};
    join_backward<lanes>(lane, carry, part < block ? slope * slope : slope);
    const double inflow = device::shuffle_down<lanes>(carry[0], 1);
    end_backward(nodes.node, block, g, slope, lane + 1 < lanes ? inflow : 0.0);
  }
}

/// The map of the lane `reach` below.
template <int lanes>
KOKKOS_INLINE_FUNCTION MaxAffineMap<double> shuffle_up(const MaxAffineMap<double>& map, int reach) {
  return {device::shuffle_up<lanes>(map.b, reach), device::shuffle_up<lanes>(map.lo, reach)};
}
template <int lanes>
KOKKOS_INLINE_FUNCTION ClampedMap<double> shuffle_up(const ClampedMap<double>& map, int reach) {
  return {device::shuffle_up<lanes>(map.b, reach), device::shuffle_up<lanes>(map.lo, reach),
          device::shuffle_up<lanes>(map.hi, reach)};
}

/// Joins the maps of lanes to those of all below; `joined` is the slope of one. Of each `stride` threads the
/// last counts.
template <int lanes, int stride = 1, class Map>
KOKKOS_INLINE_FUNCTION void join_forward(int lane, Map& map, double joined) {
  for (int reach = stride; reach < lanes; reach *= 2) {
    const Map whole = after(map, joined, shuffle_up<lanes>(map, reach));
    if (lane >= reach) map = whole;
    joined *= joined;
  }
}

/// `recur_by_maps` on registers.
template <int lanes, class Map, bool halved = false, int block>
KOKKOS_INLINE_FUNCTION LaneNodes<block> recur_by_maps(int lane, const LaneNodes<block>& y,
                                                      const LaneNodes<block>& floor, double a, double x0) {
  constexpr int part = halved ? block : part_of(block);
  double slope = a;  // not by `slope_of`: the kernel of 64 nodes would spill twice as much
  for (int m = 1; m < part; ++m) slope *= a;
  const auto map_of = [&](int m) {
    const Map node = lane == 0 && m == 0 ? Map::constant(x0) : Map::at_least(floor.node[m], y.node[m]);
    return compose(node, y.node + m, floor.node + m, part, a);
  };
  const Map first = map_of(0);
  double begin[2];  // what flows into the parts
  if constexpr (halved) {
    const Map low = shuffle_up<lanes>(first, 1);
    Map map = after(first, slope, low);
    join_forward<lanes, 2>(lane, map, slope * slope);
    const double inflow = device::shuffle(map.lo, lane / 2 * 2 - 1);  // of no use to the first two
    begin[0] = lane % 2 == 0 ? inflow : lane == 1 ? low.lo : low.at(inflow, slope);
  } else {
    Map map = first;
    if constexpr (part < block) map = after(map_of(part), slope, first);
    join_forward<lanes>(lane, map, part < block ? slope * slope : slope);
    begin[0] = device::shuffle_up<lanes>(map.lo, 1);
    begin[1] = lane == 0 ? first.lo : first.at(begin[0], slope);
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

/// v_{i-1} - 2 v_i + v_{i+1} of a lane's nodes; beyond the grid v is the part `beyond` of the last one, and
/// node 0 gets what is of no use.
template <int lanes, int block>
KOKKOS_INLINE_FUNCTION LaneNodes<block> bends_of(int lane, const LaneNodes<block>& value, double beyond) {
  const double below = device::shuffle_up<lanes>(value.node[block - 1], 1);
  double above = device::shuffle_down<lanes>(value.node[0], 1);
  if (lane + 1 == lanes) above = beyond * value.node[block - 1];
  LaneNodes<block> bend;
  for (int m = 0; m < block; ++m)
    bend.node[m] = (m == 0 ? below : value.node[m - 1]) - 2.0 * value.node[m] +
                   (m + 1 == block ? above : value.node[m + 1]);
  return bend;
}

/// Shared memory of a march, (node_count) each.
struct RegisterRows {
  double* value;        ///< at maturity, in plain order when the march is over
  double *out, *other;  ///< one after the other: room for a transform; in the end dV/dtau in `other`
  double* force;        ///< of split puts
};

/// The sum over jumps of a lane's nodes, by `Convolution`, `RegisterFourier` or `SharedFourier`.
template <int block, int lanes, bool transformed>
class JumpSum {
 public:
  KOKKOS_INLINE_FUNCTION JumpSum(int lane, const double* w, const JumpSpectrum<double>& /*spectrum*/,
                                 const RegisterRows& rows)
      : _lane(lane), _rows(rows), _convolution(lane, w, rows.value, rows.out, rows.other) {}

  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION LaneNodes<block> operator()(const ThreadGroup& workers,
                                                     const LaneNodes<block>& value) const {
    workers.each_lane([&] { value.store(_lane, _rows.value); });
    workers.each_lane(_convolution);
    LaneNodes<block> sum = LaneNodes<block>::load_swizzled(_lane, _rows.out);
    const LaneNodes<block> rest = LaneNodes<block>::load_swizzled(_lane, _rows.other);
    for (int m = 0; m < block; ++m) sum.node[m] += rest.node[m];
    return sum;
  }

 private:
  int _lane;
  RegisterRows _rows;
  Convolution<block, lanes> _convolution;
};
template <>  // halved: 32 lanes of four nodes would sum as it stands there
class JumpSum<4, most_lanes, true> : public SharedFourier {
 public:
  KOKKOS_INLINE_FUNCTION JumpSum(int thread, const double* /*w*/, const JumpSpectrum<double>& spectrum,
                                 const RegisterRows& rows)
      : SharedFourier(thread, spectrum, rows.value, reinterpret_cast<ComplexNumber<double>*>(rows.out)) {}
};
template <int lanes>
class JumpSum<8, lanes, true> : public RegisterFourier<lanes> {
 public:
  KOKKOS_INLINE_FUNCTION JumpSum(int lane, const double* /*w*/, const JumpSpectrum<double>& spectrum,
                                 const RegisterRows& rows)
      : RegisterFourier<lanes>(lane, spectrum, rows.value,
                               reinterpret_cast<ComplexNumber<double>*>(rows.out)) {}
};

/// Turns an array of nodes in plain order into a `swizzled` one.
template <int block, class ThreadGroup>
KOKKOS_INLINE_FUNCTION void swizzle(const ThreadGroup& workers, double* nodes) {
  const auto own = LaneNodes<block>::load(workers.lane, nodes);
  workers.meet();
  if (workers.writes()) own.store_swizzled(workers.lane, nodes);
}

/// Marches from expiry to maturity; `jumps.left` and `left_price` are left `swizzled`. Returns the last node
/// below the strike that is exercised, -1 if none is.
template <int block, bool halved = false, int lanes, bool alone>
KOKKOS_INLINE_FUNCTION int march_in_registers(const WarpWorkers<lanes, alone>& workers,
                                              const PutPack<double>& put, const Jumps<double>& jumps,
                                              const Grid<double>& grid, const JumpSpectrum<double>& spectrum,
                                              const Scheme<double>& scheme, const StepTable<double>& table,
                                              const RegisterRows& rows, double kink) {
  using Own = LaneNodes<block>;
  const int lane = workers.lane, strike = static_cast<int>(grid.strike);
  const double h = grid.h, stay = -jumps.rate - put.rate;
  const JumpSum<block, lanes, halved || is_transformed(lanes * block, lanes)> sum_over_jumps(lane, jumps.w,
                                                                                             spectrum, rows);
  Own value, before{}, stale{}, floor;
  Certain<double> begun{1.0, 1.0};
  if (workers.writes()) before.store(lane, rows.force);
  swizzle<block>(workers, jumps.left);
  swizzle<block>(workers, jumps.left_price);
  for (int m = 0; m < block; ++m) {
    const AtExpiry<double> node = at_expiry(put, grid, lane * block + m, kink);
    value.node[m] = node.value;
    floor.node[m] = node.floor;
  }
  for (int n = 1; n <= scheme.steps; ++n) {
    if (n % most_lanes == 1) {
      workers.meet();
      fill_table(workers, put, jumps, scheme, table, n);
    }
    workers.meet_alike();
    const Own sum = sum_over_jumps(workers, value);
    const StepFactors<double> f = table.load(n);
    const Own left = Own::load_swizzled(lane, jumps.left),
              left_price = Own::load_swizzled(lane, jumps.left_price);
    workers.meet_alike();
    if (n == scheme.steps && workers.writes()) before.store_swizzled(lane, rows.out);
    Own y;
    for (int m = 0; m < block; ++m) {
      const double fresh =
          explicit_part(begun, sum.node[m], stay * value.node[m], left.node[m], left_price.node[m]);
      y.node[m] = right_side(f, value.node[m], before.node[m], fresh, stale.node[m]);
      stale.node[m] = fresh;
    }
    if (!workers.all(f.bend <= 0.0)) {
      const double beyond = taken_beyond(f);
      const Own bend = bends_of<lanes>(lane, value, beyond),
                bend_before = bends_of<lanes>(lane, before, beyond);
      for (int m = 0; m < block; ++m)
        y.node[m] = y.node[m] - (f.bend * bend.node[m] - f.bend_before * bend_before.node[m]);
    }
    if (put.any_split) {
      const Own force = Own::load(lane, rows.force);
      for (int m = 0; m < block; ++m) y.node[m] += f.inverse * force.node[m];
    }
    begun = f.certain;
    before = value;
    recur_backward<lanes, halved>(lane, y, f.from_right);
    value = workers.all(f.from_left >= 0.0)
                ? recur_by_maps<lanes, MaxAffineMap<double>, halved>(lane, y, floor, f.from_left, f.edge)
                : recur_by_maps<lanes, ClampedMap<double>, halved>(lane, y, floor, f.from_left, f.edge);
    if (put.any_split) {
      workers.meet();  // swizzled, as sums over jumps store them, two halves of a lane share their places
      workers.each_lane([&] { value.store(lane, rows.value); });
      split_exercise(workers, put, grid, f.diagonal, rows.value, rows.force);
      value = Own::load(lane, rows.value);
      workers.meet();
    }
  }
  workers.meet_alike();
  const Own oldest = Own::load_swizzled(lane, rows.out);
  const StepLength<double> last = step_length(put.maturity, scheme.steps, scheme.steps);
  Own change;
  int exercised = -1;
  for (int m = 0; m < block; ++m) {
    const int i = lane * block + m;
    change.node[m] = rate_of_change(last, value.node[m], before.node[m], oldest.node[m]);
    if (i < strike && is_exercised(value.node[m], i - strike, h)) exercised = i;
  }
  workers.meet();
  workers.each_lane([&] {
    value.store(lane, rows.value);
    change.store(lane, rows.other);
    if (lane == 0) rows.value[grid.mesh] = rows.other[grid.mesh] = 0.0;  // the upper end, which answers read
  });
  return device::warp_max<lanes>(exercised);
}

}  // namespace drogue::options
