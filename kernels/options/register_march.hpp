#pragma once

#include "kernels/device/warp.hpp"
#include "kernels/options/march.hpp"

/// A march with the nodes of one option in the registers of a warp, for meshes of 32 `block` intervals: lane
/// L has the nodes L block, ..., L block + block - 1. It does what `step` does, number by number and in the
/// same order. Shared memory holds what lanes read of one another in the sum over jumps.
namespace drogue::options {

/// Two neighbours of an array in shared memory, which are read and written at once.
struct alignas(16) NodePair {
  double first, second;
};

/// Place of a pair of nodes in an array of results. Lanes that write eight nodes each, and lanes that read
/// `block` nodes each, then find them in different banks.
KOKKOS_INLINE_FUNCTION int swizzled(int pair) { return (pair & ~3) | ((pair & 3) ^ ((pair >> 3) & 3)); }

/// `convolve` for 32 block intervals: tasks of as many nodes as give every lane one, at most eight. The
/// weights that a task needs are a window that slides through registers. Results lie `swizzled`.
template <int block>
KOKKOS_INLINE_FUNCTION void convolve_tiles(int lane, const double* w, const double* v, double* out,
                                           double* other) {
  constexpr int mesh = lanes * block, outs = block < 4 ? 2 * block : 8, chunks = mesh / outs;
  constexpr int half = mesh / 8 / 2;
  const WeightLayout<double> layout(mesh);
  for (int task = lane; task < 2 * chunks; task += lanes) {
    const int part = task / chunks, chunk = task % chunks;
    const int begin = layout.centre + 8 * half * part - outs * chunk;
    const double* from[8 / outs];
    for (int k = 0; k < 8 / outs; ++k)
      from[k] = w + (begin + k * outs) % 8 * layout.stride + (begin + k * outs) / 8;
    double sum[outs], window[outs + 7];
    for (int m = 0; m < outs; ++m) sum[m] = 0.0;
    for (int m = 0; m < outs - 1; ++m) window[m] = w[layout.place(begin - layout.centre - (outs - 1) + m)];
    const auto* values = reinterpret_cast<const NodePair*>(v) + 4 * half * part;
    for (int u = 0; u < half; ++u, values += 4) {
      for (int k = 0; k < 8; ++k) window[outs - 1 + k] = from[k / outs][k % outs * layout.stride + u];
      for (int k = 0; k < 8; k += 2) {
        const NodePair value = values[k / 2];
        for (int m = 0; m < outs; ++m) sum[m] += window[outs - 1 + k - m] * value.first;
        for (int m = 0; m < outs; ++m) sum[m] += window[outs + k - m] * value.second;
      }
      for (int m = 0; m < outs - 1; ++m) window[m] = window[8 + m];
    }
    auto* to = reinterpret_cast<NodePair*>(part == 0 ? out : other);
    for (int m = 0; m < outs; m += 2) to[swizzled((outs * chunk + m) / 2)] = {sum[m], sum[m + 1]};
  }
}

/// A lane's nodes of an array, read and written by pairs where it has pairs.
template <int block>
struct LaneNodes {
  double node[block];

  /// From an array in plain order.
  KOKKOS_INLINE_FUNCTION static LaneNodes load(int lane, const double* from) {
    return load(lane, from, [](int pair) { return pair; });
  }
  KOKKOS_INLINE_FUNCTION void store(int lane, double* to) const {
    store(lane, to, [](int pair) { return pair; });
  }
  /// From an array whose pairs lie `swizzled`.
  KOKKOS_INLINE_FUNCTION static LaneNodes load_swizzled(int lane, const double* from) {
    return load(lane, from, [](int pair) { return swizzled(pair); });
  }
  KOKKOS_INLINE_FUNCTION void store_swizzled(int lane, double* to) const {
    store(lane, to, [](int pair) { return swizzled(pair); });
  }

