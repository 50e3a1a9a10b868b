#pragma once

#include "kernels/device/warp.hpp"
#include "kernels/options/pide/march.hpp"
#include "kernels/options/pide/recurrence.hpp"
#include "kernels/options/transforms/register_fourier.hpp"
#include "kernels/options/transforms/shared_fourier.hpp"

/// A march with the nodes of one option in the registers of its lanes, `block` adjacent nodes per lane. With
/// `halved` two threads share a lane's nodes, and `lane` and `lanes` count threads. The arithmetic equals
/// that of `step` in value and order. Shared memory exchanges values between lanes in the sum over jumps.
namespace drogue::options {

/// `convolve` for lanes x block intervals: each lane computes 2 block nodes for half of the values. Its
/// weights form a window that slides through registers. The results are stored `swizzled`. Pointers that do
/// not change between steps are computed once.
template <int block, int lanes>
class RegisterConvolution {
 public:
  /// Weights `w`, per year, in the order of a WeightLayout; values `v` as a fraction of the strike.
  KOKKOS_INLINE_FUNCTION RegisterConvolution(int lane, const double* w, const double* v, double* out,
                                             double* other) {
    const WeightLayout<double> layout(mesh);
    const int part = lane / chunks, chunk = lane % chunks;
    const int jump = 8 * half * part - outs * chunk;
    for (int k = 0; k < 8 / outs; ++k) _weights[k] = w + layout.place(jump + k * outs);
    _values = reinterpret_cast<const NodePair*>(v) + 4 * half * part;
    for (int m = 0; m < outs; m += 2)
      _sums[m / 2] = reinterpret_cast<NodePair*>(part == 0 ? out : other) + swizzled((outs * chunk + m) / 2);
  }

