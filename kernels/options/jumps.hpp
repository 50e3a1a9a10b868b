#pragma once

#include "kernels/options/grid.hpp"
#include "kernels/options/tails.hpp"

namespace drogue::options {

/// y g(y) on the heavier side at y = first h, (first + 1) h, ...: the mixture times e^{|beta| y}. Terms that
/// have died out at h add nothing.
template <class R>
KOKKOS_INLINE_FUNCTION void add_mixture(const PutPack<R>& put, const Law<R>& law, R h, int first, int count,
                                        R* sum) {
  const R tilt = device::absolute(put.jump[2]);
  for (int m = 0; m < count; ++m) sum[m] = 0.0;
  for (int q = 0; q < Mixture::size; ++q) {
    const R rate = (law.s[q] - tilt) * h;
    if (device::all(rate > R(30.0))) break;  // the rates of all members rise with q
    const R ratio = exponential(-rate);
    R power = device::select(rate > R(30.0), R(0.0), law.c[q] * exponential(rate * -double(first)));
    for (int m = 0; m < count; ++m) {
      sum[m] += power;
      power = power * ratio;
    }
  }
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

/// The mass of a normal density between two numbers, from the tails that do not cancel.
template <class R>
KOKKOS_INLINE_FUNCTION R normal_between(R from, R to) {
  const auto flipped = from + to < R(0.0);
  const R a = device::select(flipped, -to, from), b = device::select(flipped, -from, to);
  return normal_above(a) - normal_above(b);
}

template <class R>
KOKKOS_INLINE_FUNCTION WeightPair<R> merton_weights(const PutPack<R>& put, R h, int d) {
  const R per = 1.0 / merton_deviation(put), mean = put.jump[1];
  const R near = (d - 0.5) * h, far = (d + 0.5) * h;
  return {put.jump[0] * normal_between((near - mean) * per, (far - mean) * per),
          put.jump[0] * normal_between((-far - mean) * per, (-near - mean) * per)};
}

/// cos(pi 2^{-k/2}).
KOKKOS_INLINE_FUNCTION double angle_cosine(int k) {
  constexpr double cosine[16] = {-1.0,
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
  return cosine[k];
}

/// Scratch memory of `jumps_of`: that of the result, and sums of lanes.
template <class R>
struct JumpsMemory {
  R *w, *left, *left_price, *slot;  ///< slot: (5 lanes)
};

/// Sets the weights up. A mixture's are nodal values of the density: with what they leave of the variance as
/// a difference the scheme is of second order for every density that x^2 makes bounded (Cont and Voltchkova
/// 2005 for the idea), and no quadrature is needed. The other models' are masses of cells.
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION Jumps<R> jumps_of(const Workers& workers, const PutPack<R>& put, const Law<R>& law,
                                         const Tails<R>& tails, const Grid<R>& grid,
                                         const JumpsMemory<R>& memory) {
  const int mesh = grid.mesh, block = (mesh + lanes - 1) / lanes, nodes = node_count(mesh);
  const R h = grid.h;
  const WeightLayout<R> layout(mesh);
  const bool mixed = put.model == Model::generalized_hyperbolic;
  workers.each([=](int lane) {
    for (int k = lane; k < layout.size(); k += lanes) memory.w[k] = 0.0;
    for (int k = lane; k < nodes; k += lanes) memory.left[k] = memory.left_price[k] = 0.0;
  });
  workers.each([=, &put, &law](int lane) {
    R rate = 0.0, variance = 0.0, price = 0.0;
    const int end = mesh < (lane + 1) * block ? mesh : (lane + 1) * block;
    const R tilt = 2.0 * device::absolute(put.jump[2]);
    for (int first = lane * block + 1; first <= end && put.model != Model::black_scholes; first += 8) {
      R sum[8];
      const int count = end - first + 1 < 8 ? end - first + 1 : 8;
      if (mixed) add_mixture(put, law, h, first, count, sum);
      for (int m = 0; m < count; ++m) {
        const int d = first + m;
        const R y = double(d) * h, growth = exponential(y);
        WeightPair<R> pair{};
        if (mixed) {
          const R heavy = sum[m] * (1.0 / d), light = heavy * exponential(-tilt * y);
          const auto upwards = put.jump[2] > R(0.0);
          pair = {device::select(upwards, heavy, light), device::select(upwards, light, heavy)};
        } else {
          pair = put.model == Model::kou ? kou_weights(put, h, d) : merton_weights(put, h, d);
        }
        // The other half of the first is what differences stand for; that of the last is among the tails.
        const double part = d == mesh || (mixed && d == 1) ? 0.5 : 1.0;
        const R up = part * pair.up, down = part * pair.down;
        memory.w[layout.place(d)] = up;
        memory.w[layout.place(-d)] = down;
        if (d >= 2) {
          memory.left[d - 1] = down;
          memory.left_price[d - 1] = down / growth;
        }
        rate += up + down;
        variance += (up + down) * y * y;
        price += (growth - 1.0) * (up - down / growth);
      }
    }
    memory.slot[lane] = rate;
    memory.slot[lanes + lane] = variance;
    memory.slot[2 * lanes + lane] = price;
  });
  Jumps<R> jumps{};
  jumps.w = memory.w;
  jumps.left = memory.left;
  jumps.left_price = memory.left_price;
  jumps.rate = total(memory.slot) + tails.up + tails.down;
  const R rest = law.variance - total(memory.slot + lanes) - tails.variance;
  jumps.diffusion = 0.5 * device::maximum(R(0.0), put.variance + rest);
  const R compensator =
      total(memory.slot + 2 * lanes) + (tails.up_price - tails.up) + (tails.down_price - tails.down);
  const R growth = exponential(0.5 * h), chord = growth - 1.0 / growth;  // 2 sinh(h/2)
  const R sinh = 0.5 * chord * (growth + 1.0 / growth);
  jumps.drift =
      (put.rate - put.dividend - compensator - jumps.diffusion * chord * chord / (h * h)) * h / sinh;
  workers.each([=](int lane) {
    if (lane == 0) {
      memory.left[mesh - 1] += tails.down;
      memory.left_price[mesh - 1] += tails.down_price;
    }
    if (lane >= 16) return;
    const double twice = 2.0 * angle_cosine(lane);
    R sum = 0.0;
    double before = 1.0, cosine = 0.5 * twice;
    for (int d = 1; d <= mesh; ++d) {
      sum += (1.0 - cosine) * (memory.w[layout.place(d)] + memory.w[layout.place(-d)]);
      const double next = twice * cosine - before;
      before = cosine;
      cosine = next;
    }
    memory.slot[3 * lanes + lane] = sum;
  });
  for (int k = 0; k < 16; ++k) jumps.symbol[k] = memory.slot[3 * lanes + k] + tails.up + tails.down;
  recur_backward(workers, memory.left, 1, block_of(mesh), R(1.0), memory.slot);
  recur_backward(workers, memory.left_price, 1, block_of(mesh), R(1.0), memory.slot);
  workers.each([=](int lane) {
    for (int i = 1 + lane; i < mesh; i += lanes)
      memory.left_price[i] = memory.left_price[i] * exponential((double(i) - grid.strike) * h);
  });
  return jumps;
}

}  // namespace drogue::options