 private:
  template <class Place>
  KOKKOS_INLINE_FUNCTION static LaneNodes load(int lane, const double* from, const Place& place) {
    LaneNodes nodes;
    if constexpr (block == 1) {
      nodes.node[0] = from[2 * place(lane / 2) + lane % 2];
    } else {
      for (int m = 0; m < block; m += 2) {
        const NodePair pair = reinterpret_cast<const NodePair*>(from)[place((lane * block + m) / 2)];
        nodes.node[m] = pair.first;
        nodes.node[m + 1] = pair.second;
      }
    }
    return nodes;
  }
  template <class Place>
  KOKKOS_INLINE_FUNCTION void store(int lane, double* to, const Place& place) const {
    if constexpr (block == 1) {
      to[2 * place(lane / 2) + lane % 2] = node[0];
    } else {
      for (int m = 0; m < block; m += 2)
        reinterpret_cast<NodePair*>(to)[place((lane * block + m) / 2)] = {node[m], node[m + 1]};
    }
  }
};

/// `recur_backward` on registers.
template <int block>
KOKKOS_INLINE_FUNCTION void recur_backward(int lane, LaneNodes<block>& nodes, double g) {
  double(&y)[block] = nodes.node;
  double joined = g;
  for (int m = 1; m < block; ++m) joined *= g;
  for (int m = block - 2; m >= 0; --m) y[m] += g * y[m + 1];
  double carry = y[0];
  for (int reach = 1; reach < lanes; reach *= 2) {
    const double next = device::from_above(carry, reach);
    if (lane + reach < lanes) carry += joined * next;
    joined *= joined;
  }
  double inflow = device::from_above(carry, 1);
  if (lane + 1 == lanes) return;
  for (int m = block - 1; m >= 0; --m) {
    inflow *= g;
    y[m] += inflow;
  }
}

/// `recur_forward` on registers for a >= 0.
template <int block>
KOKKOS_INLINE_FUNCTION LaneNodes<block> recur_forward(int lane, const LaneNodes<block>& nodes,
                                                      const LaneNodes<block>& floors, double a, double x0) {
  const double(&y)[block] = nodes.node, (&floor)[block] = floors.node;
  using Map = RisingMap<double>;
  double joined = a;
  for (int m = 1; m < block; ++m) joined *= a;
  Map map = lane == 0 ? Map::constant(x0) : Map::at_least(floor[0], y[0]);
  for (int m = 1; m < block; ++m) map = after(Map::at_least(floor[m], y[m]), a, map);
  for (int reach = 1; reach < lanes; reach *= 2) {
    const Map below{device::from_below(map.b, reach), device::from_below(map.lo, reach)};
    if (lane >= reach) map = after(map, joined, below);
    joined *= joined;
  }
  const double inflow = device::from_below(map.lo, 1);
  LaneNodes<block> x;
  x.node[0] = lane == 0 ? x0 : device::maximum(floor[0], a * inflow + y[0]);
  for (int m = 1; m < block; ++m) x.node[m] = device::maximum(floor[m], a * x.node[m - 1] + y[m]);
  return x;
}

/// v_{i-1} - 2 v_i + v_{i+1} of a lane's nodes; 0 beyond the grid, and of no use at node 0.
template <int block>
KOKKOS_INLINE_FUNCTION LaneNodes<block> bends_of(int lane, const LaneNodes<block>& value) {
  const double below = device::from_below(value.node[block - 1], 1);
  double above = device::from_above(value.node[0], 1);
  if (lane + 1 == lanes) above = 0.0;
  LaneNodes<block> bend;
  for (int m = 0; m < block; ++m)
    bend.node[m] = (m == 0 ? below : value.node[m - 1]) - 2.0 * value.node[m] +
                   (m + 1 == block ? above : value.node[m + 1]);
  return bend;
}

/// Shared memory of a march, (node_count) each but `slot`.
struct RegisterRows {
  double* value;        ///< at maturity, in plain order when the march is over
  double *out, *other;  ///< `other`: in the end dV/dtau in plain order
  double* force;        ///< of split puts
  double* slot;         ///< (6 lanes)
};

/// Marches from expiry to maturity. Returns the last node below the strike that is exercised, -1 if none is.
template <int block>
KOKKOS_INLINE_FUNCTION int march_in_registers(const WarpWorkers& workers, const PutPack<double>& put,
                                              const Jumps<double>& jumps, const Grid<double>& grid,
                                              const Scheme<double>& scheme, const StepTable<double>& table,
                                              const RegisterRows& rows, double kink) {
  using Own = LaneNodes<block>;
  const int lane = workers.lane, strike = static_cast<int>(grid.strike);
  const double h = grid.h, stay = -jumps.rate - put.rate;
  Own value, before{}, stale{}, floor;
  before.store(lane, rows.force);
  for (int m = 0; m < block; ++m) {
    const double x = (double(lane * block + m) - grid.strike) * h;
    const double payoff = device::maximum(0.0, 1.0 - exponential(x));
    value.node[m] = device::absolute(x) < 0.5 * h ? kink : payoff;
    floor.node[m] = put.early * (1.0 - put.split) > 0.0 ? payoff : -unbounded;
  }
  for (int n = 1; n <= scheme.steps; ++n) {
    if (n % lanes == 1) {
      workers.meet();
      fill_table(workers, put, jumps, scheme, table, n);
    }
    value.store(lane, rows.value);
    workers.meet();
    convolve_tiles<block>(lane, jumps.w, rows.value, rows.out, rows.other);
    workers.meet();
    const StepFactors<double> f = table.load(n);
    const Own sum = Own::load_swizzled(lane, rows.out), rest = Own::load_swizzled(lane, rows.other),
              left = Own::load(lane, jumps.left), left_price = Own::load(lane, jumps.left_price);
    if (n == scheme.steps) before.store_swizzled(lane, rows.out);
    Own y;
    for (int m = 0; m < block; ++m) {
      const double outside = f.strike * left.node[m] - f.asset * left_price.node[m];
      const double explicit_part = (sum.node[m] + rest.node[m]) + (stay * value.node[m] + outside);
      y.node[m] = f.value * value.node[m] - f.before * before.node[m] + f.fresh * explicit_part -
                  f.stale * stale.node[m];
      stale.node[m] = explicit_part;
    }
    if (!(f.bend <= 0.0)) {
      const Own bend = bends_of(lane, value), bend_before = bends_of(lane, before);
      for (int m = 0; m < block; ++m)
        y.node[m] = y.node[m] - (f.bend * bend.node[m] - f.bend_before * bend_before.node[m]);
    }
    if (put.any_split) {
      const Own force = Own::load(lane, rows.force);
      for (int m = 0; m < block; ++m) y.node[m] += f.inverse * force.node[m];
    }
    before = value;
    recur_backward(lane, y, f.from_right);
    if (f.from_left >= 0.0) {
      value = recur_forward(lane, y, floor, f.from_left, f.edge);
    } else {
      // Rare: a drift that the diffusion left does not carry. Rows that the step no longer needs serve.
      workers.meet();
      y.store(lane, rows.value);
      floor.store(lane, rows.other);
      workers.meet();
      recur_by_maps(workers, rows.value, rows.value, rows.other, block, grid.mesh, f.from_left, f.edge,
                    reinterpret_cast<ClampedMap<double>*>(rows.slot));
      value = Own::load(lane, rows.value);
    }
    if (put.any_split) {
      value.store(lane, rows.value);
      workers.meet();
      split_exercise(workers, put, grid, f.diagonal, rows.value, rows.force);
      value = Own::load(lane, rows.value);
    }
  }
  const Own oldest = Own::load_swizzled(lane, rows.out);
  const StepLength<double> last = step_length(put.maturity, scheme.steps, scheme.steps);
  const double per = 1.0 / (last.dt * (1.0 + last.ratio));
  Own change;
  int exercised = -1;
  for (int m = 0; m < block; ++m) {
    const int i = lane * block + m;
    change.node[m] = rate_of_change(last, per, value.node[m], before.node[m], oldest.node[m]);
    if (i < strike && is_exercised(value.node[m], i - strike, h)) exercised = i;
  }
  workers.meet();
  value.store(lane, rows.value);
  change.store(lane, rows.other);
  workers.meet();
  return device::warp_largest(exercised);
}

}  // namespace drogue::options
