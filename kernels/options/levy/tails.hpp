#pragma once

#include "kernels/options/levy/levy_measure.hpp"

namespace drogue::options {

/// Moments of the Levy measure over jumps longer than the grid, 1/year.
template <class R>
struct Tails {
  R down;        ///< integral of g over downward jumps
  R down_price;  ///< integral of e^y g over downward jumps
  R up;          ///< integral of g over upward jumps
  R up_price;    ///< integral of e^y g over upward jumps
  R variance;    ///< integral of y^2 g over both
};

/// Tails beyond a grid of `length` in ln(spot): exponential integrals for a mixture, closed forms for the
/// other models. Collective over the thread group.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION Tails<R> make_tails(const ThreadGroup& group, const PutPack<R>& put,
                                           const LevyMeasure<R>& measure, R length) {
  if (put.model == JumpModel::kou) {
    const R p = put.jump[1], up = put.jump[2], down = put.jump[3];
    const R a = put.jump[0] * p * exponential(-up * length),
            b = put.jump[0] * (1.0 - p) * exponential(-down * length);
    const R i = 1.0 / up, j = 1.0 / down;
    return {.down = b,
            .down_price = b * down / (down + 1.0) * exponential(-length),
            .up = a,
            .up_price = a * up / (up - 1.0) * exponential(length),
            .variance = a * (length * length + 2.0 * i * (length + i)) +
                        b * (length * length + 2.0 * j * (length + j))};
  }
  if (put.model == JumpModel::merton) {
    const R rate = put.jump[0], m = put.jump[1], s = merton_deviation(put);
    const R price = rate * exponential(m + 0.5 * s * s), square = m * m + s * s;
    const R z_up = (length - m) / s, z_down = (length + m) / s;
    const R up = normal_upper_tail(z_up), down = normal_upper_tail(z_down);
    const auto density = [](R z) { return 0.3989422804014327 * exponential(-0.5 * z * z); };
    return {.down = rate * down,
            .down_price = price * normal_upper_tail(z_down + s),
            .up = rate * up,
            .up_price = price * normal_upper_tail(z_up - s),
            .variance = rate * (square * (up + down) +
                                s * ((length + m) * density(z_up) + (length - m) * density(z_down)))};
  }
  if (put.model != JumpModel::generalized_hyperbolic)
    return {.down = R(0.0), .down_price = R(0.0), .up = R(0.0), .up_price = R(0.0), .variance = R(0.0)};
  const R shrink = exponential(-length);
  const Kokkos::Array<R, 5> tails = sums(group, [&](int lane) {
    Kokkos::Array<R, 5> sum = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
    for (int q = lane; q < Mixture::low; q += group.lanes) {
      const R a = measure.s[q] - put.jump[2], b = measure.s[q] + put.jump[2], c = measure.c[q];
      const R rate[4] = {b * length, (b + 1.0) * length, a * length, (a - 1.0) * length};
      const R down = exponential(-rate[0]), up = exponential(-rate[2]);
      const R decay[4] = {down, down * shrink, up, exponential(-rate[3])};
      R tail[4];
      exponential_integrals(rate, decay, tail);
      for (int k = 0; k < 4; ++k) sum[k] += c * tail[k];
      const R up_length = measure.up[q], down_length = measure.down[q];
      sum[4] += c * ((length + down_length) * down_length * down + (length + up_length) * up_length * up);
    }
    return sum;
  });
  return {
      .down = tails[0], .down_price = tails[1], .up = tails[2], .up_price = tails[3], .variance = tails[4]};
}

}  // namespace drogue::options
