#pragma once

#include <utility>

#include "kernels/options/grid/grid.hpp"
#include "kernels/options/levy/tails.hpp"

namespace drogue::options {

/// y g(y) on the heavier side at y = d h, d = 1 .. mesh: the mixture times e^{|beta| y}, in two parts, that
/// of even and that of odd terms. Terms that have died out at h add nothing. `ratio` holds Mixture::size
/// values.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION void sum_mixture(const ThreadGroup& workers, const PutPack<R>& put,
                                        const LevyMeasure<R>& law, R h, int mesh, R* ratio, R* even, R* odd) {
  constexpr int at_once = 4;  // terms that do not wait for one another
  static_assert(Mixture::size % (2 * at_once) == 0);
  const R tilt = device::absolute(put.jump[2]);
  const R *s = law.s, *c = law.c;
  workers.each([=](int thread) {
    for (int q = thread; q < Mixture::size; q += workers.threads()) ratio[q] = exponential((tilt - s[q]) * h);
  });
  workers.each([=](int thread) {
    const int octets = (mesh + 7) / 8;
    for (int task = thread; task < 2 * octets; task += workers.threads()) {
      const int part = task / octets, first = task % octets * 8 + 1;
      R sum[8] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
      for (int q = part; q < Mixture::size; q += 2 * at_once) {
        if (device::all((s[q] - tilt) * h > R(30.0))) break;  // the rates of all members rise with q
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

/// The weights up (d > 0) and down of jumps by d nodes.
template <class R>
struct WeightPair {
  R up, down;
};

template <class R>
KOKKOS_INLINE_FUNCTION WeightPair<R> kou_weights(const PutPack<R>& put, R h, int d) {
  const auto cell = [=](R mass, R decay) {
    return mass * (exponential(decay * h * (0.5 - d)) - exponential(decay * h * (-0.5 - d)));
  };
  return {cell(put.jump[0] * put.jump[1], put.jump[2]), cell(put.jump[0] * (1.0 - put.jump[1]), put.jump[3])};
}

/// The integral from z to infinity of what a normal density has above.
template <class R>
KOKKOS_INLINE_FUNCTION R summed_above(R z) {
  return 0.3989422804014327 * exponential(-0.5 * z * z) - z * normal_upper_tail(z);
}

/// The part of jumps of a normal density that goes to the node at d h, by a hat over the two steps beside it.
/// Between two nodes a jump is shared so that its mean stays, however narrow the density is. Of the last node
/// the hat ends where it is highest. One loop, whose length the compiler does not know: a GPU has no
/// registers for three of its bodies.
template <class R>
KOKKOS_INLINE_FUNCTION R normal_part(R mean, R per, R h, int d, bool last) {
  const R centre = (double(d) * h - mean) * per, reach = h * per;
  // The second difference is the same for the mirrored density, whose tail does not cancel.
  const R middle = last ? centre : device::absolute(centre);
  const int points = last ? 2 : 3;
  R sum = 0.0;
  for (int k = 0; k < points; ++k) {
    const double times = k != 1 ? 1.0 : last ? -1.0 : -2.0;
    sum += times * summed_above(middle + (k - 1.0) * reach);
  }
  const R part = sum * device::reciprocal(reach);
  return last ? part - normal_upper_tail(centre) : part;
}

template <class R>
KOKKOS_INLINE_FUNCTION WeightPair<R> merton_weights(const PutPack<R>& put, R h, int d, bool last) {
  const R per = 1.0 / merton_deviation(put), mean = put.jump[1];
  return {put.jump[0] * normal_part(mean, per, h, d, last),
          put.jump[0] * normal_part(-mean, per, h, d, last)};
}

/// cos(pi 2^{-k/2}), k = 0 .. 15.
struct AngleCosines {
  static constexpr double of[symbols] = {-1.0,
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

  /// Calls f(k, cosine) for all of them, of which the compiler knows the numbers: an array of registers could
  /// not be indexed.
  template <class F>
  KOKKOS_INLINE_FUNCTION static void each(const F& f) {
    each(f, std::make_integer_sequence<int, symbols>());
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

/// Scratch memory of `jumps_of`: that of the result, and sums.
template <class R>
struct JumpsMemory {
  R *w, *left, *left_price, *symbol;
  R *even, *odd;  ///< (node_count), as the next
  R* both;        ///< the sums of both weights of a distance
  R* ratio;       ///< (Mixture::size)
  R* slot;        ///< (2 most_lanes)
};

/// The weights of jumps by d nodes: a mixture's are nodal values of the density. On a grid of twice the steps
/// they are those of the finer one; d h is the same there. `tilted` is e^{-2 |beta| d h}.
template <class R>
KOKKOS_INLINE_FUNCTION WeightPair<R> weights(const PutPack<R>& put, const Grid<R>& grid, int d, R tilted,
                                             const R* even, const R* odd, const R* finer) {
  if (put.model == Model::kou) return kou_weights(put, grid.h, d);
  if (put.model == Model::merton) return merton_weights(put, grid.h, d, d == grid.mesh);
  if (put.model != Model::generalized_hyperbolic) return {R(0.0), R(0.0)};
  // Half of the first is what differences stand for; that of the last is among the tails.
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

/// Sets the weights up, if given from those of a grid of half the steps. A mixture's are nodal values: with
/// what they leave of the variance as a difference the scheme is of second order for every density that x^2
/// makes bounded (Cont and Voltchkova 2005 for the idea), and no quadrature is needed. Kou's are masses of
/// cells, Merton's, whose density may be narrow, those of hats.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION Jumps<R> jumps_of(const ThreadGroup& workers, const PutPack<R>& put,
                                         const LevyMeasure<R>& law, const Tails<R>& tails,
                                         const Grid<R>& grid, const JumpsMemory<R>& memory, const R* finer) {
  const int mesh = grid.mesh, nodes = node_count(mesh);
  const R h = grid.h;
  const WeightLayout<R> layout(mesh);
  const bool mixed = put.model == Model::generalized_hyperbolic;
  workers.each([=](int thread) {
    for (int k = thread; k < layout.size(); k += workers.threads()) memory.w[k] = 0.0;
    for (int k = thread; k < nodes; k += workers.threads()) memory.left[k] = memory.left_price[k] = 0.0;
  });
  if (mixed && finer == nullptr)
    sum_mixture(workers, put, law, h, mesh, memory.ratio, memory.even, memory.odd);
  const R tilt = mixed && finer == nullptr ? R(-2.0 * device::absolute(put.jump[2]) * h) : R(0.0);
  const R next_growth = exponential(double(workers.lanes) * h),
          next_tilted = exponential(double(workers.lanes) * tilt);
  const Kokkos::Array<R, 3> whole = sums(workers, [=, &put, &grid](int lane) {
    R rate = 0.0, variance = 0.0, price = 0.0;
    R growth = exponential((lane + 1.0) * h), tilted = exponential((lane + 1.0) * tilt);
    for (int d = 1 + lane; d <= mesh; d += workers.lanes) {
      const double part = put.model == Model::kou && d == mesh ? 0.5 : 1.0;
      const WeightPair<R> pair = weights(put, grid, d, tilted, memory.even, memory.odd, finer);
      const R up = part * pair.up, down = part * pair.down, both = up + down;
      const R y = double(d) * h, down_price = down * device::reciprocal(growth);
      if (workers.writes()) {
        memory.w[layout.place(d)] = up;
        memory.w[layout.place(-d)] = down;
        memory.both[d] = both;
        if (d >= 2) {
          memory.left[d - 1] = down;
          memory.left_price[d - 1] = down_price;
        }
      }
      rate += both;
      variance += both * y * y;
      price += (growth - 1.0) * (up - down_price);
      growth = device::minimum(growth * next_growth, R(1e304));
      tilted = tilted * next_tilted;
    }
    return Kokkos::Array<R, 3>{rate, variance, price};
  });
  workers.meet();
  Jumps<R> jumps{};
  jumps.w = memory.w;
  jumps.left = memory.left;
  jumps.left_price = memory.left_price;
  jumps.symbol = memory.symbol;
  jumps.rate = whole[0] + tails.up + tails.down;
  const R rest = law.variance - whole[1] - tails.variance;
  jumps.diffusion = 0.5 * device::maximum(R(0.0), put.variance + rest);
  jumps.excess = device::maximum(R(0.0), -(put.variance + rest));
  const R compensator = whole[2] + (tails.up_price - tails.up) + (tails.down_price - tails.down);
  const R growth = exponential(0.5 * h), shrink = device::reciprocal(growth);
  const R chord = growth - shrink;  // 2 sinh(h/2)
  const R sinh = 0.5 * chord * (growth + shrink);
  const R per = device::reciprocal(h);
  jumps.drift = (put.rate - put.dividend - compensator - jumps.diffusion * (chord * per) * (chord * per)) *
                h * device::reciprocal(sinh);
  workers.each([=](int thread) {
    if (thread == 0) {
      memory.left[mesh - 1] += tails.down;
      memory.left_price[mesh - 1] += tails.down_price;
    }
    // The odd d of all angles first, then the even ones.
    for (int task = thread; task < 2 * symbols; task += workers.threads()) {
      double cosine = 0.0;
      AngleCosines::each([&](int k, double known) { cosine = k == task % symbols ? known : cosine; });
      const double twice = 2.0 * (2.0 * cosine * cosine - 1.0);
      const int first = task < symbols ? 1 : 2;
      double before = first == 1 ? cosine : 1.0, now = first == 1 ? cosine : 0.5 * twice;
      R sum = 0.0;
      for (int d = first; d <= mesh; d += 2) {
        sum += now * memory.both[d];
        const double next = twice * now - before;
        before = now;
        now = next;
      }
      memory.slot[task] = sum;
    }
  });
  workers.each([=](int lane) {
    if (lane < symbols) memory.symbol[lane] = jumps.rate - (memory.slot[lane] + memory.slot[symbols + lane]);
  });
  recur_backward(workers, {memory.left, memory.left_price}, block_of(mesh, workers.lanes), R(1.0),
                 memory.slot);
  workers.each([=](int thread) {
    for (int i = 1 + thread; i < mesh; i += workers.threads())
      memory.left_price[i] = memory.left_price[i] * exponential((double(i) - grid.strike) * h);
  });
  return jumps;
}

}  // namespace drogue::options
