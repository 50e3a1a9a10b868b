#pragma once

#include <utility>

#include "kernels/options/grid/grid.hpp"
#include "kernels/options/levy/tails.hpp"
#include "kernels/options/pide/recurrence.hpp"

namespace drogue::options {

/// y g(y) at y = d h, d = 1 .. mesh, on the side with the heavier tail: the mixture times e^{|beta| y}, as
/// two partial sums over its even and its odd terms. Terms that are negligible at h are omitted. `ratio`
/// holds Mixture::size values.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void sum_mixture(const ThreadGroup& group, const PutPack<R>& put,
                                        const LevyMeasure<R>& measure, R h, int mesh, R* ratio, R* even,
                                        R* odd) {
  constexpr int at_once = 4;  // independent terms, for instruction-level parallelism
  static_assert(Mixture::size % (2 * at_once) == 0);
  const R tilt = device::absolute(put.jump[2]);
  const R *s = measure.s, *c = measure.c;
  group.each([=](int thread) {
    for (int q = thread; q < Mixture::size; q += group.threads()) ratio[q] = exponential((tilt - s[q]) * h);
  });
  group.each([=](int thread) {
    const int octets = (mesh + 7) / 8;
    for (int task = thread; task < 2 * octets; task += group.threads()) {
      const int part = task / octets, first = task % octets * 8 + 1;
      R sum[8] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
      for (int q = part; q < Mixture::size; q += 2 * at_once) {
        if (device::all((s[q] - tilt) * h > R(30.0))) break;  // the rates of all members increase with q
        R power[at_once], by[at_once];
        for (int i = 0; i < at_once; ++i) {
          const R rate = (s[q + 2 * i] - tilt) * h;
          by[i] = ratio[q + 2 * i];
          power[i] =
              device::select(rate > R(30.0), R(0.0), c[q + 2 * i] * exponential(rate * -double(first)));
        }
        for (int m = 0; m < 8; ++m)
          for (int i = 0; i < at_once; ++i) {
            sum[m] += power[i];
            power[i] = power[i] * by[i];
          }
      }
      R* to = (part == 0 ? even : odd) + first;
      for (int m = 0; m < 8; ++m) to[m] = sum[m];
    }
  });
}

/// Weights of jumps by d nodes upwards and downwards, per year.
template <class R>
struct WeightPair {
  R up, down;
};

/// Weights of Kou's jumps by d nodes: masses of cells, per year.
template <class R>
KOKKOS_INLINE_FUNCTION WeightPair<R> kou_weights(const PutPack<R>& put, R h, int d) {
  const auto cell = [=](R mass, R decay) {
    return mass * (exponential(decay * h * (0.5 - d)) - exponential(decay * h * (-0.5 - d)));
  };
  return {cell(put.jump[0] * put.jump[1], put.jump[2]), cell(put.jump[0] * (1.0 - put.jump[1]), put.jump[3])};
}

/// Integral from z to infinity of the upper tail probability of a standard normal variable.
template <class R>
KOKKOS_INLINE_FUNCTION R normal_tail_integral(R z) {
  return 0.3989422804014327 * exponential(-0.5 * z * z) - z * normal_upper_tail(z);
}

/// Part of normally distributed jumps that is assigned to the node d h by a hat function over the two
/// adjacent intervals. Assigning a jump to its two neighbouring nodes preserves its mean for any standard
/// deviation. At the last node the hat function ends at its maximum. One loop of a length unknown to the
/// compiler: three unrolled bodies exceed the registers of a GPU.
template <class R>
KOKKOS_INLINE_FUNCTION R normal_hat_mass(R mean, R inverse_deviation, R h, int d, bool last) {
  const R centre = (double(d) * h - mean) * inverse_deviation, width = h * inverse_deviation;
  // The second difference equals that of the mirrored density, whose tail does not cancel.
  const R middle = last ? centre : device::absolute(centre);
  const int points = last ? 2 : 3;
  R sum = 0.0;
  for (int k = 0; k < points; ++k) {
    const double times = k != 1 ? 1.0 : last ? -1.0 : -2.0;
    sum += times * normal_tail_integral(middle + (k - 1.0) * width);
  }
  const R part = sum * device::reciprocal(width);
  return last ? part - normal_upper_tail(centre) : part;
}

/// Weights of Merton's jumps by d nodes, per year; `last`: d is the largest distance.
template <class R>
KOKKOS_INLINE_FUNCTION WeightPair<R> merton_weights(const PutPack<R>& put, R h, int d, bool last) {
  const R inverse_deviation = 1.0 / merton_deviation(put), mean = put.jump[1];
  return {put.jump[0] * normal_hat_mass(mean, inverse_deviation, h, d, last),
          put.jump[0] * normal_hat_mass(-mean, inverse_deviation, h, d, last)};
}