  KOKKOS_INLINE_FUNCTION void operator()() const {
    constexpr int last = 8 / outs - 1;  // row of weights that overlaps the row before the first one
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

/// Second differences v_{i-1} - 2 v_i + v_{i+1} of a lane's nodes. The ghost value beyond the grid is `ghost`
/// times the last value. The result at node 0 is not used.
template <int lanes, int block>
KOKKOS_INLINE_FUNCTION LaneNodes<block> second_differences(int lane, const LaneNodes<block>& value,
                                                           double ghost) {
  const double below = device::shuffle_up<lanes>(value.node[block - 1], 1);
  double above = device::shuffle_down<lanes>(value.node[0], 1);
  if (lane + 1 == lanes) above = ghost * value.node[block - 1];
  LaneNodes<block> difference;
  for (int m = 0; m < block; ++m)
    difference.node[m] = (m == 0 ? below : value.node[m - 1]) - 2.0 * value.node[m] +
                         (m + 1 == block ? above : value.node[m + 1]);
  return difference;
}

/// Shared memory of a march, (node_count) each.
struct RegisterRows {
  double* value;        ///< in plain order after the march: V at maturity
  double *out, *other;  ///< contiguous: memory of a transform; after the march dV/dtau in `other`
  double* multiplier;   ///< Lagrange multiplier of split exercise
};

/// Sum over jumps at a lane's nodes, by `RegisterConvolution`, `RegisterFourier` or `SharedFourier`.
template <int block, int lanes, bool transformed>
class JumpSum {
 public:
  /// Weights `w`, per year, in the order of a WeightLayout; `rows`: shared memory of the march.
  KOKKOS_INLINE_FUNCTION JumpSum(int lane, const double* w, const JumpSpectrum<double>& /*spectrum*/,
                                 const RegisterRows& rows)
      : _lane(lane), _rows(rows), _convolution(lane, w, rows.value, rows.out, rows.other) {}

  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION LaneNodes<block> operator()(const ThreadGroup& group,
                                                     const LaneNodes<block>& value) const {
    group.each_lane([&] { value.store(_lane, _rows.value); });
    group.each_lane(_convolution);
    LaneNodes<block> sum = LaneNodes<block>::load_swizzled(_lane, _rows.out);
    const LaneNodes<block> rest = LaneNodes<block>::load_swizzled(_lane, _rows.other);
    for (int m = 0; m < block; ++m) sum.node[m] += rest.node[m];
    return sum;
  }

 private:
  int _lane;
  RegisterRows _rows;
  RegisterConvolution<block, lanes> _convolution;
};
template <>  // for `halved`; 32 lanes of four nodes without transforms use the primary template
class JumpSum<4, max_lanes, true> : public SharedFourier {
 public:
  /// Spectrum of the weights, per year; `rows`: shared memory of the march.
  KOKKOS_INLINE_FUNCTION JumpSum(int thread, const double* /*w*/, const JumpSpectrum<double>& spectrum,
                                 const RegisterRows& rows)
      : SharedFourier(thread, spectrum, rows.value, reinterpret_cast<ComplexNumber<double>*>(rows.out)) {}
};
template <int lanes>
class JumpSum<8, lanes, true> : public RegisterFourier<lanes> {
 public:
  /// Spectrum of the weights, per year; `rows`: shared memory of the march.
  KOKKOS_INLINE_FUNCTION JumpSum(int lane, const double* /*w*/, const JumpSpectrum<double>& spectrum,
                                 const RegisterRows& rows)
      : RegisterFourier<lanes>(lane, spectrum, rows.value,
                               reinterpret_cast<ComplexNumber<double>*>(rows.out)) {}
};

/// Converts an array of node values, in any unit, from plain to `swizzled` order.
template <int block, class ThreadGroup>
KOKKOS_INLINE_FUNCTION void swizzle(const ThreadGroup& group, double* nodes) {
  const auto own = LaneNodes<block>::load(group.lane, nodes);
  group.sync();
  if (group.is_writer()) own.store_swizzled(group.lane, nodes);
}

/// Marches from expiry to maturity; leaves `jumps.exit_mass` and `exit_price` `swizzled`. `strike_value`:
/// payoff at the strike as a fraction of it. Returns the last exercised node below the strike, -1 if there is
/// none.
template <int block, bool halved = false, int lanes, bool single>
KOKKOS_INLINE_FUNCTION int march_in_registers(const WarpThreadGroup<lanes, single>& group,
                                              const PutPack<double>& put, const Jumps<double>& jumps,
                                              const Grid<double>& grid, const JumpSpectrum<double>& spectrum,
                                              const Scheme<double>& scheme, const StepTable<double>& table,
                                              const RegisterRows& rows, double strike_value) {
  using Own = LaneNodes<block>;
  const int lane = group.lane, strike = static_cast<int>(grid.strike);
  const double h = grid.h, reaction = -jumps.rate - put.rate;
  const JumpSum<block, lanes, halved || is_transformed(lanes * block, lanes)> sum_over_jumps(lane, jumps.w,
                                                                                             spectrum, rows);
  Own value, before{}, explicit_before{}, floor;
  DiscountFactors<double> discount{1.0, 1.0};
  if (group.is_writer()) before.store(lane, rows.multiplier);
  swizzle<block>(group, jumps.exit_mass);
  swizzle<block>(group, jumps.exit_price);
  for (int m = 0; m < block; ++m) {
    const InitialNode<double> node = initial_node(put, grid, lane * block + m, strike_value);
    value.node[m] = node.value;
    floor.node[m] = node.floor;
  }
  for (int n = 1; n <= scheme.steps; ++n) {
    if (n % max_lanes == 1) {
      group.sync();
      fill_table(group, put, jumps, scheme, table, n);
    }
    group.sync_duplicates();
    const Own sum = sum_over_jumps(group, value);
    const StepFactors<double> f = table.load(n);
    const Own exit_mass = Own::load_swizzled(lane, jumps.exit_mass),
              exit_price = Own::load_swizzled(lane, jumps.exit_price);
    group.sync_duplicates();
    if (n == scheme.steps && group.is_writer()) before.store_swizzled(lane, rows.out);
    Own y;
    for (int m = 0; m < block; ++m) {
      const double explicit_now = explicit_part(discount, sum.node[m], reaction * value.node[m],
                                                exit_mass.node[m], exit_price.node[m]);
      y.node[m] = right_side(f, value.node[m], before.node[m], explicit_now, explicit_before.node[m]);
      explicit_before.node[m] = explicit_now;
    }
    if (!group.all(f.compensation <= 0.0)) {
      const double ghost = ghost_factor(f, jumps.moved / (h * h));
      const Own difference = second_differences<lanes>(lane, value, ghost),
                difference_before = second_differences<lanes>(lane, before, ghost);
      for (int m = 0; m < block; ++m)
        y.node[m] = y.node[m] -
                    (f.compensation * difference.node[m] - f.compensation_before * difference_before.node[m]);
    }
    if (put.any_split) {
      const Own multiplier = Own::load(lane, rows.multiplier);
      for (int m = 0; m < block; ++m) y.node[m] += f.inverse_pivot * multiplier.node[m];
    }
    discount = f.discount;
    before = value;
    recur_backward<lanes, halved>(lane, y, f.from_right);
    value =
        group.all(f.from_left >= 0.0)
            ? recur_by_maps<lanes, MaxAffineMap<double>, halved>(lane, y, floor, f.from_left, f.left_value)
            : recur_by_maps<lanes, ClampedMap<double>, halved>(lane, y, floor, f.from_left, f.left_value);
    if (put.any_split) {
      group.sync();  // the swizzled stores of the sum over jumps place two halves of a lane together
      group.each_lane([&] { value.store(lane, rows.value); });
      apply_split_exercise(group, put, grid, f.diagonal, rows.value, rows.multiplier);
      value = Own::load(lane, rows.value);
      group.sync();
    }
  }
  group.sync_duplicates();
  const Own oldest = Own::load_swizzled(lane, rows.out);
  const StepLength<double> last = step_length(put.maturity, scheme.steps, scheme.steps);
  Own time_derivative;
  int exercised = -1;
  for (int m = 0; m < block; ++m) {
    const int i = lane * block + m;
    time_derivative.node[m] = bdf_derivative(last, value.node[m], before.node[m], oldest.node[m]);
    if (i < strike && is_exercised(value.node[m], i - strike, h)) exercised = i;
  }
  group.sync();
  group.each_lane([&] {
    value.store(lane, rows.value);
    time_derivative.store(lane, rows.other);
    if (lane == 0)
      rows.value[grid.mesh] = rows.other[grid.mesh] = 0.0;  // upper end, which the interpolation reads
  });
  return device::warp_maximum<lanes>(exercised);
}

}  // namespace drogue::options