/// cos(pi 2^{-k/2}), k = 0 .. 15.
struct AngleCosines {
  static constexpr double of[symbol_count] = {-1.0,
                                              -0.60569968077342403,
                                              0.0,
                                              0.44406709312226836,
                                              0.70710678118654757,
                                              0.84972234063003164,
                                              0.92387953251128674,
                                              0.96171261162945637,
                                              0.98078528040323043,
                                              0.99038193932259957,
                                              0.99518472667219693,
                                              0.99759258832293451,
                                              0.99879545620517241,
                                              0.99939796607266041,
                                              0.99969881869620425,
                                              0.99984948021804443};

  /// Calls f(k, cosine) for all angles with compile-time indices, since registers cannot be indexed at run
  /// time.
  template <class F>
  KOKKOS_INLINE_FUNCTION static void each(const F& f) {
    each(f, std::make_integer_sequence<int, symbol_count>());
  }

 private:
  template <class F, int... k>
  KOKKOS_INLINE_FUNCTION static void each(const F& f, std::integer_sequence<int, k...> /*all*/) {
    (call<k>(f), ...);
  }
  template <int k, class F>
  KOKKOS_INLINE_FUNCTION static void call(const F& f) {
    constexpr double cosine = of[k];
    f(k, cosine);
  }
};

/// Scratch memory of `discretize_jumps`: arrays of the result and partial sums.
template <class R>
struct JumpsMemory {
  R *w, *exit_mass, *exit_price, *symbol;
  R *even, *odd;  ///< (node_count), as is `both`
  R* both;        ///< sum of the upward and downward weights of a distance
  R* ratio;       ///< (Mixture::size)
  R* scratch;     ///< (2 max_lanes)
};

/// Weights of jumps by d nodes, per year. A mixture has nodal values of the density. On the coarser grid
/// these are taken from the finer one, since d h is the same there. `tilted` is e^{-2 |beta| d h}.
template <class R>
KOKKOS_INLINE_FUNCTION WeightPair<R> jump_weights(const PutPack<R>& put, const Grid<R>& grid, int d, R tilted,
                                                  const R* even, const R* odd, const R* finer) {
  if (put.model == JumpModel::kou) return kou_weights(put, grid.h, d);
  if (put.model == JumpModel::merton) return merton_weights(put, grid.h, d, d == grid.mesh);
  if (put.model != JumpModel::generalized_hyperbolic) return {R(0.0), R(0.0)};
  // Half of the first weight is represented by finite differences; half of the last one belongs to the tails.
  if (finer != nullptr) {
    const WeightLayout<R> layout(2 * grid.mesh);
    const double part = d == 1 ? 1.0 : 2.0;
    return {part * finer[layout.place(2 * d)], part * finer[layout.place(-2 * d)]};
  }
  const double part = d == grid.mesh || d == 1 ? 0.5 : 1.0;
  const R heavy = (even[d] + odd[d]) * (part * device::reciprocal(double(d)));
  const R light = heavy * tilted;
  const auto upwards = put.jump[2] > R(0.0);
  return {device::select(upwards, heavy, light), device::select(upwards, light, heavy)};
}

/// Discretizes the jumps on `grid`. With `finer`, the weights of a grid of half the step, those of a mixture
/// are taken from it. A mixture has nodal values of the density. With the remaining variance as a finite
/// difference the scheme is of second order for every density that x^2 makes bounded (idea of Cont and
/// Voltchkova 2005), without quadrature. The weights of Kou's jumps are masses of cells. Merton's, whose
/// density may be narrow, are masses of hat functions.
///
/// D and b are implicit in time, the weights explicit, which has another error dt^2. Of a mixture, D and b
/// depend on h in first order, so that this error would contain h dt^2, which the extrapolation from both
/// grids does not remove. So the finer grid moves the part `moved` of the variance, and the mean that goes
/// with it, from the weights of d = +-1 to finite differences: that which the weights have in excess of those
/// of the coarser grid. The operator remains the same.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION Jumps<R> discretize_jumps(const ThreadGroup& group, const PutPack<R>& put,
                                                 const LevyMeasure<R>& measure, const Tails<R>& tails,
                                                 const Grid<R>& grid, const JumpsMemory<R>& memory,
                                                 const R* finer) {
  const int mesh = grid.mesh, nodes = node_count(mesh);
  const R h = grid.h;
  const WeightLayout<R> layout(mesh);
  const bool mixed = put.model == JumpModel::generalized_hyperbolic;
  group.each([=](int thread) {
    for (int k = thread; k < layout.size(); k += group.threads()) memory.w[k] = 0.0;
    for (int k = thread; k < nodes; k += group.threads()) memory.exit_mass[k] = memory.exit_price[k] = 0.0;
  });
  if (mixed && finer == nullptr)
    sum_mixture(group, put, measure, h, mesh, memory.ratio, memory.even, memory.odd);
  const R tilt = mixed && finer == nullptr ? R(-2.0 * device::absolute(put.jump[2]) * h) : R(0.0);
  const R next_growth = exponential(double(group.lanes) * h),
          next_tilted = exponential(double(group.lanes) * tilt);
  const bool moves = mixed && finer == nullptr;
  // With twice the weights of even d, and once that of d = 2, the coarser grid has less than this one by the
  // sum over odd d less that over even d from 4 on.
  const Kokkos::Array<R, 5> whole = sums(group, [=, &put, &grid](int lane) {
    R rate = 0.0, variance = 0.0, price = 0.0, more_variance = 0.0, more_price = 0.0;
    R growth = exponential((lane + 1.0) * h), tilted = exponential((lane + 1.0) * tilt);
    for (int d = 1 + lane; d <= mesh; d += group.lanes) {
      const double part = put.model == JumpModel::kou && d == mesh ? 0.5 : 1.0;
      const WeightPair<R> pair = jump_weights(put, grid, d, tilted, memory.even, memory.odd, finer);
      const R up = part * pair.up, down = part * pair.down, both = up + down;
      const R y = double(d) * h, down_price = down * device::reciprocal(growth);
      if (group.is_writer()) {
        memory.w[layout.place(d)] = up;
        memory.w[layout.place(-d)] = down;
        memory.both[d] = both;
        if (d >= 2) {
          memory.exit_mass[d - 1] = down;
          memory.exit_price[d - 1] = down_price;
        }
      }
      rate += both;
      const R square = both * y * y, gain = (growth - 1.0) * (up - down_price);
      variance += square;
      price += gain;
      const double sign = !moves || d == 2 ? 0.0 : d % 2 == 0 ? -1.0 : 1.0;
      more_variance += sign * square;
      more_price += sign * gain;
      growth = device::minimum(growth * next_growth, R(1e304));
      tilted = tilted * next_tilted;
    }
    return Kokkos::Array<R, 5>{rate, variance, price, more_variance, more_price};
  });
  group.sync();
  Jumps<R> jumps{};
  jumps.w = memory.w;
  jumps.exit_mass = memory.exit_mass;
  jumps.exit_price = memory.exit_price;
  jumps.symbol = memory.symbol;
  const R rest = measure.variance - whole[1] - tails.variance;
  const R remaining = 0.5 * device::maximum(R(0.0), put.variance + rest);
  const R growth = exponential(0.5 * h), shrink = device::reciprocal(growth);
  const R chord = growth - shrink;   // 2 sinh(h/2)
  const R shared = 1.0 - put.split;  // splitting of exercise has an error of first order in time
  jumps.moved = shared * device::minimum(device::maximum(R(0.0), 0.5 * whole[3]), remaining);
  jumps.diffusion = remaining + jumps.moved;
  // Rates taken from the weights of d = 1 and d = -1, of the variance 2 `moved` and the compensator whole[4].
  const R moved_rate = 2.0 * jumps.moved * device::reciprocal(h * h);
  const R moved_up = (shared * whole[4] + moved_rate * chord * shrink) *
                     device::reciprocal(chord * (growth + shrink)),
          moved_down = moved_rate - moved_up;
  jumps.rate = whole[0] + tails.up + tails.down - moved_rate;
  jumps.excess_variance = device::maximum(R(0.0), -(put.variance + rest));
  const R compensator = whole[2] + (tails.up_price - tails.up) + (tails.down_price - tails.down) -
                        chord * (moved_up * growth - moved_down * shrink);
  const R sinh = 0.5 * chord * (growth + shrink);
  const R inverse_deviation = device::reciprocal(h);
  jumps.drift = (put.rate - put.dividend - compensator -
                 jumps.diffusion * (chord * inverse_deviation) * (chord * inverse_deviation)) *
                h * device::reciprocal(sinh);
  group.each([=](int thread) {
    if (thread == 0) {
      memory.w[layout.place(1)] = memory.w[layout.place(1)] - moved_up;
      memory.w[layout.place(-1)] = memory.w[layout.place(-1)] - moved_down;
      memory.exit_mass[mesh - 1] += tails.down;
      memory.exit_price[mesh - 1] += tails.down_price;
    }
    // First the odd d of all angles, then the even ones.
    for (int task = thread; task < 2 * symbol_count; task += group.threads()) {
      double cosine = 0.0;
      AngleCosines::each([&](int k, double known) { cosine = k == task % symbol_count ? known : cosine; });
      const double twice = 2.0 * (2.0 * cosine * cosine - 1.0);
      const int first = task < symbol_count ? 1 : 2;
      double before = first == 1 ? cosine : 1.0, now = first == 1 ? cosine : 0.5 * twice;
      R sum = first == 1 ? R(-cosine * moved_rate) : R(0.0);
      for (int d = first; d <= mesh; d += 2) {
        sum += now * memory.both[d];
        const double next = twice * now - before;
        before = now;
        now = next;
      }
      memory.scratch[task] = sum;
    }
  });
  group.each([=](int lane) {
    if (lane < symbol_count)
      memory.symbol[lane] = jumps.rate - (memory.scratch[lane] + memory.scratch[symbol_count + lane]);
  });
  recur_backward(group, {memory.exit_mass, memory.exit_price}, block_of(mesh, group.lanes), R(1.0),
                 memory.scratch);
  group.each([=](int thread) {
    for (int i = 1 + thread; i < mesh; i += group.threads())
      memory.exit_price[i] = memory.exit_price[i] * exponential((double(i) - grid.strike) * h);
  });
  return jumps;
}

}  // namespace drogue::options
